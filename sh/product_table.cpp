#include "sh/product_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/quadrature.h"

namespace zonal::sh {
namespace {

constexpr int kLanes = 16;
/// Smaller entries are zeros in all but rounding: rounding reaches 1e-15, and true entries stay above 1e-6 at
/// 20 bands.
constexpr double kZero = 1e-12;

/// Integral over the azimuth of the three trigonometric factors, whose |m| are such that the largest is the
/// sum of the others and an even number of which are sines.
double azimuth_integral(int m1, int m2, int m3) {
  const int m[3] = {m1, m2, m3};
  const bool any_zero = m1 == 0 || m2 == 0 || m3 == 0;
  if (any_zero) return 2 * std::numbers::pi;
  const int largest = std::max({std::abs(m1), std::abs(m2), std::abs(m3)});
  const int sines = (m1 < 0) + (m2 < 0) + (m3 < 0);
  // cos(a+b) against sin a sin b has the only minus sign.
  const bool cosine_is_largest = std::any_of(m, m + 3, [&](int k) { return k == largest; });
  return (sines == 2 && cosine_is_largest ? -1 : 1) * std::numbers::sqrt2 * std::numbers::pi;
}

/// Values of X_l^m at the positive nodes of a rule with an even number of nodes, function by function.
struct LegendreAtNodes {
  int bands, nodes;
  std::vector<double> values, weights;

