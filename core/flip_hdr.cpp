#include "core/flip_hdr.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace zonal {
namespace {

/// The ACES curve of Narkowicz (2015) with its exposure of 0.6 inside: (n0 x^2 + n1 x + n2) / (d0 x^2 + d1 x
/// + d2), after which values are clamped to [0,1].
constexpr float kNumerator[3] = {0.6f * 0.6f * 2.51f, 0.6f * 0.03f, 0.0f};
constexpr float kDenominator[3] = {0.6f * 0.6f * 2.43f, 0.6f * 0.59f, 0.14f};

float tone_mapped(float x) {
  const float y = ((kNumerator[0] * x + kNumerator[1]) * x + kNumerator[2]) /
                  ((kDenominator[0] * x + kDenominator[1]) * x + kDenominator[2]);
  return std::clamp(y, 0.0f, 1.0f);
}

/// The luminance that the curve maps to 0.85, where highlights still tell apart: a quadratic equation.
double bright_luminance() {
  constexpr double kBright = 0.85;
  const double a = kNumerator[0] - kBright * kDenominator[0], b = kNumerator[1] - kBright * kDenominator[1],
               c = kNumerator[2] - kBright * kDenominator[2];
  return std::max((-b + std::sqrt(b * b - 4 * a * c)) / (2 * a),
                  (-b - std::sqrt(b * b - 4 * a * c)) / (2 * a));
}

Image exposed(const Image& radiance, float factor) {
  Image shown(radiance.width, radiance.height);
  for (size_t i = 0; i < shown.pixels.size(); ++i)
    shown.pixels[i] = tone_mapped(std::max(0.0f, std::min(radiance.pixels[i] * factor, 1e9f)));
  return shown;
}

/// Radiance of `image` where `usable`, else of `other`; always three channels.
Image usable_part(const Image& image, const Image& other, const std::vector<bool>& usable) {
  Image part(image.width, image.height);
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x) {
      const vec3 color = (usable[size_t(y) * part.width + x] ? image : other).rgb(x, y);
      std::copy(&color.x, &color.x + 3, part.at(x, y));
    }
  return part;
}

}  // namespace

float FlipExposures::factor(int i) const {
  return std::exp2(start + (stop - start) * static_cast<float>(i) / static_cast<float>(count - 1));
}

FlipExposures flip_exposures(const Image& reference) {
  std::vector<double> luminances;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      const vec3 c = reference.rgb(x, y);
      if (is_finite(c)) luminances.push_back(0.212636822 * c.x + 0.715182982 * c.y + 0.0721801965 * c.z);
    }
  if (luminances.empty()) return {};
  std::sort(luminances.begin(), luminances.end());
  // As the authors' program does: a black median counts as the smallest step of a float at 1.
  constexpr double kDarkest = std::numeric_limits<float>::epsilon();
  const double brightest = std::max(luminances.back(), kDarkest);
  const size_t half = luminances.size() / 2;
  const double middle =
      luminances.size() % 2 ? luminances[half] : 0.5 * (luminances[half - 1] + luminances[half]);
  const double median = std::max(middle, kDarkest);
  FlipExposures exposures;
  exposures.start = static_cast<float>(std::log2(bright_luminance() / brightest));
  exposures.stop = static_cast<float>(std::log2(bright_luminance() / median));
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
  return exposures;
}

FlipHdr::FlipHdr(const Image& reference) : exposures_(flip_exposures(reference)) {
  usable_.resize(size_t(reference.width) * reference.height);
  for (size_t i = 0; i < usable_.size(); ++i)
    usable_[i] = is_finite(
        reference.rgb(static_cast<int>(i % reference.width), static_cast<int>(i / reference.width)));
  reference_ = usable_part(reference, Image(reference.width, reference.height), usable_);
  constexpr size_t kMost = size_t(256) << 20;
  if (usable_.size() * exposures_.count * 5 * sizeof(float) > kMost) return;
  views_.resize(exposures_.count);
  oneapi::tbb::parallel_for(0, exposures_.count,
                            [&](int i) { views_[i] = flip_view(exposed(reference_, exposures_.factor(i))); });
}

Image FlipHdr::map(const Image& image) const {
  std::vector<bool> usable = usable_;
  for (size_t i = 0; i < usable.size(); ++i)
    usable[i] = usable[i] &&
                is_finite(image.rgb(static_cast<int>(i % image.width), static_cast<int>(i / image.width)));
  const Image clean = usable_part(image, reference_, usable);
  std::vector<Image> maps(exposures_.count);
  oneapi::tbb::parallel_for(0, exposures_.count, [&](int i) {
    const float factor = exposures_.factor(i);
    const FlipView seen = flip_view(exposed(clean, factor));
    maps[i] = flip_difference(seen, views_.empty() ? flip_view(exposed(reference_, factor)) : views_[i]);
  });
  Image worst = std::move(maps[0]);
  for (size_t i = 0; i < worst.pixels.size(); ++i) {
    for (int k = 1; k < exposures_.count; ++k) worst.pixels[i] = std::max(worst.pixels[i], maps[k].pixels[i]);
    if (!usable[i]) worst.pixels[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return worst;
}

}  // namespace zonal
