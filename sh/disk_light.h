#pragma once
/// Oriented disks: uniform disks that always face the shaded point. Half angle atan(r/d) (Mézières 2022,
/// Eq. 3.29), so unlike a sphere's everything is smooth down to d = 0, where a disk fills the hemisphere
/// (around +z at d = 0 itself).
///
///     sh::disk_light(9, shaded_point, center, radius, L);

#include "sh/zonal.h"

namespace zonal::sh {

/// The cap of an oriented disk of radius r > 0 around y, seen from x.
template <class T>
SeenCap<T> see_disk(const Vec3<T>& x, const Vec3<T>& y, T r);
template <class T>
SeenCap<T> see_disk(T d, T r);

/// Zonal coefficients by distance d > 0; optionally their derivatives with respect to d, r fixed.
template <class T>
void disk_light_zonal(int bands, T d, T r, T* z, T* dz_dd = nullptr, T* d2z_dd2 = nullptr);

/// SH coefficients, gradient and Hessian with respect to x. Arrays of count(bands).
template <class T>
void disk_light(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L) {
  seen_cap(bands, see_disk(x, y, r), L);
}
template <class T>
void disk_light_gradient(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L, Vec3<T>* gradient) {
  seen_cap_gradient(bands, see_disk(x, y, r), L, gradient);
}
template <class T>
void disk_light_hessian(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L, Vec3<T>* gradient,
                        Hessian<T>* hessian) {
  seen_cap_hessian(bands, see_disk(x, y, r), L, gradient, hessian);
}

}  // namespace zonal::sh
