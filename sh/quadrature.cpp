#include "sh/quadrature.h"

#include <cmath>
#include <numbers>

namespace zonal::sh {

GaussLegendre gauss_legendre(int n, double low, double high) {
  GaussLegendre rule{std::vector<double>(n), std::vector<double>(n)};
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  for (int i = 0; i < (n + 1) / 2; ++i) {
    // Newton's iteration on P_n from Tricomi's estimate of the i-th root, counted from z = 1.
    double z = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double p = 1, before = 0;
      for (int l = 1; l <= n; ++l) {
        const double next = ((2 * l - 1) * z * p - (l - 1) * before) / l;
        before = p, p = next;
      }
      slope = n * (before - z * p) / ((1 - z) * (1 + z));
      const double step = p / slope;
      z -= step;
      if (std::abs(step) < 1e-15) break;
    }
    if (n % 2 == 1 && i == n / 2) z = 0;
    const double weight = 2 / ((1 - z) * (1 + z) * slope * slope);
    rule.nodes[i] = middle - half * z, rule.nodes[n - 1 - i] = middle + half * z;
    rule.weights[i] = rule.weights[n - 1 - i] = half * weight;
  }
  return rule;
}

void normalized_legendre(int bands, double z, double s, double* X) {
  double diagonal = 0.5 * std::numbers::inv_sqrtpi;  // X_0^0
  for (int m = 0; m < bands; ++m) {
    // X_m^m = -sqrt((2m+1)/(2m)) s X_{m-1}^{m-1}: the normalisation stays inside, so nothing overflows.
    if (m > 0) diagonal *= -std::sqrt((2 * m + 1) / (2.0 * m)) * s;
    double* row = X + legendre_index(bands, m, m);
    row[0] = diagonal;
    if (m + 1 < bands) row[1] = std::sqrt(2.0 * m + 3) * z * diagonal;
    double b = std::sqrt(1 / (2.0 * m + 3));
    for (int l = m + 2; l < bands; ++l) {
      const double a = std::sqrt((4.0 * l * l - 1) / (double(l) * l - double(m) * m));
      row[l - m] = a * (z * row[l - m - 1] - b * row[l - m - 2]);
      b = 1 / a;
    }
  }
}

}  // namespace zonal::sh
