#pragma once
/// How far a picture is from its reference. Formulas: docs/metrics.md.

#include <limits>
#include <optional>

#include "core/image.h"

namespace zonal {

/// On linear radiance, over all pixels and channels. x: image, r: reference.
struct LinearMetrics {
  double rmse = 0, mae = 0;
  double relmse = 0;          ///< mean of (x-r)^2 / (r^2 + (0.1 mean r)^2)
  double relmse_trimmed = 0;  ///< the same without the worst 0.1 % of pixels
  double smape = 0;           ///< mean of 2|x-r| / (|x|+|r|), 0/0 = 0
  double bias = 0;            ///< mean of x-r
  double fireflies = 0;       ///< share of pixels whose luminance exceeds the largest of the reference's 5x5 neighbourhood by more than 10 times its mean there (docs/metrics.md)
  size_t nan = 0;             ///< pixels with a non-finite channel; left out of the rest
  /// With a reference of two independent halves: mean((x-A)(x-B)), the squared error without the reference's noise.
  std::optional<double> mse_unbiased;
  std::optional<double> reference_floor;  ///< RMS standard error of the reference
};

/// On values times exposure, clamped to [0,1], sRGB-encoded.
struct DisplayMetrics {
  double rmse = 0, mae = 0, psnr = std::numeric_limits<double>::infinity(), ssim = 1;
};

LinearMetrics linear_metrics(const Image& image, const Image& reference, const Image* half_a = nullptr,
                             const Image* half_b = nullptr, const Image* variance = nullptr);
/// Display-encoded inputs (see `to_display`).
DisplayMetrics display_metrics(const Image& image, const Image& reference);
Image to_display(const Image& linear, float exposure);
/// Mean SSIM of Wang et al. 2004 on luminance: 11x11 Gaussian window, sigma 1.5, K1 0.01, K2 0.03, population
/// covariance, valid region only. Inputs are display-encoded, at least 11x11.
double ssim(const Image& image, const Image& reference);

}  // namespace zonal
