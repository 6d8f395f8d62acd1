// Structural similarity: Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment: From Error Visibility
// to Structural Similarity", IEEE TIP 13(4), 2004, equation 13 averaged over all windows inside the picture.

#include <array>
#include <cassert>
#include <cmath>

#include "core/metrics.h"

namespace zonal {
namespace {

constexpr int kReach = kSsimWindow / 2;
constexpr double kSigma = 1.5;       // pixels
constexpr double kC1 = 0.01 * 0.01;  // (K1 L)^2, K1 = 0.01, values span L = 1
constexpr double kC2 = 0.03 * 0.03;  // (K2 L)^2, K2 = 0.03

/// Window sums of one place: means of x, y, x^2, y^2 and xy.
struct Moments {
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  void add(double w, const Moments& m) {
    x += w * m.x, y += w * m.y, xx += w * m.xx, yy += w * m.yy, xy += w * m.xy;
  }
};

std::array<double, kSsimWindow> gaussian_weights() {
  std::array<double, kSsimWindow> weights;
  double sum = 0;
  for (int i = 0; i < kSsimWindow; ++i) {
    const double d = (i - kReach) / kSigma;
    sum += weights[i] = std::exp(-0.5 * d * d);
  }
  for (double& w : weights) w /= sum;
  return weights;
}

double luminance_of(vec3 c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}  // Rec. 709

/// One row of pictures, filtered along the row; entry i is the window starting at column i.
std::vector<Moments> filtered_row(const Image& image, const Image& reference, int row,
                                  const std::array<double, kSsimWindow>& weights) {
  std::vector<Moments> raw(image.width);
  for (int x = 0; x < image.width; ++x) {
    const double a = luminance_of(image.rgb(x, row)), b = luminance_of(reference.rgb(x, row));
    raw[x] = {a, b, a * a, b * b, a * b};
  }
  std::vector<Moments> filtered(image.width - kSsimWindow + 1);
  for (size_t i = 0; i < filtered.size(); ++i) {
    for (int k = 0; k < kSsimWindow; ++k) filtered[i].add(weights[k], raw[i + k]);
  }
  return filtered;
}

double similarity(const Moments& m) {
  const double variance_x = m.xx - m.x * m.x, variance_y = m.yy - m.y * m.y, covariance = m.xy - m.x * m.y;
  return (2 * m.x * m.y + kC1) * (2 * covariance + kC2) /
         ((m.x * m.x + m.y * m.y + kC1) * (variance_x + variance_y + kC2));
}

}  // namespace

double ssim(const Image& image, const Image& reference) {
  assert(image.width == reference.width && image.height == reference.height);
  assert(image.width >= kSsimWindow && image.height >= kSsimWindow);
  const auto weights = gaussian_weights();

  // The Gaussian is separable: filter each row once, keep the last eleven, combine them down the column.
  std::array<std::vector<Moments>, kSsimWindow> rows;
  double sum = 0;
  size_t windows = 0;
  for (int y = 0; y < image.height; ++y) {
    rows[y % kSsimWindow] = filtered_row(image, reference, y, weights);
    if (y < kSsimWindow - 1) continue;
    const int top = y - kSsimWindow + 1;
    for (size_t i = 0; i < rows[0].size(); ++i) {
      Moments m;
      for (int k = 0; k < kSsimWindow; ++k) m.add(weights[k], rows[(top + k) % kSsimWindow][i]);
      const double s = similarity(m);
      // A NaN pixel makes every window that holds it NaN: those are left out.
      if (std::isnan(s)) continue;
      sum += s;
      ++windows;
    }
  }
  return windows ? sum / windows : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace zonal
