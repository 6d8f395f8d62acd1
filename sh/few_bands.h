#pragma once
/// Caps of up to 6 bands with every constant known to the compiler, for one light or several in lanes: V is T
/// or a vector of T.
///
/// The m-th derivative of P_l over its value at 1 is, with s2 = 1 - z^2, n = floor((l-m)/2) and b = l - m -
/// n,
///
///     p_l^m = z^{(l-m) mod 2}  sum_k (-n)_k (b+m+1/2)_k / ((m+1)_k k!) s2^k,     (x)_k = x(x+1)..(x+k-1)
///
/// a Gegenbauer polynomial as a hypergeometric sum around the pole, where its first term is 1 and nothing
/// cancels. Nearer the equator terms of up to 8 cancel at l = 5, which costs float less than 1e-6; from
/// l = 6 on the recurrences of tables.h are better. The gains of a cap want p_l^1 of the cosine of its half
/// angle.

#include <utility>

#include "sh/zonal_lanes.h"

namespace zonal::sh {

inline constexpr int kFewBands = 6;

namespace few {

constexpr double kPi = 3.14159265358979323846;

consteval double root(double v) {
  double x = v > 1 ? v : 1;
  for (int i = 0; i < 64; ++i) x = (x + v / x) / 2;
  return x;
}

/// Y_l^m = norm p_l^m Re (x+iy)^m.
consteval double norm(int l, int m) {
  double v = (2 * l + 1) / (4 * kPi) * (m > 0 ? 2 : 1), d = 1;
  for (int k = l - m + 1; k <= l + m; ++k) v *= k;
  for (int k = 1; k <= m; ++k) d *= -2 * k;
  return root(v) / d;
}

/// Factor of s2^k in p_l^m.
consteval double term(int l, int m, int k) {
  const int n = (l - m) / 2, b = l - m - n;
  double v = 1;
  for (int j = 0; j < k; ++j) v *= (j - n) * (b + m + 0.5 + j) / ((m + 1 + j) * (j + 1.0));
  return v;
}

/// scale p_l^m without its factor z, K the power Horner's scheme has come down to; never called for a
/// constant.
template <class T, int L, int M, bool kScaled, int K, class V>
[[gnu::always_inline]] inline V polynomial(V s2) {
  constexpr T k = T((kScaled ? norm(L, M) : 1) * term(L, M, K)),
              next = T((kScaled ? norm(L, M) : 1) * term(L, M, K + 1));
  if constexpr (K + 1 == (L - M) / 2) {
    return next * s2 + k;
  } else {
    return polynomial<T, L, M, kScaled, K + 1>(s2) * s2 + k;
  }
}

/// f(integral constant) for 0..N-1.
template <int N, class F>
[[gnu::always_inline]] inline void unroll(F&& f) {
  [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline)) {
    (f(std::integral_constant<int, I>{}), ...);
  }
  (std::make_integer_sequence<int, N>{});
}

}  // namespace few

/// Gains of a cap that is at most a hemisphere, from sin^2 and cosine of its half angle.
template <int N, class T, class V>
[[gnu::always_inline]] inline void few_gains(V sine2, V cosine, V* gain) {
  gain[0] = T(2 * few::kPi) * sine2 / (cosine + T(1));
  const V scale = T(few::kPi) * sine2, scale_cosine = scale * cosine;
  few::unroll<N - 1>([&](auto i) __attribute__((always_inline)) {
    constexpr int l = decltype(i)::value + 1;
    gain[l] = l % 2 ? scale : scale_cosine;
    if constexpr (l > 2) gain[l] *= few::polynomial<T, l, 1, false, 0>(sine2);
  });
}

/// x^2 + y^2 of a unit vector, with z^2's rounding where that is the smaller one: near the equator the terms
/// of the polynomials grow and repeat it.
template <class V>
[[gnu::always_inline]] inline V few_sine2(V z, V xy2) {
  const V z2 = z * z;
  return z2 < 0.5f ? 1.0f - z2 : xy2;
}

/// put(i, value) for every coefficient i of gain[l] Y_lm(x, y, z); s2 = x^2 + y^2.
template <int N, class T, class V, class Put>
[[gnu::always_inline]] inline void few_bands(V x, V y, V z, V s2, const V* gain, Put&& put) {
  V c[N], s[N];
  if constexpr (N > 1) c[1] = x, s[1] = y;
  few::unroll<N>([&](auto m) __attribute__((always_inline)) {
    constexpr int M = decltype(m)::value;
    if constexpr (M > 1) c[M] = x * c[M - 1] - y * s[M - 1], s[M] = x * s[M - 1] + y * c[M - 1];
  });
  few::unroll<N>([&](auto l) __attribute__((always_inline)) {
    constexpr int L = decltype(l)::value;
    const V even = gain[L], odd = even * z;
    few::unroll<L + 1>([&](auto m) __attribute__((always_inline)) {
      constexpr int M = decltype(m)::value;
      V X = (L - M) % 2 ? odd : even;
      if constexpr (L - M < 2) {
        constexpr T norm = T(few::norm(L, M));
        X *= norm;
      } else {
        X *= few::polynomial<T, L, M, true, 0>(s2);
      }
      if constexpr (M == 0) {
        put(index(L, 0), X);
      } else {
        put(index(L, M), X * c[M]), put(index(L, -M), X * s[M]);
      }
    });
  });
}

/// A sphere that the fast path may take: r/d below 0.968, where float's d^2 - r^2 is good enough, and squares
/// well within float's range.
inline constexpr float kFewSine2 = 0.9375f, kFewLeast = 1e-24f, kFewMost = 1e30f;

}  // namespace zonal::sh
