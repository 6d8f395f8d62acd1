#pragma once
/// Triangular lights replaced by spheres at their centroid: the approximations of Mézières 2022, section 4.2,
/// with gradients. Cheap and smooth; sh/polygon.h is exact. Rough for narrow triangles and near ones.
///
///     const TriangleSphere<float> s = sh::triangle_sphere(p1, p2, p3);
///     sh::triangle_sphere_light(9, TriangleMethod::main, s, x, L, gradient);
///
/// Both faces shine. Where r_s >= d the sphere is the hemisphere and stands still, as in sh/sphere_light.h;
/// in the triangle's plane (cos gamma = 0) the gradient of |cos gamma| is taken as 0.

#include "sh/zonal.h"

namespace zonal::sh {

enum class TriangleMethod {
  main,               ///< sphere of equal area, radiance times |cos gamma| (Eq. 4.9-4.11)
  alternative,        ///< cap of the triangle's own solid angle (Eq. 4.14-4.16)
  compromise_radius,  ///< sin a = r |cos gamma|/d (Eq. 4.17 left, 4.18)
  compromise_angle    ///< a = |cos gamma| asin(r/d) (Eq. 4.17 right, 4.19)
};

template <class T>
struct TriangleSphere {
  Vec3<T> vertices[3];
  Vec3<T> center{0};        ///< (Eq. 4.7)
  Vec3<T> normal{0, 0, 1};  ///< unit
  T radius = 0;             ///< of the disk of the triangle's area (Eq. 4.8); 0 if it is degenerate
};

template <class T>
TriangleSphere<T> triangle_sphere(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c);

/// SH coefficients and, if not null, their gradient with respect to x. Arrays of count(bands). Black at x =
/// centroid only where the method says so; a degenerate triangle is black.
template <class T>
void triangle_sphere_light(int bands, TriangleMethod method, const TriangleSphere<T>& triangle,
                           const Vec3<T>& x, T* L, Vec3<T>* gradient = nullptr);

/// Batch: adds radiance[k] times the coefficients of triangle k to L (one colour a coefficient) and, if not
/// null, to gradient[axis][count(bands)].
template <class T>
void accumulate_triangle_spheres(int bands, TriangleMethod method, int n, const TriangleSphere<T>* triangles,
                                 const Vec3<T>* radiance, const Vec3<T>& x, Vec3<T>* L,
                                 Vec3<T>* const gradient[3] = nullptr);

}  // namespace zonal::sh
