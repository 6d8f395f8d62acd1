#pragma once
/// From functions to coefficients by quadrature, and what coefficients say about a function: values and
/// energy (Mézières 2022, Sec. 2.2.3).
///
///     const auto nodes = sh::gauss_nodes<float>(2 * (bands - 1));
///     sh::project_function(bands, nodes, [](const sh::Vec3<float>& w) { return w.z * w.z; }, coefficients);
///
/// Weights are solid angles: they sum to 4 pi (Eq. 2.41; 4 pi / M for uniform samples). Directions are
/// structures of arrays. batch.h has the loops underneath, `project` and `reconstruct`. 1 <= bands <=
/// kMaxBands.

#include <vector>

#include "sh/batch.h"

namespace zonal::sh {

template <class T>
struct SphereNodes {
  std::vector<T> x, y, z;  ///< unit
  std::vector<T> weights;  ///< steradians

  int size() const { return int(x.size()); }
  Vec3<T> direction(int k) const { return {x[k], y[k], z[k]}; }
};

/// Point k of a spherical Fibonacci set of `size` (Keinert et al. 2015): k steps of the golden angle on equal
/// areas.
template <class T>
Vec3<T> spherical_fibonacci(int k, int size);
template <class T>
SphereNodes<T> fibonacci_nodes(int size);

/// Gauss-Legendre heights and uniform azimuths: integrals are exact up to polynomials of `degree` in (x, y,
/// z). Projecting a function of b bands on n takes degree b + n - 2; that is (degree/2 + 1) (degree + 1)
/// nodes.
template <class T>
SphereNodes<T> gauss_nodes(int degree);

/// coefficients[i] = sum of weight value Y_i. The sum runs in double.
template <class T>
void project_values(int bands, const SphereNodes<T>& nodes, const T* values, T* coefficients);
/// Several functions at the same nodes: values[f * nodes.size() + k], coefficients[i * functions + f].
template <class T>
void project_values(int bands, const SphereNodes<T>& nodes, int functions, const T* values, T* coefficients);

template <class T, class Function>
void project_function(int bands, const SphereNodes<T>& nodes, const Function& f, T* coefficients) {
  std::vector<T> values(nodes.size());
  for (int k = 0; k < nodes.size(); ++k) values[k] = T(f(nodes.direction(k)));
  project_values(bands, nodes, values.data(), coefficients);
}

/// The value at the unit direction w (Eq. 2.37, with l up to bands - 1).
template <class T>
T reconstruct(int bands, const T* coefficients, const Vec3<T>& w);

/// energy[l]: sum of squares of band l; their sum is the integral of the squared function (Parseval,
/// Eq. 2.38).
template <class T>
void band_energy(int bands, const T* coefficients, T* energy);
/// energy[l * functions + f]
template <class T>
void band_energy(int bands, int functions, const T* coefficients, T* energy);

}  // namespace zonal::sh
