#include "core/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace zonal {
namespace {

constexpr int kRadiance = 3;  // channels
constexpr int kLayers = 7;    // albedo 3, normal 3, depth 1
constexpr int kPending = kRadiance + kLayers;

}  // namespace

Film::Film(int width, int height)
    : width_(width),
      height_(height),
      sum_(size_t(width) * height * kRadiance),
      sum_squares_(sum_.size()),
      layers_(size_t(width) * height * kLayers),
      pending_(size_t(width) * height * kPending) {
  assert(width > 0 && height > 0);
}

void Film::begin_pass() {
  std::fill(pending_.begin(), pending_.end(), 0.0f);
}

void Film::discard_pass() {
  begin_pass();
}

void Film::add(int x, int y, vec3 radiance, vec3 albedo, vec3 normal, float depth) {
  assert(x >= 0 && x < width_ && y >= 0 && y < height_);
  // Kept as it is, bad or not: counting waits for `commit_pass`, where no thread races and discarded passes
  // are gone.
  float* p = &pending_[(size_t(y) * width_ + x) * kPending];
  const float values[kPending] = {radiance.x, radiance.y, radiance.z, albedo.x, albedo.y,
                                  albedo.z,   normal.x,   normal.y,   normal.z, depth};
  std::copy(values, values + kPending, p);
}

void Film::commit_pass() {
  const size_t pixels = size_t(width_) * height_;
  for (size_t i = 0; i < pixels; ++i) {
    const float* p = &pending_[i * kPending];
    // The comparison is false for NaN, so NaN counts as bad too.
    bool good = std::all_of(p, p + kRadiance, [](float c) { return c >= 0 && std::isfinite(c); });
    if (good) {
      for (int c = 0; c < kRadiance; ++c) {
        const double value = p[c];
        sum_[i * kRadiance + c] += value;
        sum_squares_[i * kRadiance + c] += value * value;  // exact: 24 bits times 24 bits fit a double
      }
    }
    for (int c = 0; c < kLayers; ++c) {
      const float value = p[kRadiance + c];
      if (std::isfinite(value)) {
        layers_[i * kLayers + c] += value;
      } else {
        good = false;
      }
    }
    if (!good) ++bad_samples_;
  }
  ++passes_;
  begin_pass();
}

Image Film::radiance() const {
  Image image(width_, height_, kRadiance);
  if (passes_ == 0) return image;
  for (size_t i = 0; i < sum_.size(); ++i) image.pixels[i] = static_cast<float>(sum_[i] / passes_);
  return image;
}

Image Film::variance_of_mean() const {
  Image image(width_, height_, kRadiance);
  if (passes_ < 2) return image;
  const double n = passes_;
  for (size_t i = 0; i < sum_.size(); ++i) {
    // Sample variance (sum x^2 - (sum x)^2 / n) / (n - 1), over n for the mean; rounding may leave a tiny
    // negative.
    const double scatter = sum_squares_[i] - sum_[i] * sum_[i] / n;
    image.pixels[i] = static_cast<float>(std::max(0.0, scatter) / (n * (n - 1)));
  }
  return image;
}

ImageFile Film::resolve() const {
  ImageFile file;
  file.layers[""] = radiance();
  Image albedo(width_, height_, 3), normal(width_, height_, 3), depth(width_, height_, 1);
  const size_t pixels = size_t(width_) * height_;
  const double share = passes_ > 0 ? 1.0 / passes_ : 0.0;
  for (size_t i = 0; i < pixels; ++i) {
    const double* sum = &layers_[i * kLayers];
    for (int c = 0; c < 3; ++c) {
      albedo.pixels[3 * i + c] = static_cast<float>(sum[c] * share);
      normal.pixels[3 * i + c] = static_cast<float>(sum[3 + c] * share);
    }
    depth.pixels[i] = static_cast<float>(sum[6] * share);
  }
  file.layers["albedo"] = std::move(albedo);
  file.layers["normal"] = std::move(normal);
  file.layers["depth"] = std::move(depth);
  return file;
}

}  // namespace zonal