  LegendreAtNodes(int bands, int degree)
      : bands(bands), nodes(degree / 4 + 1), values(size_t(legendre_count(bands)) * nodes) {
    const GaussLegendre rule = gauss_legendre(2 * nodes);
    std::vector<double> X(legendre_count(bands));
    for (int k = 0; k < nodes; ++k) {
      const double z = rule.nodes[nodes + k];
      normalized_legendre(bands, z, std::sqrt((1 - z) * (1 + z)), X.data());
      for (size_t i = 0; i < X.size(); ++i) values[i * nodes + k] = X[i];
      weights.push_back(2 * rule.weights[nodes + k]);
    }
  }
  const double* at(int l, int m) const { return values.data() + size_t(legendre_index(bands, l, m)) * nodes; }
};

}  // namespace

template <class T>
ProductTable<T>::ProductTable(int bands_a, int bands_b, int bands_out)
    : bands_a_(bands_a), bands_b_(bands_b), bands_out_(bands_out), symmetric_(bands_a == bands_b) {
  bands_out = std::min(bands_out, bands_a + bands_b - 1);
  const LegendreAtNodes X(std::max({bands_a, bands_b, bands_out}), bands_a + bands_b + bands_out - 3);
  std::vector<double> weighted(X.nodes);
  for (int l1 = 0; l1 < bands_a; ++l1)
    for (int m1 = -l1; m1 <= l1; ++m1)
      for (int l2 = symmetric_ ? l1 : 0; l2 < bands_b; ++l2)
        for (int m2 = symmetric_ && l2 == l1 ? m1 : -l2; m2 <= l2; ++m2) {
          const int k1 = std::abs(m1), k2 = std::abs(m2);
          const double *x1 = X.at(l1, k1), *x2 = X.at(l2, k2);
          for (int n = 0; n < X.nodes; ++n) weighted[n] = X.weights[n] * x1[n] * x2[n];
          pairs_.push_back({uint16_t(index(l1, m1)), uint16_t(index(l2, m2)), uint32_t(entries_.size())});
          const bool sine = (m1 < 0) != (m2 < 0);
          const int sizes[2] = {std::abs(k1 - k2), k1 + k2};
          for (int s = sizes[0] == sizes[1] ? 1 : 0; s < 2; ++s) {
            const int k3 = sizes[s], m3 = sine ? -k3 : k3;
            if (sine && k3 == 0) continue;
            // The triangle rule and the parity of l1 + l2 + l3.
            int l3 = std::max(std::abs(l1 - l2), k3);
            l3 += (l1 + l2 + l3) % 2;
            const double azimuth = azimuth_integral(m1, m2, m3);
            for (; l3 <= std::min(l1 + l2, bands_out - 1); l3 += 2) {
              const double* x3 = X.at(l3, k3);
              double sum = 0;
              for (int n = 0; n < X.nodes; ++n) sum += weighted[n] * x3[n];
              if (std::abs(sum * azimuth) > kZero)
                entries_.push_back({uint32_t(index(l3, m3)), T(sum * azimuth)});
            }
          }
          if (pairs_.back().first == entries_.size()) pairs_.pop_back();
        }
  pairs_.push_back({0, 0, uint32_t(entries_.size())});
}

template <class T>
size_t ProductTable<T>::nonzeros() const {
  size_t sum = 0;
  for (size_t p = 0; p + 1 < pairs_.size(); ++p)
    sum += (mirrored(pairs_[p]) ? 2 : 1) * size_t(pairs_[p + 1].first - pairs_[p].first);
  return sum;
}

template <class T>
void ProductTable<T>::multiply(const T* a, const T* b, T* out) const {
  std::fill(out, out + count(bands_out_), T(0));
  for (size_t p = 0; p + 1 < pairs_.size(); ++p) {
    const T ab = factor(pairs_[p], a, b);
    for (uint32_t e = pairs_[p].first; e < pairs_[p + 1].first; ++e)
      out[entries_[e].k] += entries_[e].value * ab;
  }
}

template <class T>
void ProductTable<T>::multiply(int functions, const T* a, const T* b, T* out) const {
  // A few functions at a time, copied together so that the tensor's scattered accesses stay in the nearest
  // cache.
  const int size_a = count(bands_a_), size_b = count(bands_b_), size_out = count(bands_out_);
  std::vector<T> block(size_t(size_a + size_b + size_out) * kLanes);
  T *block_a = block.data(), *block_b = block_a + size_a * kLanes, *block_out = block_b + size_b * kLanes;
  for (int first = 0; first < functions; first += kLanes) {
    const int lanes = std::min(kLanes, functions - first);
    for (int i = 0; i < size_a; ++i)
      std::copy_n(a + size_t(i) * functions + first, lanes, block_a + i * kLanes);
    for (int i = 0; i < size_b; ++i)
      std::copy_n(b + size_t(i) * functions + first, lanes, block_b + i * kLanes);
    std::fill(block_out, block_out + size_out * kLanes, T(0));
    for (size_t p = 0; p + 1 < pairs_.size(); ++p) {
      const Pair& pair = pairs_[p];
      const T *ai = block_a + pair.i * kLanes, *bj = block_b + pair.j * kLanes;
      T ab[kLanes];
      for (int f = 0; f < kLanes; ++f) ab[f] = ai[f] * bj[f];
      if (mirrored(pair)) {
        const T *aj = block_a + pair.j * kLanes, *bi = block_b + pair.i * kLanes;
        for (int f = 0; f < kLanes; ++f) ab[f] += aj[f] * bi[f];
      }
      for (uint32_t e = pair.first; e < pairs_[p + 1].first; ++e) {
        T* target = block_out + size_t(entries_[e].k) * kLanes;
        const T value = entries_[e].value;
        for (int f = 0; f < kLanes; ++f) target[f] += value * ab[f];
      }
    }
    for (int k = 0; k < size_out; ++k)
      std::copy_n(block_out + k * kLanes, lanes, out + size_t(k) * functions + first);
  }
}

template <class T>
T ProductTable<T>::triple(const T* a, const T* b, const T* c) const {
  T total = 0;
  for (size_t p = 0; p + 1 < pairs_.size(); ++p) {
    T sum = 0;
    for (uint32_t e = pairs_[p].first; e < pairs_[p + 1].first; ++e)
      sum += entries_[e].value * c[entries_[e].k];
    total += sum * factor(pairs_[p], a, b);
  }
  return total;
}

template <class T>
void ProductTable<T>::transfer_matrix(const T* f, T* matrix) const {
  const int columns = count(bands_a_);
  std::fill(matrix, matrix + size_t(count(bands_out_)) * columns, T(0));
  for (size_t p = 0; p + 1 < pairs_.size(); ++p) {
    const Pair& pair = pairs_[p];
    for (uint32_t e = pair.first; e < pairs_[p + 1].first; ++e) {
      T* row = matrix + size_t(entries_[e].k) * columns;
      row[pair.i] += f[pair.j] * entries_[e].value;
      if (mirrored(pair)) row[pair.j] += f[pair.i] * entries_[e].value;
    }
  }
}

template class ProductTable<float>;
template class ProductTable<double>;

}  // namespace zonal::sh
