#include "sh/zonal.h"

#include "sh/seen_cap_unrolled.h"
#include "sh/zonal_lanes.h"

namespace zonal::sh {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct BandFactors {
  double zonal[kMaxBands];  ///< sqrt((2l+1)/4pi): from gain to zonal coefficient

  BandFactors() {
    for (int l = 0; l < kMaxBands; ++l) zonal[l] = std::sqrt((2 * l + 1) / (4 * kPi));
  }
};

const BandFactors& band_factors() {
  static const BandFactors factors;
  return factors;
}

}  // namespace

template <class T>
void cap_gains(int bands, const Cap<T>& cap, T* g, T* dg_dt, T* d2g_dt2) {
  constexpr T pi = T(kPi);
  // Beyond the hemisphere, recur in the other cap's versine and give odd polynomials their sign back.
  const bool mirrored = cap.versine > 1;
  const T sign = mirrored ? T(-1) : T(1);
  CapRecurrence<T> r(mirrored ? 2 - cap.versine : cap.versine);

  g[0] = 2 * pi * cap.versine;
  if (dg_dt) dg_dt[0] = 2 * pi;
  if (d2g_dt2) d2g_dt2[0] = 0;
  T even = 1;  // sign^l
  for (int l = 1; l < bands; ++l) {
    r.step(l);
    g[l] = pi * cap.sine2 * even * r.q;
    if (d2g_dt2) d2g_dt2[l] = -pi * T(l * (l + 1)) * even * r.q;
    even *= sign;
    if (dg_dt) dg_dt[l] = 2 * pi * even * r.p;
  }
}

template <class T>
void cap_zonal(int bands, const Cap<T>& cap, T* z, T* dz_dt, T* d2z_dt2) {
  cap_gains(bands, cap, z, dz_dt, d2z_dt2);
  const double* factor = band_factors().zonal;
  for (int l = 0; l < bands; ++l) {
    z[l] *= T(factor[l]);
    if (dz_dt) dz_dt[l] *= T(factor[l]);
    if (d2z_dt2) d2z_dt2[l] *= T(factor[l]);
  }
}

template <class T>
void cap_zonal_batch(int bands, int n, const T* versine, const T* sine2, T* z) {
  constexpr int kWidth = lane_count<T>;
  using V = Lanes<T, kWidth>;
  const double* factor = band_factors().zonal;
  for (int i = 0; i < n; i += kWidth) {
    const int filled = n - i < kWidth ? n - i : kWidth;
    const V t = load_lanes<T, kWidth>(versine + i, filled), s2 = load_lanes<T, kWidth>(sine2 + i, filled);
    V sign, u;
    for (int k = 0; k < kWidth; ++k) {
      sign[k] = t[k] > 1 ? T(-1) : T(1);
      u[k] = t[k] > 1 ? 2 - t[k] : t[k];
    }
    CapRecurrence<T, V> r(u);
    store_lanes<T, kWidth>(z + i, t * T(2 * kPi * factor[0]), filled);
    V scale = s2 * T(kPi);
    for (int l = 1; l < bands; ++l) {
      r.step(l);
      store_lanes<T, kWidth>(z + static_cast<size_t>(l) * n + i, scale * r.q * T(factor[l]), filled);
      scale *= sign;
    }
  }
}

template <class T>
void rotate_zonal(int bands, const T* z, const Vec3<T>& axis, T* f) {
  evaluate(bands, axis, f);
  const double* factor = band_factors().zonal;
  for (int l = 0; l < bands; ++l) {
    const T gain = z[l] / T(factor[l]);
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) f[i] *= gain;
  }
}

template <class T>
void rotate_zonal_batch(int bands, int n, const T* z, const T* x, const T* y, const T* zz, T* f) {
  constexpr int kWidth = lane_count<T>;
  using V = Lanes<T, kWidth>;
  const double* factor = band_factors().zonal;
  V gain[kMaxBands];
  for (int i = 0; i < n; i += kWidth) {
    const int filled = n - i < kWidth ? n - i : kWidth;
    const DirectionLanes<T, V> axis(load_lanes<T, kWidth>(x + i, filled),
                                    load_lanes<T, kWidth>(y + i, filled),
                                    load_lanes<T, kWidth>(zz + i, filled));
    V parity = axis.sign * axis.sign;
    for (int l = 0; l < bands; ++l, parity *= axis.sign) {
      gain[l] = load_lanes<T, kWidth>(z + static_cast<size_t>(l) * n + i, filled) * parity * T(1 / factor[l]);
    }
    basis_lanes<T, kWidth, false>(bands, axis, [&](int l, int m, V X, V, V c, V s, V, V) {
      const V u = gain[l] * X;
      store_lanes<T, kWidth>(f + static_cast<size_t>(index(l, m)) * n + i, u * c, filled);
      if (m > 0) store_lanes<T, kWidth>(f + static_cast<size_t>(index(l, -m)) * n + i, u * s, filled);
    });
  }
}

