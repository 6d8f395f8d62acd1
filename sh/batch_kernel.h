#pragma once
/// One block of directions through the recurrences of tables.h, a direction a lane. Where values go is a
/// sink, called as they are made: sink(i, pack). Used by batch.h.

#include <cmath>
#include <cstring>
#include <memory>
#include <new>

#include "sh/tables.h"

// Sums here are ordered for accuracy; a file compiled with -fassociative-math must not reorder them.
#ifdef __clang__
#define ZONAL_SH_EXACT _Pragma("clang fp reassociate(off)")
// Whole loops where the number of bands is a constant kBands; pairs, outer loops not at all, where it is not.
#define ZONAL_SH_UNROLL_OUTER _Pragma("clang loop unroll_count(kBands > 0 ? 16 : 1)")
#define ZONAL_SH_UNROLL_INNER _Pragma("clang loop unroll_count(kBands > 0 ? 16 : 2)")
#else
#define ZONAL_SH_EXACT
#define ZONAL_SH_UNROLL_OUTER
#define ZONAL_SH_UNROLL_INNER
#endif
#define ZONAL_SH_INLINE inline __attribute__((always_inline))

namespace zonal::sh {

/// Directions a block: one cache line, one AVX-512 register, two of AVX2.
template <class T>
inline constexpr int kLanes = 64 / int(sizeof(T));

namespace batch {

template <class T>
struct PackType;
template <>
struct PackType<float> {
  typedef float type __attribute__((vector_size(64)));
  typedef float unaligned __attribute__((vector_size(64), aligned(4), may_alias));
};
template <>
struct PackType<double> {
  typedef double type __attribute__((vector_size(64)));
  typedef double unaligned __attribute__((vector_size(64), aligned(8), may_alias));
};
template <class T>
using Pack = typename PackType<T>::type;

/// Passed by reference only: a pack's calling convention depends on the target.
template <class T>
ZONAL_SH_INLINE void store(T* p, const Pack<T>& v) {
  *reinterpret_cast<typename PackType<T>::unaligned*>(p) = v;
}

/// Arrays of count(bands) packs, aligned.
template <class T>
class Scratch {
 public:
  Scratch(int arrays, int bands)
      : size_(std::size_t(count(bands)) * kLanes<T>),
        data_(static_cast<T*>(::operator new(size_* arrays * sizeof(T), std::align_val_t(64)))) {}
  T* array(int k) { return data_.get() + k * size_; }

