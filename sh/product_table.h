#pragma once
/// The tensor C_ijk = integral of Y_i Y_j Y_k (the real Gaunt coefficients, Mézières 2022, Eq. 2.47) as a
/// sparse table, made in milliseconds at the first use. products.h chooses and shares tables; this is for
/// those who want their own.
///
///     const sh::ProductTable<float> table(9, 9, 9);
///     table.multiply(a, b, out);

#include <cstdint>
#include <vector>

#include "sh/basis.h"

namespace zonal::sh {

template <class T>
class ProductTable {
 public:
  /// i of the first factor, j of the second, k of the result. Equal bands of the factors halve the table.
  ProductTable(int bands_a, int bands_b, int bands_out);

  void multiply(const T* a, const T* b, T* out) const;
  void multiply(int functions, const T* a, const T* b, T* out) const;  ///< structures of arrays
  T triple(const T* a, const T* b, const T* c) const;                  ///< integral of the product of three
  /// matrix[k * count(bands_a) + i] such that the product with f is out_k = sum over i of matrix(k, i) a_i
  /// (Eq. 2.49).
  void transfer_matrix(const T* f, T* matrix) const;

  size_t entries() const {
    return entries_.size();
  }                         ///< stored, of i <= j only where the factors have equal bands
  size_t nonzeros() const;  ///< of the tensor

  /// Calls visit(i, j, k, value) for every stored entry.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (size_t p = 0; p + 1 < pairs_.size(); ++p)
      for (uint32_t e = pairs_[p].first; e < pairs_[p + 1].first; ++e)
        visit(int(pairs_[p].i), int(pairs_[p].j), int(entries_[e].k), entries_[e].value);
  }

 private:
  struct Pair {
    uint16_t i, j;
    uint32_t first;  ///< its entries: from here to the next pair's
  };
  struct Entry {
    uint32_t k;
    T value;
  };
  T factor(const Pair& pair, const T* a, const T* b) const {
    return mirrored(pair) ? a[pair.i] * b[pair.j] + a[pair.j] * b[pair.i] : a[pair.i] * b[pair.j];
  }
  bool mirrored(const Pair& pair) const { return symmetric_ && pair.i != pair.j; }

  int bands_a_, bands_b_, bands_out_;
  bool symmetric_;
  std::vector<Pair> pairs_;  ///< and one more, to end the last
  std::vector<Entry> entries_;
};

}  // namespace zonal::sh
