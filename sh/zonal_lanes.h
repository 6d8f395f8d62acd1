#pragma once
/// Lanes: the recurrences of caps and of the basis for several lights or directions at once, one a SIMD lane.
/// The vector types are the compiler's own, so that the batch kernels vectorise under g++ as well.
///
///     basis_lanes<float, 8, false>(bands, x, y, z, [&](int l, int m, V X, V dX, V c, V s, V c1, V s1) { ...
///     });

#include <cmath>
#include <cstddef>

#include "sh/tables.h"

namespace zonal::sh {

template <class T, int W>
struct LanesOf {
  typedef T type __attribute__((vector_size(W * sizeof(T))));
};
template <class T, int W>
using Lanes = typename LanesOf<T, W>::type;

template <class V>
inline V sqrt_lanes(V v) {
#if __has_builtin(__builtin_elementwise_sqrt)
  return __builtin_elementwise_sqrt(v);
#else
  constexpr int kWidth = static_cast<int>(sizeof(V) / sizeof(v[0]));
  for (int k = 0; k < kWidth; ++k) v[k] = std::sqrt(v[k]);
  return v;
#endif
}

/// Lanes of one 256-bit register.
template <class T>
inline constexpr int lane_count = 32 / static_cast<int>(sizeof(T));

template <class T, int W>
inline Lanes<T, W> load_lanes(const T* p, int filled) {
  Lanes<T, W> v{};
  if (filled >= W) {
    __builtin_memcpy(&v, p, sizeof v);
  } else {
    for (int k = 0; k < filled; ++k) v[k] = p[k];
  }
  return v;
}

template <class T, int W>
inline void store_lanes(T* p, Lanes<T, W> v, int filled) {
  if (filled >= W) {
    __builtin_memcpy(p, &v, sizeof v);
  } else {
    for (int k = 0; k < filled; ++k) p[k] = v[k];
  }
}

/// p = P_l(1 - t) and q = 2 P_l'(1 - t)/(l(l+1)), upwards from l = 0, for t in [0, 1]. Both are 1 at t = 0.
/// Each keeps its difference to the previous band instead of the value at alpha = 1 - t (Reinsch's form of
/// the recurrence), so no digit is lost however small t is:
///     l (p_l - p_{l-1}) = (l-1)(p_{l-1} - p_{l-2}) - (2l-1) t p_{l-1}
///     (l+1)(q_l - q_{l-1}) = (l-2)(q_{l-1} - q_{l-2}) - (2l-1) t q_{l-1}
template <class T, class V = T>
struct CapRecurrence {
  V t, p, q, dp, dq;

  explicit CapRecurrence(V versine) : t(versine), p(versine * 0 + 1), q(p), dp(versine * 0), dq(dp) {}

  void step_q(int l) {
    if (l < 2) return;
    dq = (T(l - 2) * dq - T(2 * l - 1) * t * q) * (1 / T(l + 1));
    q += dq;
  }
  void step_p(int l) {
    dp = (T(l - 1) * dp - T(2 * l - 1) * t * p) * (1 / T(l));
    p += dp;
  }
  /// From l - 1 to l >= 1.
  void step(int l) { step_q(l), step_p(l); }
};

/// A direction as the recurrences of tables.h want it.
template <class T, class V>
struct DirectionLanes {
  V x, y, z;
  V u;     ///< 1 - |z|
  V sign;  ///< of z, +-1

  DirectionLanes(V x_, V y_, V z_) : x(x_), y(y_), z(z_) {
    const V size = z < 0 ? -z : z;
    u = (x * x + y * y) / (size + T(1));
    sign = z < 0 ? z * 0 - T(1) : z * 0 + T(1);
  }
  /// With u known better than x and y tell.
  DirectionLanes(V x_, V y_, V z_, V u_)
      : x(x_), y(y_), z(z_), u(u_), sign(z_ < 0 ? z_ * 0 - T(1) : z_ * 0 + T(1)) {}
};

/// Calls f(l, m, X, dX, c, s, c1, s1) for every 0 <= m <= l < bands, m from the highest down, such that
/// Y_l^m = sign^l X c and Y_l^-m = sign^l X s: the caller puts sign^l into whatever it multiplies band l
/// with. dX is the derivative of X for z (where wanted), c1 and s1 those of c and s: dc/dx = c1, dc/dy = -s1,
/// ds/dx = s1, ds/dy = c1.
template <class T, int W, bool kDerivative, class F>
inline void basis_lanes(int bands, const DirectionLanes<T, Lanes<T, W>>& d, F&& f) {
  using V = Lanes<T, W>;
  const Tables<T>& table = tables<T>();
  const V zero = d.x * 0;
  V c[kMaxBands], s[kMaxBands], above[kDerivative ? kMaxBands : 1];
  // Powers of sign (x + iy): with sign^l from the caller they make sign^{l-m}.
  const V x = d.x * d.sign, y = d.y * d.sign;
  c[0] = zero + T(1), s[0] = zero;
  for (int m = 1; m < bands; ++m) c[m] = x * c[m - 1] - y * s[m - 1], s[m] = x * s[m - 1] + y * c[m - 1];

  for (int m = bands - 1; m >= 0; --m) {
    V c1 = zero, s1 = zero;
    if (kDerivative && m > 0) c1 = T(m) * d.sign * c[m - 1], s1 = T(m) * d.sign * s[m - 1];
    const Step<T>* step = table.column(m) - m;
    V p = zero + T(1), e = zero;
    if constexpr (kDerivative) above[m] = zero;
    for (int l = m; l < bands; ++l) {
      if (l > m) {
        e = step[l].fall * e - step[l].rise * p;
        p += d.u * e;
      }
      V dX = zero;
      if constexpr (kDerivative) dX = step[l].slope * (d.sign * above[l]), above[l] = p;
      f(l, m, step[l].norm * p, dX, c[m], s[m], c1, s1);
    }
  }
}

}  // namespace zonal::sh
