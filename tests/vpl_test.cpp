// `vpl`: what its clamp claims to take, and its kernel. Against the path tracer:
// virtual_light_transport_test.cpp.
#include "integrators/vpl/vpl.h"

#include <gtest/gtest.h>

#include "core/glsl.h"
#include "tests/support.h"
#include "tests/virtual_light_support.h"

namespace zonal {
namespace kernel {
#include "integrators/vpl/vpl.glsl"
}
namespace {

double mean_luminance(const Image& image) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += luminance(image.rgb(x, y));
  return sum / (image.width * image.height);
}

TEST(Vpl, the_clamp_takes_the_energy_it_says) {
  const Scene scene = test::scene_from(test::room(test::kDiffuse, test::kSphere));
  const auto run = [&](const std::string& settings, TileStats* stats) {
    const auto method = find_integrator("vpl", "").make(nlohmann::json::parse(settings), "", nullptr);
    Film film(24, 24);
    *stats = render(scene, *method, film, {.passes = 1}, {.seed = 5}).counters;
    return mean_luminance(film.radiance());
  };
  TileStats free_stats, clamp_stats;
  const double free = run(R"({"direct": "none", "lights": 300})", &free_stats);
  const double clamped = run(R"({"direct": "none", "lights": 300, "clamp": 0.5})", &clamp_stats);
  const double share = clamp_stats.clamped_energy / clamp_stats.total_energy;
  EXPECT_GT(share, 0.01);
  EXPECT_NEAR(clamped / free, 1 - share, 2e-5);  // float sums of 300 terms
  EXPECT_EQ(free_stats.clamped_energy, 0);
}

TEST(Vpl, the_first_generation_carries_the_flux_of_the_lamp) {
  // Nothing escapes a closed box: what its first generation receives is what the lamp emits.
  const Scene scene = test::scene_from(test::room(test::kDiffuse, test::kPoint));
  const VirtualLightSet set = make_virtual_lights(scene, {.lights = 600, .bounces = 1, .seed = 4}, Stop{});
  double flux = 0;
  for (const VirtualLight& light : set.lights) flux += light.power.y;
  EXPECT_NEAR(flux, 2 * 4 * 3.14159265, 0.01 * flux);  // intensity times 4 pi
}

TEST(VplKernel, yuksel_is_the_published_formula_and_stays_finite) {
  for (float r : {0.01f, 1.0f, 30.0f}) {
    for (float d : {0.0f, 1e-3f, 0.5f, 7.0f, 1e4f}) {
      const double s = std::sqrt(double(d) * d + double(r) * r);
      const double truth = 2 / (double(d) * d + double(r) * r + d * s);
      EXPECT_NEAR(kernel::vpl_yuksel(d * d, r), truth, 4e-7 * truth)
          << "d " << d << " r " << r;  // a few roundings
    }
  }
  EXPECT_NEAR(kernel::vpl_yuksel(1e8f, 1e-3f) * 1e8, 1, 1e-6);  // far away: 1/d^2
}

TEST(VplKernel, geometry_is_cosines_over_squared_distance) {
  vec3 w;
  const float g = kernel::vpl_geometry(vec3(3, 4, 0), vec3(1, 0, 0), vec3(0, -1, 0), 1 / 25.0f, w);
  EXPECT_FLOAT_EQ(g, 0.6f * 0.8f / 25);
  EXPECT_EQ(kernel::vpl_geometry(vec3(-3, 4, 0), vec3(1, 0, 0), vec3(0, -1, 0), 1, w),
            0);  // behind the point
  EXPECT_EQ(kernel::vpl_geometry(vec3(0), vec3(1, 0, 0), vec3(0, -1, 0), 1, w), 0);
}

}  // namespace
}  // namespace zonal
