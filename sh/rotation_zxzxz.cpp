// Rotation about z, and general rotation without a matrix: z x z x z (Mézières 2022, Eq. 2.74 to 2.76).
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "sh/ivanic.h"
#include "sh/lazy_tables.h"
#include "sh/rotation.h"

namespace zonal::sh {
namespace {

constexpr int kLanes = 32;
constexpr int kLongest = kMaxBands / 2 + 1;  ///< of a group of same sign and parity

/// The cosines and sines of m times an angle, in double so that m = 100 costs no accuracy.
struct Multiples {
  double cos[kMaxBands], sin[kMaxBands];

  Multiples(int bands, double c, double s) {
    cos[0] = 1, sin[0] = 0;
    for (int m = 1; m < bands; ++m) {
      cos[m] = c * cos[m - 1] - s * sin[m - 1];
      sin[m] = s * cos[m - 1] + c * sin[m - 1];
    }
  }
};

/// Orders of one sign and one parity of |m| in one band: m = first, first + step, ...
struct Group {
  int first, step, size;

  Group(int l, bool negative, int parity) {
    const int start = negative && parity == 0 ? 2 : parity;
    size = l >= start ? (l - start) / 2 + 1 : 0;
    first = negative ? -start : start;
    step = negative ? -2 : 2;
  }
};

/// Rotation by 90 degrees about x, y to z and z to -y. Mirroring at x = 0 commutes with it, and mirroring at
/// y = 0 after it is mirroring at z = 0 before it, so a group of orders depends on one other group: a quarter
/// of the matrix is left.
template <class T>
class X90 {
 public:
  struct Block {
    Group out, in;
    int matrix;  ///< where its elements start, column by column
  };

  explicit X90(int bands) {
    std::vector<double> columns(Rotation<double>::band_offset(bands));
    ivanic_ruedenberg(bands,
                      Mat3<double>(Vec3<double>(1, 0, 0), Vec3<double>(0, 0, 1), Vec3<double>(0, -1, 0)),
                      columns.data());
    for (int l = 0; l < bands; ++l)
      for (int negative = 0; negative < 2; ++negative)
        for (int parity = 0; parity < 2; ++parity) {
          const int in_parity = (l + negative) % 2;
          const bool in_negative = in_parity != (parity + negative) % 2;
          const Block block{Group(l, negative, parity), Group(l, in_negative, in_parity),
                            int(elements_.size())};
          const double* band = columns.data() + Rotation<double>::band_offset(l);
          for (int j = 0; j < block.in.size; ++j)
            for (int i = 0; i < block.out.size; ++i)
              elements_.push_back(T(band[(block.in.first + block.in.step * j + l) * (2 * l + 1) +
                                         block.out.first + block.out.step * i + l]));
          blocks_.push_back(block);
        }
  }

  void apply(int bands, const T* in, T* out) const {
    T sum[kLongest];
    for (int l = 0; l < bands; ++l)
      for (int b = 4 * l; b < 4 * l + 4; ++b) {
        const Block& block = blocks_[b];
        const T* column = elements_.data() + block.matrix;
        const T* g = in + index(l, block.in.first);
        std::fill(sum, sum + block.out.size, T(0));
        for (int j = 0; j < block.in.size; ++j, column += block.out.size)
          for (int i = 0; i < block.out.size; ++i) sum[i] += column[i] * g[block.in.step * j];
        T* target = out + index(l, block.out.first);
        for (int i = 0; i < block.out.size; ++i) target[block.out.step * i] = sum[i];
      }
  }

  void apply(int bands, int functions, const T* in, T* out) const {
    for (int l = 0; l < bands; ++l)
      for (int b = 4 * l; b < 4 * l + 4; ++b)
        for (int first = 0; first < functions; first += kLanes) {
          const int lanes = std::min(kLanes, functions - first);
          if (lanes == kLanes)
            apply_block(blocks_[b], l, std::integral_constant<int, kLanes>(), functions, in + first,
                        out + first);
          else
            apply_block(blocks_[b], l, lanes, functions, in + first, out + first);
        }
  }

 private:
  template <class Lanes>  ///< a number, or one known when compiling
  void apply_block(const Block& block, int l, Lanes lanes, int functions, const T* in, T* out) const {
    for (int i = 0; i < block.out.size; ++i) {
      T sum[kLanes] = {};
      for (int j = 0; j < block.in.size; ++j) {
        const T factor = elements_[block.matrix + j * block.out.size + i];
        const T* g = in + size_t(index(l, block.in.first + block.in.step * j)) * functions;
        for (int f = 0; f < lanes; ++f) sum[f] += factor * g[f];
      }
      std::copy(sum, sum + lanes, out + size_t(index(l, block.out.first + block.out.step * i)) * functions);
    }
  }

