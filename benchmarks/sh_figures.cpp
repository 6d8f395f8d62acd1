// The data behind figures 3.4, 3.9, 4.2 and 4.4 of Mézières 2022, recomputed.
//
//     build/bench_sh_figures
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "sh/gauss_panel.h"
#include "sh/sphere_light.h"

namespace zonal::sh {
namespace {

using dvec3 = Vec3<double>;
constexpr double kPi = 3.14159265358979323846;

/// Figure 3.4. Closed forms: sin^2 a times a polynomial in cos^2 a by Horner, times cos a for even bands,
/// times a constant. Printed recurrence: P_{l+1} (3 products, 1 difference), the difference of two, a
/// constant. Ours: the difference form.
void figure_3_4() {
  std::printf(
      "Figure 3.4: operations for the zonal coefficients of a sphere, cosine given\n%6s %8s %10s %6s\n",
      "bands", "closed", "Eq. 3.10", "ours");
  for (int bands = 1; bands <= 15; ++bands) {
    int closed = 2, printed = 2, ours = 1;  // band 0; sin^2 and cos^2 once
    if (bands > 1) closed += 3, ours += 1;
    for (int l = 1; l < bands; ++l) {
      closed += 2 * ((l - 1) / 2) + 2 + (l % 2 == 0);
      printed += 6;
      ours += l == 1 ? 1 : 5 + 1;
    }
    std::printf("%6d %8d %10d %6d\n", bands, closed, printed, ours);
  }
}

/// Y_6^3 and its gradient as derivatives of Cartesian polynomials: k (11 z^3 - 3 z)(x^3 - 3 x y^2) on the
/// unit sphere.
dvec3 analytic_gradient(const dvec3& d, double& Y) {
  const double k = -std::sqrt(2730 / kPi) / 32;  // the sign is Condon and Shortley's
  const double f = 11 * d.z * d.z * d.z - 3 * d.z, g = d.x * d.x * d.x - 3 * d.x * d.y * d.y;
  Y = k * f * g;
  const dvec3 whole =
      dvec3(f * 3 * (d.x * d.x - d.y * d.y), f * -6 * d.x * d.y, (33 * d.z * d.z - 3) * g) * k;
  return whole - d * glm::dot(whole, d);
}

/// Figure 3.9: (l, m) = (6, 3), rows phi, columns theta; a sphere of radius 0.5 at distance 2.
void figure_3_9() {
  std::printf(
      "\nFigure 3.9: gradients for (l, m) = (6, 3) against differentiated polynomials; every 8th of 64 x 64 "
      "printed\n");
  std::printf("%7s %7s %10s %10s %10s %11s | %10s %10s %10s %11s\n", "theta", "phi", "dY/dx", "dY/dy",
              "dY/dz", "difference", "dL/dx", "dL/dy", "dL/dz", "difference");
  constexpr int kGrid = 64;
  const double alpha = std::sqrt(1 - 0.0625), a2 = alpha * alpha;
  // Eq. 3.10 and its derivative by hand: 2 pi sin^2 a P_6'/42 and 2 pi P_6 dt/dd.
  const double gain = 2 * kPi * 0.0625 * (1386 * a2 * a2 - 1260 * a2 + 210) * alpha / 16 / 42;
  const double change =
      2 * kPi * (231 * a2 * a2 * a2 - 315 * a2 * a2 + 105 * a2 - 5) / 16 * (-0.0625 / (2 * alpha));
  double worst_basis = 0, worst_light = 0;
  std::vector<double> Y(49), L(49);
  std::vector<dvec3> dY(49), dL(49);
  for (int j = 0; j < kGrid; ++j) {
    for (int i = 0; i <= kGrid; ++i) {
      const double theta = kPi * i / kGrid, phi = 2 * kPi * j / kGrid;
      const dvec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      double y;
      const dvec3 truth = analytic_gradient(d, y);
      evaluate_gradient(7, d, Y.data(), dY.data());
      const dvec3 light = -(truth * (gain / 2) + d * (change * y));  // with respect to the shaded point
      sphere_light_gradient(7, dvec3(0), d * 2.0, 0.5, L.data(), dL.data());
      const double e = glm::length(dY[index(6, 3)] - truth), el = glm::length(dL[index(6, 3)] - light);
      worst_basis = std::max(worst_basis, e), worst_light = std::max(worst_light, el);
      if (i % 16 || j % 16) continue;
      const dvec3 &b = dY[index(6, 3)], &s = dL[index(6, 3)];
      std::printf("%7.3f %7.3f %10.6f %10.6f %10.6f %11.1e | %10.6f %10.6f %10.6f %11.1e\n", theta, phi, b.x,
                  b.y, b.z, e, s.x, s.y, s.z, el);
    }
  }
  std::printf("largest difference over the grid: basis %.1e, spherical light %.1e\n", worst_basis,
              worst_light);
}

/// Does the product of three real azimuthal functions have a mean?
bool azimuth_survives(int a, int b, int c) {
  if (((a < 0) + (b < 0) + (c < 0)) % 2) return false;
  const int i = std::abs(a), j = std::abs(b), k = std::abs(c);
  return i + j == k || j + k == i || k + i == j;
}

/// Figure 4.2: two operations an entry that is not zero.
void figure_4_2() {
  std::printf(
      "\nFigure 4.2: operations of SH products (a product and a sum for every entry of the tensor or matrix "
      "that selection "
      "rules leave)\n%6s %12s %16s %18s %18s\n",
      "bands", "general", "zonal cosine", "cosine 3 bands 4.5", "clamped cosine 4.6");
  for (int n = 1; n <= 9; ++n) {
    long general = 0, zonal = 0, low = 0, clamped = 0;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        for (int m = -std::min(a, b); m <= std::min(a, b); ++m) {
          // Eq. 4.6 folds the whole cosine; 4.5 folds its bands 0 to 2.
          if ((a + b) % 2 == 0 || std::abs(a - b) == 1) ++clamped;
          bool reached = false;
          for (int c = std::abs(a - b); c <= a + b; c += 2) {
            if (c < std::min(n, 3)) reached = true;
            if (c < n && (c % 2 == 0 || c == 1))
              ++zonal;  // odd bands of the clamped cosine above 1 are empty
          }
          low += reached;
        }
        for (int c = std::abs(a - b); c <= std::min(a + b, n - 1); c += 2) {
          for (int ma = -a; ma <= a; ++ma) {
            for (int mb = -b; mb <= b; ++mb) {
              for (int mc = -c; mc <= c; ++mc) general += azimuth_survives(ma, mb, mc);
            }
          }
        }
      }
    }
    std::printf("%6d %12ld %16ld %18ld %18ld\n", n, 3 * general, 2 * zonal, 2 * low, 2 * clamped);
  }
}

