#include "core/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace zonal {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void require_same_size(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw SceneError(fmt::format("the image is {}x{}, its reference {}x{}: expected the same size", a.width,
                                 a.height, b.width, b.height));
  }
  if (a.pixels.empty()) throw SceneError("the images have no pixels");
}

double luminance_of(vec3 c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}  // Rec. 709

/// Which pixels count: all channels finite in both pictures.
std::vector<bool> usable_pixels(const Image& image, const Image& reference) {
  std::vector<bool> usable(size_t(image.width) * image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      usable[size_t(y) * image.width + x] = is_finite(image.rgb(x, y)) && is_finite(reference.rgb(x, y));
    }
  }
  return usable;
}

/// Calls `visit(x, y, pixel index)` for every usable pixel.
template <class Visit>
void for_each(const Image& image, const std::vector<bool>& usable, Visit visit) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const size_t i = size_t(y) * image.width + x;
      if (usable[i]) visit(x, y, i);
    }
  }
}

double mean_of(const Image& reference, const std::vector<bool>& usable, size_t count) {
  double sum = 0;
  for_each(reference, usable, [&](int x, int y, size_t) {
    const vec3 r = reference.rgb(x, y);
    sum += double(r.x) + r.y + r.z;
  });
  return sum / (3.0 * count);
}

/// Mean over channels of (x-r)^2 / (r^2 + floor^2), with 0/0 = 0.
double relative_squared_error(vec3 x, vec3 r, double floor) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const double difference = double(x[c]) - r[c];
    if (difference != 0) sum += difference * difference / (double(r[c]) * r[c] + floor * floor);
  }
  return sum / 3;
}

/// Share of pixels far above everything the reference shows nearby (docs/metrics.md).
double firefly_share(const Image& image, const Image& reference, const std::vector<bool>& usable,
                     size_t count) {
  constexpr int kReach = 2;  // 5x5
  constexpr double kTimes = 10, kDarkest = 0.1;
  const double darkest = kDarkest * mean_of(reference, usable, count);
  size_t fireflies = 0;
  for_each(image, usable, [&](int x, int y, size_t) {
    double largest = 0, sum = 0;
    int neighbours = 0;
    for (int v = std::max(0, y - kReach); v <= std::min(image.height - 1, y + kReach); ++v) {
      for (int u = std::max(0, x - kReach); u <= std::min(image.width - 1, x + kReach); ++u) {
        if (!usable[size_t(v) * image.width + u]) continue;
        const double r = luminance_of(reference.rgb(u, v));
        largest = std::max(largest, r), sum += r, ++neighbours;
      }
    }
    const double margin = std::max(kTimes * sum / neighbours, darkest);
    if (luminance_of(image.rgb(x, y)) > largest + margin) ++fireflies;
  });
  return double(fireflies) / count;
}

/// Mean without the worst 0.1 % (rounded down) of the values. Reorders them.
double trimmed_mean(std::vector<double>& values) {
  const size_t kept = values.size() - values.size() / 1000;
  std::nth_element(values.begin(), values.begin() + (kept - 1), values.end());
  double sum = 0;
  for (size_t i = 0; i < kept; ++i) sum += values[i];
  return sum / kept;
}

/// mean((x-A)(x-B)) and the reference's RMS standard error, sqrt(mean((A-B)^2)) / 2: A and B are independent
/// and equally noisy, so that the variance of their mean is a quarter of the variance of their difference.
void score_against_halves(const Image& image, const Image& a, const Image& b, std::vector<bool> usable,
                          LinearMetrics* metrics) {
  require_same_size(image, a);
  require_same_size(image, b);
  double product = 0, scatter = 0;
  size_t count = 0;
  for_each(image, usable, [&](int x, int y, size_t) {
    const vec3 value = image.rgb(x, y), first = a.rgb(x, y), second = b.rgb(x, y);
    if (!is_finite(first) || !is_finite(second)) return;
    for (int c = 0; c < 3; ++c) {
      product += (double(value[c]) - first[c]) * (double(value[c]) - second[c]);
      scatter += (double(first[c]) - second[c]) * (double(first[c]) - second[c]);
    }
    ++count;
  });
  if (count == 0) return;
  metrics->mse_unbiased = product / (3.0 * count);
  metrics->reference_floor = 0.5 * std::sqrt(scatter / (3.0 * count));
}

double floor_from_variance(const Image& image, const Image& variance, const std::vector<bool>& usable,
                           size_t count) {
  require_same_size(image, variance);
  return std::sqrt(mean_of(variance, usable, count));
}

}  // namespace

bool LinearMetrics::reference_limited() const {
  return mse_unbiased && reference_floor && *mse_unbiased < 9 * *reference_floor * *reference_floor;
}

