#include "sh/zonal_factorization.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace zonal::sh {
namespace {

using Rows = std::vector<double>;

constexpr int kCandidates =
    3;  ///< directions a band: with 2 the worst pivot ratio is 45, with 3 it is 8, with 4 it is 7

/// A spiral over the upper hemisphere: opposite directions carry the same lobe up to its sign.
std::vector<Vec3<double>> hemisphere_spiral(int size) {
  std::vector<Vec3<double>> points(size);
  for (int i = 0; i < size; ++i) {
    const double z = (i + 0.5) / size, phi = 2 * std::numbers::pi * std::fmod(i / std::numbers::phi, 1.0);
    const double s = std::sqrt((1 - z) * (1 + z));
    points[i] = {s * std::cos(phi), s * std::sin(phi), z};
  }
  return points;
}

/// Picks `size` of the rows (each `size` long) so that they are as independent as can be: the one farthest
/// from the span of those already chosen, again and again (Gram-Schmidt with pivoting). Returns largest over
/// smallest distance.
double pick_independent(int size, Rows rows, std::vector<int>& chosen) {
  const int total = int(rows.size()) / size;
  std::vector<double> norm2(total);
  for (int i = 0; i < total; ++i)
    for (int k = 0; k < size; ++k) norm2[i] += rows[size_t(i) * size + k] * rows[size_t(i) * size + k];
  double largest = 0, smallest = 0;
  std::vector<double> axis(size);
  for (int step = 0; step < size; ++step) {
    const int best = int(std::max_element(norm2.begin(), norm2.end()) - norm2.begin());
    chosen.push_back(best);
    double length = 0;
    for (int k = 0; k < size; ++k) axis[k] = rows[size_t(best) * size + k], length += axis[k] * axis[k];
    length = std::sqrt(length);
    for (double& a : axis) a /= length;
    if (step == 0) largest = length;
    smallest = length;
    for (int i = 0; i < total; ++i) {
      double* row = rows.data() + size_t(i) * size;
      double along = 0;
      for (int k = 0; k < size; ++k) along += row[k] * axis[k];
      for (int k = 0; k < size; ++k) row[k] -= along * axis[k];
      norm2[i] -= along * along;
    }
    norm2[best] = -1;
  }
  return largest / smallest;
}

/// Gauss-Jordan elimination with row pivoting, in place.
void invert(int size, Rows& a) {
  std::vector<int> swapped(size);
  for (int c = 0; c < size; ++c) {
    int pivot = c;
    for (int r = c + 1; r < size; ++r)
      if (std::abs(a[size_t(r) * size + c]) > std::abs(a[size_t(pivot) * size + c])) pivot = r;
    swapped[c] = pivot;
    if (pivot != c)
      std::swap_ranges(&a[size_t(c) * size], &a[size_t(c) * size] + size, &a[size_t(pivot) * size]);
    double* row = &a[size_t(c) * size];
    const double inverse = 1 / row[c];
    row[c] = 1;
    for (int k = 0; k < size; ++k) row[k] *= inverse;
    for (int r = 0; r < size; ++r) {
      if (r == c) continue;
      double* other = &a[size_t(r) * size];
      const double factor = std::exchange(other[c], 0.0);
      for (int k = 0; k < size; ++k) other[k] -= factor * row[k];
    }
  }
  for (int c = size - 1; c >= 0; --c)
    if (swapped[c] != c)
      for (int r = 0; r < size; ++r) std::swap(a[size_t(r) * size + c], a[size_t(r) * size + swapped[c]]);
}

}  // namespace

