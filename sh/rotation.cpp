#include "sh/rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/ivanic.h"

namespace zonal::sh {
namespace {

constexpr int kLanes = 32;  ///< functions treated together: four registers of floats

template <class T>
Mat3<T> to_matrix(const glm::qua<T>& q) {
  // Scale by the largest component first: the square of a length of 1e-30 is nothing.
  const double largest =
      std::max({std::abs(double(q.w)), std::abs(double(q.x)), std::abs(double(q.y)), std::abs(double(q.z))});
  const double a = q.w / largest, x = q.x / largest, y = q.y / largest, z = q.z / largest;
  const double s = 2 / (a * a + x * x + y * y + z * z);
  return Mat3<T>(Vec3<T>(1 - s * (y * y + z * z), s * (x * y + a * z), s * (x * z - a * y)),
                 Vec3<T>(s * (x * y - a * z), 1 - s * (x * x + z * z), s * (y * z + a * x)),
                 Vec3<T>(s * (x * z + a * y), s * (y * z - a * x), 1 - s * (x * x + y * y)));
}

}  // namespace

template <class T>
Mat3<T> matrix_from_z_to(const Vec3<T>& axis) {
  const double x = axis.x, y = axis.y, z = axis.z, h = std::hypot(x, y);
  // R = I - k (x, y)(x, y)^T on the plane, k = 1/(1+z) = (1-z)/h^2: of unit cosines c, s below the equator,
  // where the first form cancels. At -z the cosines are a choice.
  const double c = h > 0 ? x / h : 0, s = h > 0 ? y / h : 1;
  const double k = z > 0 ? h * h / (1 + z) : 1 - z;
  return Mat3<T>(Vec3<T>(1 - k * c * c, -k * c * s, -x), Vec3<T>(-k * c * s, 1 - k * s * s, -y),
                 Vec3<T>(x, y, z));
}

template <class T>
Mat3<double> orthonormalized(const Mat3<T>& R) {
  Mat3<double> Q(R);
  for (int step = 0; step < 2; ++step) Q = Q * (Mat3<double>(1.5) - 0.5 * (glm::transpose(Q) * Q));
  return Q;
}

template <class T>
Rotation<T>::Rotation(int bands, const Mat3<T>& R) : bands_(bands), columns_(band_offset(bands)) {
  ivanic_ruedenberg(bands, orthonormalized(R), columns_.data());
}

template <class T>
Rotation<T>::Rotation(int bands, const glm::qua<T>& q) : Rotation(bands, to_matrix(q)) {}

template <class T>
Rotation<T> Rotation<T>::from_z_to(int bands, const Vec3<T>& axis) {
  return Rotation(bands, matrix_from_z_to(axis));
}

template <class T>
void Rotation<T>::apply(const T* in, T* out) const {
  for (int l = 0; l < bands_; ++l) {
    const int size = 2 * l + 1;
    const T* column = columns_.data() + band_offset(l);
    const T* g = in + l * l;
    T* sum = out + l * l;
    for (int m = 0; m < size; ++m) sum[m] = column[m] * g[0];
    for (int n = 1; n < size; ++n) {
      column += size;
      for (int m = 0; m < size; ++m) sum[m] += column[m] * g[n];
    }
  }
}

template <class T>
void Rotation<T>::apply_inverse(const T* in, T* out) const {
  for (int l = 0; l < bands_; ++l) {
    const int size = 2 * l + 1;
    const T* column = columns_.data() + band_offset(l);
    for (int n = 0; n < size; ++n, column += size) {
      T sum = 0;
      for (int m = 0; m < size; ++m) sum += column[m] * in[l * l + m];
      out[l * l + n] = sum;
    }
  }
}

namespace {

/// out_m = sum_n matrix[m * row_step + n * column_step] in_n, one band, lanes of functions.
template <class T>
void multiply_band(int size, const T* matrix, int row_step, int column_step, int functions, const T* in,
                   T* out) {
  for (int first = 0; first < functions; first += kLanes) {
    const int lanes = std::min(kLanes, functions - first);
    for (int m = 0; m < size; ++m) {
      T sum[kLanes] = {};
      if (lanes == kLanes) {
        for (int n = 0; n < size; ++n) {
          const T factor = matrix[m * row_step + n * column_step];
          const T* g = in + size_t(n) * functions + first;
          for (int f = 0; f < kLanes; ++f) sum[f] += factor * g[f];
        }
      } else {
        for (int n = 0; n < size; ++n) {
          const T factor = matrix[m * row_step + n * column_step];
          const T* g = in + size_t(n) * functions + first;
          for (int f = 0; f < lanes; ++f) sum[f] += factor * g[f];
        }
      }
      std::copy(sum, sum + lanes, out + size_t(m) * functions + first);
    }
  }
}

}  // namespace

template <class T>
void Rotation<T>::apply(int functions, const T* in, T* out) const {
  for (int l = 0; l < bands_; ++l) {
    const size_t start = size_t(l) * l * functions;
    multiply_band(2 * l + 1, columns_.data() + band_offset(l), 1, 2 * l + 1, functions, in + start,
                  out + start);
  }
}

template <class T>
void Rotation<T>::apply_inverse(int functions, const T* in, T* out) const {
  for (int l = 0; l < bands_; ++l) {
    const size_t start = size_t(l) * l * functions;
    multiply_band(2 * l + 1, columns_.data() + band_offset(l), 2 * l + 1, 1, functions, in + start,
                  out + start);
  }
}

template <class T>
void rotate_zonal(int bands, const Vec3<T>& axis, const T* zonal, T* out) {
  evaluate(bands, axis, out);
  for (int l = 0; l < bands; ++l) {
    const T scale = T(std::sqrt(4 * std::numbers::pi / (2 * l + 1))) * zonal[l];  // (2.73)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) out[i] *= scale;
  }
}

template <class T>
void rotate_zonal(int bands, int functions, const Vec3<T>* axes, const T* zonal, T* out) {
  T Y[count(kMaxBands)];
  T norm[kMaxBands];
  for (int l = 0; l < bands; ++l) norm[l] = T(std::sqrt(4 * std::numbers::pi / (2 * l + 1)));
  for (int f = 0; f < functions; ++f) {
    evaluate(bands, axes[f], Y);
    for (int l = 0; l < bands; ++l) {
      const T scale = norm[l] * zonal[size_t(l) * functions + f];
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) out[size_t(i) * functions + f] = Y[i] * scale;
    }
  }
}

#define ZONAL_INSTANTIATE(T)                                     \
  template class Rotation<T>;                                    \
  template Mat3<T> matrix_from_z_to(const Vec3<T>&);             \
  template Mat3<double> orthonormalized(const Mat3<T>&);         \
  template void rotate_zonal(int, const Vec3<T>&, const T*, T*); \
  template void rotate_zonal(int, int, const Vec3<T>*, const T*, T*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
