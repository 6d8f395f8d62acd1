#pragma once
/// Constants of the recurrences of the basis, computed once in double and rounded once to T.
///
/// Y_l^m = q_l^m(z) Re (x+iy)^m for m >= 0, and q_l^|m|(z) Im (x+iy)^|m| for m < 0, where q_l^m is the m-th
/// derivative of the Legendre polynomial times everything constant: normalisation, sqrt(2) for m > 0 and the
/// Condon-Shortley sign.
///
/// q is found as norm * p with p = 1 at the pole. The usual three-term recurrence loses l^2 roundings near
/// the poles (1e-5 at 20 bands in float); one for the differences of p, in u = 1 - |z| (Reinsch's form of
/// Clenshaw's sum), loses about l:
///
///     p_m = 1, e_m = 0;   e_l = fall e_{l-1} - rise p_{l-1};   p_l = p_{l-1} + u e_l            l > m
///     q_l^m(z) = sign(z)^{l-m} norm p_l          q_l^m'(z) = sign(z)^{l-m-1} slope p_l^{m+1}
///     q_l^m''(z) = sign(z)^{l-m} curve p_l^{m+2}
///
/// No factorial is ever formed, so nothing overflows (the largest constant at 101 bands is below 1e36).

#include <array>

#include "sh/basis.h"

namespace zonal::sh {

/// Constants of one pair (l, m), m >= 0.
template <class T>
struct Step {
  T rise;   ///< (2l - 1) / (l + m)
  T fall;   ///< (l - m - 1) / (l + m)
  T norm;   ///< q_l^m(1)
  T slope;  ///< q_l^m'(1)
  T curve;  ///< q_l^m''(1)
};

template <class T>
struct Tables {
  std::array<Step<T>, kMaxBands*(kMaxBands + 1) / 2> steps;

  /// The entries of order m without gaps in the order of the recurrence, to be indexed by l - m, l =
  /// m..kMaxBands-1.
  const Step<T>* column(int m) const { return steps.data() + offset(m); }
  static constexpr int offset(int m) { return m * kMaxBands - m * (m - 1) / 2; }
};

/// Shared, immutable; made at the first call.
template <class T>
const Tables<T>& tables();

}  // namespace zonal::sh
