#pragma once
/// Many point, spot or directional lights at once, one a SIMD lane: the sum of their coefficients in three
/// colours and, where wanted, its gradient with respect to x. Any number of bands; the single forms are in
/// simple_lights.h.
///
///     sh::DiracArrays<float> lights{n, x, y, z, {red, green, blue}};
///     sh::accumulate_point_lights(5, point, lights, sum);          // [colour][l(l+1)+m], zeroed by the
///     caller
///
/// Distances are computed in double for float lights; squares and cubes of distances must stay in T's range.

#include <algorithm>
#include <type_traits>
#include <vector>

#include "sh/zonal_lanes.h"

namespace zonal::sh {

/// Structure of arrays, caller-owned.
template <class T>
struct DiracArrays {
  int count = 0;
  const T *x = nullptr, *y = nullptr, *z = nullptr;  ///< positions; of directional lights: unit travel
  const T* intensity[3] = {nullptr, nullptr,
                           nullptr};  ///< red, green, blue, W/sr; of directional: irradiance
  const T* radius = nullptr;          ///< point lights: Yuksel's, > 0; null: 1/d^2
  const T *axis_x = nullptr, *axis_y = nullptr, *axis_z = nullptr;  ///< spots: unit
  const T *cos_inner = nullptr, *cos_outer = nullptr;               ///< spots: cos_outer < cos_inner
};

namespace detail {

enum class DiracKind { point, spot, directional };

/// Lights of a block: weight Y(x, y, z), weight's gradient for the shaded point.
template <class T, int W>
struct DiracLanes {
  using V = Lanes<T, W>;
  using D = Lanes<double, W>;
  V x, y, z, weight, inverse_d, gx, gy, gz;

  static V narrow(D v) { return __builtin_convertvector(v, V); }
  static D wide(const T* p, int first, int filled) {
    return __builtin_convertvector((load_lanes<T, W>(p + first, filled)), D);
  }

