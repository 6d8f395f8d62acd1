#include "sh/sphere_light.h"

#include <algorithm>

#include "sh/disk_light.h"
#include "sh/few_bands.h"
#include "sh/seen_cap_unrolled.h"
#include "sh/seen_distance.h"

// Compiled without reassociation: the sums below carry their own rounding errors.

namespace zonal::sh {
namespace {

/// The sphere's cap from d and h2 = d^2 - r^2, in double.
template <class T>
SeenCap<T> sphere_cap(double d, double h2, double r) {
  SeenCap<T> seen;
  seen.distance = T(d);
  if (!(h2 > 0)) {  // on or inside: the hemisphere, constant
    seen.cap = {1, 1}, seen.cosine = 0;
    return seen;
  }
  const double h = std::sqrt(h2), inverse_d = 1 / d, inverse_h = 1 / h;
  const double cosine = h * inverse_d, ratio = r * inverse_d, sine2 = ratio * ratio;
  seen.cap = {T(sine2 / (1 + cosine)), T(sine2)};
  seen.cosine = T(cosine);
  seen.dt = T(-sine2 * inverse_h);  // (Eq. 3.28) times sin a
  const double k = ratio * inverse_h;
  seen.d2t = T(k * k * (3 * h2 + r * r) * (inverse_d * inverse_h));  // r^2 (3d^2 - 2r^2)/(d h)^3
  return seen;
}

template <class T>
SeenCap<T> disk_cap(double d, double r) {
  SeenCap<T> seen;
  const double s = std::sqrt(d * d + r * r), ratio = r / s;
  seen.distance = T(d);
  seen.cap = {T(ratio * (r / (s + d))), T(ratio * ratio)};
  seen.cosine = T(d / s);
  seen.dt = T(-ratio * ratio / s);                        // (Eq. 3.29) times sin a
  seen.d2t = T(3 * (ratio / s) * (ratio / s) * (d / s));  // 3 r^2 d/s^5
  return seen;
}

/// Undoes the power of two that kept squares in range.
template <class T>
SeenCap<T> rescaled(SeenCap<T> seen, double scale) {
  if (scale == 1) return seen;
  seen.distance = T(double(seen.distance) / scale);
  seen.dt = T(double(seen.dt) * scale);
  seen.d2t = T(double(seen.d2t) * scale * scale);
  return seen;
}

template <class T>
void chain_to_distance(int bands, const SeenCap<T>& seen, T* z, T* dz_dd, T* d2z_dd2) {
  T dt[kMaxBands], d2t[kMaxBands];
  cap_zonal(bands, seen.cap, z, dt, d2t);
  for (int l = 0; l < bands; ++l) {
    if (dz_dd) dz_dd[l] = dt[l] * seen.dt;
    if (d2z_dd2) d2z_dd2[l] = d2t[l] * seen.dt * seen.dt + dt[l] * seen.d2t;
  }
}

/// Any sphere, any number of bands.
template <class T>
[[gnu::noinline]] void sphere_many_bands(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L) {
  if constexpr (std::is_same_v<T, float>) {
    // Nothing but what the coefficients need, the roots where they are cheap.
    const Vec3<double> w = Vec3<double>(y) - Vec3<double>(x);
    const double d2 = w.x * w.x + w.y * w.y + w.z * w.z, r2 = double(r) * r, inverse_d2 = 1 / d2;
    if (bands <= 10 && d2 > r2) {
      const float sine2 = float(r2 * inverse_d2), cosine = std::sqrt(float((d2 - r2) * inverse_d2));
      const Vec3<float> axis(w * std::sqrt(inverse_d2));
      seen_cap_few_bands<float>(bands, axis, {sine2 / (1 + cosine), sine2}, L);
      return;
    }
  }
  seen_cap(bands, see_sphere(x, y, r), L);
}

/// False, and nothing done, for spheres that are near, or of extreme size.
template <int N>
[[gnu::always_inline]] inline bool sphere_few_bands(const Vec3<float>& x, const Vec3<float>& y, float r,
                                                    float* __restrict__ L) {
  const float wx = y.x - x.x, wy = y.y - x.y, wz = y.z - x.z;
  const float xy2 = wx * wx + wy * wy, d2 = xy2 + wz * wz;
  const float inverse = 1 / std::sqrt(d2), ratio = r * inverse, sine2 = ratio * ratio;
  if (!(sine2 < kFewSine2 && d2 > kFewLeast && d2 < kFewMost)) return false;
  float gain[N];
  few_gains<N, float>(sine2, std::sqrt(1 - sine2), gain);
  const float z = wz * inverse, s2 = few_sine2(z, xy2 * inverse * inverse);
  few_bands<N, float>(
      wx * inverse, wy * inverse, z, s2,
      gain, [&](int i, float v) __attribute__((always_inline)) { L[i] = v; });
  return true;
}

}  // namespace

template <class T>
SeenCap<T> see_sphere(const Vec3<T>& x, const Vec3<T>& y, T r) {
  const SeenDistance s = seen_distance<T>(x, y, r);
  SeenCap<T> seen = rescaled(sphere_cap<T>(s.d, s.h2, s.r), s.scale);
  seen.axis = Vec3<T>(T(s.axis.x), T(s.axis.y), T(s.axis.z));
  if (!(seen.distance > 0)) seen.distance = 1;
  return seen;
}

template <class T>
SeenCap<T> see_sphere(T d, T r) {
  const double scale = range_scale<T>(std::max(double(d), double(r)));
  const double ds = double(d) * scale, rs = double(r) * scale;
  return rescaled(sphere_cap<T>(ds, (ds - rs) * (ds + rs), rs), scale);
}

template <class T>
SeenCap<T> see_disk(const Vec3<T>& x, const Vec3<T>& y, T r) {
  const SeenDistance s = seen_distance<T>(x, y, r);
  SeenCap<T> seen = rescaled(disk_cap<T>(s.d, s.r), s.scale);
  seen.axis = Vec3<T>(T(s.axis.x), T(s.axis.y), T(s.axis.z));
  if (!(seen.distance > 0)) seen.distance = 1;
  return seen;
}

template <class T>
SeenCap<T> see_disk(T d, T r) {
  const double scale = range_scale<T>(std::max(double(d), double(r)));
  return rescaled(disk_cap<T>(double(d) * scale, double(r) * scale), scale);
}

template <class T>
void sphere_light(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L) {
  if constexpr (std::is_same_v<T, float>) {
    switch (bands) {
      case 1:
        if (sphere_few_bands<1>(x, y, r, L)) return;
        break;
      case 2:
        if (sphere_few_bands<2>(x, y, r, L)) return;
        break;
      case 3:
        if (sphere_few_bands<3>(x, y, r, L)) return;
        break;
      case 4:
        if (sphere_few_bands<4>(x, y, r, L)) return;
        break;
      case 5:
        if (sphere_few_bands<5>(x, y, r, L)) return;
        break;
      case 6:
        if (sphere_few_bands<6>(x, y, r, L)) return;
        break;
      default:
        break;
    }
  }
  sphere_many_bands(bands, x, y, r, L);
}

template <class T>
void sphere_light_zonal(int bands, T d, T r, T* z, T* dz_dd, T* d2z_dd2) {
  chain_to_distance(bands, see_sphere(d, r), z, dz_dd, d2z_dd2);
}

template <class T>
void disk_light_zonal(int bands, T d, T r, T* z, T* dz_dd, T* d2z_dd2) {
  chain_to_distance(bands, see_disk(d, r), z, dz_dd, d2z_dd2);
}

#define ZONAL_INSTANTIATE(T)                                                 \
  template SeenCap<T> see_sphere<T>(const Vec3<T>&, const Vec3<T>&, T);      \
  template SeenCap<T> see_sphere<T>(T, T);                                   \
  template SeenCap<T> see_disk<T>(const Vec3<T>&, const Vec3<T>&, T);        \
  template SeenCap<T> see_disk<T>(T, T);                                     \
  template void sphere_light<T>(int, const Vec3<T>&, const Vec3<T>&, T, T*); \
  template void sphere_light_zonal<T>(int, T, T, T*, T*, T*);                \
  template void disk_light_zonal<T>(int, T, T, T*, T*, T*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
