#include "sh/checked_operations.h"

#include <algorithm>
#include <cmath>

namespace zonal::sh::checked {
namespace {

[[noreturn]] void refuse(const std::string& sentence) {
  throw std::invalid_argument(sentence);
}

template <class Number>
void require_at_least(const char* name, Number value, Number least) {
  if (!(value >= least))
    refuse(std::string(name) + " is " + std::to_string(value) + ", must be at least " +
           std::to_string(least));
}

void require_window_size(double size) {
  if (!(size > 0)) refuse("window size is " + std::to_string(size) + ", must be more than 0 bands");
}

template <class T>
void require_nodes(const SphereNodes<T>& nodes) {
  const size_t size = nodes.x.size();
  if (nodes.y.size() != size || nodes.z.size() != size || nodes.weights.size() != size)
    refuse("nodes have " + std::to_string(size) + " x, " + std::to_string(nodes.y.size()) + " y, " +
           std::to_string(nodes.z.size()) + " z and " + std::to_string(nodes.weights.size()) +
           " weights, must be as many of each");
  if (size == 0) refuse("there are 0 nodes, must be at least 1");
  for (size_t k = 0; k < size; ++k) {
    require_direction(nodes.direction(int(k)));
    if (!(nodes.weights[k] >= 0) || !std::isfinite(nodes.weights[k]))
      refuse("weight " + std::to_string(k) + " is " + std::to_string(nodes.weights[k]) +
             ", must be 0 or more steradians");
  }
}

template <class T>
SphereNodes<T> normalized_nodes(const SphereNodes<T>& nodes) {
  SphereNodes<T> unit = nodes;
  for (int k = 0; k < nodes.size(); ++k) {
    const Vec3<T> w = sh::normalized(nodes.direction(k));
    unit.x[k] = w.x, unit.y[k] = w.y, unit.z[k] = w.z;
  }
  return unit;
}

}  // namespace

template <class T>
void require_finite(const char* name, size_t size, const T* values) {
  for (size_t i = 0; i < size; ++i)
    if (!std::isfinite(values[i]))
      refuse(std::string(name) + " " + std::to_string(i) + " is " + std::to_string(values[i]) +
             ", must be finite");
}

template <class T>
void require_rotation(const Mat3<T>& R) {
  require_finite("element of the rotation", 9, &R[0][0]);
  const Mat3<double> Q(R), gram = glm::transpose(Q) * Q;
  double off = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) off = std::max(off, std::abs(gram[i][j] - (i == j)));
  if (!(off <= 1e-3))
    refuse("R^T R is off the identity by " + std::to_string(off) +
           ", must be within 0.001: R must be a rotation");
  if (glm::determinant(Q) < 0) refuse("determinant of R is -1, must be 1: R mirrors");
}

template <class T>
Rotation<T> rotation(int bands, const Mat3<T>& R) {
  require_bands(bands);
  require_rotation(R);
  return Rotation<T>(bands, R);
}

template <class T>
Rotation<T> rotation(int bands, const glm::qua<T>& q) {
  require_bands(bands);
  const T parts[4] = {q.w, q.x, q.y, q.z};
  require_finite("quaternion part", 4, parts);
  if (q.w == 0 && q.x == 0 && q.y == 0 && q.z == 0) refuse("quaternion is (0, 0, 0, 0), must not be zero");
  return Rotation<T>(bands, q);
}

template <class T>
void rotate_about_z(int bands, T angle, const T* in, T* out) {
  require_bands(bands);
  require_finite("angle", 1, &angle);
  sh::rotate_about_z(bands, angle, in, out);
}

template <class T>
void rotate_zxzxz(int bands, const Mat3<T>& R, const T* in, T* out) {
  require_bands(bands);
  require_rotation(R);
  sh::rotate_zxzxz(bands, R, in, out);
}

template <class T>
void rotate_zonal(int bands, const Vec3<T>& axis, const T* zonal, T* out) {
  require_bands(bands);
  sh::rotate_zonal(bands, normalized(axis), zonal, out);
}

template <class T>
ZonalFactorization<T> zonal_factorization(int bands) {
  require_bands(bands);
  return ZonalFactorization<T>(bands);
}

template <class T>
void product(int bands, const T* a, const T* b, T* out) {
  require_bands(bands);
  sh::product(bands, a, b, out);
}

template <class T>
void product_full(int bands, const T* a, const T* b, T* out) {
  require_bands(bands);
  sh::product_full(bands, a, b, out);
}

template <class T>
T triple_product(int bands, const T* a, const T* b, const T* c) {
  require_bands(bands);
  return sh::triple_product(bands, a, b, c);
}

template <class T>
void product_of_many(int bands, int M, const T* const* functions, int bands_out, T* out) {
  require_bands(bands);
  require_at_least("number of functions", M, 1);
  require_bands(bands_out, std::max(kMaxBands, M * (bands - 1) + 1));
  sh::product_of_many(bands, M, functions, bands_out, out);
}

template <class T>
void clamped_cosine_product(int bands, const T* in, T* out) {
  require_bands(bands);
  sh::clamped_cosine_product(bands, in, out);
}

template <class T>
void clamped_cosine_product_in_world(int bands, const Vec3<T>& normal, const T* in, T* out) {
  require_bands(bands);
  sh::clamped_cosine_product_in_world(bands, normalized(normal), in, out);
}

