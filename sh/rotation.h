#pragma once
/// Rotation of spherical harmonics coefficients. Active everywhere: the rotated function is g(R^T w), so what
/// pointed along z points along Rz (Mézières 2022, Sec. 2.2.12, in the convention of Eq. 2.73).
///
///     const sh::Rotation<float> rotation(bands, R);
///     rotation.apply(coefficients, rotated);
///
/// Many vectors at once are held as structure of arrays: coefficient i of function f at [i * functions + f].
/// Inputs and outputs must not overlap unless said otherwise. 1 <= bands <= kMaxBands; R is a rotation (what
/// float rounding took from its orthogonality is restored); sh/checked_operations.h has an entry point that
/// checks.

#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "sh/basis.h"

namespace zonal::sh {

template <class T>
using Mat3 = glm::mat<3, 3, T>;

/// The matrices of all bands, made once and applied often. Making them costs about 40 operations an element,
/// and there are N(2N-1)(2N+1)/3 elements; applying costs one multiplication an element.
template <class T>
class Rotation {
 public:
  /// By the recurrences of Ivanic and Ruedenberg (1996, with the corrections of 1998), in double inside.
  Rotation(int bands, const Mat3<T>& R);
  Rotation(int bands, const glm::qua<T>& q);  ///< any non-zero length
  /// Sends z to the unit `axis`: matrix_from_z_to.
  static Rotation from_z_to(int bands, const Vec3<T>& axis);

  void apply(const T* in, T* out) const;
  void apply(int functions, const T* in, T* out) const;
  void apply_inverse(const T* in, T* out) const;
  void apply_inverse(int functions, const T* in, T* out) const;

  int bands() const { return bands_; }
  /// Element of band l: rotated_l^m = sum over n of element(l, m, n) g_l^n.
  T element(int l, int m, int n) const { return columns_[band_offset(l) + (n + l) * (2 * l + 1) + m + l]; }

  static constexpr int band_offset(int l) { return l * (2 * l - 1) * (2 * l + 1) / 3; }

 private:
  int bands_;
  std::vector<T> columns_;  ///< band after band, each (2l+1)^2 column by column
};

/// About z by `angle`: rotated^m = g^m cos(m a) - g^-m sin(m a), rotated^-m = g^m sin(m a) + g^-m cos(m a)
/// (Eq. 2.74 turned to the active sense). `out` may be `in`.
template <class T>
void rotate_about_z(int bands, T angle, const T* in, T* out);
template <class T>
void rotate_about_z(int bands, T angle, int functions, const T* in, T* out);

/// The same from the cosine and sine of the angle, which must lie on the unit circle.
template <class T>
void rotate_about_z(int bands, T cos, T sin, int functions, const T* in, T* out);

/// One vector by R without making a matrix: about z, x by 90 degrees, z, x by -90 degrees, z (Eq. 2.76). No
/// angle is taken; every gimbal position is exact. About 2 N^3/3 operations.
template <class T>
void rotate_zxzxz(int bands, const Mat3<T>& R, const T* in, T* out);
template <class T>
void rotate_zxzxz(int bands, const Mat3<T>& R, int functions, const T* in, T* out);

/// A zonal function about z, zonal[bands], turned to the unit `axis`: sqrt(4pi/(2l+1)) F_l Y_l^m(axis)
/// (Eq. 2.73).
template <class T>
void rotate_zonal(int bands, const Vec3<T>& axis, const T* zonal, T* out);
/// `axes[functions]`; zonal and out are structures of arrays.
template <class T>
void rotate_zonal(int bands, int functions, const Vec3<T>* axes, const T* zonal, T* out);

/// Sends z to the unit `axis` along the shortest arc; for axis = -z, half a turn about x.
template <class T>
Mat3<T> matrix_from_z_to(const Vec3<T>& axis);

/// The nearest rotation to a matrix that is one up to rounding (two steps of Newton's polar iteration), in
/// double.
template <class T>
Mat3<double> orthonormalized(const Mat3<T>& R);

}  // namespace zonal::sh
