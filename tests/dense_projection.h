#pragma once
/// F' of a measured file at one w_out by brute force: pairs of Gauss points in polar angle and azimuth, in
/// double, crowded about the mirror direction. Files' interpolants have kinks everywhere, so rules of higher
/// order would do no better. Shares nothing with the projector but the file's reader and Y.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "materials/measured_brdf.h"
#include "materials/sh_material.h"
#include "sh/basis.h"
#include "sh/quadrature.h"

namespace zonal::test {

inline constexpr double kPiD = 3.14159265358979323846;

/// Points of a line and their weights, in cells that are uniform in u = asinh((x - from) / width).
struct CrowdedLine {
  double width;
  std::vector<double> at, weight;

  double length(double low, double high) const { return std::asinh((high - low) / width); }
  /// From `low` to `high`, in cells of `step` in u; `from` is one of the two.
  void add(double low, double high, double from, double step) {
    const double sign = from == low ? 1 : -1, whole = length(low, high);
    const int cells = int(std::ceil(whole / step));
    for (int i = 0; i < 2 * cells; ++i) {
      const double u =
          whole / cells * (i / 2 + (i % 2 ? 0.5 + 0.5 / std::sqrt(3.0) : 0.5 - 0.5 / std::sqrt(3.0)));
      at.push_back(from + sign * width * std::sinh(u));
      weight.push_back(width * std::cosh(u) * 0.5 * whole / cells);
    }
  }
};

struct DenseProjection {
  std::vector<double> c[3];  ///< [channel][sh::index(l, m)], the mean of both sides of the plane of w_out
  double energy_cosine = 0;  ///< integral of F'^2, channels summed
};

/// `steps` of the polar angle, and of the azimuth on each side.
inline DenseProjection dense_projection(const MeasuredBrdf& brdf, double theta_out, int bands, int steps) {
  // Half of the narrowest published lobe, that of ilm_solo_m_68; in azimuth, lobes narrow like the cosine.
  const double width = 0.004, edge = 89.5 * kPiD / 180;  // beyond which the data's cosine is not divided out
  CrowdedLine theta{width, {}, {}}, phi{width / std::tan(std::max(theta_out, 1e-3)), {}, {}};
  const double step =
      2 * (theta.length(0, theta_out) + theta.length(theta_out, edge) + theta.length(edge, kPiD / 2)) / steps;
  theta.add(0, theta_out, theta_out, step);
  theta.add(theta_out, edge, theta_out, step);
  theta.add(edge, kPiD / 2, edge, step);
  phi.add(0, kPiD, kPiD, 2 * phi.length(0, kPiD) / steps);

  DenseProjection dense;
  for (auto& channel : dense.c) channel.assign(size_t(sh::count(bands)), 0.0);
  const size_t half = phi.at.size(), n = size_t(bands);
  std::vector<double> cosines(half * n), X(size_t(sh::legendre_count(bands)));
  for (size_t j = 0; j < half; ++j)
    for (size_t m = 0; m < n; ++m) cosines[j * n + m] = std::cos(double(m) * phi.at[j]);
  std::vector<vec3> w(2 * half), f(2 * half);
  std::vector<glm::dvec3> sums(n);
  const vec3 w_out(float(std::sin(theta_out)), 0, float(std::cos(theta_out)));
  for (size_t i = 0; i < theta.at.size(); ++i) {
    const double s = std::sin(theta.at[i]), z = std::cos(theta.at[i]);
    for (size_t j = 0; j < half; ++j) {
      const float x = float(s * std::cos(phi.at[j])), y = float(s * std::sin(phi.at[j]));
      w[j] = vec3(x, y, float(z)), w[half + j] = vec3(x, -y, float(z));
    }
    brdf.evaluate(w_out, int(2 * half), w.data(), f.data());
    std::fill(sums.begin(), sums.end(), glm::dvec3(0));
    for (size_t j = 0; j < half; ++j) {
      const glm::dvec3 here(f[j]), there(f[half + j]);
      const double weight = s * theta.weight[i] * phi.weight[j];
      dense.energy_cosine += weight * z * z * (glm::dot(here, here) + glm::dot(there, there));
      for (size_t m = 0; m < n; ++m) sums[m] += weight * z * cosines[j * n + m] * (here + there);
    }
    sh::normalized_legendre(bands, z, s, X.data());
    for (int m = 0; m < bands; ++m)
      for (int l = m; l < bands; ++l)
        for (int c = 0; c < 3; ++c)
          dense.c[c][size_t(sh::index(l, m))] +=
              (m > 0 ? std::sqrt(2.0) : 1) * X[size_t(sh::legendre_index(bands, l, m))] * sums[size_t(m)][c];
  }
  return dense;
}

/// Largest difference of two functions given by coefficients (one channel), as a share of the second one's
/// peak.
inline double difference(int bands, bool mirrored, const float* row, const std::vector<double>& truth) {
  std::vector<double> error = truth;
  for (int l = 0; l < bands; ++l)
    for (int m = mirrored ? 0 : -l; m <= l; ++m)
      error[size_t(sh::index(l, m))] -= row[sh_index(l, m, mirrored)];
  double worst = 0, peak = 0;
  std::vector<double> Y(size_t(sh::count(bands)));
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) {
      const double t = (i + 0.5) * kPiD / 60, p = (j + 0.5) * kPiD / 30;
      sh::evaluate(bands, glm::dvec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)),
                   Y.data());
      worst = std::max(worst, std::abs(std::inner_product(Y.begin(), Y.end(), error.begin(), 0.0)));
      peak = std::max(peak, std::abs(std::inner_product(Y.begin(), Y.end(), truth.begin(), 0.0)));
    }
  return worst / peak;
}

}  // namespace zonal::test
