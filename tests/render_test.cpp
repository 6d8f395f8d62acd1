#include "core/render.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support.h"

namespace zonal {
namespace {

const char* kBallOnPlane = R"({
  "camera": {"position": [0, 1, 4], "look_at": [0, 0.5, 0], "vertical_fov": 40, "resolution": [37, 21]},
  "materials": [{"name": "grey", "type": "lambert", "albedo": 0.5}],
  "objects": [{"name": "ball", "type": "sphere", "center": [0, 0.5, 0], "radius": 0.5, "material": "grey"},
              {"name": "floor", "type": "quad", "corner": [-5, 0, 5], "edges": [[10, 0, 0], [0, 0, -10]], "material": "grey"}],
  "lights": [{"type": "quad", "corner": [-1, 3, -1], "edges": [[2, 0, 0], [0, 0, 2]], "radiance": 5},
             {"type": "environment", "radiance": 0.2}]
})";

/// Adds the pass number + 1 everywhere; can wait, so that passes take a known time.
struct CountingIntegrator : Integrator {
  double seconds_a_pass = 0;
  int passes_begun = 0;
  std::atomic<bool>* ask_stop_in_pass_two = nullptr;
  mutable std::atomic<int> shaded = 0;

  void begin_pass(const Pass& pass, const Stop&, PassStats&) override {
    passes_begun = pass.index + 1;
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds_a_pass));
  }
  void shade(const Tile& tile, vec3* radiance, Sampler*, const Stop&, TileStats&) const override {
    if (ask_stop_in_pass_two && passes_begun == 2) *ask_stop_in_pass_two = true;
    shaded += tile.count;
    for (int i = 0; i < tile.count; ++i) radiance[i] = vec3(static_cast<float>(passes_begun));
  }
};

TEST(Render, passes_are_averaged_and_every_pixel_is_shaded_once_a_pass) {
  const Scene scene = test::scene_from(kBallOnPlane);
  CountingIntegrator method;
  Film film(37, 21);  // no multiple of the tile size
  const RenderReport report = render(scene, method, film, {.passes = 3}, {.threads = 2});
  EXPECT_EQ(report.passes, 3);
  EXPECT_EQ(method.shaded, 3 * 37 * 21);
  EXPECT_EQ(report.counters.camera_rays, 3u * 37 * 21);
  const Image image = film.radiance();
  for (float value : image.pixels) EXPECT_FLOAT_EQ(value, 2.0f);  // (1 + 2 + 3) / 3
}

TEST(Render, a_timed_render_always_finishes_its_first_pass) {
  const Scene scene = test::scene_from(kBallOnPlane);
  CountingIntegrator method;
  method.seconds_a_pass = 0.05;
  Film film(16, 16);
  const RenderReport report = render(scene, method, film, {.seconds = 0.001}, {.threads = 2});
  EXPECT_EQ(report.passes, 1);
  EXPECT_FALSE(report.partial);
}

TEST(Render, a_later_pass_that_is_cut_leaves_no_trace) {
  const Scene scene = test::scene_from(kBallOnPlane);
  CountingIntegrator method;
  std::atomic<bool> stop = false;
  method.ask_stop_in_pass_two = &stop;
  Film film(16, 16);
  const RenderReport report = render(scene, method, film, {.passes = 5}, {.threads = 2, .stop = &stop});
  EXPECT_TRUE(report.interrupted);
  EXPECT_EQ(report.passes, 1);
  const Image image = film.radiance();
  for (float value : image.pixels) EXPECT_FLOAT_EQ(value, 1.0f);
}

TEST(Render, on_pass_runs_outside_the_clock) {
  const Scene scene = test::scene_from(kBallOnPlane);
  CountingIntegrator method;
  Film film(8, 8);
  int calls = 0;
  const auto wait = [&](const Film&, double) { ++calls, std::this_thread::sleep_for(std::chrono::milliseconds(200)); };
  const RenderReport report = render(scene, method, film, {.passes = 2}, {.threads = 1}, wait);
  EXPECT_EQ(calls, 2);
  EXPECT_LT(report.begin_pass_seconds + report.radiance_seconds, 0.4);  // the waits alone are 0.4 s
}

class EveryMethod : public testing::TestWithParam<IntegratorRow> {};

TEST_P(EveryMethod, same_seed_gives_the_same_bits_on_any_number_of_threads) {
  const Scene scene = test::scene_from(kBallOnPlane);
  const test::RenderSpec spec{.passes = 2, .width = 37, .height = 21, .threads = 1, .seed = 7};
  auto two = spec;
  two.threads = 2;
  const Image a = test::render_with(scene, GetParam().name, spec);
  EXPECT_EQ(a.pixels, test::render_with(scene, GetParam().name, two).pixels);
  EXPECT_EQ(a.pixels, test::render_with(scene, GetParam().name, spec).pixels);
}

TEST_P(EveryMethod, another_seed_gives_another_picture_of_the_same_thing) {
  if (GetParam().debug) GTEST_SKIP() << "debugging pictures have no noise but that of the jitter";
  const Scene scene = test::scene_from(kBallOnPlane);
  const Image a = test::render_with(scene, GetParam().name, {.passes = 2, .seed = 1});
  const Image b = test::render_with(scene, GetParam().name, {.passes = 2, .seed = 2});
  EXPECT_NE(a.pixels, b.pixels);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryMethod,
                         testing::ValuesIn(integrator_table().begin(), integrator_table().end()),
                         [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace zonal
