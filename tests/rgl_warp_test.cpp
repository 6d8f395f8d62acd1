/// Warps of the unit square by bilinear densities, which RGL files are read through: inverse of each other,
/// normalised, and the same whether slices are mixed before or while they are used.

#include "materials/rgl_warp.h"

#include <gtest/gtest.h>

#include "tests/bsdf_cases.h"

namespace zonal {
namespace {

using namespace test;

/// Two slices with empty rows, and one of noise.
WarpGrid three_slices(int width, int height) {
  Random random(5);
  std::vector<float> samples;
  for (int slice = 0; slice < 3; ++slice)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        samples.push_back(slice < 2 && (y + slice) % 5 < 2 ? 0.0f : 7 * sqr(random.unit()) + 0.01f);
  return WarpGrid(width, height, samples);
}

const std::vector<SliceMix>& mixes() {
  static const std::vector<SliceMix> all = {
      {1, {2}, {1.0f}}, {1, {0}, {1.0f}}, {2, {0, 1}, {0.3f, 0.7f}}, {2, {1, 2}, {0.9f, 0.1f}}};
  return all;
}

TEST(RglWarp, sampling_undoes_inversion) {
  const WarpGrid grid = three_slices(17, 23);
  Random random(6);
  for (const SliceMix& mix : mixes()) {
    for (int i = 0; i < 5000; ++i) {
      const vec2 u = random.square();
      const vec2 p = grid.sample(mix, u);
      // A float of the unit square is exact to 6e-8; divided by a density, which here is above 0.1 where
      // anything is drawn.
      float density;
      const vec2 back = grid.invert(mix, p, &density);
      ASSERT_GT(density, 0) << p.x << " " << p.y;
      ASSERT_NEAR(back.x, u.x, 2e-5f) << u.x << " " << u.y;
      ASSERT_NEAR(back.y, u.y, 2e-6f) << u.x << " " << u.y;
      if (density < 0.1f) continue;
      const vec2 again = grid.sample(mix, back);
      ASSERT_NEAR(again.x, p.x, 2e-4f) << p.x << " " << p.y;
      ASSERT_NEAR(again.y, p.y, 2e-4f) << p.x << " " << p.y;
    }
  }
}

TEST(RglWarp, every_mixture_integrates_to_one) {
  // 2 x 2 Gauss points a cell are exact for a bilinear function; what is left is rounding of 350 floats.
  const WarpGrid grid = three_slices(17, 23);
  for (const SliceMix& mix : mixes()) {
    double sum = 0;
    for (int y = 0; y < 22; ++y)
      for (int x = 0; x < 16; ++x)
        for (const double s : {0.5 - 0.28867513459, 0.5 + 0.28867513459})
          for (const double t : {0.5 - 0.28867513459, 0.5 + 0.28867513459})
            sum += grid.density(mix, vec2((x + s) / 16, (y + t) / 22));
    EXPECT_NEAR(sum / (4 * 16 * 22), 1, 1e-5);
  }
}

TEST(RglWarp, blending_first_changes_nothing) {
  const WarpGrid grid = three_slices(17, 23);
  const WarpGrid one = grid.blended(mixes()[2]);
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const vec2 p = random.square();
    float a, b;
    const vec2 x = grid.invert(mixes()[2], p, &a), y = one.invert(SliceMix{}, p, &b);
    ASSERT_NEAR(a, b, 1e-5f * a);
    ASSERT_NEAR(x.x, y.x, 1e-5f);
    ASSERT_NEAR(x.y, y.y, 1e-5f);
  }
}

TEST(RglWarp, an_empty_slice_is_uniform) {
  const WarpGrid grid(4, 3, std::vector<float>(12, 0.0f));
  EXPECT_TRUE(grid.is_empty(0));
  EXPECT_NEAR(grid.density({}, {0.3f, 0.9f}), 1, 1e-6f);
  EXPECT_NEAR(grid.sample({}, {0.3f, 0.9f}).x, 0.3f, 1e-6f);
}

}  // namespace
}  // namespace zonal