template <class T>
ZonalFactorization<T>::ZonalFactorization(int bands)
    : bands_(bands), inverse_(Rotation<T>::band_offset(bands)), condition_(bands) {
  const std::vector<Vec3<double>> spiral = hemisphere_spiral(kCandidates * bands);
  directions_.assign(spiral.begin(), spiral.end());
  const int stride = count(bands);
  std::vector<double> Y(spiral.size() * stride);
  // The lobes point along the directions as T rounds them, so the matrices must too.
  for (size_t i = 0; i < spiral.size(); ++i)
    evaluate(bands, normalized(Vec3<double>(directions_[i])), Y.data() + i * stride);
  for (int l = 0; l < bands; ++l) {
    const int size = 2 * l + 1;
    Rows rows(spiral.size() * size);
    for (size_t i = 0; i < spiral.size(); ++i)
      std::copy_n(Y.data() + i * stride + l * l, size, rows.data() + i * size);
    std::vector<int> chosen;
    condition_[l] = T(pick_independent(size, rows, chosen));
    Rows matrix(size_t(size) * size);
    for (int d = 0; d < size; ++d)
      std::copy_n(rows.data() + size_t(chosen[d]) * size, size, matrix.data() + size_t(d) * size);
    invert(size, matrix);
    const double scale = size / (4 * std::numbers::pi);
    T* inverse = inverse_.data() + Rotation<T>::band_offset(l);
    for (int k = 0; k < size * size; ++k) inverse[k] = T(scale * matrix[k]);
    lobes_.insert(lobes_.end(), chosen.begin(), chosen.end());
  }
}

template <class T>
void ZonalFactorization<T>::from_lobes(const T* v, T* coefficients) const {
  from_lobes(1, v, coefficients);
}

template <class T>
void ZonalFactorization<T>::from_lobes(int functions, const T* v, T* coefficients) const {
  for (int l = 0; l < bands_; ++l) {
    const int size = 2 * l + 1;
    const T* inverse = inverse_.data() + Rotation<T>::band_offset(l);
    for (int m = 0; m < size; ++m) {
      T* out = coefficients + size_t(l * l + m) * functions;
      std::fill(out, out + functions, T(0));
      for (int d = 0; d < size; ++d) {
        const T factor = inverse[m * size + d];
        const T* in = v + size_t(l * l + d) * functions;
        for (int f = 0; f < functions; ++f) out[f] += factor * in[f];
      }
    }
  }
}

template <class T>
void ZonalFactorization<T>::weights(const T* coefficients, T* weights) const {
  for (int l = 0; l < bands_; ++l) {
    const int size = 2 * l + 1;
    const T* inverse = inverse_.data() + Rotation<T>::band_offset(l);
    T* out = weights + l * l;
    std::fill(out, out + size, T(0));
    for (int m = 0; m < size; ++m, inverse += size)
      for (int d = 0; d < size; ++d) out[d] += inverse[d] * coefficients[l * l + m];
  }
}

template <class T>
void ZonalFactorization<T>::rotate(const Mat3<T>& R, const T* in, T* out) const {
  rotate(R, 1, in, out);
}

// The matrix of a band is Y_l(R w_d)^T times the inverse: made a band at a time, then applied to every
// function.
template <class T>
void ZonalFactorization<T>::rotate(const Mat3<T>& R, int functions, const T* in, T* out) const {
  const Mat3<double> Q = orthonormalized(R);
  const int stride = count(bands_);
  std::vector<T> Y(directions_.size() * stride);
  for (size_t i = 0; i < directions_.size(); ++i)
    evaluate(bands_, normalized(Vec3<T>(Q * Vec3<double>(directions_[i]))), Y.data() + i * stride);
  std::vector<T> lobe_weights(size_t(2 * bands_ - 1) * functions);
  for (int l = 0; l < bands_; ++l) {
    const int size = 2 * l + 1;
    const T* inverse = inverse_.data() + Rotation<T>::band_offset(l);
    std::fill(lobe_weights.begin(), lobe_weights.end(), T(0));
    for (int m = 0; m < size; ++m)
      for (int d = 0; d < size; ++d)
        for (int f = 0; f < functions; ++f)
          lobe_weights[size_t(d) * functions + f] +=
              inverse[m * size + d] * in[size_t(l * l + m) * functions + f];
    T* band = out + size_t(l) * l * functions;
    std::fill(band, band + size_t(size) * functions, T(0));
    const T scale = T(4 * std::numbers::pi / size);
    for (int d = 0; d < size; ++d) {
      const T* turned = Y.data() + size_t(lobe(l, d)) * stride + l * l;
      for (int m = 0; m < size; ++m)
        for (int f = 0; f < functions; ++f)
          band[size_t(m) * functions + f] += scale * turned[m] * lobe_weights[size_t(d) * functions + f];
    }
  }
}

template class ZonalFactorization<float>;
template class ZonalFactorization<double>;

}  // namespace zonal::sh
