#include "core/error_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace zonal {
namespace {

/// Ten stops of matplotlib's "inferno" (van der Walt and Smith 2015): lightness rises evenly, also for
/// colour-blind eyes.
constexpr std::array<uint32_t, 10> kInferno = {0x000004, 0x1b0c42, 0x4b0c6b, 0x781c6d, 0xa52c60,
                                               0xcf4446, 0xed6925, 0xfb9a06, 0xf7d03c, 0xfcffa4};

vec3 stop_color(uint32_t rgb) {
  return vec3(rgb >> 16, rgb >> 8 & 255, rgb & 255) / 255.0f;
}

vec3 color_of(float share) {
  const float place = std::clamp(share, 0.0f, 1.0f) * (kInferno.size() - 1);
  const auto below = std::min(static_cast<size_t>(place), kInferno.size() - 2);
  return glm::mix(stop_color(kInferno[below]), stop_color(kInferno[below + 1]), place - below);
}

/// The smallest of 1, 2, 5 x 10^n that is at least `x` > 0.
double round_up(double x) {
  const double decade = std::pow(10.0, std::floor(std::log10(x)));
  // A hair of slack, so that 0.2 is not rounded up to 0.5 by its own rounding.
  for (const double step : {1.0, 2.0, 5.0}) {
    if (x <= step * decade * (1 + 1e-6)) return step * decade;
  }
  return 10 * decade;
}

double scale_of(const Image& error) {
  std::vector<float> finite;
  for (const float e : error.pixels) {
    if (std::isfinite(e)) finite.push_back(e);
  }
  if (finite.empty()) return 1;
  const auto worst = finite.begin() + (finite.size() - 1) * 99 / 100;
  std::nth_element(finite.begin(), worst, finite.end());
  return *worst > 0 ? round_up(*worst) : 1;
}

}  // namespace

ImageFile error_map(const Image& error) {
  const double high = scale_of(error);
  const int bar = std::max(4, error.width / 40), gap = std::max(1, bar / 4);
  ImageFile file;
  file.display_referred = true;
  file.metadata["error_map_low"] = "0";
  file.metadata["error_map_high"] = fmt::format("{:g}", high);
  Image& map = file.layers[""] = Image(error.width + gap + bar, error.height);
  std::fill(map.pixels.begin(), map.pixels.end(), 1.0f);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const bool in_picture = x < error.width, in_bar = x >= error.width + gap;
      if (!in_picture && !in_bar) continue;
      const float value = in_picture ? *error.at(x, y) / high : 1 - (y + 0.5f) / map.height;
      const vec3 color = std::isnan(value) ? vec3(0, 1, 0) : color_of(value);
      std::copy(&color.x, &color.x + 3, map.at(x, y));
    }
  }
  return file;
}

}  // namespace zonal