template <class T>
void clamped_cosine_product_low_order(int bands, int cosine_bands, const Vec3<T>& normal, const T* in,
                                      T* out) {
  require_bands(bands);
  require_bands(cosine_bands);
  sh::clamped_cosine_product_low_order(bands, cosine_bands, normalized(normal), in, out);
}

template <class T>
void project_values(int bands, const SphereNodes<T>& nodes, const T* values, T* coefficients) {
  require_bands(bands);
  require_nodes(nodes);
  require_finite("value", nodes.x.size(), values);
  sh::project_values(bands, normalized_nodes(nodes), values, coefficients);
}

template <class T>
T reconstruct(int bands, const T* coefficients, const Vec3<T>& w) {
  require_bands(bands);
  return sh::reconstruct(bands, coefficients, normalized(w));
}

template <class T>
SphereNodes<T> fibonacci_nodes(int size) {
  require_at_least("number of points", size, 1);
  return sh::fibonacci_nodes<T>(size);
}

template <class T>
SphereNodes<T> gauss_nodes(int degree) {
  require_at_least("degree", degree, 0);
  return sh::gauss_nodes<T>(degree);
}

template <class T>
LeastSquares<T> least_squares(int bands, const SphereNodes<T>& nodes, const LeastSquaresOptions& options) {
  require_bands(bands);
  require_nodes(nodes);
  require_at_least("lambda", options.lambda, 0.0);
  if (!std::isfinite(options.lambda))
    refuse("lambda is " + std::to_string(options.lambda) + ", must be finite");
  const int M = nodes.size(), N = count(bands);
  // The Laplacian leaves the mean free, which one sample settles.
  const bool decided = options.lambda > 0 || options.method == LeastSquaresOptions::Method::svd;
  if (M < N && !decided)
    refuse("least squares has " + std::to_string(M) + " samples for the " + std::to_string(N) +
           " coefficients of " + std::to_string(bands) + " bands, must be at least " + std::to_string(N) +
           ": raise the samples to " + std::to_string(N + (N + 1) / 2) +
           " (1.5 a coefficient is well conditioned), lower the bands to " +
           std::to_string(std::max(1, int(std::sqrt(M / 1.5)))) +
           ", raise lambda above 0, or take the truncated SVD");
  return LeastSquares<T>(bands, nodes, options);
}

template <class T>
void apply_window(int bands, Window window, double size, T* coefficients) {
  require_bands(bands);
  require_window_size(size);
  sh::apply_window(bands, window, size, coefficients);
}

template <class T>
Dering dering(int bands, T* coefficients) {
  require_bands(bands);
  require_finite("coefficient", count(bands), coefficients);
  return sh::dering(bands, coefficients);
}

template <class T>
Dering dering(int bands, Window window, T* coefficients) {
  require_bands(bands);
  if (window == Window::none) refuse("window is none, must be hann, lanczos or hamming");
  require_finite("coefficient", count(bands), coefficients);
  return sh::dering(bands, window, coefficients);
}

template <class T>
void evaluate_hemispherical(int bands, const Vec3<T>& d, T* H) {
  require_bands(bands);
  sh::evaluate_hemispherical(bands, normalized(d), H);
}

template <class T>
HemisphericalConversion<T> hemispherical_conversion(int hsh_bands, int sh_bands) {
  require_bands(hsh_bands);
  require_bands(sh_bands);
  return HemisphericalConversion<T>(hsh_bands, sh_bands);
}

#define ZONAL_INSTANTIATE(T)                                                                      \
  template void require_finite(const char*, size_t, const T*);                                    \
  template void require_rotation(const Mat3<T>&);                                                 \
  template Rotation<T> rotation(int, const Mat3<T>&);                                             \
  template Rotation<T> rotation(int, const glm::qua<T>&);                                         \
  template void rotate_about_z(int, T, const T*, T*);                                             \
  template void rotate_zxzxz(int, const Mat3<T>&, const T*, T*);                                  \
  template void rotate_zonal(int, const Vec3<T>&, const T*, T*);                                  \
  template ZonalFactorization<T> zonal_factorization(int);                                        \
  template void product(int, const T*, const T*, T*);                                             \
  template void product_full(int, const T*, const T*, T*);                                        \
  template T triple_product(int, const T*, const T*, const T*);                                   \
  template void product_of_many(int, int, const T* const*, int, T*);                              \
  template void clamped_cosine_product(int, const T*, T*);                                        \
  template void clamped_cosine_product_in_world(int, const Vec3<T>&, const T*, T*);               \
  template void clamped_cosine_product_low_order(int, int, const Vec3<T>&, const T*, T*);         \
  template void project_values(int, const SphereNodes<T>&, const T*, T*);                         \
  template T reconstruct(int, const T*, const Vec3<T>&);                                          \
  template SphereNodes<T> fibonacci_nodes(int);                                                   \
  template SphereNodes<T> gauss_nodes(int);                                                       \
  template LeastSquares<T> least_squares(int, const SphereNodes<T>&, const LeastSquaresOptions&); \
  template void apply_window(int, Window, double, T*);                                            \
  template Dering dering(int, T*);                                                                \
  template Dering dering(int, Window, T*);                                                        \
  template void evaluate_hemispherical(int, const Vec3<T>&, T*);                                  \
  template HemisphericalConversion<T> hemispherical_conversion(int, int);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh::checked
