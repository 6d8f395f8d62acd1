#include "sh/extremum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace zonal::sh {
namespace {

constexpr int kRefined =
    16;  ///< grid minima, by their parabolas' lowest points, that Newton's method starts from
constexpr int kSteps = 30;

std::vector<double> uniform_heights(int rows) {
  std::vector<double> z(rows);
  for (int j = 0; j < rows; ++j) z[j] = std::cos(std::numbers::pi * (j + 0.5) / rows);
  return z;
}

/// How far below its middle the parabola through three equidistant values goes.
double parabola_drop(double before, double middle, double after) {
  const double slope = 0.5 * (after - before), curvature = before - 2 * middle + after;
  return curvature > 0 ? 0.5 * slope * slope / curvature : 0;
}

struct Derivatives {
  double value, g1, g2, h11, h12, h22;  ///< in the tangent frame e1, e2
};

Derivatives derivatives(int bands, const double* c, const Vec3<double>& w, const Vec3<double>& e1,
                        const Vec3<double>& e2) {
  const int size = count(bands);
  std::vector<double> Y(size);
  std::vector<Vec3<double>> gradients(size);
  std::vector<Hessian<double>> hessians(size);
  evaluate_hessian(bands, w, Y.data(), gradients.data(), hessians.data());
  double value = 0;
  Vec3<double> g(0);
  glm::dmat3 H(0);
  for (int i = 0; i < size; ++i) {
    value += c[i] * Y[i];
    g += c[i] * gradients[i];
    const Hessian<double>& h = hessians[i];
    H += c[i] * glm::dmat3(h.xx, h.xy, h.xz, h.xy, h.yy, h.yz, h.xz, h.yz, h.zz);
  }
  return {value,
          glm::dot(g, e1),
          glm::dot(g, e2),
          glm::dot(e1, H * e1),
          glm::dot(e1, H * e2),
          glm::dot(e2, H * e2)};
}

double value_at(int bands, const double* c, const Vec3<double>& w) {
  double Y[count(kMaxBands)];
  evaluate(bands, w, Y);
  double sum = 0;
  for (int i = 0; i < count(bands); ++i) sum += c[i] * Y[i];
  return sum;
}

}  // namespace

MinimumSearch::MinimumSearch(int bands)
    : bands_(bands), grid_(bands, uniform_heights(3 * bands + 1), 6 * bands) {}

// With the function extended by F(v) = f(v/|v|), its Hessian at |v| = 1 between tangents is that of the
// sphere.
Minimum MinimumSearch::refine(const double* c, Vec3<double> w) const {
  double value = value_at(bands_, c, w);
  for (int step = 0; step < kSteps; ++step) {
    const Vec3<double> e1 =
        glm::normalize(glm::cross(w, std::abs(w.x) < 0.6 ? Vec3<double>(1, 0, 0) : Vec3<double>(0, 1, 0)));
    const Vec3<double> e2 = glm::cross(w, e1);
    const Derivatives d = derivatives(bands_, c, w, e1, e2);
    const double size = std::hypot(d.h11, d.h12, d.h22), determinant = d.h11 * d.h22 - d.h12 * d.h12;
    if (!(size > 0)) break;
    double s1 = -d.g1 / size, s2 = -d.g2 / size;  // downhill where the surface is not a bowl
    if (d.h11 > 0 && determinant > 1e-8 * size * size) {
      s1 = (d.h12 * d.g2 - d.h22 * d.g1) / determinant;
      s2 = (d.h12 * d.g1 - d.h11 * d.g2) / determinant;
    }
    // No step beyond a quarter of a wavelength, and none that climbs.
    double scale = std::min(1.0, 1.5 / bands_ / std::max(std::hypot(s1, s2), 1e-300));
    if (std::hypot(s1, s2) < 1e-10) break;
    bool lower = false;
    for (int half = 0; half < 8 && !lower; ++half, scale *= 0.5) {
      const Vec3<double> next = glm::normalize(w + scale * (s1 * e1 + s2 * e2));
      const double there = value_at(bands_, c, next);
      if (there < value) lower = true, w = next, value = there;
    }
    if (!lower) break;
  }
  return {value, w};
}

Minimum MinimumSearch::minimum(const double* c) const {
  return minimum(c, -std::numeric_limits<double>::infinity());
}

Minimum MinimumSearch::minimum(const double* c, double enough) const {
  std::vector<double> values(grid_.size());
  grid_.synthesize(bands_, c, values.data());
  const int rows = grid_.rows(), columns = grid_.columns();
  const auto at = [&](int j, int k) { return values[size_t(j) * columns + (k + columns) % columns]; };
  const size_t lowest = std::min_element(values.begin(), values.end()) - values.begin();
  Minimum best{values[lowest], grid_.direction(int(lowest) / columns, int(lowest) % columns)};
  if (best.value < enough) return best;

  struct Start {
    double predicted;
    int row, column;
  };
  std::vector<Start> starts;
  for (int j = 0; j < rows; ++j)
    for (int k = 0; k < columns; ++k) {
      const double v = at(j, k);
      // Across the pole the neighbour lies half a turn away.
      const double up = j > 0 ? at(j - 1, k) : at(j, k + columns / 2);
      const double down = j + 1 < rows ? at(j + 1, k) : at(j, k + columns / 2);
      if (v > up || v > down || v > at(j, k - 1) || v > at(j, k + 1)) continue;
      starts.push_back({v - parabola_drop(up, v, down) - parabola_drop(at(j, k - 1), v, at(j, k + 1)), j, k});
    }
  const size_t kept = std::min(starts.size(), size_t(kRefined));
  std::partial_sort(starts.begin(), starts.begin() + kept, starts.end(),
                    [](const Start& a, const Start& b) { return a.predicted < b.predicted; });
  for (size_t s = 0; s < kept; ++s) {
    const Minimum found = refine(c, grid_.direction(starts[s].row, starts[s].column));
    if (found.value < best.value) best = found;
    if (best.value < enough) return best;
  }
  return best;
}

Minimum zonal_minimum(int bands, const double* zonal) {
  const auto value = [&](double theta) {
    const double z = std::cos(theta);
    double p = 1, before = 0, sum = 0;
    for (int l = 0; l < bands; ++l) {
      sum += zonal[l] * std::sqrt((2 * l + 1) / (4 * std::numbers::pi)) * p;
      const double next = ((2 * l + 1) * z * p - l * before) / (l + 1);
      before = p, p = next;
    }
    return sum;
  };
  const int samples = 8 * bands;
  const double step = std::numbers::pi / samples;
  std::vector<double> values(samples + 1);
  for (int i = 0; i <= samples; ++i) values[i] = value(i * step);
  double best_theta = 0, best = values[0];
  for (int i = 0; i <= samples; ++i) {
    const double before = values[std::max(i - 1, 0)], after = values[std::min(i + 1, samples)];
    if (values[i] > before || values[i] > after) continue;
    // Golden section between the neighbours.
    double low = std::max(i - 1, 0) * step, high = std::min(i + 1, samples) * step;
    for (int k = 0; k < 45; ++k) {
      const double a = high - (high - low) / std::numbers::phi, b = low + (high - low) / std::numbers::phi;
      (value(a) < value(b) ? high : low) = value(a) < value(b) ? b : a;
    }
    for (const double theta : {0.5 * (low + high), i * step})
      if (const double v = value(theta); v < best) best = v, best_theta = theta;
  }
  return {best, {std::sin(best_theta), 0, std::cos(best_theta)}};
}

}  // namespace zonal::sh
