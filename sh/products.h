#pragma once
/// Integrals and products of functions given by coefficients (Mézières 2022, Sec. 2.2.6 to 2.2.8).
///
///     float D = sh::dot(bands, light, lobe);                      // Eq. 2.46
///     sh::product(bands, light, visibility, out);                 // Eq. 2.48, first `bands` bands of the
///     product sh::product_full(bands, light, visibility, out);            // all (2N-1)^2 coefficients:
///     nothing is lost
///
/// Up to kMaxTableBands bands the sparse tensor does it (O(N^5), 23621 non-zero numbers at 9 bands); beyond,
/// exact quadrature (O(N^3)). Both are built at the first use of a size and shared by all threads. Batches
/// are structures of arrays, coefficient i of function f at [i * functions + f]. Outputs must not overlap
/// inputs. 1 <= bands <= kMaxBands; the full product of two functions has up to 2 kMaxBands - 1.

#include <functional>

#include "sh/basis.h"

namespace zonal::sh {

inline constexpr int kTableBands = 8;        ///< up to which one product takes the table
inline constexpr int kTableBandsBatch = 12;  ///< and a batch

/// Integral of the product of two functions.
template <class T>
T dot(int bands, const T* a, const T* b) {
  T sum = 0;
  for (int i = 0; i < count(bands); ++i) sum += a[i] * b[i];
  return sum;
}
/// out[functions]
template <class T>
void dot(int bands, int functions, const T* a, const T* b, T* out) {
  for (int f = 0; f < functions; ++f) out[f] = 0;
  for (size_t i = 0; i < size_t(count(bands)); ++i)
    for (int f = 0; f < functions; ++f) out[f] += a[i * functions + f] * b[i * functions + f];
}

/// Integral of the product of three functions (Eq. 2.47).
template <class T>
T triple_product(int bands, const T* a, const T* b, const T* c);
template <class T>
void triple_product(int bands, int functions, const T* a, const T* b, const T* c, T* out);

/// The first `bands_out` bands of the product of functions of bands_a and bands_b.
template <class T>
void product(int bands_a, int bands_b, int bands_out, const T* a, const T* b, T* out);
template <class T>
void product(int bands_a, int bands_b, int bands_out, int functions, const T* a, const T* b, T* out);

template <class T>
void product(int bands, const T* a, const T* b, T* out) {
  product(bands, bands, bands, a, b, out);
}
template <class T>
void product(int bands, int functions, const T* a, const T* b, T* out) {
  product(bands, bands, bands, functions, a, b, out);
}
template <class T>
void product_full(int bands, const T* a, const T* b, T* out) {
  product(bands, bands, 2 * bands - 1, a, b, out);
}
template <class T>
void product_full(int bands, int functions, const T* a, const T* b, T* out) {
  product(bands, bands, 2 * bands - 1, functions, a, b, out);
}

/// The same by quadrature, whatever the number of bands.
template <class T>
void product_by_quadrature(int bands_a, int bands_b, int bands_out, const T* a, const T* b, T* out);

/// The product of M functions of `bands` bands, without truncation in between (Eq. 2.51): its first
/// `bands_out` bands, by quadrature. 2 sqrt(pi) times coefficient 0 is the integral of all M. `functions[M]`.
template <class T>
void product_of_many(int bands, int M, const T* const* functions, int bands_out, T* out);
/// Cheaper and lossy: function after function, cut to `bands` each time (Zhou et al. 2005).
template <class T>
void product_of_many_truncated(int bands, int M, const T* const* functions, T* out);
/// `count` such products at once: factor i is a structure of arrays.
template <class T>
void product_of_many_truncated(int bands, int M, int count, const T* const* functions, T* out);

/// The matrix of multiplication by f, out_k = sum over i of matrix[k * count(bands) + i] in_i (Eq. 2.49). N^4
/// numbers.
template <class T>
void transfer_matrix(int bands, const T* f, T* matrix);
/// Multiplication by a function that is not band-limited (Eq. 2.50), by quadrature that is exact if `degree`
/// is at least that of f: the result is cut, f is not. Symmetric.
template <class T>
void transfer_matrix(int bands, int degree, const std::function<T(const Vec3<T>&)>& f, T* matrix);
/// out = matrix in.
template <class T>
void apply_transfer_matrix(int bands, const T* matrix, const T* in, T* out);
template <class T>
void apply_transfer_matrix(int bands, int functions, const T* matrix, const T* in, T* out);

}  // namespace zonal::sh