template <class T>
void seen_cap(int bands, const SeenCap<T>& seen, T* L) {
  if (seen_cap_few_bands(bands, seen.axis, seen.cap, L)) return;
  evaluate(bands, seen.axis, L);
  // A seen cap is at most a hemisphere: no mirror, and the gains need no array.
  CapRecurrence<T> r(seen.cap.versine);
  L[0] *= T(2 * kPi) * seen.cap.versine;
  const T scale = T(kPi) * seen.cap.sine2;
  for (int l = 1; l < bands; ++l) {
    r.step_q(l);
    const T gain = scale * r.q;
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) L[i] *= gain;
  }
}

template <class T>
void seen_cap_gradient(int bands, const SeenCap<T>& seen, T* L, Vec3<T>* gradient) {
  T g[kMaxBands], dg[kMaxBands];
  cap_gains(bands, seen.cap, g, dg);
  evaluate_gradient(bands, seen.axis, L, gradient);
  const T inverse_distance = 1 / seen.distance;
  for (int l = 0; l < bands; ++l) {
    const T turn = -g[l] * inverse_distance;
    const Vec3<T> grow = seen.axis * (-dg[l] * seen.dt);
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
      gradient[i] = gradient[i] * turn + grow * L[i];  // (Eq. 3.26)
      L[i] *= g[l];
    }
  }
}

template <class T>
void seen_cap_hessian(int bands, const SeenCap<T>& seen, T* L, Vec3<T>* gradient, Hessian<T>* hessian) {
  T g[kMaxBands], dg[kMaxBands], d2g[kMaxBands];
  cap_gains(bands, seen.cap, g, dg, d2g);
  evaluate_hessian(bands, seen.axis, L, gradient, hessian);
  const Vec3<T> w = seen.axis;
  const T inv = 1 / seen.distance;
  for (int l = 0; l < bands; ++l) {
    // Second derivative of g(t(d)) Y(w): g Y'' + 2 sym(g' t' w (x) Y') + Y (radial w (x) w + round (1 - w (x)
    // w)).
    const T turn = g[l] * inv * inv;
    const T cross = dg[l] * seen.dt * inv;
    const T radial = d2g[l] * seen.dt * seen.dt + dg[l] * seen.d2t;
    const T round = dg[l] * seen.dt * inv;
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
      const T y = L[i];
      const Vec3<T> d = gradient[i];
      const T ww = y * (radial - round), one = y * round;
      Hessian<T>& h = hessian[i];
      h.xx = turn * h.xx + 2 * cross * w.x * d.x + ww * w.x * w.x + one;
      h.yy = turn * h.yy + 2 * cross * w.y * d.y + ww * w.y * w.y + one;
      h.zz = turn * h.zz + 2 * cross * w.z * d.z + ww * w.z * w.z + one;
      h.xy = turn * h.xy + cross * (w.x * d.y + w.y * d.x) + ww * w.x * w.y;
      h.xz = turn * h.xz + cross * (w.x * d.z + w.z * d.x) + ww * w.x * w.z;
      h.yz = turn * h.yz + cross * (w.y * d.z + w.z * d.y) + ww * w.y * w.z;
      gradient[i] = d * (-g[l] * inv) - w * (dg[l] * seen.dt * y);
      L[i] = g[l] * y;
    }
  }
}

#define ZONAL_INSTANTIATE(T)                                                                 \
  template void cap_gains<T>(int, const Cap<T>&, T*, T*, T*);                                \
  template void cap_zonal<T>(int, const Cap<T>&, T*, T*, T*);                                \
  template void cap_zonal_batch<T>(int, int, const T*, const T*, T*);                        \
  template void rotate_zonal<T>(int, const T*, const Vec3<T>&, T*);                          \
  template void rotate_zonal_batch<T>(int, int, const T*, const T*, const T*, const T*, T*); \
  template void seen_cap<T>(int, const SeenCap<T>&, T*);                                     \
  template void seen_cap_gradient<T>(int, const SeenCap<T>&, T*, Vec3<T>*);                  \
  template void seen_cap_hessian<T>(int, const SeenCap<T>&, T*, Vec3<T>*, Hessian<T>*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
