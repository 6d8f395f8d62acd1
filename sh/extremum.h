#pragma once
/// The smallest value a function given by coefficients takes on the sphere, and where.
///
///     const sh::MinimumSearch search(bands);       // reusable: the grid's tables
///     const sh::Minimum low = search.minimum(coefficients);

#include <vector>

#include "sh/grid_transform.h"

namespace zonal::sh {

struct Minimum {
  double value = 0;
  Vec3<double> direction{0, 0, 1};
};

class MinimumSearch {
 public:
  explicit MinimumSearch(int bands);

  /// Local minima of a grid of 6 samples a wavelength, the lowest of them refined by Newton's method on the
  /// sphere.
  Minimum minimum(const double* coefficients) const;
  /// The same, but stops at the first value below `enough`: which need not be the smallest.
  Minimum minimum(const double* coefficients, double enough) const;
  int bands() const { return bands_; }

 private:
  Minimum refine(const double* coefficients, Vec3<double> w) const;

  int bands_;
  GridTransform<double> grid_;
};

/// Of a zonal function, zonal[bands], over z in [-1, 1]: `direction` lies in the plane y = 0.
Minimum zonal_minimum(int bands, const double* zonal);

}  // namespace zonal::sh
