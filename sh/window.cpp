#include "sh/window.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "sh/extremum.h"
#include "sh/quadrature.h"

namespace zonal::sh {
namespace {

/// The largest size whose windowed function `minimum_of(size)` is not below `threshold`: from mild to strong
/// until one will do, then by bisection between it and the last that would not. The one returned has been
/// tried.
struct LargestSize {
  static double parameter(const Dering& found) { return found.size; }

  template <class MinimumOf>
  Dering operator()(int bands, double threshold, const MinimumOf& minimum_of) const {
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
};

/// The least strength of the automatic window: 0, else by bisection in [0, 1], else in [1, 2].
struct LeastStrength {
  static double parameter(const Dering& found) { return found.strength; }

  template <class MinimumOf>
  Dering operator()(int, double threshold, const MinimumOf& minimum_of) const {
    Dering found;
    const auto enough = [&](double strength) {
      found.strength = strength, found.minimum = minimum_of(strength);
      return found.minimum >= threshold;
    };
    if (enough(0)) return found;
    double bad = 0, good = 1;
    if (!enough(1)) bad = 1, good = 2;
    for (int step = 0; step < 30; ++step) {
      const double middle = 0.5 * (bad + good);
      (enough(middle) ? good : bad) = middle;
    }
    found.non_negative = enough(good);
    return found;
  }
};

/// What is searched: a number `parameter` of the window and the weight of each band under it.
using WeightOf = std::function<double(int l, double parameter)>;

WeightOf window_weights(Window window) {
  return [window](int l, double size) { return window_weight(window, l, size); };
}

WeightOf automatic_weights(int bands) {
  std::vector<double> positive(bands);
  positive_weights(bands, positive.data());
  return [positive](int l, double strength) {
    if (l == 0) return 1.0;
    return strength <= 1 ? 1 - strength * (1 - positive[l]) : (2 - strength) * positive[l];
  };
}

double threshold_of(double mean_coefficient) {
  return -1e-9 * 0.5 * std::numbers::inv_sqrtpi * std::abs(mean_coefficient);
}

template <class T, class Search>
void dering_functions(int bands, int functions, T* coefficients, Dering* found, const WeightOf& weight,
                      const Search& search) {
  const MinimumSearch minimum_search(bands);
  const int size = count(bands);
  std::vector<double> original(size), windowed(size);
  for (int f = 0; f < functions; ++f) {
    for (int i = 0; i < size; ++i) original[i] = coefficients[size_t(i) * functions + f];
    const double threshold = threshold_of(original[0]);
    const auto apply = [&](double parameter) {
      for (int l = 0; l < bands; ++l) {
        const double w = weight(l, parameter);
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) windowed[i] = w * original[i];
      }
    };
    found[f] = search(bands, threshold, [&](double parameter) {
      apply(parameter);
      return minimum_search.minimum(windowed.data(), threshold).value;
    });
    apply(Search::parameter(found[f]));
    for (int i = 0; i < size; ++i) coefficients[size_t(i) * functions + f] = T(windowed[i]);
  }
}

template <class T, class Search>
Dering dering_one_zonal(int bands, T* zonal, const WeightOf& weight, const Search& search) {
  const std::vector<double> original(zonal, zonal + bands);
  std::vector<double> windowed(bands);
  const auto apply = [&](double parameter) {
    for (int l = 0; l < bands; ++l) windowed[l] = weight(l, parameter) * original[l];
  };
  const Dering found = search(bands, threshold_of(original[0]), [&](double parameter) {
    apply(parameter);
    return zonal_minimum(bands, windowed.data()).value;
  });
  for (int l = 0; l < bands; ++l) zonal[l] = T(weight(l, Search::parameter(found)) * original[l]);
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
void positive_weights(int bands, T* weights) {
  const GaussLegendre rule = gauss_legendre(bands);  // degree of the kernel times P_l: at most 2N - 2
  std::vector<double> sums(bands), P(bands + 1);
  for (size_t k = 0; k < rule.nodes.size(); ++k) {
    const double z = rule.nodes[k];
    P[0] = 1, P[1] = z;
    for (int l = 2; l <= bands; ++l) P[l] = ((2 * l - 1) * z * P[l - 1] - (l - 1) * P[l - 2]) / l;
    double root = 0;
    if (bands % 2 == 1)
      for (int l = 0; l <= bands / 2; ++l) root += (2 * l + 1) * P[l];
    else
      for (int l = bands / 2 - 1; l >= 0; l -= 2)
        root += (2 * l + 1) * P[l];  // P'_{l+1} - P'_{l-1} = (2l+1) P_l
    const double kernel = rule.weights[k] * root * root * (bands % 2 == 1 ? 1 : 1 + z);
    for (int l = 0; l < bands; ++l) sums[l] += kernel * P[l];
  }
  for (int l = 0; l < bands; ++l) weights[l] = T(sums[l] / sums[0]);
}

template <class T>
Dering dering(int bands, T* coefficients) {
  Dering found;
  dering(bands, 1, coefficients, &found);
  return found;
}

template <class T>
void dering(int bands, int functions, T* coefficients, Dering* found) {
  dering_functions(bands, functions, coefficients, found, automatic_weights(bands), LeastStrength());
}

template <class T>
Dering dering_zonal(int bands, T* zonal) {
  return dering_one_zonal(bands, zonal, automatic_weights(bands), LeastStrength());
}

template <class T>
Dering dering(int bands, Window window, T* coefficients) {
  Dering found;
  dering(bands, window, 1, coefficients, &found);
  return found;
}

template <class T>
void dering(int bands, Window window, int functions, T* coefficients, Dering* found) {
  dering_functions(bands, functions, coefficients, found, window_weights(window), LargestSize());
}

template <class T>
Dering dering_zonal(int bands, Window window, T* zonal) {
  return dering_one_zonal(bands, zonal, window_weights(window), LargestSize());
}

#define ZONAL_INSTANTIATE(T)                                 \
  template void apply_window(int, Window, double, T*);       \
  template void apply_window(int, Window, double, int, T*);  \
  template void apply_window_zonal(int, Window, double, T*); \
  template void positive_weights(int, T*);                   \
  template Dering dering(int, T*);                           \
  template void dering(int, int, T*, Dering*);               \
  template Dering dering_zonal(int, T*);                     \
  template Dering dering(int, Window, T*);                   \
  template void dering(int, Window, int, T*, Dering*);       \
  template Dering dering_zonal(int, Window, T*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
