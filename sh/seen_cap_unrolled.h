#pragma once
/// The coefficients of one cap for up to 10 bands, basis and gains in one and unrolled: the fast path of
/// single lights.

#include "sh/zonal.h"
#include "sh/zonal_lanes.h"

namespace zonal::sh {

/// L_l^m and L_l^-m for l = L_..N-1 of one m, unrolled for certain: the recurrence of tables.h with its
/// rational factors as constants.
template <int N, int M, int L_, class T>
[[gnu::always_inline]] inline void seen_column(const T* gain, const Step<T>* step, T u, T p, T e, T c, T s,
                                               T* __restrict__ L) {
  if constexpr (L_ < N) {
    if constexpr (L_ > M) {
      e = T(double(L_ - M - 1) / (L_ + M)) * e - T(double(2 * L_ - 1) / (L_ + M)) * p;
      p += u * e;
    }
    const T X = gain[L_] * step[L_ - M].norm * p;
    L[index(L_, M)] = X * c;
    if constexpr (M > 0) L[index(L_, -M)] = X * s;
    seen_column<N, M, L_ + 1>(gain, step, u, p, e, c, s, L);
  }
}

template <int N, int M, class T>
[[gnu::always_inline]] inline void seen_columns(const T* gain, const Step<T>* steps, T x, T y, T u, T c, T s,
                                                T* __restrict__ L) {
  if constexpr (M < N) {
    seen_column<N, M, M>(gain, steps + Tables<T>::offset(M), u, T(1), T(0), c, s, L);
    seen_columns<N, M + 1>(gain, steps, x, y, u, x * c - y * s, x * s + y * c, L);
  }
}

/// Basis and gains in one.
template <int N, class T>
inline void seen_cap_unrolled(const Vec3<T>& axis, const Cap<T>& cap, T* L) {
  constexpr double kPi = 3.14159265358979323846;
  static const Tables<T>& table = tables<T>();
  const T sign = std::copysign(T(1), axis.z);
  const T x = axis.x * sign, y = axis.y * sign;
  const T u = (x * x + y * y) / (1 + std::abs(axis.z));
  T gain[N];  // times sign^l
  gain[0] = T(2 * kPi) * cap.versine;
  CapRecurrence<T> r(cap.versine);
  T scale = T(kPi) * cap.sine2 * sign;
#pragma GCC unroll 16
  for (int l = 1; l < N; ++l) {
    r.step_q(l);
    gain[l] = scale * r.q;
    scale *= sign;
  }
  seen_columns<N, 0>(gain, table.steps.data(), x, y, u, T(1), T(0), L);
}

/// False beyond 10 bands. The cap is at most a hemisphere.
template <class T>
inline bool seen_cap_few_bands(int bands, const Vec3<T>& axis, const Cap<T>& cap, T* L) {
  switch (bands) {
    case 1:
      seen_cap_unrolled<1>(axis, cap, L);
      return true;
    case 2:
      seen_cap_unrolled<2>(axis, cap, L);
      return true;
    case 3:
      seen_cap_unrolled<3>(axis, cap, L);
      return true;
    case 4:
      seen_cap_unrolled<4>(axis, cap, L);
      return true;
    case 5:
      seen_cap_unrolled<5>(axis, cap, L);
      return true;
    case 6:
      seen_cap_unrolled<6>(axis, cap, L);
      return true;
    case 7:
      seen_cap_unrolled<7>(axis, cap, L);
      return true;
    case 8:
      seen_cap_unrolled<8>(axis, cap, L);
      return true;
    case 9:
      seen_cap_unrolled<9>(axis, cap, L);
      return true;
    case 10:
      seen_cap_unrolled<10>(axis, cap, L);
      return true;
    default:
      return false;
  }
}

}  // namespace zonal::sh
