#pragma once
/// Two independent references at pixel centres, so that the error of a picture is told from their noise.

#include "tests/support.h"

namespace zonal::test {

struct CenterReference {
  Image a, b;

  /// `path` with these settings, `passes` each half.
  CenterReference(const Scene& scene, const std::string& settings, int width, int height, int passes) {
    for (const uint64_t seed : {1, 2}) {
      const auto method =
          find_integrator("path", "test").make(nlohmann::json::parse(settings), "test", nullptr);
      Film film(width, height);
      render(scene, *method, film, {.passes = passes},
             {.seed = seed, .threads = 2, .pixels = RenderOptions::Pixels::center});
      (seed == 1 ? a : b) = film.radiance();
    }
  }

  /// RMSE over the mean: the root of the mean of (x - A)(x - B), which the halves' noise does not bias; 0
  /// where that comes out negative.
  double error(const Image& x) const {
    double squares = 0, mean = 0;
    for (size_t i = 0; i < x.pixels.size(); ++i) {
      squares += (double(x.pixels[i]) - a.pixels[i]) * (double(x.pixels[i]) - b.pixels[i]);
      mean += 0.5 * (double(a.pixels[i]) + b.pixels[i]);
    }
    const double n = double(x.pixels.size());
    return std::sqrt(std::max(0.0, squares / n)) / (mean / n);
  }
};

}  // namespace zonal::test
