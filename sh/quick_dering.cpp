#include "sh/quick_dering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/projection.h"
#include "sh/window.h"

namespace zonal::sh {

namespace {
constexpr double kAWavelength = 8;
constexpr float kBetween = 1.08f;
}  // namespace

QuickDering::QuickDering(int bands) : bands_(bands), positive_(bands) {
  positive_weights(bands, positive_.data());
  // Squares of side h = 2 pi/(8 l) cover the sphere 4 pi/h^2 times.
  const double last = std::max(1, bands - 1);
  directions_ = int(std::ceil((kAWavelength * last) * (kAWavelength * last) / std::numbers::pi));
  basis_.resize(size_t(count(bands)) * directions_);
  std::vector<float> Y(count(bands));
  for (int k = 0; k < directions_; ++k) {
    evaluate(bands, spherical_fibonacci<float>(k, directions_), Y.data());
    for (size_t i = 0; i < Y.size(); ++i) basis_[i * directions_ + k] = Y[i];
  }
}

void QuickDering::apply(float* coefficients, float* strength) const {
  const int n = count(bands_);
  thread_local std::vector<float> values;
  values.resize(2 * size_t(directions_));
  float *f = values.data(), *g = f + directions_;
  for (int c = 0; c < 3; ++c, coefficients += n) {
    std::fill(values.begin(), values.end(), 0.0f);
    for (int l = 0; l < bands_; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
        const float a = coefficients[i], b = a * positive_[l];
        const float* Y = basis_.data() + size_t(i) * directions_;
        for (int k = 0; k < directions_; ++k) f[k] += a * Y[k], g[k] += b * Y[k];
      }
    float s = 0;
    for (int k = 0; k < directions_; ++k)
      s = std::max(s, f[k] < 0 && g[k] > f[k] ? -f[k] / (g[k] - f[k]) : 0.0f);
    s = std::min(1.0f, kBetween * s);
    for (int l = 1; l < bands_; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) coefficients[i] *= 1 - s * (1 - positive_[l]);
    if (strength) strength[c] = s;
  }
}

}  // namespace zonal::sh
