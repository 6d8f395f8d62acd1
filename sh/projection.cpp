#include "sh/projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/quadrature.h"

namespace zonal::sh {

template <class T>
Vec3<T> spherical_fibonacci(int k, int size) {
  const double z = 1 - (2.0 * k + 1) / size, s = std::sqrt((1 - z) * (1 + z));
  const double phi = 2 * std::numbers::pi * std::fmod(k * (std::numbers::phi - 1), 1.0);
  return Vec3<T>(s * std::cos(phi), s * std::sin(phi), z);
}

template <class T>
SphereNodes<T> fibonacci_nodes(int size) {
  SphereNodes<T> nodes;
  for (int k = 0; k < size; ++k) {
    const Vec3<T> w = spherical_fibonacci<T>(k, size);
    nodes.x.push_back(w.x), nodes.y.push_back(w.y), nodes.z.push_back(w.z);
  }
  nodes.weights.assign(size, T(4 * std::numbers::pi / size));
  return nodes;
}

template <class T>
SphereNodes<T> gauss_nodes(int degree) {
  SphereNodes<T> nodes;
  const GaussLegendre rule = gauss_legendre(degree / 2 + 1);
  const int columns = degree + 1;
  for (size_t j = 0; j < rule.nodes.size(); ++j) {
    const double z = rule.nodes[j], s = std::sqrt((1 - z) * (1 + z));
    for (int k = 0; k < columns; ++k) {
      const double phi = 2 * std::numbers::pi * k / columns;
      nodes.x.push_back(T(s * std::cos(phi))), nodes.y.push_back(T(s * std::sin(phi))),
          nodes.z.push_back(T(z));
      nodes.weights.push_back(T(rule.weights[j] * 2 * std::numbers::pi / columns));
    }
  }
  return nodes;
}

template <class T>
void project_values(int bands, const SphereNodes<T>& nodes, const T* values, T* coefficients) {
  project_values(bands, nodes, 1, values, coefficients);
}

template <class T>
void project_values(int bands, const SphereNodes<T>& nodes, int functions, const T* values, T* coefficients) {
  const int size = count(bands);
  std::vector<double> sums(size_t(size) * functions);
  evaluate_blocks<T>(bands, nodes.x.data(), nodes.y.data(), nodes.z.data(), nodes.size(),
                     [&](int first, int lanes, const T* Y) {
                       for (int f = 0; f < functions; ++f) {
                         T weighted[kLanes<T>] = {};
                         for (int k = 0; k < lanes; ++k)
                           weighted[k] =
                               nodes.weights[first + k] * values[size_t(f) * nodes.size() + first + k];
                         for (int i = 0; i < size; ++i) {
                           T sum = 0;
                           for (int k = 0; k < kLanes<T>; ++k) sum += weighted[k] * Y[i * kLanes<T> + k];
                           sums[size_t(i) * functions + f] += sum;
                         }
                       }
                     });
  for (size_t i = 0; i < sums.size(); ++i) coefficients[i] = T(sums[i]);
}

template <class T>
T reconstruct(int bands, const T* coefficients, const Vec3<T>& w) {
  T Y[count(kMaxBands)];
  evaluate(bands, w, Y);
  T sum = 0;
  for (int i = 0; i < count(bands); ++i) sum += coefficients[i] * Y[i];
  return sum;
}

template <class T>
void band_energy(int bands, const T* coefficients, T* energy) {
  band_energy(bands, 1, coefficients, energy);
}

template <class T>
void band_energy(int bands, int functions, const T* coefficients, T* energy) {
  std::fill(energy, energy + size_t(bands) * functions, T(0));
  for (int l = 0; l < bands; ++l)
    for (size_t i = l * l; i < size_t(l + 1) * (l + 1); ++i)
      for (int f = 0; f < functions; ++f)
        energy[size_t(l) * functions + f] +=
            coefficients[i * functions + f] * coefficients[i * functions + f];
}

#define ZONAL_INSTANTIATE(T)                                                   \
  template Vec3<T> spherical_fibonacci(int, int);                              \
  template SphereNodes<T> fibonacci_nodes(int);                                \
  template SphereNodes<T> gauss_nodes(int);                                    \
  template void project_values(int, const SphereNodes<T>&, const T*, T*);      \
  template void project_values(int, const SphereNodes<T>&, int, const T*, T*); \
  template T reconstruct(int, const T*, const Vec3<T>&);                       \
  template void band_energy(int, const T*, T*);                                \
  template void band_energy(int, int, const T*, T*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
