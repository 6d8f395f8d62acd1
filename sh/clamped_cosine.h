#pragma once
/// The product of a function with max(0, cos theta) about z: what weighs light on a surface whose normal is z
/// (Mézières 2022, Sec. 4.1.3). Exact up to the truncation of the result, and sparse: only equal m couple,
/// and only l of the same parity or neighbours, 377 numbers at 9 bands.
///
///     sh::clamped_cosine_product(9, light, weighted);                // Eq. 4.6; light in the frame of the
///     normal sh::clamped_cosine_product_in_world(9, normal, light, weighted);   // turns, multiplies, turns
///     back
///
/// The irradiance is 2 sqrt(pi) times coefficient 0 of the result (Eq. 4.4). Outputs must not overlap inputs;
/// 1 <= bands <= kMaxBands. Batches are structures of arrays, coefficient i of function f at [i * functions +
/// f].

#include <vector>

#include "sh/basis.h"

namespace zonal::sh {

/// The matrix of Eq. 4.6. max(0, z) = (z + |z|)/2: the first half couples l with l+1, the second equal
/// parities.
template <class T>
class ClampedCosine {
 public:
  explicit ClampedCosine(int bands);
  /// Built at the first use of this number of bands, shared by all threads.
  static const ClampedCosine& shared(int bands);

  void multiply(const T* in, T* out) const;
  void multiply(int functions, const T* in, T* out) const;

  /// The integral of Y_l1^m max(0, z) Y_l2^m; the same for -m.
  T element(int l1, int l2, int m) const;
  int bands() const { return bands_; }
  int nonzeros() const;  ///< of the whole matrix, both signs of m

 private:
  int parity_block(int m, int parity) const { return block_[2 * m + parity]; }
  int parity_size(int m, int parity) const { return (bands_ - m + 1 - parity) / 2; }

  int bands_;
  std::vector<int> block_;    ///< where the block of order m and parity of l - m starts in even_
  std::vector<T> even_;       ///< dense symmetric blocks over l = m + parity, m + parity + 2, ...
  std::vector<T> neighbour_;  ///< couples l with l+1: [m * bands + l]

  struct Entry {
    T value;
    int from;
  };
  std::vector<Entry> entries_;  ///< up to kListed bands: the non-zero numbers, result after result
  std::vector<int> ends_;       ///< where each result's end
};

template <class T>
void clamped_cosine_product(int bands, const T* in, T* out);
template <class T>
void clamped_cosine_product(int bands, int functions, const T* in, T* out);

/// The same about any unit normal, coefficients in world frame before and after: by zxzxz rotation there and
/// back.
template <class T>
void clamped_cosine_product_in_world(int bands, const Vec3<T>& normal, const T* in, T* out);

/// The low-order variant (Eq. 4.5): the cosine is cut to `cosine_bands` (the thesis takes 3) and turned to
/// the normal, then multiplied. Needs no rotation of `in`, but its cosine dips below zero by 4.0, 3.1 and 1.4
/// % at 3, 5 and 9 bands.
template <class T>
void clamped_cosine_product_low_order(int bands, int cosine_bands, const Vec3<T>& normal, const T* in,
                                      T* out);

/// Zonal coefficients of max(0, cos theta), zonal[bands]: pi/sqrt(4pi), sqrt(pi/3), ..., 0 for odd l > 1.
template <class T>
void clamped_cosine_zonal(int bands, T* zonal);

}  // namespace zonal::sh
