#pragma once
/// One direction with SIMD lanes over the order m: the recurrences of tables.h, row by row. Used by
/// basis.cpp.

#include <cstddef>
#include <cstring>

#include "sh/tables.h"

#if defined(__AVX__)
#include <immintrin.h>
#endif

#ifdef __clang__
#define ZONAL_SH_ROWS_EXACT _Pragma("clang fp reassociate(off)")
#define ZONAL_SH_ROWS_UNROLL _Pragma("clang loop unroll_count(kCount > 0 ? 4 : 1)")
#else
#define ZONAL_SH_ROWS_EXACT
#define ZONAL_SH_ROWS_UNROLL
#endif
#define ZONAL_SH_ROWS_INLINE inline __attribute__((always_inline))

// Packs are passed to functions that are always inlined; what their calling convention would be does not
// matter.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace zonal::sh::rows {

template <class T>
struct LaneType;
template <>
struct LaneType<float> {
  typedef float type __attribute__((vector_size(32)));
  typedef float unaligned __attribute__((vector_size(32), aligned(4), may_alias));
};
template <>
struct LaneType<double> {
  typedef double type __attribute__((vector_size(32)));
  typedef double unaligned __attribute__((vector_size(32), aligned(8), may_alias));
};
template <class T>
using Lanes = typename LaneType<T>::type;
template <class T>
inline constexpr int kWidth = 32 / int(sizeof(T));
template <class T>
inline constexpr int kPacks = (kMaxBands + kWidth<T>) / kWidth<T>;  ///< room for order l + 1

/// The table by rows: entries of W orders side by side, zero beyond m = l and `rise`, `fall` at m = l.
template <class T>
struct RowTables {
  struct Entry {
    Lanes<T> rise, fall, norm, slope;
  };
  Entry entries[kMaxBands][kPacks<T>];
};

/// Made at the first call.
template <class T>
const RowTables<T>& row_tables();

ZONAL_SH_ROWS_INLINE Lanes<float> reversed(const Lanes<float>& v) {
  return __builtin_shufflevector(v, v, 7, 6, 5, 4, 3, 2, 1, 0);
}
ZONAL_SH_ROWS_INLINE Lanes<double> reversed(const Lanes<double>& v) {
  return __builtin_shufflevector(v, v, 3, 2, 1, 0);
}

/// v[1..W-1], next[0]
ZONAL_SH_ROWS_INLINE Lanes<float> from_next(const Lanes<float>& v, const Lanes<float>& next) {
  return __builtin_shufflevector(v, next, 1, 2, 3, 4, 5, 6, 7, 8);
}
ZONAL_SH_ROWS_INLINE Lanes<double> from_next(const Lanes<double>& v, const Lanes<double>& next) {
  return __builtin_shufflevector(v, next, 1, 2, 3, 4);
}

/// previous[W-1], v[0..W-2]
ZONAL_SH_ROWS_INLINE Lanes<float> from_previous(const Lanes<float>& previous, const Lanes<float>& v) {
  return __builtin_shufflevector(previous, v, 7, 8, 9, 10, 11, 12, 13, 14);
}
ZONAL_SH_ROWS_INLINE Lanes<double> from_previous(const Lanes<double>& previous, const Lanes<double>& v) {
  return __builtin_shufflevector(previous, v, 3, 4, 5, 6);
}

alignas(64) inline constexpr int kMask[16] = {-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0, 0};

/// Lanes 0..n-1 of v to p, n in 1..W.
ZONAL_SH_ROWS_INLINE void store_first(float* p, const Lanes<float>& v, int n) {
#if defined(__AVX512VL__)
  _mm256_mask_storeu_ps(p, __mmask8((1 << n) - 1), v);
#elif defined(__AVX__)
  _mm256_maskstore_ps(p, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kMask + 8 - n)), v);
#else
  for (int k = 0; k < n; ++k) p[k] = v[k];
#endif
}
ZONAL_SH_ROWS_INLINE void store_first(double* p, const Lanes<double>& v, int n) {
#if defined(__AVX512VL__)
  _mm256_mask_storeu_pd(p, __mmask8((1 << n) - 1), v);
#elif defined(__AVX__)
  _mm256_maskstore_pd(p, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kMask + 8 - 2 * n)), v);
#else
  for (int k = 0; k < n; ++k) p[k] = v[k];
#endif
}
/// Lanes W-n..W-1 of v to where they lie in p[0..W-1].
ZONAL_SH_ROWS_INLINE void store_last(float* p, const Lanes<float>& v, int n) {
#if defined(__AVX512VL__)
  _mm256_mask_storeu_ps(p, __mmask8((1 << 8) - (1 << (8 - n))), v);
#elif defined(__AVX__)
  const __m256i skipped = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kMask + n));
  _mm256_maskstore_ps(p, _mm256_xor_si256(skipped, _mm256_set1_epi32(-1)), v);
#else
  for (int k = 8 - n; k < 8; ++k) p[k] = v[k];
#endif
}
ZONAL_SH_ROWS_INLINE void store_last(double* p, const Lanes<double>& v, int n) {
#if defined(__AVX512VL__)
  _mm256_mask_storeu_pd(p, __mmask8((1 << 4) - (1 << (4 - n))), v);
#elif defined(__AVX__)
  const __m256i skipped = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kMask + 2 * n));
  _mm256_maskstore_pd(p, _mm256_xor_si256(skipped, _mm256_set1_epi32(-1)), v);
#else
  for (int k = 4 - n; k < 4; ++k) p[k] = v[k];
#endif
}

