/// Damaged material files, thousands of them, always the same ones: every answer is a SceneError or a BRDF
/// that stays finite. One test a format.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "core/error.h"
#include "materials/rgl.h"
#include "tests/measured_files.h"

namespace zonal {
namespace {

using namespace test;

/// What a method would ask of it.
::testing::AssertionResult stays_finite(const MeasuredBrdf& brdf) {
  const auto good = [](float x) { return std::isfinite(x) && x >= 0; };
  const vec3 directions[] = {vec3(0, 0, 1), vec3(0.6f, 0, 0.8f), vec3(-0.48f, 0.64f, 0.6f),
                             vec3(0, -0.99999f, 0.0044f)};
  for (const vec3 w_out : directions) {
    for (const vec3 w_in : directions) {
      vec3 f;
      float pdf;
      brdf.evaluate_with_pdf(w_out, w_in, &f, &pdf);
      if (!good(f.x) || !good(f.y) || !good(f.z) || !good(pdf))
        return ::testing::AssertionFailure() << "f " << f.x << " " << f.y << " " << f.z << ", pdf " << pdf;
    }
    for (const float u : {0.0f, 0.4f, 0.9999999f})
      if (!is_finite(brdf.sample_direction(w_out, 0.5f, {u, 1 - u})))
        return ::testing::AssertionFailure() << "sample";
  }
  for (int k = 0; k < 3; ++k)
    if (!good(brdf.albedo[k])) return ::testing::AssertionFailure() << "albedo " << brdf.albedo[k];
  return ::testing::AssertionSuccess();
}

struct Tally {
  int refused = 0, taken = 0;
};

TEST(MaterialFuzz, rgl) {
  const std::string good =
      rgl_tensors({.surface = {0.4, 0.2}, .azimuths = 4, .elevations = 3, .facets = 4, .side = 3}).bytes();
  const TensorFile whole("whole", good);
  size_t header = good.size();
  for (const TensorField& field : whole.fields()) header = std::min(header, size_t(field.offset));
  Tally tally;
  const auto attempt = [&](const std::string& bytes, const std::string& what) {
    try {
      const RglBrdf brdf(TensorFile("damaged.bsdf", bytes));
      ++tally.taken;
      EXPECT_TRUE(stays_finite(brdf)) << what;
    } catch (const SceneError& error) {
      ++tally.refused;
      EXPECT_EQ(std::string(error.what()).find("damaged.bsdf: "), 0u) << what << ": " << error.what();
    }
  };

  for (size_t size = 0; size <= header; ++size)
    attempt(good.substr(0, size), "cut at " + std::to_string(size));
  EXPECT_EQ(tally.taken, 0);
  for (size_t bit = 0; bit < 8 * header; ++bit) {
    std::string bytes = good;
    bytes[bit / 8] = char(bytes[bit / 8] ^ (1 << bit % 8));
    attempt(bytes, "bit " + std::to_string(bit));
  }
  std::mt19937 random(1);
  for (int i = 0; i < 1500; ++i) {
    std::string bytes = good;
    for (int n = 1 + i % 4; n > 0; --n) bytes[random() % bytes.size()] = char(random());
    if (i % 10 == 0) bytes.resize(random() % bytes.size());
    attempt(bytes, "change " + std::to_string(i));
  }
  EXPECT_GT(tally.refused, 1000);
  EXPECT_GT(tally.taken, 500);
}

}  // namespace
}  // namespace zonal
