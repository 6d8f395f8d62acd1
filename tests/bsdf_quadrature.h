#pragma once
/// Integrals over the hemisphere of functions with one narrow lobe, and Pearson's chi-square test of a
/// sampler.
///
///     SphericalGrid(w_out, alpha).integrate([&](vec3 w, double weight) { sum += f(w) * weight; });

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/vec.h"

namespace zonal::test {

/// Cells in polar angle and azimuth that shrink by halves towards the mirror direction of w_out, so that
/// within a cell a lobe there is smooth however narrow it is. 8 x 8 Gauss points a cell.
class SphericalGrid {
 public:
  /// `width`: of the lobe, as a slope of the half vector.
  SphericalGrid(vec3 w_out, double width) {
    const double sine = std::hypot(double(w_out.x), double(w_out.y));
    const double theta = std::atan2(sine, double(w_out.z));
    mirror_ = std::atan2(-double(w_out.y), -double(w_out.x));
    // The reflected lobe is as wide as the half vector's in theta, and narrower by cot(theta) in azimuth.
    polar_ = graded(0, kPiD / 2, theta, width * 0.5 * std::max(double(w_out.z), width));
    azimuth_ = graded(-kPiD, kPiD, 0, std::min(0.5, width * 0.5 * w_out.z / std::max(sine, 1e-3)));
  }
  int cells() const { return int((polar_.size() - 1) * (azimuth_.size() - 1)); }

  /// Calls f(w, solid angle) at all points of one cell, or of all cells.
  template <class F>
  void integrate_cell(int cell, F&& f) const {
    const int columns = int(azimuth_.size()) - 1, i = cell / columns, j = cell % columns;
    const double dt = polar_[i + 1] - polar_[i], dp = azimuth_[j + 1] - azimuth_[j];
    for (int a = 0; a < 8; ++a) {
      const double t = polar_[i] + dt * node(a);
      for (int b = 0; b < 8; ++b) {
        const double p = mirror_ + azimuth_[j] + dp * node(b);
        f(vec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)),
          dt * dp * weight(a) * weight(b) * std::sin(t));
      }
    }
  }
  template <class F>
  void integrate(F&& f) const {
    for (int c = 0; c < cells(); ++c) integrate_cell(c, f);
  }
  int cell_of(vec3 w) const {
    const double t = std::atan2(std::hypot(double(w.x), double(w.y)), double(w.z));
    const double p = std::remainder(std::atan2(double(w.y), double(w.x)) - mirror_, 2 * kPiD);
    return find(polar_, t) * (int(azimuth_.size()) - 1) + find(azimuth_, p);
  }

 private:
  static constexpr double kPiD = 3.14159265358979323846;

  static std::vector<double> graded(double low, double high, double peak, double finest) {
    std::vector<double> x = {low, high};
    if (peak > low && peak < high) x.push_back(peak);
    for (double d = finest; d < high - low; d *= d < 0.3 ? 2 : 1.5) {
      for (double p : {peak - d, peak + d}) {
        // A sliver next to an end would be a cell of its own that expects no sample.
        if (p > low + d / 4 && p < high - d / 4) x.push_back(p);
      }
    }
    std::sort(x.begin(), x.end());
    return x;
  }
  static int find(const std::vector<double>& x, double v) {
    const auto it = std::upper_bound(x.begin(), x.end(), v);
    return std::clamp(int(it - x.begin()) - 1, 0, int(x.size()) - 2);
  }
  /// Gauss-Legendre with 8 points on [0,1] (Abramowitz and Stegun, table 25.4).
  static double node(int i) {
    constexpr double x[4] = {0.9602898564975363, 0.7966664774136267, 0.5255324099163290, 0.1834346424956498};
    return 0.5 + (i < 4 ? -0.5 * x[i] : 0.5 * x[7 - i]);
  }
  static double weight(int i) {
    constexpr double w[4] = {0.1012285362903763, 0.2223810344533745, 0.3137066458778873, 0.3626837833783620};
    return 0.5 * (i < 4 ? w[i] : w[7 - i]);
  }

  double mirror_;
  std::vector<double> polar_, azimuth_;
};

/// Regularised upper incomplete gamma function Q(a, x) (DLMF 8.7.1 series; 8.9.2 continued fraction by
/// Lentz).
inline double gamma_q(double a, double x) {
  if (x <= 0) return 1;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && term > 1e-17 * sum; ++n) sum += term *= x / (a + n);
    return 1 - scale * sum;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 10000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b), c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return scale * h;
}

struct ChiSquare {
  double p = 0;     ///< probability of a deviation at least this large if the sampler follows the density
  double mass = 0;  ///< integral of the density over the hemisphere
  int cells = 0;
};

/// `draw(vec3*)` returns false when it found no direction: those samples are a cell of their own, which
/// expects what the density's integral lacks of 1. Cells that expect fewer than 5 samples are pooled
/// (Cochran's rule).
template <class Draw, class Pdf>
ChiSquare chi_square(const SphericalGrid& grid, int samples, Draw&& draw, Pdf&& pdf) {
  struct Cell {
    double expected = 0, observed = 0;
  };
  std::vector<Cell> cells(grid.cells() + 1);
  ChiSquare result;
  for (int c = 0; c < grid.cells(); ++c) {
    double mass = 0;
    grid.integrate_cell(c, [&](vec3 w, double weight) { mass += pdf(w) * weight; });
    cells[c].expected = mass * samples;
    result.mass += mass;
  }
  cells.back().expected = (1 - result.mass) * samples;
  for (int i = 0; i < samples; ++i) {
    vec3 w;
    ++cells[draw(&w) ? grid.cell_of(w) : grid.cells()].observed;
  }
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.expected < b.expected; });
  double statistic = 0;
  Cell pool;
  for (size_t i = 0; i < cells.size(); ++i) {
    pool.expected += cells[i].expected, pool.observed += cells[i].observed;
    if (pool.expected < 5) continue;
    statistic += (pool.observed - pool.expected) * (pool.observed - pool.expected) / pool.expected;
    ++result.cells;
    pool = {};
  }
  result.p = result.cells > 1 ? gamma_q(0.5 * (result.cells - 1), 0.5 * statistic) : 0;
  return result;
}

}  // namespace zonal::test
