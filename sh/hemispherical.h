#pragma once
/// Hemispherical harmonics (Gautron et al. 2004; Mézières 2022, Eq. 2.33 with P_l^0(2 cos theta - 1) in the
/// row m = 0): orthonormal on the upper hemisphere z >= 0, zero below it, where a spherical function would
/// spend half its bands.
///
///     sh::evaluate_hemispherical(bands, direction, H);
///     const sh::HemisphericalConversion<float> conversion(hsh_bands, sh_bands);
///     conversion.to_hemispherical(sh_coefficients, hsh_coefficients);
///
/// H_l^m(w) = sqrt2 Y_l^m(w'), with w' the direction of height 2z - 1 and the same azimuth. 1 <= bands <=
/// kMaxBands.

#include <vector>

#include "sh/basis.h"

namespace zonal::sh {

/// Below the horizon (z < 0) all values are 0; on it the limit from above, which knows only m = 0.
template <class T>
void evaluate_hemispherical(int bands, const Vec3<T>& d, T* H);
/// H[i * count + k] at (x, y, z)[k]: structures of arrays.
template <class T>
void evaluate_hemispherical(int bands, const T* x, const T* y, const T* z, int count, T* H);

/// The matrix M_ij = integral of H_i Y_j over the upper hemisphere, by quadrature to rounding. Only equal m
/// couple.
template <class T>
class HemisphericalConversion {
 public:
  HemisphericalConversion(int hsh_bands, int sh_bands);

  /// H = M Y (Eq. 2.35 corrected): the part of a spherical function above the horizon, projected on H.
  void to_hemispherical(const T* sh, T* hsh) const;
  void to_hemispherical(int functions, const T* sh, T* hsh) const;
  /// Y = M^T H: the hemispherical function, zero below the horizon, projected on Y. Both directions cut to
  /// their bands, so one after the other is the identity only in the limit.
  void to_spherical(const T* hsh, T* sh) const;
  void to_spherical(int functions, const T* hsh, T* sh) const;

  /// Of H_lh^m and Y_ls^m; the same for -m.
  T element(int lh, int ls, int m) const;

 private:
  int hsh_bands_, sh_bands_;
  std::vector<int> block_;   ///< where order m starts
  std::vector<T> elements_;  ///< order by order, lh - m times the block's width plus ls - m
};

}  // namespace zonal::sh
