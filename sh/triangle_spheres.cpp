#include "sh/triangle_spheres.h"

#include <vector>

#include "sh/seen_distance.h"
#include "sh/solid_angle.h"

namespace zonal::sh {
namespace {

constexpr double kPi = 3.14159265358979323846;
using dvec3 = Vec3<double>;

/// A cap whose size and brightness depend on x in any way; gradients with respect to w = y - x.
struct GeneralCap {
  dvec3 axis{0, 0, 1};
  double distance = 1;
  Cap<double> cap;
  dvec3 grad_versine{0};
  double brightness = 1;
  dvec3 grad_brightness{0};
};

template <class T>
GeneralCap general_cap(TriangleMethod method, const TriangleSphere<T>& triangle, const Vec3<T>& x) {
  GeneralCap g;
  const SeenDistance s = seen_distance<T>(x, triangle.center, triangle.radius);
  const double r = s.r / s.scale, d = s.d / s.scale;
  if (!(triangle.radius > 0)) {
    g.brightness = 0;
    return g;
  }
  g.axis = s.axis;
  g.distance = d > 0 ? d : 1;
  const double inverse_d = d > 0 ? 1 / d : 0;

  // |cos gamma| = |n.w| and its gradient (Eq. 4.11).
  const dvec3 n(triangle.normal);
  const double dot = glm::dot(n, g.axis), cosine = std::fabs(dot), side = dot > 0 ? 1 : dot < 0 ? -1 : 0;
  const dvec3 grad_cosine = (n - g.axis * dot) * (side * inverse_d);

  const bool outside = s.h2 > 0;
  const double h = outside ? std::sqrt(s.h2) / s.scale : 0, alpha = h * inverse_d;
  const double sine = outside ? r * inverse_d : 1;
  switch (method) {
    case TriangleMethod::main:
      g.cap = {sine * sine / (1 + alpha), sine * sine};
      if (outside) g.grad_versine = g.axis * (-sine * sine / h);
      g.brightness = cosine, g.grad_brightness = grad_cosine;
      break;
    case TriangleMethod::alternative: {
      Vec3<double> slope, v[3];
      for (int i = 0; i < 3; ++i) v[i] = dvec3(triangle.vertices[i]);
      double omega = polygon_solid_angle(3, v, dvec3(x), &slope);
      if (omega < 0) omega = -omega, slope = -slope;
      g.cap = cap_from_solid_angle(omega);
      g.grad_versine = slope * (-0.5 / kPi);  // (Eq. 4.15), without the square root of a vanishing angle
      break;
    }
    case TriangleMethod::compromise_radius: {
      const double full = r * inverse_d * cosine;
      if (!(full < 1)) {
        g.cap = {1, 1};
        break;
      }
      const double root = std::sqrt((1 - full) * (1 + full));
      g.cap = {full * full / (1 + root), full * full};
      // t = 1 - sqrt(1 - s^2): grad t = s grad s/sqrt(1 - s^2) (Eq. 4.18 times sin a).
      g.grad_versine = (grad_cosine - g.axis * (cosine * inverse_d)) * (r * inverse_d * full / root);
      break;
    }
    case TriangleMethod::compromise_angle: {
      const double whole = outside ? std::atan2(r, h) : kPi / 2, a = whole * cosine;
      g.cap = cap_from_half_angle(a);
      const dvec3 grad_whole = outside ? g.axis * (-r * inverse_d / h) : dvec3(0);  // (Eq. 3.28)
      g.grad_versine = (grad_whole * cosine + grad_cosine * whole) * std::sin(a);   // (Eq. 4.19)
      break;
    }
  }
  return g;
}

}  // namespace

template <class T>
TriangleSphere<T> triangle_sphere(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c) {
  TriangleSphere<T> s{{a, b, c}};
  s.center = Vec3<T>((dvec3(a) + dvec3(b) + dvec3(c)) / 3.0);
  const dvec3 e1 = dvec3(b) - dvec3(a), e2 = dvec3(c) - dvec3(a);
  const double scale = std::fmax(std::fmax(std::fabs(e1.x) + std::fabs(e1.y), std::fabs(e1.z)),
                                 std::fmax(std::fabs(e2.x) + std::fabs(e2.y), std::fabs(e2.z)));
  if (!(scale > 0)) return s;
  const dvec3 cross = glm::cross(e1 / scale, e2 / scale);
  const double length = glm::length(cross);
  if (!(length > 0)) return s;
  s.normal = Vec3<T>(cross / length);
  s.radius = T(std::sqrt(length / (2 * kPi)) * scale);
  return s;
}

template <class T>
void triangle_sphere_light(int bands, TriangleMethod method, const TriangleSphere<T>& triangle,
                           const Vec3<T>& x, T* L, Vec3<T>* gradient) {
  const GeneralCap g = general_cap(method, triangle, x);
  const Vec3<T> axis(g.axis);
  if (!gradient) {
    const Cap<T> cap{T(g.cap.versine), T(g.cap.sine2)};
    T gain[kMaxBands];
    cap_gains(bands, cap, gain);
    evaluate(bands, axis, L);
    for (int l = 0; l < bands; ++l) {
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) L[i] *= gain[l] * T(g.brightness);
    }
    return;
  }
  double gain[kMaxBands], slope[kMaxBands];
  cap_gains(bands, g.cap, gain, slope);
  evaluate_gradient(bands, axis, L, gradient);
  for (int l = 0; l < bands; ++l) {
    // grad_x = -(b g grad Y + Y (b g' grad t + g grad b)) (Eq. 4.10).
    const T turn = T(-g.brightness * gain[l] / g.distance);
    const Vec3<T> grow(-(g.grad_versine * (g.brightness * slope[l]) + g.grad_brightness * gain[l]));
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
      gradient[i] = gradient[i] * turn + grow * L[i];
      L[i] *= T(g.brightness * gain[l]);
    }
  }
}

template <class T>
void accumulate_triangle_spheres(int bands, TriangleMethod method, int n, const TriangleSphere<T>* triangles,
                                 const Vec3<T>* radiance, const Vec3<T>& x, Vec3<T>* L,
                                 Vec3<T>* const gradient[3]) {
  T one[kMaxBands * kMaxBands];
  thread_local std::vector<Vec3<T>> slope;
  if (gradient) slope.resize(count(bands));
  for (int k = 0; k < n; ++k) {
    triangle_sphere_light(bands, method, triangles[k], x, one, gradient ? slope.data() : nullptr);
    for (int i = 0; i < count(bands); ++i) {
      L[i] += radiance[k] * one[i];
      if (!gradient) continue;
      for (int axis = 0; axis < 3; ++axis) gradient[axis][i] += radiance[k] * slope[i][axis];
    }
  }
}

#define ZONAL_INSTANTIATE(T)                                                                                \
  template TriangleSphere<T> triangle_sphere<T>(const Vec3<T>&, const Vec3<T>&, const Vec3<T>&);            \
  template void triangle_sphere_light<T>(int, TriangleMethod, const TriangleSphere<T>&, const Vec3<T>&, T*, \
                                         Vec3<T>*);                                                         \
  template void accumulate_triangle_spheres<T>(int, TriangleMethod, int, const TriangleSphere<T>*,          \
                                               const Vec3<T>*, const Vec3<T>&, Vec3<T>*, Vec3<T>* const*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
