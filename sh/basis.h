#pragma once
/// Real, orthonormal spherical harmonics of one direction, with gradient and Hessian.
///
/// Conventions: Condon-Shortley phase inside the Legendre functions, so Y_1^-1 = -sqrt(3/4pi) y, Y_1^0 =
/// sqrt(3/4pi) z, Y_1^1 = -sqrt(3/4pi) x (Mézières 2022, Eq. 2.30). Order: index l(l+1)+m. "N bands" means l
/// = 0..N-1, N^2 values.
///
///     float Y[sh::count(9)];
///     sh::evaluate(9, direction, Y);
///
/// T is float or double. Outputs belong to the caller. Directions are unit unless said otherwise;
/// `normalized` makes them so, safely. These functions state preconditions and do not check them;
/// sh/checked.h has entry points that do.

#include <glm/glm.hpp>

namespace zonal::sh {

template <class T>
using Vec3 = glm::vec<3, T>;

inline constexpr int kMaxBands = 101;  ///< l up to 100

constexpr int index(int l, int m) {
  return l * (l + 1) + m;
}
constexpr int count(int bands) {
  return bands * bands;
}

/// Second derivatives: symmetric, so six numbers.
template <class T>
struct Hessian {
  T xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
};

/// v/|v| without overflow or underflow for any finite non-zero v (1e-30 and 1e30 are ordinary inputs).
template <class T>
Vec3<T> normalized(const Vec3<T>& v);

/// Y[count(bands)] at the unit direction d. 1 <= bands <= kMaxBands. "Unit" to rounding: what is evaluated is
/// Y(d/|d|).
template <class T>
void evaluate(int bands, const Vec3<T>& d, T* Y);

/// Also the Cartesian gradient of Y(v/|v|) with respect to v, any non-zero v: contains 1/|v| and is tangent
/// to the sphere. Recurrences in z and (x, y), never an angle: at the poles it is the limit.
/// `gradient[count(bands)]`.
template <class T>
void evaluate_gradient(int bands, const Vec3<T>& v, T* Y, Vec3<T>* gradient);

/// The same with a component an array, which is faster: nothing has to be interleaved.
template <class T>
void evaluate_gradient(int bands, const Vec3<T>& v, T* Y, T* gradient_x, T* gradient_y, T* gradient_z);

/// Also the Cartesian Hessian of Y(v/|v|) with respect to v. `hessian[count(bands)]`.
template <class T>
void evaluate_hessian(int bands, const Vec3<T>& v, T* Y, Vec3<T>* gradient, Hessian<T>* hessian);

}  // namespace zonal::sh
