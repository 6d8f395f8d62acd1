// FLIP and HDR-FLIP against the authors' own program and against what must hold of any such measure.
#include "core/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/flip_hdr.h"
#include "core/metrics.h"
#include "tests/paths.h"
#include "tests/patterns.h"

namespace zonal {
namespace {

using nlohmann::json;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

json golden() {
  return json::parse(std::ifstream(test::source_dir() + "/tests/golden/flip.json"));
}

std::map<std::string, Image> pictures(const json& g) {
  const int w = g["width"], h = g["height"];
  return {{"truth", picture(w, h, pattern)},
          {"noisy", picture(w, h, noisy)},
          {"blurred", picture(w, h, blurred)},
          {"shifted", picture(w, h, shifted)}};
}

/// As flip_oracle.py makes them: the fourth power times 50.
Image radiance(const Image& picture) {
  Image bright = picture;
  for (float& x : bright.pixels) x = x * x * x * x * 50.0f;
  return bright;
}

/// Both sides compute in float, with matrices that agree to the sixth digit: 1e-6 of L*a*b* values up to 100,
/// where a difference of 100 is about the largest. Powers below 1 and sums of some 20 taps make 1e-5 of it at
/// most a few times.
constexpr double kTolerance = 5e-5;

void expect_map(const Image& map, const json& g, const json& wanted, const std::string& name) {
  EXPECT_NEAR(mean_of_map(map), wanted["mean"].get<double>(), kTolerance) << name;
  for (size_t i = 0; i < g["places"].size(); ++i)
    EXPECT_NEAR(*map.at(g["places"][i][0], g["places"][i][1]), wanted["map"][i].get<double>(), kTolerance)
        << name << " at " << g["places"][i];
}

TEST(Flip, agrees_with_its_authors_program) {
  const json g = golden();
  const auto p = pictures(g);
  for (const auto& [name, wanted] : g["ldr"].items())
    expect_map(flip_map(p.at(name), p.at("truth")), g, wanted, name);
  expect_map(flip_map(p.at("noisy"), p.at("truth"), 30), g, g["ldr_30_pixels_a_degree"]["noisy"],
             "30 pixels a degree");
}

TEST(Flip, of_equal_pictures_is_0_and_of_opposites_near_1) {
  const Image green = picture(40, 30, [](int, int, int c) { return c == 1 ? 256 : 0; }),
              blue = picture(40, 30, [](int, int, int c) { return c == 2 ? 256 : 0; });
  EXPECT_EQ(mean_of_map(flip_map(green, green)), 0);
  // The pair of colours that scales the measure: 1 up to rounding, and no features in flat pictures.
  EXPECT_NEAR(mean_of_map(flip_map(green, blue)), 1, 1e-4);
}

TEST(Flip, a_pixel_that_is_no_number_is_left_out_and_spoils_no_neighbour) {
  Image r = picture(40, 30, pattern), x = r;
  x.at(7, 5)[1] = kNaN;
  r.at(20, 20)[0] = kNaN;
  const Image map = flip_map(x, r);
  for (int v = 0; v < 30; ++v)
    for (int u = 0; u < 40; ++u) {
      if ((u == 7 && v == 5) || (u == 20 && v == 20))
        EXPECT_TRUE(std::isnan(*map.at(u, v)));
      else
        EXPECT_EQ(*map.at(u, v), 0) << u << " " << v;
    }
  EXPECT_EQ(mean_of_map(map), 0);
}

TEST(FlipHdr, agrees_with_its_authors_program) {
  const json g = golden();
  const auto p = pictures(g);
  const FlipHdr flip(radiance(p.at("truth")));
  for (const auto& [name, wanted] : g["hdr"].items()) {
    EXPECT_NEAR(flip.exposures().start, wanted["start"].get<double>(), 1e-4);
    EXPECT_NEAR(flip.exposures().stop, wanted["stop"].get<double>(), 1e-4);
    EXPECT_EQ(flip.exposures().count, wanted["count"].get<int>());
    expect_map(flip.map(radiance(p.at(name))), g, wanted, name);
  }
}

TEST(FlipHdr, does_not_depend_on_the_unit_of_radiance) {
  const Image r = radiance(picture(40, 30, pattern)), x = radiance(picture(40, 30, noisy));
  Image r4 = r, x4 = x;
  for (float& v : r4.pixels) v *= 4;  // a power of two: exact
  for (float& v : x4.pixels) v *= 4;
  EXPECT_NEAR(mean_of_map(FlipHdr(r4).map(x4)), mean_of_map(FlipHdr(r).map(x)), 1e-6);
}

TEST(FlipHdr, bears_black_references_and_not_finite_pixels) {
  const Image black(20, 20);
  Image x = picture(20, 20, pattern);
  const FlipHdr flip(black);
  EXPECT_EQ(mean_of_map(flip.map(black)), 0);
  const double seen = mean_of_map(flip.map(x));
  EXPECT_TRUE(seen > 0 && seen <= 1) << seen;
  x.at(3, 3)[2] = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(std::isnan(*flip.map(x).at(3, 3)));
  // Most of the reference black: the median is 0. The authors' program finds these exposures and this mean.
  const FlipHdr most(picture(20, 20, [](int, int v, int) { return v < 8 ? 128 : 0; }));
  EXPECT_EQ(most.exposures().count, 22);
  EXPECT_NEAR(most.exposures().start, 2.0832973, 1e-4);
  // It keeps luminance with a shift of 16/116, whose float spacing, 1e-8, the slope of L* near black (903)
  // and the power 0.7 make 1e-3 of a pixel where the blur fades out: four rows of twenty, well below their
  // mean of 1e-4 here.
  EXPECT_NEAR(mean_of_map(most.map(black)), 0.5290795, 2e-4);
}

}  // namespace
}  // namespace zonal
