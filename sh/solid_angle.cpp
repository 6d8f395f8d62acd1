#include "sh/solid_angle.h"

#include "sh/polygon_geometry.h"

namespace zonal::sh {

template <class T>
T polygon_solid_angle(int n, const Vec3<T>* vertices, const Vec3<T>& x, Vec3<T>* gradient) {
  const double scale = polygon_scale(n, vertices, x);
  const SeenVertex first = see_vertex(vertices[0], x, scale);
  SeenVertex before = see_vertex(vertices[1], x, scale);
  double omega = 0;
  dvec3 slope = solid_angle_gradient_term(first, before);
  for (int i = 2; i < n; ++i) {
    const SeenVertex v = see_vertex(vertices[i], x, scale);
    omega += seen_solid_angle(first, before, v);
    slope += solid_angle_gradient_term(before, v);
    before = v;
  }
  slope += solid_angle_gradient_term(before, first);
  if (gradient) *gradient = Vec3<T>(slope * scale);
  return T(omega);
}

template <class T>
void triangle_solid_angles(int count, const T* const a[3], const T* const b[3], const T* const c[3],
                           const Vec3<T>& x, T* omega, T* const gradient[3]) {
  for (int i = 0; i < count; ++i) {
    const Vec3<T> v[3] = {
        {a[0][i], a[1][i], a[2][i]}, {b[0][i], b[1][i], b[2][i]}, {c[0][i], c[1][i], c[2][i]}};
    Vec3<T> slope;
    omega[i] = polygon_solid_angle(3, v, x, gradient ? &slope : nullptr);
    if (gradient) gradient[0][i] = slope.x, gradient[1][i] = slope.y, gradient[2][i] = slope.z;
  }
}

#define ZONAL_INSTANTIATE(T)                                                                     \
  template T polygon_solid_angle<T>(int, const Vec3<T>*, const Vec3<T>&, Vec3<T>*);              \
  template void triangle_solid_angles<T>(int, const T* const*, const T* const*, const T* const*, \
                                         const Vec3<T>&, T*, T* const*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
