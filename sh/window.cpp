#include "sh/window.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sh/extremum.h"

namespace zonal::sh {
namespace {

/// The largest size whose windowed function `minimum_of(size)` is not below `threshold`: from mild to strong
/// until one will do, then by bisection between it and the last that would not. The one returned has been
/// tried.
template <class MinimumOf>
Dering largest_size(int bands, double threshold, const MinimumOf& minimum_of) {
  Dering found;
  found.minimum = minimum_of(found.size);
  if (found.minimum >= threshold) return found;
  constexpr double kAlone = 0.999;  // smaller than 1: only the mean is left
  double bad = 64.0 * bands, good = bad;
  for (;; bad = good) {
    good = std::max(good / 1.2, kAlone);
    found.minimum = minimum_of(good);
    if (found.minimum >= threshold || good == kAlone) break;
  }
  found.non_negative = found.minimum >= threshold;
  while (found.non_negative && bad > good * (1 + 1e-5)) {
    const double middle = std::sqrt(bad * good), minimum = minimum_of(middle);
    if (minimum >= threshold)
      good = middle, found.minimum = minimum;
    else
      bad = middle;
  }
  found.size = good;
  return found;
}

}  // namespace

double window_weight(Window window, int l, double size) {
  if (window == Window::none || l == 0 || std::isinf(size)) return 1;
  if (l > size) return 0;
  const double x = std::numbers::pi * l / size;
  switch (window) {
    case Window::hann:
      return 0.5 + 0.5 * std::cos(x);
    case Window::lanczos:
      return std::sin(x) / x;
    default:
      return 0.54 + 0.46 * std::cos(x);
  }
}

template <class T>
void apply_window(int bands, Window window, double size, T* coefficients) {
  apply_window(bands, window, size, 1, coefficients);
}

template <class T>
void apply_window(int bands, Window window, double size, int functions, T* coefficients) {
  for (int l = 0; l < bands; ++l) {
    const T weight = T(window_weight(window, l, size));
    const size_t end = size_t(l + 1) * (l + 1) * functions;
    for (size_t i = size_t(l) * l * functions; i < end; ++i) coefficients[i] *= weight;
  }
}

template <class T>
void apply_window_zonal(int bands, Window window, double size, T* zonal) {
  for (int l = 0; l < bands; ++l) zonal[l] *= T(window_weight(window, l, size));
}

template <class T>
Dering dering(int bands, Window window, T* coefficients) {
  Dering found;
  dering(bands, window, 1, coefficients, &found);
  return found;
}

template <class T>
void dering(int bands, Window window, int functions, T* coefficients, Dering* found) {
  const MinimumSearch search(bands);
  const int size = count(bands);
  std::vector<double> original(size), windowed(size);
  for (int f = 0; f < functions; ++f) {
    for (int i = 0; i < size; ++i) original[i] = coefficients[size_t(i) * functions + f];
    const double threshold = -1e-9 * 0.5 * std::numbers::inv_sqrtpi * std::abs(original[0]);
    found[f] = largest_size(bands, threshold, [&](double window_size) {
      windowed = original;
      apply_window(bands, window, window_size, windowed.data());
      return search.minimum(windowed.data(), threshold).value;
    });
    for (int l = 0; l < bands; ++l) {
      const double weight = window_weight(window, l, found[f].size);
      for (int i = l * l; i < (l + 1) * (l + 1); ++i)
        coefficients[size_t(i) * functions + f] = T(weight * original[i]);
    }
  }
}

template <class T>
Dering dering_zonal(int bands, Window window, T* zonal) {
  const std::vector<double> original(zonal, zonal + bands);
  std::vector<double> windowed(bands);
  const double threshold = -1e-9 * 0.5 * std::numbers::inv_sqrtpi * std::abs(original[0]);
  const Dering found = largest_size(bands, threshold, [&](double size) {
    windowed = original;
    apply_window_zonal(bands, window, size, windowed.data());
    return zonal_minimum(bands, windowed.data()).value;
  });
  for (int l = 0; l < bands; ++l) zonal[l] = T(window_weight(window, l, found.size) * original[l]);
  return found;
}

#define ZONAL_INSTANTIATE(T)                                 \
  template void apply_window(int, Window, double, T*);       \
  template void apply_window(int, Window, double, int, T*);  \
  template void apply_window_zonal(int, Window, double, T*); \
  template Dering dering(int, Window, T*);                   \
  template void dering(int, Window, int, T*, Dering*);       \
  template Dering dering_zonal(int, Window, T*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