  DiracLanes(DiracKind kind, const Vec3<T>& p, const DiracArrays<T>& lights, int first, int filled) {
    D wx = wide(lights.x, first, filled), wy = wide(lights.y, first, filled),
      wz = wide(lights.z, first, filled);
    const D none = wx * 0;
    if (kind == DiracKind::directional) {
      x = narrow(-wx), y = narrow(-wy), z = narrow(-wz);
      weight = narrow(none + 1.0), inverse_d = gx = gy = gz = narrow(none);
      return;
    }
    wx -= double(p.x), wy -= double(p.y), wz -= double(p.z);
    const D d2 = wx * wx + wy * wy + wz * wz, inverse = 1.0 / sqrt_lanes(d2 > 0 ? d2 : none + 1.0);
    wx *= inverse, wy *= inverse, wz = d2 > 0 ? wz * inverse : none + 1.0;
    D value = d2 > 0 ? inverse * inverse : none, slope = 2 * value * inverse;
    if (kind == DiracKind::point && lights.radius) {  // (Eq. 5.18, 5.22)
      const D r = wide(lights.radius, first, filled), s2 = d2 + r * r,
              s = sqrt_lanes(s2 > 0 ? s2 : none + 1.0);
      value = 2.0 / (s * (s + sqrt_lanes(d2)));
      slope = d2 > 0 ? 2.0 / (s * s * s) : none;
    }
    D sx = wx * slope, sy = wy * slope, sz = wz * slope;
    if (kind == DiracKind::spot) {
      const D ax = wide(lights.axis_x, first, filled), ay = wide(lights.axis_y, first, filled),
              az = wide(lights.axis_z, first, filled), outer = wide(lights.cos_outer, first, filled),
              width = wide(lights.cos_inner, first, filled) - outer;
      const D cosine = -(ax * wx + ay * wy + az * wz), unit = 1.0 / (width > 0 ? width : none + 1.0);
      D u = (cosine - outer) * unit;
      u = u > 0 ? u : none, u = u < 1 ? u : none + 1.0;
      const D falloff = u * u * (3.0 - 2.0 * u), turn = value * inverse * 6.0 * u * (1.0 - u) * unit;
      sx = sx * falloff + (ax + wx * cosine) * turn;
      sy = sy * falloff + (ay + wy * cosine) * turn;
      sz = sz * falloff + (az + wz * cosine) * turn;
      value *= falloff;
    }
    x = narrow(wx), y = narrow(wy), z = narrow(wz);
    weight = narrow(value), inverse_d = narrow(inverse);
    gx = narrow(sx), gy = narrow(sy), gz = narrow(sz);
  }
};

/// Adds a block to lane sums, 3 or 12 a coefficient.
template <bool kGradient, class T, int W>
void add_diracs(int bands, const DiracLanes<T, W>& seen, const Lanes<T, W>* colour, Lanes<T, W>* lanes) {
  using V = Lanes<T, W>;
  constexpr int kSums = kGradient ? 12 : 3;
  const DirectionLanes<T, V> d(seen.x, seen.y, seen.z);
  const V even = seen.weight * 0 + T(1);
  const auto add = [&](int i, V value, V gx, V gy, V gz) {
    V* sum = lanes + static_cast<size_t>(i) * kSums;
    for (int k = 0; k < 3; ++k) {
      sum[k] += colour[k] * value;
      if constexpr (kGradient) {
        sum[3 + 3 * k] += colour[k] * gx, sum[4 + 3 * k] += colour[k] * gy, sum[5 + 3 * k] += colour[k] * gz;
      }
    }
  };
  basis_lanes<T, W, kGradient>(bands, d, [&](int l, int m, V X, V dX, V c, V s, V c1, V s1) {
    const V parity = l % 2 ? d.sign : even, q = parity * X, value = seen.weight * q;
    if constexpr (!kGradient) {
      add(index(l, m), value * c, q, q, q);
      if (m > 0) add(index(l, -m), value * s, q, q, q);
    } else {
      // weight grad_x Y + Y grad_x weight (Eq. 5.20); X (x+iy)^m made independent of |w| as in
      // light_batch.cpp.
      const V turn = -seen.inverse_d * seen.weight * parity, flat = turn * X, up = turn * dX;
      const V along = -(up * d.z + T(m) * flat);
      V k = along * c, y = q * c;
      add(index(l, m), value * c, flat * c1 + d.x * k + seen.gx * y, d.y * k - flat * s1 + seen.gy * y,
          up * c + d.z * k + seen.gz * y);
      if (m == 0) return;
      k = along * s, y = q * s;
      add(index(l, -m), value * s, flat * s1 + d.x * k + seen.gx * y, flat * c1 + d.y * k + seen.gy * y,
          up * s + d.z * k + seen.gz * y);
    }
  });
}

template <bool kGradient, class T>
void accumulate_diracs(DiracKind kind, int bands, const Vec3<T>& x, const DiracArrays<T>& lights, T* sum,
                       T* gradient) {
  constexpr int kWidth = lane_count<T>, kSums = kGradient ? 12 : 3;
  using V = Lanes<T, kWidth>;
  thread_local std::vector<V> lanes;
  const int n = count(bands);
  lanes.assign(static_cast<size_t>(n) * kSums, V{});
  for (int first = 0; first < lights.count; first += kWidth) {
    const int filled = std::min(kWidth, lights.count - first);
    const DiracLanes<T, kWidth> seen(kind, x, lights, first, filled);
    V colour[3];
    for (int k = 0; k < 3; ++k) colour[k] = load_lanes<T, kWidth>(lights.intensity[k] + first, filled);
    add_diracs<kGradient, T, kWidth>(bands, seen, colour, lanes.data());
  }
  for (int i = 0; i < n; ++i) {
    const V* v = &lanes[static_cast<size_t>(i) * kSums];
    for (int k = 0; k < kSums; ++k) {
      T total = 0;
      for (int lane = 0; lane < kWidth; ++lane) total += v[k][lane];
      (k < 3 ? sum[k * n + i] : gradient[(k - 3) * n + i]) += total;
    }
  }
}

template <class T>
void accumulate_diracs(DiracKind kind, int bands, const Vec3<T>& x, const DiracArrays<T>& lights, T* sum,
                       T* gradient) {
  gradient ? accumulate_diracs<true>(kind, bands, x, lights, sum, gradient)
           : accumulate_diracs<false>(kind, bands, x, lights, sum, gradient);
}

}  // namespace detail

/// sum[c * count(bands) + i] += intensity_c times coefficient i, over all lights; where gradient is not null,
/// gradient[(c * 3 + axis) * count(bands) + i] += its derivative with respect to x. With lights.radius:
/// Yuksel's attenuation (Eq. 5.18), else 1/d^2, black at d = 0 (Eq. 5.17).
template <class T>
void accumulate_point_lights(int bands, const Vec3<T>& x, const DiracArrays<T>& lights, T* sum,
                             std::type_identity_t<T>* gradient = nullptr) {
  detail::accumulate_diracs(detail::DiracKind::point, bands, x, lights, sum, gradient);
}

/// The same for spots with 1/d^2.
template <class T>
void accumulate_spot_lights(int bands, const Vec3<T>& x, const DiracArrays<T>& lights, T* sum,
                            std::type_identity_t<T>* gradient = nullptr) {
  detail::accumulate_diracs(detail::DiracKind::spot, bands, x, lights, sum, gradient);
}

/// Parallel lights; their light does not depend on the point.
template <class T>
void accumulate_directional_lights(int bands, const DiracArrays<T>& lights, T* sum) {
  detail::accumulate_diracs<false, T>(detail::DiracKind::directional, bands, Vec3<T>(0), lights, sum,
                                      nullptr);
}

}  // namespace zonal::sh
