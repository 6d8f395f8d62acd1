#pragma once
/// The operations on coefficients for input that nobody has looked at: what cannot be answered is a
/// std::invalid_argument with the value and the valid range, and directions are normalised.
///
///     const auto rotation = sh::checked::rotation(bands, R);
///
/// The functions of basis.h have theirs in checked.h.

#include "sh/checked.h"
#include "sh/clamped_cosine.h"
#include "sh/hemispherical.h"
#include "sh/least_squares.h"
#include "sh/products.h"
#include "sh/projection.h"
#include "sh/rotation.h"
#include "sh/window.h"
#include "sh/zonal_factorization.h"

namespace zonal::sh::checked {

/// Throws unless R R^T is the identity to 1e-3 and R does not mirror.
template <class T>
void require_rotation(const Mat3<T>& R);

/// Throws unless all of them are finite.
template <class T>
void require_finite(const char* name, size_t size, const T* values);

template <class T>
Rotation<T> rotation(int bands, const Mat3<T>& R);
template <class T>
Rotation<T> rotation(int bands, const glm::qua<T>& q);
template <class T>
void rotate_about_z(int bands, T angle, const T* in, T* out);
template <class T>
void rotate_zxzxz(int bands, const Mat3<T>& R, const T* in, T* out);
template <class T>
void rotate_zonal(int bands, const Vec3<T>& axis, const T* zonal, T* out);
template <class T>
ZonalFactorization<T> zonal_factorization(int bands);

template <class T>
void product(int bands, const T* a, const T* b, T* out);
template <class T>
void product_full(int bands, const T* a, const T* b, T* out);
template <class T>
T triple_product(int bands, const T* a, const T* b, const T* c);
template <class T>
void product_of_many(int bands, int M, const T* const* functions, int bands_out, T* out);
template <class T>
void clamped_cosine_product(int bands, const T* in, T* out);
template <class T>
void clamped_cosine_product_in_world(int bands, const Vec3<T>& normal, const T* in, T* out);
template <class T>
void clamped_cosine_product_low_order(int bands, int cosine_bands, const Vec3<T>& normal, const T* in,
                                      T* out);

/// Samples in any number, lengths and weights; throws where arrays differ in size.
template <class T>
void project_values(int bands, const SphereNodes<T>& nodes, const T* values, T* coefficients);
template <class T>
T reconstruct(int bands, const T* coefficients, const Vec3<T>& w);
template <class T>
SphereNodes<T> fibonacci_nodes(int size);
template <class T>
SphereNodes<T> gauss_nodes(int degree);
/// Throws for fewer samples than coefficients, unless a penalty or the truncated SVD decides what they leave
/// open.
template <class T>
LeastSquares<T> least_squares(int bands, const SphereNodes<T>& nodes,
                              const LeastSquaresOptions& options = {});

template <class T>
void apply_window(int bands, Window window, double size, T* coefficients);
template <class T>
Dering dering(int bands, T* coefficients);
template <class T>
Dering dering(int bands, Window window, T* coefficients);

template <class T>
void evaluate_hemispherical(int bands, const Vec3<T>& d, T* H);
template <class T>
HemisphericalConversion<T> hemispherical_conversion(int hsh_bands, int sh_bands);

}  // namespace zonal::sh::checked