  std::vector<Block> blocks_;  ///< four a band
  std::vector<T> elements_;
};

/// The table for at least `bands` bands, from five sizes.
template <class T>
const X90<T>& x90(int bands) {
  constexpr int sizes[] = {6, 12, 24, 48, kMaxBands};
  static LazyTables<X90<T>, 5> tables;
  int key = 0;
  while (sizes[key] < bands) ++key;
  return tables.get(key, [&] { return std::make_unique<X90<T>>(sizes[key]); });
}

template <class T>
void rotate_by_multiples(int bands, const Multiples& multiples, const T* in, T* out) {
  T c[kMaxBands], s[kMaxBands];
  for (int m = 0; m < bands; ++m) c[m] = T(multiples.cos[m]), s[m] = T(multiples.sin[m]);
  for (int l = 0; l < bands; ++l) {
    const int middle = index(l, 0);
    out[middle] = in[middle];
    for (int m = 1; m <= l; ++m) {
      const T plus = in[middle + m], minus = in[middle - m];
      out[middle + m] = plus * c[m] - minus * s[m];  // (2.74, active)
      out[middle - m] = plus * s[m] + minus * c[m];
    }
  }
}

template <class T>
void rotate_by_multiples(int bands, const Multiples& multiples, int functions, const T* in, T* out) {
  for (int l = 0; l < bands; ++l) {
    const size_t middle = size_t(index(l, 0)) * functions;
    if (in != out) std::copy(in + middle, in + middle + functions, out + middle);
    for (int m = 1; m <= l; ++m) {
      const size_t up = size_t(index(l, m)) * functions, down = size_t(index(l, -m)) * functions;
      const T c = T(multiples.cos[m]), s = T(multiples.sin[m]);
      for (int f = 0; f < functions; ++f) {
        const T plus = in[up + f], minus = in[down + f];
        out[up + f] = plus * c - minus * s;
        out[down + f] = plus * s + minus * c;
      }
    }
  }
}

/// R = Rz(alpha) Ry(beta) Rz(gamma) as cosines and sines.
struct EulerZyz {
  double cos_alpha = 1, sin_alpha = 0, cos_beta, sin_beta, cos_gamma, sin_gamma;

  explicit EulerZyz(const Mat3<double>& R) {
    // Squares that vanish leave alpha at 0, which is as good.
    const double s = std::sqrt(R[2][0] * R[2][0] + R[2][1] * R[2][1]);
    if (s > 0) cos_alpha = R[2][0] / s, sin_alpha = R[2][1] / s;
    // Whatever alpha is, even noise at a pole, the rest is read off Rz(-alpha) R, so that the product is R
    // again.
    set(R[2][2], s, cos_beta, sin_beta);
    set(cos_alpha * R[1][1] - sin_alpha * R[1][0], cos_alpha * R[0][1] - sin_alpha * R[0][0], cos_gamma,
        sin_gamma);
  }

 private:
  static void set(double c, double s, double& cos, double& sin) {
    const double inverse = 1 / std::sqrt(c * c + s * s);
    cos = c * inverse, sin = s * inverse;
  }
};

}  // namespace

template <class T>
void rotate_about_z(int bands, T angle, const T* in, T* out) {
  rotate_by_multiples(bands, Multiples(bands, std::cos(double(angle)), std::sin(double(angle))), in, out);
}

template <class T>
void rotate_about_z(int bands, T angle, int functions, const T* in, T* out) {
  rotate_by_multiples(bands, Multiples(bands, std::cos(double(angle)), std::sin(double(angle))), functions,
                      in, out);
}

template <class T>
void rotate_about_z(int bands, T cos, T sin, int functions, const T* in, T* out) {
  const double length = std::hypot(double(cos), double(sin));
  rotate_by_multiples(bands, Multiples(bands, cos / length, sin / length), functions, in, out);
}

// Rx(-90) is Rx(90) between two half turns about z, which flip the signs of the angles beside it.
template <class T>
void rotate_zxzxz(int bands, const Mat3<T>& R, const T* in, T* out) {
  const EulerZyz e(orthonormalized(R));
  const X90<T>& quarter = x90<T>(bands);
  T turned[count(kMaxBands)];
  rotate_by_multiples(bands, Multiples(bands, e.cos_gamma, e.sin_gamma), in, out);
  quarter.apply(bands, out, turned);
  rotate_by_multiples(bands, Multiples(bands, -e.cos_beta, -e.sin_beta), turned, turned);
  quarter.apply(bands, turned, out);
  rotate_by_multiples(bands, Multiples(bands, -e.cos_alpha, -e.sin_alpha), out, out);
}

template <class T>
void rotate_zxzxz(int bands, const Mat3<T>& R, int functions, const T* in, T* out) {
  const EulerZyz e(orthonormalized(R));
  const X90<T>& quarter = x90<T>(bands);
  std::vector<T> turned(size_t(count(bands)) * functions);
  rotate_by_multiples(bands, Multiples(bands, e.cos_gamma, e.sin_gamma), functions, in, out);
  quarter.apply(bands, functions, out, turned.data());
  rotate_by_multiples(bands, Multiples(bands, -e.cos_beta, -e.sin_beta), functions, turned.data(),
                      turned.data());
  quarter.apply(bands, functions, turned.data(), out);
  rotate_by_multiples(bands, Multiples(bands, -e.cos_alpha, -e.sin_alpha), functions, out, out);
}

#define ZONAL_INSTANTIATE(T)                                     \
  template void rotate_about_z(int, T, const T*, T*);            \
  template void rotate_about_z(int, T, int, const T*, T*);       \
  template void rotate_about_z(int, T, T, int, const T*, T*);    \
  template void rotate_zxzxz(int, const Mat3<T>&, const T*, T*); \
  template void rotate_zxzxz(int, const Mat3<T>&, int, const T*, T*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
