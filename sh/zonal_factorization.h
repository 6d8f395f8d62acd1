#pragma once
/// Every harmonic of band l is a weighted sum of 2l+1 zonal lobes (Mézières 2022, Eq. 2.55 to 2.58;
/// Nowrouzezahrai et al. 2012). Knowing a function's integral against each lobe is knowing its coefficients,
/// which is how the literature integrates polygons; turning the lobes turns the function.
///
///     const sh::ZonalFactorization<double> factors(bands);
///     for (int l = 0; l < bands; ++l)
///       for (int d = 0; d <= 2 * l; ++d) v[l * l + d] = integral of f(w) P_l(w . factors.direction(l, d));
///     factors.from_lobes(v, coefficients);

#include <vector>

#include "sh/rotation.h"

namespace zonal::sh {

template <class T>
class ZonalFactorization {
 public:
  /// Chooses lobes for 1 <= bands <= kMaxBands: all bands share few directions (3N), so that what is computed
  /// along a direction serves every band. Making it costs about 10 N^4 operations.
  explicit ZonalFactorization(int bands);

  int bands() const { return bands_; }
  const std::vector<Vec3<T>>& directions() const { return directions_; }
  int lobe(int l, int d) const { return lobes_[l * l + d]; }  ///< which direction, 0 <= d <= 2l
  const Vec3<T>& direction(int l, int d) const { return directions_[lobe(l, d)]; }

  /// From v[l^2 + d] = integral of f(w) P_l(w . direction(l, d)) to the coefficients of f. Not in place.
  void from_lobes(const T* v, T* coefficients) const;
  void from_lobes(int functions, const T* v, T* coefficients) const;

  /// The weights that make f of lobes: f_l(w) = sum over d of weights[l^2 + d] P_l(w . direction(l, d)).
  void weights(const T* coefficients, T* weights) const;

  /// Active rotation (Sec. 2.2.12): the lobes turn, their weights stay.
  void rotate(const Mat3<T>& R, const T* in, T* out) const;
  void rotate(const Mat3<T>& R, int functions, const T* in, T* out) const;

  /// Largest over smallest pivot of band l's matrix of harmonics: how much rounding it may amplify.
  T condition(int l) const { return condition_[l]; }

 private:
  int bands_;
  std::vector<Vec3<T>> directions_;
  std::vector<int> lobes_;  ///< l^2 + d
  std::vector<T> inverse_;  ///< A-hat of (2.58): inverse of Y_l, row by row, band after band
  std::vector<T> condition_;
};

}  // namespace zonal::sh
