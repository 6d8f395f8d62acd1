#pragma once
/// From coefficients to values on a grid of Gauss-Legendre heights and uniform azimuths, and back by exact
/// quadrature, one axis at a time: O(N^3) instead of O(N^4). Products of any number of bands are made with
/// it: values multiply.
///
///     const sh::GridTransform<double> grid(bands, 3 * (bands - 1));   // exact integrals of three functions
///     grid.synthesize(bands, a, values);
///     grid.analyze(bands, values, coefficients);

#include <vector>

#include "sh/basis.h"

namespace zonal::sh {

template <class T>
class GridTransform {
 public:
  /// For functions of up to `bands` bands (any number), with quadrature exact up to polynomials of `degree`
  /// in (x, y, z): integrating f g exactly takes the degree of f plus that of g, bands less one each.
  GridTransform(int bands, int degree);
  /// Any heights z, ascending in [-1, 1], for synthesis only.
  GridTransform(int bands, const std::vector<double>& heights, int azimuths);

  int bands() const { return bands_; }
  int rows() const { return int(z_.size()); }
  int columns() const { return azimuths_; }
  size_t size() const { return z_.size() * size_t(azimuths_); }  ///< number of values, height by height
  Vec3<double> direction(int row, int column) const;
  double weight(int row) const { return weights_[row]; }  ///< solid angle of each point of the row

  void synthesize(int bands, const T* coefficients, T* values) const;
  void analyze(int bands, const T* values, T* coefficients) const;

 private:
  void make_tables();

  int bands_, azimuths_;
  std::vector<double> z_, weights_;
  std::vector<T> X_;          ///< row, then legendre_index
  std::vector<T> cos_, sin_;  ///< order m, then column, with the factor sqrt2 of m > 0
};

}  // namespace zonal::sh