/// Row `middle` = out + l(l+1): orders first..first+n-1 of the cosines to the right, of the sines to the
/// left. Sines first: order 0 of them is no function and gives way to the cosine's.
template <class T>
ZONAL_SH_ROWS_INLINE void store_orders(T* middle, int first, int n, const Lanes<T>& cosine,
                                       const Lanes<T>& sine) {
  constexpr int W = kWidth<T>;
  T* const left = middle - first - (W - 1);
  const Lanes<T> turned = reversed(sine);
  if (n == W) {
    *reinterpret_cast<typename LaneType<T>::unaligned*>(left) = turned;
    *reinterpret_cast<typename LaneType<T>::unaligned*>(middle + first) = cosine;
  } else {
    store_last(left, turned, n);
    store_first(middle + first, cosine, n);
  }
}

/// x, y, |z|, 1 - |z| and the sign of z of a unit direction; `inverse` is 1/|v|.
template <class T>
struct Input {
  T x, y, z, u, sign, inverse;
};

/// Y and, if kGradient, the gradient's components, into arrays of count(bands).
/// kCount is the number of packs, so that they stay in registers, or 0: as many as it takes.
template <bool kGradient, int kCount, class T>
ZONAL_SH_ROWS_INLINE void evaluate(int bands, const Input<T>& d, T* Y, T* gx, T* gy, T* gz) {
  ZONAL_SH_ROWS_EXACT
  using V = Lanes<T>;
  constexpr int W = kWidth<T>;
  const auto& table = row_tables<T>();
  constexpr int kRoom = kCount > 0 ? kCount : kPacks<T>;
  const int packs = kCount > 0 ? kCount : (bands - 1) / W + 1;
  const V zero = {};

  // Powers sign(z)^m (x+iy)^m: the first W by squaring, then W orders at a time.
  V c[kRoom], s[kRoom], c1[kRoom], s1[kRoom], m_of[kRoom];
  const T xs = d.x * d.sign, ys = d.y * d.sign;
  T re[W + 1] = {1, xs}, im[W + 1] = {0, ys};
  for (int k = 2; k <= W; ++k) {
    const int a = k / 2, b = k - a;
    re[k] = re[a] * re[b] - im[a] * im[b];
    im[k] = re[a] * im[b] + im[a] * re[b];
  }
  V c0 = {}, s0 = {}, m0 = {};
  for (int k = 0; k < W; ++k) c0[k] = re[k], s0[k] = im[k], m0[k] = T(k);
  c[0] = c0, s[0] = s0, m_of[0] = m0;
  for (int k = 1; k < packs; ++k) {
    c[k] = c[k - 1] * re[W] - s[k - 1] * im[W];
    s[k] = c[k - 1] * im[W] + s[k - 1] * re[W];
    m_of[k] = m_of[k - 1] + T(W);
  }
  if (kGradient) {
    for (int k = 0; k < packs; ++k) {
      const V order = m_of[k] * (d.sign * d.inverse);
      c1[k] = from_previous(k > 0 ? c[k - 1] : zero, c[k]) * order;
      s1[k] = from_previous(k > 0 ? s[k - 1] : zero, s[k]) * order;
    }
  }

  V p[kRoom + 1], change[kRoom];
  for (int k = 0; k <= packs; ++k) p[k] = zero + T(1);
  for (int k = 0; k < packs; ++k) change[k] = zero;
  const T rho2 = d.x * d.x + d.y * d.y;
  const T x = d.x * d.inverse, y = d.y * d.inverse, z = d.z * d.sign * d.inverse,
          flat = rho2 * d.sign * d.inverse;
  T parity = 1;
  // Rows of one pack, then those of two, and so on: only the last of a row is cut short.
  ZONAL_SH_ROWS_UNROLL
  for (int last = 0; last < packs; ++last) {
    const int end = bands < (last + 1) * W ? bands : (last + 1) * W;
    for (int l = last * W; l < end; ++l, parity *= d.sign) {
      const auto* entry = table.entries[l];
      const std::ptrdiff_t row = l * (l + 1);
      for (int k = 0; k <= last; ++k) {
        change[k] = entry[k].fall * change[k] - entry[k].rise * p[k];
        p[k] += d.u * change[k];
      }
      for (int k = 0; k <= last; ++k) {
        const int first = k * W, n = k < last ? W : l + 1 - first;
        const V f = entry[k].norm * (p[k] * parity);
        store_orders<T>(Y + row, first, n, f * c[k], f * s[k]);
        if (!kGradient) continue;
        const V df = entry[k].slope * (from_next(p[k], p[k + 1]) * parity);  // without the sign of z
        const V radial = m_of[k] * f + d.z * df, rx = radial * x, ry = radial * y;
        const V up = flat * df - (m_of[k] * z) * f;
        store_orders<T>(gx + row, first, n, f * c1[k] - rx * c[k], f * s1[k] - rx * s[k]);
        store_orders<T>(gy + row, first, n, -(f * s1[k]) - ry * c[k], f * c1[k] - ry * s[k]);
        store_orders<T>(gz + row, first, n, up * c[k], up * s[k]);
      }
    }
  }
}

template <bool kGradient, class T>
ZONAL_SH_ROWS_INLINE void evaluate_any(int bands, const Input<T>& d, T* Y, T* gx, T* gy, T* gz) {
  switch ((bands - 1) / kWidth<T>) {
    case 0:
      return evaluate<kGradient, 1>(bands, d, Y, gx, gy, gz);
    case 1:
      return evaluate<kGradient, 2>(bands, d, Y, gx, gy, gz);
    case 2:
      return evaluate<kGradient, 3>(bands, d, Y, gx, gy, gz);
    default:
      return evaluate<kGradient, 0>(bands, d, Y, gx, gy, gz);
  }
}

}  // namespace zonal::sh::rows

#pragma GCC diagnostic pop
