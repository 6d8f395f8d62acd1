#pragma once
/// Constants of the recurrences of the basis, computed once in double and rounded once to T.
///
/// Y_l^m = q_l^m(z) Re (x+iy)^m for m >= 0, and q_l^|m|(z) Im (x+iy)^|m| for m < 0, where q_l^m is the m-th
/// derivative of the Legendre polynomial times everything constant: normalisation, sqrt(2) for m > 0 and the
/// Condon-Shortley sign. No factorial is ever formed, so nothing overflows (the largest constant at 101 bands
/// is below 1e31).
///
///     q_m^m   = start[m]
///     q_l^m   = rise(l, m) (z q_{l-1}^m - fall(l, m) q_{l-2}^m)                     l > m, fall(m+1, m) = 0
///     q_l^m ' = -slope(l, m) q_l^{m+1}                                              derivative in z
///
/// Column m holds l = m..kMaxBands-1 without gaps, which is the order of the recurrence.

#include <vector>

#include "sh/basis.h"

namespace zonal::sh {

template <class T>
struct Tables {
  struct Step {
    T rise;   ///< sqrt((4l^2 - 1) / (l^2 - m^2))
    T fall;   ///< 1 / rise(l-1, m)
    T slope;  ///< sqrt((l + m + 1) (l - m)), over sqrt(2) for m = 0
  };
  T start[kMaxBands];
  std::vector<Step> steps;

  /// The entries of order m, to be indexed by l - m.
  const Step* column(int m) const { return steps.data() + m * kMaxBands - m * (m - 1) / 2; }
};

/// Shared, immutable; made at the first call.
template <class T>
const Tables<T>& tables();

}  // namespace zonal::sh
