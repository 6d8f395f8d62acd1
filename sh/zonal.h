#pragma once
/// Zonal lights: radiance that is 1 inside a spherical cap and 0 outside, and any other lobe with an axis.
///
/// A cap of half angle a is held by its versine t = 1 - cos a, in [0, 2], because everything is smooth in t:
/// with the Legendre polynomials P_l at alpha = 1 - t,
///
///     z_l = sqrt(pi(2l+1))/(l(l+1)) sin^2 a P_l'(alpha),  z_0 = sqrt(pi) t      (Mézières 2022, Eq. 3.10)
///     dz_l/dt = sqrt(pi(2l+1)) P_l(alpha),  d2z_l/dt2 = -sqrt(pi(2l+1)) P_l'(alpha)        (Eq. 3.30-3.32)
///
/// The printed 3.10 subtracts P_{l+1} from P_{l-1}, which is all cancellation for a small cap; these forms
/// have none. Turned to an axis (Eq. 2.73, 3.11) sqrt(4pi/(2l+1)) meets sqrt(pi(2l+1)), so an SH coefficient
/// is g_l Y_lm(axis) with gains free of square roots: g_l = 2pi sin^2 a P_l'/(l(l+1)), dg_l/dt = 2pi P_l,
/// d2g_l/dt2 = -2pi P_l'.
///
///     float z[9];
///     sh::cap_zonal(9, sh::cap_from_half_angle(0.1f), z);

#include <cmath>

#include "sh/basis.h"

namespace zonal::sh {

template <class T>
struct Cap {
  T versine = 0;  ///< t = 1 - cos a, in [0, 2]
  T sine2 = 0;    ///< sin^2 a = t(2 - t), kept apart because each is cheap and exact in its own way
};

/// Half angle in radians, in [0, pi].
template <class T>
Cap<T> cap_from_half_angle(T a) {
  const T half = std::sin(a / 2), sine = std::sin(a);
  return {2 * half * half, sine * sine};
}

/// Solid angle in steradians, in [0, 4pi]; linear, so nothing is lost for small ones (Eq. 4.14 without its
/// acos).
template <class T>
Cap<T> cap_from_solid_angle(T omega) {
  const T t = omega * T(0.15915494309189533577);  // 1/(2pi)
  return {t, t * (2 - t)};
}

/// Gains g_l with SH coefficient g_l Y_lm(axis); optionally their first and second derivatives with respect
/// to t. Arrays of `bands` values.
template <class T>
void cap_gains(int bands, const Cap<T>& cap, T* g, T* dg_dt = nullptr, T* d2g_dt2 = nullptr);

/// Zonal coefficients z_l = sqrt((2l+1)/4pi) g_l; optionally their derivatives with respect to t.
template <class T>
void cap_zonal(int bands, const Cap<T>& cap, T* z, T* dz_dt = nullptr, T* d2z_dt2 = nullptr);

/// Batch: z[l * n + i] for cap i of n.
template <class T>
void cap_zonal_batch(int bands, int n, const T* versine, const T* sine2, T* z);

/// SH coefficients of zonal ones turned to a unit axis: f_lm = sqrt(4pi/(2l+1)) z_l Y_lm(axis) (Eq. 2.73,
/// active).
template <class T>
void rotate_zonal(int bands, const T* z, const Vec3<T>& axis, T* f);

/// Batch: n lobes, z[l * n + i], axes as three arrays; f[(l(l+1)+m) * n + i].
template <class T>
void rotate_zonal_batch(int bands, int n, const T* z, const T* axis_x, const T* axis_y, const T* axis_z,
                        T* f);

/// A cap seen from x: what its coefficients and their derivatives need. `w` below is the vector from x to the
/// light.
template <class T>
struct SeenCap {
  Vec3<T> axis{0, 0, 1};  ///< unit, from x towards the light
  T distance = 1;         ///< > 0
  Cap<T> cap;
  T cosine = 1;  ///< of the half angle; more accurate than 1 - versine near the hemisphere
  T dt = 0;      ///< dt/dd of the versine, d = |w|
  T d2t = 0;     ///< d2t/dd2
};

/// SH coefficients L, gradient and Hessian with respect to x (the light stays; Eq. 3.26: grad_x = -grad_w) of
/// a cap. Arrays of count(bands).
template <class T>
void seen_cap(int bands, const SeenCap<T>& seen, T* L);
template <class T>
void seen_cap_gradient(int bands, const SeenCap<T>& seen, T* L, Vec3<T>* gradient);
template <class T>
void seen_cap_hessian(int bands, const SeenCap<T>& seen, T* L, Vec3<T>* gradient, Hessian<T>* hessian);

}  // namespace zonal::sh