LinearMetrics linear_metrics(const Image& image, const Image& reference, const Image* half_a,
                             const Image* half_b, const Image* variance) {
  require_same_size(image, reference);
  const std::vector<bool> usable = usable_pixels(image, reference);
  const size_t count = std::count(usable.begin(), usable.end(), true);
  LinearMetrics metrics;
  metrics.nan = usable.size() - count;
  if (count == 0) {
    metrics.rmse = metrics.mae = metrics.relmse = metrics.relmse_trimmed = kNaN;
    metrics.smape = metrics.bias = metrics.fireflies = kNaN;
    return metrics;
  }

  const double floor = 0.1 * mean_of(reference, usable, count);
  double squares = 0, absolutes = 0, smape = 0, bias = 0, relative_sum = 0;
  std::vector<double> relative;
  relative.reserve(count);
  for_each(image, usable, [&](int x, int y, size_t) {
    const vec3 value = image.rgb(x, y), truth = reference.rgb(x, y);
    for (int c = 0; c < 3; ++c) {
      const double difference = double(value[c]) - truth[c];
      squares += difference * difference;
      absolutes += std::abs(difference);
      bias += difference;
      if (difference != 0)
        smape += 2 * std::abs(difference) / (std::abs(double(value[c])) + std::abs(double(truth[c])));
    }
    relative.push_back(relative_squared_error(value, truth, floor));
    relative_sum += relative.back();
  });
  const double values = 3.0 * count;
  metrics.rmse = std::sqrt(squares / values);
  metrics.mae = absolutes / values;
  metrics.smape = smape / values;
  metrics.bias = bias / values;
  metrics.relmse = relative_sum / count;
  metrics.relmse_trimmed = trimmed_mean(relative);
  metrics.fireflies = firefly_share(image, reference, usable, count);
  if (half_a && half_b) score_against_halves(image, *half_a, *half_b, usable, &metrics);
  if (variance && !metrics.reference_floor)
    metrics.reference_floor = floor_from_variance(image, *variance, usable, count);
  return metrics;
}

Image relative_error(const Image& image, const Image& reference) {
  require_same_size(image, reference);
  const std::vector<bool> usable = usable_pixels(image, reference);
  const size_t count = std::count(usable.begin(), usable.end(), true);
  Image error(image.width, image.height, 1);
  std::fill(error.pixels.begin(), error.pixels.end(), std::numeric_limits<float>::quiet_NaN());
  if (count == 0) return error;
  const double floor = 0.1 * mean_of(reference, usable, count);
  for_each(image, usable, [&](int x, int y, size_t i) {
    error.pixels[i] = float(std::sqrt(relative_squared_error(image.rgb(x, y), reference.rgb(x, y), floor)));
  });
  return error;
}

Image to_display(const Image& linear, float exposure) {
  Image display(linear.width, linear.height, 3);
  for (int y = 0; y < linear.height; ++y) {
    for (int x = 0; x < linear.width; ++x) {
      const vec3 c = linear.rgb(x, y);
      for (int k = 0; k < 3; ++k) {
        display.at(x, y)[k] =
            is_finite(c) ? srgb_encode(c[k] * exposure) : std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
  return display;
}

DisplayMetrics display_metrics(const Image& image, const Image& reference, const FlipReference* flip) {
  require_same_size(image, reference);
  const std::vector<bool> usable = usable_pixels(image, reference);
  const size_t count = std::count(usable.begin(), usable.end(), true);
  double squares = 0, absolutes = 0;
  for_each(image, usable, [&](int x, int y, size_t) {
    for (int c = 0; c < 3; ++c) {
      const double difference = double(image.rgb(x, y)[c]) - reference.rgb(x, y)[c];
      squares += difference * difference;
      absolutes += std::abs(difference);
    }
  });
  DisplayMetrics metrics;
  metrics.rmse = count ? std::sqrt(squares / (3.0 * count)) : kNaN;
  metrics.mae = count ? absolutes / (3.0 * count) : kNaN;
  metrics.psnr = -20 * std::log10(metrics.rmse);  // infinity when nothing differs
  const bool large_enough = image.width >= kSsimWindow && image.height >= kSsimWindow;
  metrics.ssim = large_enough ? ssim(image, reference) : kNaN;
  metrics.flip = mean_of_map(flip ? flip->map(image) : flip_map(image, reference));
  return metrics;
}

const std::vector<MetricInfo>& metric_infos() {
  static const std::vector<MetricInfo> infos = {
      {"rmse", "linear", ">= 0", "W m^-2 sr^-1", "root of the mean squared error"},
      {"mae", "linear", ">= 0", "W m^-2 sr^-1", "mean absolute error"},
      {"relmse", "linear", ">= 0", "", "mean of (x-r)^2 / (r^2 + (0.1 mean r)^2)"},
      {"relmse_trimmed", "linear", ">= 0", "", "relmse without the worst 0.1 % of pixels"},
      {"smape", "linear", "in [0, 2]", "", "mean of 2|x-r| / (|x|+|r|)"},
      {"bias", "linear", "", "W m^-2 sr^-1", "mean of x-r"},
      {"fireflies", "linear", "in [0, 1]", "", "share of pixels far above all the reference shows nearby"},
      {"flip_hdr", "linear", "in [0, 1]", "",
       "HDR-FLIP (Andersson et al. 2021): FLIP's worst over exposures"},
      {"nan", "linear", ">= 0", "pixels", "pixels that are not finite; left out of everything else"},
      {"rmse", "display", "in [0, 1]", "", "root of the mean squared error of sRGB-encoded values"},
      {"mae", "display", "in [0, 1]", "", "mean absolute error of sRGB-encoded values"},
      {"psnr", "display", "", "dB", "-20 log10 of the display rmse; \"inf\" when nothing differs"},
      {"ssim", "display", "in [-1, 1]", "",
       "structural similarity (Wang et al. 2004) of luminance, 11x11 Gaussian"},
      {"flip", "display", "in [0, 1]", "", "FLIP (Andersson et al. 2020) seen from 67 pixels a degree"},
  };
  return infos;
}

}  // namespace zonal