 private:
  struct Free {
    void operator()(T* p) const { ::operator delete(p, std::align_val_t(64)); }
  };
  std::size_t size_;
  std::unique_ptr<T, Free> data_;
};

/// Unit directions with u = 1 - |z|, as in basis.cpp.
template <class T>
struct Directions {
  Pack<T> x, y, z, u, sign;
};

template <class T>
ZONAL_SH_INLINE Directions<T> load(const T* px, const T* py, const T* pz, int lanes) {
  ZONAL_SH_EXACT
  alignas(64) T a[3][kLanes<T>];
  Pack<T> x, y, z;
  if (lanes == kLanes<T>) {
    std::memcpy(&x, px, sizeof x), std::memcpy(&y, py, sizeof y), std::memcpy(&z, pz, sizeof z);
  } else {
    for (int k = 0; k < kLanes<T>; ++k) {
      const int from = k < lanes ? k : lanes - 1;
      a[0][k] = px[from], a[1][k] = py[from], a[2][k] = pz[from];
    }
    std::memcpy(&x, a[0], sizeof x), std::memcpy(&y, a[1], sizeof y), std::memcpy(&z, a[2], sizeof z);
  }
  // 1/|d| - 1 to second order in |d|^2 - 1, which is at the level of rounding.
  const Pack<T> excess = (z - T(1)) * (z + T(1)) + (x * x + y * y);
  const Pack<T> scale = excess * (T(0.375) * excess - T(0.5));
  Directions<T> d;
  d.x = x + x * scale, d.y = y + y * scale, d.z = z + z * scale;
  const Pack<T> zero = {}, one = zero + T(1);
  d.sign = d.z < zero ? -one : one;
  // 1 - |z| is exact near the pole, so that no division is needed.
  const Pack<T> up = z * d.sign;
  d.u = (T(1) - up) - up * scale;
  return d;
}

/// Writes Y_i to out + i * stride.
template <class T>
struct Store {
  T* out;
  std::ptrdiff_t stride;
  ZONAL_SH_INLINE void operator()(int i, const Pack<T>& v) const { store(out + i * stride, v); }
};

template <class T>
struct StoreGradient {
  T* out[4];  ///< Y and the three components
  std::ptrdiff_t stride;
  ZONAL_SH_INLINE void operator()(int i, const Pack<T>& v, const Pack<T>& gx, const Pack<T>& gy,
                                  const Pack<T>& gz) const {
    store(out[0] + i * stride, v), store(out[1] + i * stride, gx), store(out[2] + i * stride, gy),
        store(out[3] + i * stride, gz);
  }
};

/// sink(i, Y_i) for each i, order by order. kBands > 0 is the number of bands, known to the compiler.
template <int kBands, class T, class Sink>
ZONAL_SH_INLINE void values(const Tables<T>& table, int bands, const Directions<T>& d, Sink&& sink) {
  ZONAL_SH_EXACT
  if (kBands > 0) bands = kBands;
  const Pack<T> zero = {}, one = zero + T(1);
  Pack<T> c = one, s = zero;  // (x+iy)^m
  ZONAL_SH_UNROLL_OUTER
  for (int m = 0; m < bands; ++m) {
    const Step<T>* step = table.column(m);
    // For z < 0, every second l - m changes sign: two sets of powers take turns.
    Pack<T> re = c, im = s, re_next = c * d.sign, im_next = s * d.sign;
    Pack<T> p = one, change = zero;
    ZONAL_SH_UNROLL_INNER
    for (int l = m; l < bands; ++l, ++step) {
      if (l > m) {
        change = step->fall * change - step->rise * p;
        p += d.u * change;
      }
      const Pack<T> q = step->norm * p;
      if (m > 0) sink(index(l, -m), q * im);
      sink(index(l, m), m > 0 ? q * re : (l & 1) ? q * d.sign : q);
      const Pack<T> r = re, i = im;
      re = re_next, im = im_next, re_next = r, im_next = i;
    }
    const Pack<T> next = m > 0 ? d.x * c - d.y * s : d.x;
    s = m > 0 ? d.x * s + d.y * c : d.y;
    c = next;
  }
}

/// Adds sum_l over order m of coefficients[i] Y_i: a column is summed before it meets (x+iy)^m = c + is.
template <class T>
ZONAL_SH_INLINE void add_dot_column(const Tables<T>& table, int bands, int m, const Directions<T>& d,
                                    const T* coefficients, const Pack<T>& c, const Pack<T>& s, Pack<T>& sum) {
  ZONAL_SH_EXACT
  const Step<T>* step = table.column(m);
  const Pack<T> zero = {};
  Pack<T> p = zero + T(1), change = zero;
  Pack<T> re = zero, im = zero, re_next = zero, im_next = zero;  // same and other parity of l - m, by turns
  for (int l = m;;) {
    re += (coefficients[index(l, m)] * step->norm) * p;
    im += (coefficients[index(l, -m)] * step->norm) * p;
    const Pack<T> r = re, i = im;
    re = re_next, im = im_next, re_next = r, im_next = i;
    if (++l == bands) break;
    ++step;
    change = step->fall * change - step->rise * p;
    p += d.u * change;
  }
  // The last term went to re_next; parity even belongs to the one that took the first.
  const bool even_last = ((bands - 1 - m) & 1) == 0;
  const Pack<T> even = even_last ? re_next : re, odd = even_last ? re : re_next;
  sum += (even + d.sign * odd) * c;
  if (m > 0) {
    const Pack<T> even_s = even_last ? im_next : im, odd_s = even_last ? im : im_next;
    sum += (even_s + d.sign * odd_s) * s;
  }
}

/// sink(i, Y_i, gradient x, y, z) at unit directions; see evaluate_gradient in basis.cpp.
template <int kBands, class T, class Sink>
ZONAL_SH_INLINE void gradients(const Tables<T>& table, int bands, const Directions<T>& d, Sink&& sink) {
  ZONAL_SH_EXACT
  if (kBands > 0) bands = kBands;
  const Pack<T> zero = {}, one = zero + T(1), rho2 = d.x * d.x + d.y * d.y;
  Pack<T> c = one, s = zero, c1 = zero, s1 = zero;  // (x+iy)^m and m (x+iy)^{m-1}
  ZONAL_SH_UNROLL_OUTER
  for (int m = 0; m < bands; ++m) {
    const Step<T>* step = table.column(m);
    const Step<T>* step1 = m + 1 < bands ? table.column(m + 1) : nullptr;
    Pack<T> p = one, change = zero, p1 = zero, change1 = zero, sign = one;
    const Pack<T> mz = T(m) * d.z;
    // p of this order and of the next run side by side: the next is the derivative.
    ZONAL_SH_UNROLL_INNER
    for (int l = m; l < bands; ++l, ++step) {
      if (l > m) {
        change = step->fall * change - step->rise * p;
        p += d.u * change;
        if (l == m + 1) {
          p1 = one;
        } else {
          ++step1;
          change1 = step1->fall * change1 - step1->rise * p1;
          p1 += d.u * change1;
        }
      }
      const Pack<T> f = step->norm * (p * sign);
      sign *= d.sign;
      const Pack<T> df = step->slope * (p1 * sign);
      const Pack<T> radial = T(m) * f + d.z * df, up = rho2 * df - mz * f;
      const Pack<T> rx = radial * d.x, ry = radial * d.y;
      if (m > 0) sink(index(l, -m), f * s, f * s1 - rx * s, f * c1 - ry * s, up * s);
      sink(index(l, m), f * c, f * c1 - rx * c, -(f * s1) - ry * c, up * c);
    }
    const Pack<T> next = m > 0 ? d.x * c - d.y * s : d.x, next_s = m > 0 ? d.x * s + d.y * c : d.y;
    c1 = T(m + 1) * c, s1 = T(m + 1) * s;
    c = next, s = next_s;
  }
}

/// sink(i, Y_i, gradient[3], hessian[6]) at unit directions, hessian as xx, xy, xz, yy, yz, zz; see
/// evaluate_hessian in basis.cpp.
template <int kBands, class T, class Sink>
ZONAL_SH_INLINE void hessians(const Tables<T>& table, int bands, const Directions<T>& d, Sink&& sink) {
  ZONAL_SH_EXACT
  if (kBands > 0) bands = kBands;
  const Pack<T> zero = {}, one = zero + T(1), rho2 = d.x * d.x + d.y * d.y;
  const Pack<T> x = d.x, y = d.y, z = d.z;
  Pack<T> c = one, s = zero, c1 = zero, s1 = zero, c2 = zero, s2 = zero;  // (x+iy)^m, ^{m-1}, ^{m-2}
  for (int m = 0; m < bands; ++m) {
    const Step<T>* column[3];
    for (int k = 0; k < 3; ++k) column[k] = table.column(m + k < kMaxBands ? m + k : 0);
    Pack<T> p[3] = {zero, zero, zero}, change[3] = {zero, zero, zero}, sign = one;
    for (int l = m; l < bands; ++l) {
      for (int k = 0; k < 3; ++k) {
        const int j = l - m - k;
        if (j == 0) p[k] = one;
        if (j <= 0) continue;
        change[k] = column[k][j].fall * change[k] - column[k][j].rise * p[k];
        p[k] += d.u * change[k];
      }
      const Step<T>& step = column[0][l - m];
      const Pack<T> f = step.norm * (p[0] * sign), ddf = step.curve * (p[2] * sign);
      sign *= d.sign;
      const Pack<T> df = step.slope * (p[1] * sign);
      const T degree = T(l) * T(l + 1), order = T(m);
      const Pack<T> radial = order * f + z * df, up = rho2 * df - order * z * f;
      const Pack<T> squares = order * (order + 2) * f + (2 * order + 3) * z * df + z * z * ddf;
      const Pack<T> side = z * ((degree + order) * f) - (order + rho2) * df;
      const Pack<T> zz = (order * (order + 1) * z * z - (degree - order * order) * rho2) * f - rho2 * z * df;
      const Pack<T> mf = order * f, mmf = order * (order - 1) * f, mr = order * radial, mu = order * up;
      auto write = [&](int i, const Pack<T>& p0, const Pack<T>& px, const Pack<T>& py, const Pack<T>& pxx,
                       const Pack<T>& pxy) {
        const Pack<T> g[3] = {mf * px - radial * x * p0, mf * py - radial * y * p0, up * p0};
        const Pack<T> h[6] = {mmf * pxx - T(2) * x * mr * px + (x * x * squares - radial) * p0,
                              mmf * pxy - mr * (x * py + y * px) + x * y * squares * p0,
                              mu * px + x * side * p0,
                              -(mmf * pxx) - T(2) * y * mr * py + (y * y * squares - radial) * p0,
                              mu * py + y * side * p0,
                              zz * p0};
        sink(i, f * p0, g, h);
      };
      if (m > 0) write(index(l, -m), s, s1, c1, s2, c2);
      write(index(l, m), c, c1, -s1, c2, -s2);
    }
    const Pack<T> next = x * c - y * s, next_s = x * s + y * c;
    c2 = c1, s2 = s1, c1 = c, s1 = s, c = next, s = next_s;
  }
}

}  // namespace batch

}  // namespace zonal::sh
