#pragma once
/// How far a picture is from its reference. Formulas: docs/metrics.md.
///
///     LinearMetrics linear = linear_metrics(image, reference);
///     DisplayMetrics display = display_metrics(to_display(image, exposure), to_display(reference,
///     exposure));
///
/// Pictures of different sizes are a SceneError naming both. One-channel pictures count as grey.

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/flip.h"

namespace zonal {

/// On linear radiance, over all pixels and channels. x: image, r: reference.
struct LinearMetrics {
  double rmse = 0, mae = 0;   ///< W m^-2 sr^-1
  double relmse = 0;          ///< mean of (x-r)^2 / (r^2 + (0.1 mean r)^2)
  double relmse_trimmed = 0;  ///< the same without the worst 0.1 % of pixels
  double smape = 0;           ///< mean of 2|x-r| / (|x|+|r|), 0/0 = 0
  double bias = 0;            ///< mean of x-r
  /// Share of pixels whose luminance exceeds the reference's largest of the 5x5 neighbourhood by more than 10
  /// times its mean there (a tenth of the picture's mean where that is darker still).
  double fireflies = 0;
  size_t nan = 0;  ///< pixels with a non-finite channel in image or reference; left out of the rest
  /// With a reference of two independent halves: mean((x-A)(x-B)), the squared error without the reference's
  /// noise.
  std::optional<double> mse_unbiased;
  std::optional<double> reference_floor;  ///< RMS standard error of the reference
  /// True when the error is not told from the reference's own noise: mse_unbiased < (3 reference_floor)^2.
  bool reference_limited() const;
};

/// On values times exposure, clamped to [0,1], sRGB-encoded. Pixels with a NaN are left out; so are SSIM's
/// windows.
struct DisplayMetrics {
  double rmse = 0, mae = 0, psnr = std::numeric_limits<double>::infinity();
  double ssim = 1;  ///< NaN for pictures below 11x11
  double flip = 0;  ///< see core/flip.h; what a viewer sees when flipping between the two
};

/// The halves and the variance of the mean belong to a cached reference and may be absent.
LinearMetrics linear_metrics(const Image& image, const Image& reference, const Image* half_a = nullptr,
                             const Image* half_b = nullptr, const Image* variance = nullptr);
/// Display-encoded inputs (see `to_display`). `flip`: the reference made ready for FLIP, where it is at hand.
DisplayMetrics display_metrics(const Image& image, const Image& reference,
                               const FlipReference* flip = nullptr);
/// Three channels; a pixel with a non-finite channel becomes NaN.
Image to_display(const Image& linear, float exposure);
/// Mean SSIM of Wang et al. 2004 on luminance: 11x11 Gaussian window, sigma 1.5, K1 0.01, K2 0.03, population
/// covariance, valid region only. Inputs are display-encoded, at least 11x11.
double ssim(const Image& image, const Image& reference);
inline constexpr int kSsimWindow = 11;

/// Per pixel, one channel: sqrt of the mean over channels of (x-r)^2 / (r^2 + (0.1 mean r)^2); NaN where x or
/// r is.
Image relative_error(const Image& image, const Image& reference);

/// What `zonal list metrics` prints.
struct MetricInfo {
  std::string name, values, range, unit, summary;  ///< values: "linear" or "display"
};
const std::vector<MetricInfo>& metric_infos();

}  // namespace zonal
