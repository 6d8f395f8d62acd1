#pragma once
/// Constants of the recurrences in hvl_lanes.h, and the orders in which coefficients lie there. Computed once
/// in double.

#include <array>

#include "materials/sh_material.h"
#include "materials/zonal_lobes.h"

namespace zonal::hvl {

inline constexpr int kMaxBands = kMaxZonalBands;

class Bands {
 public:
  static const Bands& table();

  /// B_lm at [l - m].
  const float* step(int m) const { return step_.data() + offset(m); }
  /// The same two bands at a time: p_l = (4 z^2 - A) p_{l-2} - B p_{l-4}, at [l - m] for even l - m.
  const float* even_step(int m) const { return even_step_.data() + offset(m); }
  const float* even_fall(int m) const { return even_fall_.data() + offset(m); }
  /// What p_l of order m lacks: Y_l^m = norm p_l Re (x + iy)^m; Y_l^-m with Im.
  float norm(int l, int m) const { return norm_[offset(m) + l - m]; }
  /// What gain[l] of hvl_lanes.h lacks: g_l = cap(l) sin^2 a gain[l].
  float cap(int l) const { return cap_[l]; }
  /// P_l = legendre(l) p_l of order 0.
  float legendre(int l) const { return legendre_[l]; }

 private:
  Bands();
  static constexpr int offset(int m) { return m * kMaxBands - m * (m - 1) / 2; }

  static constexpr int kPairs = kMaxBands * (kMaxBands + 1) / 2;
  std::array<float, kPairs> step_{}, even_step_{}, even_fall_{}, norm_{};
  std::array<float, kMaxBands> cap_{}, legendre_{};
};

/// Calls f(place, l, m, i) for each coefficient of `bands` bands in the order of `product`: by order m, first
/// m then -m where both are there, l rising; `i` is its place in a table of materials/sh_material.h.
template <class F>
void for_each_coefficient(int bands, bool mirrored, F&& f) {
  int place = 0;
  for (int m = 0; m < bands; ++m) {
    for (int side = 0; side < (mirrored || m == 0 ? 1 : 2); ++side) {
      for (int l = m; l < bands; ++l) {
        const int order = side ? -m : m;
        f(place++, l, order, mirrored ? l * (l + 1) / 2 + m : l * (l + 1) + order);
      }
    }
  }
}

/// The same for `emission`: those with even l + m alone; m and -m side by side.
template <class F>
void for_each_even_coefficient(int bands, bool mirrored, F&& f) {
  int place = 0;
  for (int m = 0; m < bands; ++m) {
    for (int l = m; l < bands; l += 2) {
      for (int side = 0; side < (mirrored || m == 0 ? 1 : 2); ++side) {
        const int order = side ? -m : m;
        f(place++, l, order, mirrored ? l * (l + 1) / 2 + m : l * (l + 1) + order);
      }
    }
  }
}

/// How many those are.
constexpr int even_count(int bands, bool mirrored) {
  int n = 0;
  for (int m = 0; m < bands; ++m) n += ((bands - m + 1) / 2) * (mirrored || m == 0 ? 1 : 2);
  return n;
}

}  // namespace zonal::hvl
