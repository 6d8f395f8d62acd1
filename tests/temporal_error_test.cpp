#include "core/temporal_error.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"

namespace zonal {
namespace {

Image flat(float value) {
  Image image(40, 30);
  for (float& x : image.pixels) x = value;
  return image;
}

TEST(TemporalError, an_error_that_stands_still_does_not_flicker) {
  TemporalError temporal;
  // The reference moves, the picture with it, one tenth too bright.
  for (const float r : {1.0f, 2.0f, 1.5f}) temporal.add(flat(r + 0.1f), flat(r), flat(r));
  EXPECT_NEAR(temporal.error(), 0.1 / 1.5, 1e-6);
  EXPECT_NEAR(temporal.flicker(), 0, 1e-6);
}

TEST(TemporalError, an_error_that_changes_sign_flickers_by_twice_its_size) {
  TemporalError temporal;
  for (int frame = 0; frame < 6; ++frame) temporal.add(flat(frame % 2 ? 1.9f : 2.1f), flat(2), flat(2));
  EXPECT_NEAR(temporal.error(), 0.05, 1e-6);
  EXPECT_NEAR(temporal.flicker(), 0.1, 1e-6);
}

TEST(TemporalError, the_references_noise_is_left_out) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 0.5f);
  const auto noisy = [&] {
    Image image = flat(1);
    for (float& x : image.pixels) x += noise(random);
    return image;
  };
  TemporalError temporal;
  for (int frame = 0; frame < 20; ++frame) temporal.add(flat(frame % 2 ? 0.9f : 1.1f), noisy(), noisy());
  // Products of independent noise of 0.25 (0.5 of differences) over 72,000 numbers: squares are off by
  // 0.25/sqrt(72,000) = 1e-3 and 2e-3 of 0.01 and 0.04.
  EXPECT_NEAR(temporal.error() * temporal.error(), 0.01, 4e-3);
  EXPECT_NEAR(temporal.flicker() * temporal.flicker(), 0.04, 8e-3);
}

TEST(TemporalError, sizes_must_agree) {
  TemporalError temporal;
  EXPECT_THROW(temporal.add(flat(1), flat(1), Image(2, 2)), SceneError);
}

}  // namespace
}  // namespace zonal
