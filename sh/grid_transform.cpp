#include "sh/grid_transform.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/quadrature.h"

namespace zonal::sh {

template <class T>
GridTransform<T>::GridTransform(int bands, int degree)
    : bands_(bands), azimuths_(std::max(degree, 2 * bands - 2) + 1) {
  const GaussLegendre rule = gauss_legendre(degree / 2 + 1);
  z_ = rule.nodes;
  for (const double w : rule.weights) weights_.push_back(w * 2 * std::numbers::pi / azimuths_);
  make_tables();
}

template <class T>
GridTransform<T>::GridTransform(int bands, const std::vector<double>& heights, int azimuths)
    : bands_(bands), azimuths_(azimuths), z_(heights), weights_(heights.size()) {
  make_tables();
}

template <class T>
void GridTransform<T>::make_tables() {
  std::vector<double> X(legendre_count(bands_));
  for (const double z : z_) {
    normalized_legendre(bands_, z, std::sqrt((1 - z) * (1 + z)), X.data());
    X_.insert(X_.end(), X.begin(), X.end());
  }
  cos_.resize(size_t(bands_) * azimuths_), sin_.resize(cos_.size());
  for (int m = 0; m < bands_; ++m)
    for (int k = 0; k < azimuths_; ++k) {
      const double phi = 2 * std::numbers::pi * ((long(m) * k) % azimuths_) / azimuths_;
      const double scale = m == 0 ? 1 : std::numbers::sqrt2;
      cos_[size_t(m) * azimuths_ + k] = T(scale * std::cos(phi));
      sin_[size_t(m) * azimuths_ + k] = T(scale * std::sin(phi));
    }
}

template <class T>
Vec3<double> GridTransform<T>::direction(int row, int column) const {
  const double z = z_[row], s = std::sqrt((1 - z) * (1 + z)), phi = 2 * std::numbers::pi * column / azimuths_;
  return {s * std::cos(phi), s * std::sin(phi), z};
}

template <class T>
void GridTransform<T>::synthesize(int bands, const T* coefficients, T* values) const {
  // Coefficients of one order side by side, as X_ has them.
  std::vector<T> plus(legendre_count(bands)), minus(plus.size());
  for (int m = 0; m < bands; ++m)
    for (int l = m; l < bands; ++l) {
      plus[legendre_index(bands, l, m)] = coefficients[index(l, m)];
      minus[legendre_index(bands, l, m)] = coefficients[index(l, -m)];
    }
  for (int j = 0; j < rows(); ++j) {
    const T* X = X_.data() + size_t(j) * legendre_count(bands_);
    T* row = values + size_t(j) * azimuths_;
    std::fill(row, row + azimuths_, T(0));
    for (int m = 0; m < bands; ++m) {
      const T* x = X + legendre_index(bands_, m, m);
      const T *p = &plus[legendre_index(bands, m, m)], *q = &minus[legendre_index(bands, m, m)];
      T c = 0, s = 0;
      for (int i = 0; i < bands - m; ++i) c += x[i] * p[i], s += x[i] * q[i];
      const T *cosine = &cos_[size_t(m) * azimuths_], *sine = &sin_[size_t(m) * azimuths_];
      for (int k = 0; k < azimuths_; ++k) row[k] += c * cosine[k] + s * sine[k];
    }
  }
}

template <class T>
void GridTransform<T>::analyze(int bands, const T* values, T* coefficients) const {
  std::vector<T> plus(legendre_count(bands)), minus(plus.size());
  for (int j = 0; j < rows(); ++j) {
    const T* X = X_.data() + size_t(j) * legendre_count(bands_);
    const T* row = values + size_t(j) * azimuths_;
    for (int m = 0; m < bands; ++m) {
      const T *cosine = &cos_[size_t(m) * azimuths_], *sine = &sin_[size_t(m) * azimuths_];
      T c = 0, s = 0;
      for (int k = 0; k < azimuths_; ++k) c += row[k] * cosine[k], s += row[k] * sine[k];
      c *= T(weights_[j]), s *= T(weights_[j]);
      const T* x = X + legendre_index(bands_, m, m);
      T *p = &plus[legendre_index(bands, m, m)], *q = &minus[legendre_index(bands, m, m)];
      for (int i = 0; i < bands - m; ++i) p[i] += c * x[i], q[i] += s * x[i];
    }
  }
  for (int m = bands - 1; m >= 0; --m)  // m = 0 last: its sine part is no coefficient
    for (int l = m; l < bands; ++l) {
      coefficients[index(l, -m)] = minus[legendre_index(bands, l, m)];
      coefficients[index(l, m)] = plus[legendre_index(bands, l, m)];
    }
}

template class GridTransform<float>;
template class GridTransform<double>;

}  // namespace zonal::sh
