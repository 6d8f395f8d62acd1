#pragma once
/// Gauss-Legendre nodes for n = 1..kMaxPanel on [-1, 1], made once; and how many a given oscillation needs.

#include <array>
#include <cmath>

namespace zonal::sh {

inline constexpr int kMaxPanel = 32;

class GaussPanels {
 public:
  static const GaussPanels& get() {
    static const GaussPanels panels;
    return panels;
  }
  const double* nodes(int n) const { return &nodes_[n * (n - 1) / 2]; }
  const double* weights(int n) const { return &weights_[n * (n - 1) / 2]; }

  /// Nodes that integrate exp(i kappa t) over [-1, 1] to rounding: the error is below (e kappa/4n)^2n. Valid
  /// up to kappa = kMaxPanelPhase; split longer intervals.
  static int nodes_for(double kappa) {
    for (int n = 2; n < kMaxPanel; ++n) {
      if (2 * n * std::log(0.6796 * kappa / n + 1e-300) < -38) return n;
    }
    return kMaxPanel;
  }
  static constexpr double kMaxPanelPhase = 25;

 private:
  GaussPanels() {
    for (int n = 1; n <= kMaxPanel; ++n) {
      for (int i = 0; i < n; ++i) {
        // Newton's method on P_n from Tricomi's estimate.
        double x = -std::cos(3.14159265358979323846 * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int step = 0; step < 8; ++step) {
          double before = 1, p = x;
          for (int k = 2; k <= n; ++k) {
            const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
            before = p, p = next;
          }
          slope = n * (before - x * p) / (1 - x * x);
          x -= p / slope;
        }
        nodes_[n * (n - 1) / 2 + i] = n == 1 ? 0 : x;
        weights_[n * (n - 1) / 2 + i] = n == 1 ? 2 : 2 / ((1 - x * x) * slope * slope);
      }
    }
  }

  std::array<double, kMaxPanel*(kMaxPanel + 1) / 2> nodes_, weights_;
};

}  // namespace zonal::sh
