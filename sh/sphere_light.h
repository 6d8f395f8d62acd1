#pragma once
/// Spherical lights: the SH coefficients of the light a uniform sphere of radiance 1 sends to a point, and
/// how they change as the point moves. The sphere is a cap of half angle asin(r/d) (Mézières 2022,
/// Eq. 3.10, 3.11, 3.26-3.30).
///
///     float L[81];
///     sh::sphere_light(9, shaded_point, light_center, radius, L);
///
/// Inside the sphere and on it (d <= r) the light is the hemisphere around the axis, the limit from outside,
/// and its size does not change any more: cosine 0, dt = 0. At the centre itself the axis is +z. From outside
/// the gradient grows without bound towards the surface, like 1/sqrt(d - r).

#include "sh/zonal.h"

namespace zonal::sh {

/// The cap of a sphere of radius r > 0 around y, seen from x. Carries d^2 - r^2 in twice the precision, for
/// it decides everything close to the surface.
template <class T>
SeenCap<T> see_sphere(const Vec3<T>& x, const Vec3<T>& y, T r);

/// The same at a distance d along +z.
template <class T>
SeenCap<T> see_sphere(T d, T r);

/// Zonal coefficients by distance d > 0; optionally their derivatives with respect to d, r fixed.
template <class T>
void sphere_light_zonal(int bands, T d, T r, T* z, T* dz_dd = nullptr, T* d2z_dd2 = nullptr);

/// SH coefficients, gradient and Hessian with respect to x. Arrays of count(bands).
template <class T>
void sphere_light(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L);
template <class T>
void sphere_light_gradient(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L, Vec3<T>* gradient) {
  seen_cap_gradient(bands, see_sphere(x, y, r), L, gradient);
}
template <class T>
void sphere_light_hessian(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L, Vec3<T>* gradient,
                          Hessian<T>* hessian) {
  seen_cap_hessian(bands, see_sphere(x, y, r), L, gradient, hessian);
}

}  // namespace zonal::sh
