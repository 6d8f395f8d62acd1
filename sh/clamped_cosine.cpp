#include "sh/clamped_cosine.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/lazy_tables.h"
#include "sh/products.h"
#include "sh/quadrature.h"
#include "sh/rotation.h"

namespace zonal::sh {
namespace {

constexpr int kListed = 16;  ///< bands up to which a list of numbers beats blocks
constexpr int kLanes = 32;   ///< functions treated together

/// The functions' coefficients of one order and one parity of l - m, `size` of them, or zeros beyond the last
/// function.
template <class T>
using Gathered = T[kMaxBands / 2 + 2][kLanes];

}  // namespace

template <class T>
ClampedCosine<T>::ClampedCosine(int bands)
    : bands_(bands), block_(2 * bands), neighbour_(size_t(bands) * bands) {
  // X_l1 X_l2 z is a polynomial of degree at most 2N-1 for equal m: N nodes on [0, 1] are exact.
  const GaussLegendre rule = gauss_legendre(bands, 0, 1);
  const int row = legendre_count(bands);
  std::vector<double> X(size_t(bands) * row);  // node, then (l, m)
  for (int k = 0; k < bands; ++k) {
    const double z = rule.nodes[k];
    double* values = X.data() + size_t(k) * row;
    normalized_legendre(bands, z, std::sqrt((1 - z) * (1 + z)), values);
    const double weight = std::sqrt(2 * std::numbers::pi * z * rule.weights[k]);
    for (int i = 0; i < row; ++i) values[i] *= weight;
  }
  std::vector<double> block;
  for (int m = 0; m < bands; ++m) {
    for (int parity = 0; parity < 2; ++parity) {
      const int size = parity_size(m, parity);
      block_[2 * m + parity] = int(even_.size());
      block.assign(size_t(size) * size, 0);
      for (int k = 0; k < bands; ++k) {
        const double* values = X.data() + size_t(k) * row + legendre_index(bands, m, m) + parity;
        for (int i = 0; i < size; ++i)
          for (int j = 0; j < size; ++j) block[i * size + j] += values[2 * i] * values[2 * j];
      }
      even_.insert(even_.end(), block.begin(), block.end());
    }
    // z Y_l = c_{l+1} Y_{l+1} + c_l Y_{l-1}; half of it lies above the horizon.
    for (int l = m; l + 1 < bands; ++l)
      neighbour_[size_t(m) * bands + l] =
          T(0.5 * std::sqrt((double(l + 1) * (l + 1) - double(m) * m) / (4.0 * (l + 1) * (l + 1) - 1)));
  }
  if (bands > kListed) return;
  for (int l = 0; l < bands; ++l)
    for (int m = -l; m <= l; ++m) {
      for (int from = std::abs(m); from < bands; ++from)
        if (std::abs(from - l) == 1 || (from - l) % 2 == 0)
          entries_.push_back({element(l, from, m), index(from, m)});
      ends_.push_back(int(entries_.size()));
    }
}

template <class T>
const ClampedCosine<T>& ClampedCosine<T>::shared(int bands) {
  static LazyTables<ClampedCosine> tables;
  return tables.get(bands, [&] { return std::make_unique<ClampedCosine>(bands); });
}

template <class T>
T ClampedCosine<T>::element(int l1, int l2, int m) const {
  m = std::abs(m);
  if (std::abs(l1 - l2) == 1) return neighbour_[size_t(m) * bands_ + std::min(l1, l2)];
  const int parity = (l1 - m) % 2;
  if ((l2 - m) % 2 != parity) return 0;
  return even_[parity_block(m, parity) + (l1 - m) / 2 * parity_size(m, parity) + (l2 - m) / 2];
}

template <class T>
int ClampedCosine<T>::nonzeros() const {
  int sum = 0;
  for (int m = 0; m < bands_; ++m) {
    const int even = parity_size(m, 0), odd = parity_size(m, 1), chain = 2 * (bands_ - m - 1);
    sum += (m == 0 ? 1 : 2) * (even * even + odd * odd + chain);
  }
  return sum;
}

template <class T>
void ClampedCosine<T>::multiply(const T* in, T* out) const {
  if (!ends_.empty()) {
    const Entry* entry = entries_.data();
    for (int i = 0; i < count(bands_); ++i) {
      T sum = 0;
#pragma clang loop vectorize(disable)
      for (const Entry* end = entries_.data() + ends_[i]; entry != end; ++entry)
        sum += entry->value * in[entry->from];
      out[i] = sum;
    }
    return;
  }
  // Gather one order into even and odd l - m, multiply, scatter: the loops in the middle run over contiguous
  // numbers.
  T from[2][kMaxBands / 2 + 1], to[2][kMaxBands / 2 + 1];
  for (int m = 1 - bands_; m < bands_; ++m) {
    const int k = std::abs(m);
    for (int l = k; l < bands_; ++l) from[(l - k) & 1][(l - k) >> 1] = in[index(l, m)];
    for (int parity = 0; parity < 2; ++parity) {
      const int size = parity_size(k, parity);
      const T* column = even_.data() + parity_block(k, parity);
      std::fill(to[parity], to[parity] + size, T(0));
      for (int j = 0; j < size; ++j, column += size)
        for (int i = 0; i < size; ++i) to[parity][i] += column[i] * from[parity][j];
    }
    const T* next = neighbour_.data() + size_t(k) * bands_;
    for (int l = k; l < bands_; ++l) {
      const int p = (l - k) & 1, i = (l - k) >> 1;
      T sum = to[p][i];
      if (l + 1 < bands_) sum += next[l] * from[1 - p][i + p];
      if (l > k) sum += next[l - 1] * from[1 - p][i + p - 1];
      out[index(l, m)] = sum;
    }
  }
}

template <class T>
void ClampedCosine<T>::multiply(int functions, const T* in, T* out) const {
  // One order of a few functions at a time, gathered so that it stays in the nearest cache.
  Gathered<T> from[2];
  for (int first = 0; first < functions; first += kLanes) {
    const int lanes = std::min(kLanes, functions - first);
    for (int m = 1 - bands_; m < bands_; ++m) {
      const int k = std::abs(m);
      for (int l = k; l < bands_; ++l) {
        T* row = from[(l - k) & 1][(l - k) >> 1];
        std::copy_n(in + size_t(index(l, m)) * functions + first, lanes, row);
        std::fill(row + lanes, row + kLanes, T(0));
      }
      const T* next = neighbour_.data() + size_t(k) * bands_;
      for (int l = k; l < bands_; ++l) {
        const int p = (l - k) & 1, i = (l - k) >> 1, size = parity_size(k, p);
        const T* row = even_.data() + parity_block(k, p) + i * size;
        T sum[kLanes] = {};
        for (int j = 0; j < size; ++j)
          for (int f = 0; f < kLanes; ++f) sum[f] += row[j] * from[p][j][f];
        if (l + 1 < bands_)
          for (int f = 0; f < kLanes; ++f) sum[f] += next[l] * from[1 - p][i + p][f];
        if (l > k)
          for (int f = 0; f < kLanes; ++f) sum[f] += next[l - 1] * from[1 - p][i + p - 1][f];
        std::copy_n(sum, lanes, out + size_t(index(l, m)) * functions + first);
      }
    }
  }
}

template <class T>
void clamped_cosine_product(int bands, const T* in, T* out) {
  ClampedCosine<T>::shared(bands).multiply(in, out);
}

template <class T>
void clamped_cosine_product(int bands, int functions, const T* in, T* out) {
  ClampedCosine<T>::shared(bands).multiply(functions, in, out);
}

template <class T>
void clamped_cosine_product_in_world(int bands, const Vec3<T>& normal, const T* in, T* out) {
  const Mat3<T> to_normal = matrix_from_z_to(normal);
  T local[count(kMaxBands)];
  rotate_zxzxz(bands, glm::transpose(to_normal), in, local);
  clamped_cosine_product(bands, local, out);
  std::copy(out, out + count(bands), local);
  rotate_zxzxz(bands, to_normal, local, out);
}

template <class T>
void clamped_cosine_product_low_order(int bands, int cosine_bands, const Vec3<T>& normal, const T* in,
                                      T* out) {
  T zonal[kMaxBands], cosine[count(kMaxBands)];
  clamped_cosine_zonal(cosine_bands, zonal);
  rotate_zonal(cosine_bands, normal, zonal, cosine);
  product(bands, cosine_bands, bands, in, cosine, out);
}

template <class T>
void clamped_cosine_zonal(int bands, T* zonal) {
  // For even l: (-1)^(l/2-1) sqrt(pi (2l+1)) / ((l+2)(l-1)) l!/(2^l (l/2)!^2) (Ramamoorthi and Hanrahan
  // 2001).
  double ratio = 1;  // l! / (2^l (l/2)!^2)
  for (int l = 0; l < bands; ++l) {
    if (l > 0 && l % 2 == 0) ratio *= double(l - 1) / l;
    const double even = (l / 2 % 2 == 0 ? -1 : 1) * std::sqrt(std::numbers::pi * (2 * l + 1)) /
                        ((l + 2.0) * (l - 1.0)) * ratio;
    zonal[l] = T(l == 1 ? std::sqrt(std::numbers::pi / 3) : l % 2 == 0 ? even : 0);
  }
}

#define ZONAL_INSTANTIATE(T)                                                              \
  template class ClampedCosine<T>;                                                        \
  template void clamped_cosine_product(int, const T*, T*);                                \
  template void clamped_cosine_product(int, int, const T*, T*);                           \
  template void clamped_cosine_product_in_world(int, const Vec3<T>&, const T*, T*);       \
  template void clamped_cosine_product_low_order(int, int, const Vec3<T>&, const T*, T*); \
  template void clamped_cosine_zonal(int, T*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