/// Figure 4.4: the clamped cosine from its first bands.
void figure_4_4() {
  constexpr int kBands = 9;
  double coefficient[kBands];  // of P_l
  const double *x = GaussPanels::get().nodes(16), *w = GaussPanels::get().weights(16);
  for (int l = 0; l < kBands; ++l) {
    coefficient[l] = 0;
    for (int i = 0; i < 16; ++i) {
      const double c = 0.5 + 0.5 * x[i];
      coefficient[l] += (2 * l + 1) / 2.0 * 0.5 * w[i] * c * std::legendre(l, c);
    }
  }
  std::printf("\nFigure 4.4: clamped cosine projected on a number of bands\n%8s %9s %9s %9s %9s %9s %9s\n",
              "theta", "exact", "2", "3", "5", "7", "9");
  double lowest[kBands + 1] = {};
  for (int i = 0; i <= 180; ++i) {
    const double theta = kPi * i / 180, c = std::cos(theta);
    double sum = 0, partial[kBands + 1];
    for (int l = 0; l < kBands; ++l) {
      sum += coefficient[l] * std::legendre(unsigned(l), std::abs(c)) * (c < 0 && l % 2 ? -1 : 1);
      partial[l + 1] = sum;
      lowest[l + 1] = std::min(lowest[l + 1], sum);
    }
    if (i % 10 == 0) {
      std::printf("%8.3f %9.5f %9.5f %9.5f %9.5f %9.5f %9.5f\n", theta, std::max(0.0, c), partial[2],
                  partial[3], partial[5], partial[7], partial[9]);
    }
  }
  std::printf("%8s %9.5f %9.5f %9.5f %9.5f %9.5f %9.5f\n", "minimum", 0.0, lowest[2], lowest[3], lowest[5],
              lowest[7], lowest[9]);
}

}  // namespace
}  // namespace zonal::sh

int main() {
  zonal::sh::figure_3_4();
  zonal::sh::figure_3_9();
  zonal::sh::figure_4_2();
  zonal::sh::figure_4_4();
}
