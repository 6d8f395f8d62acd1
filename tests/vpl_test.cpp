// `vpl` against the path tracer for the same transport, and what its clamp claims to take.
#include "integrators/vpl/vpl.h"

#include <gtest/gtest.h>

#include "core/glsl.h"
#include "tests/support.h"

namespace zonal {
namespace kernel {
#include "integrators/vpl/vpl.glsl"
}
namespace {

/// A box with a blocker, seen so that no pixel lies within half a metre of a corner, where 1/d^2 has no finite variance.
std::string room(const std::string& material, const std::string& lights) {
  return R"({
    "camera": {"position": [0, 1, 1.9], "look_at": [0, 0.9, -2], "vertical_fov": 24, "resolution": [4, 4]},
    "materials": [{"name": "wall", )" + material + R"(}, {"name": "grey", "type": "lambert", "albedo": 0.5}],
    "objects": [{"name": "room", "type": "box", "low": [-1, 0, -2], "high": [1, 2, 2], "material": "wall"},
                {"name": "blocker", "type": "box", "low": [-0.6, 0, -1], "high": [-0.2, 0.5, -0.6], "material": "grey"}],
    "lights": [)" + lights + "]}";
}
const char* kDiffuse = R"("type": "lambert", "albedo": 0.6)";
const char* kGlossy = R"("type": "coated", "albedo": 0.4, "roughness": 0.7)";
const char* kSphere = R"({"type": "sphere", "center": [0.3, 1.5, 0], "radius": 0.1, "radiance": 50})";
const char* kSpot = R"({"type": "spot", "position": [0.3, 1.2, 1], "look_at": [0.9, 0.4, 0], "intensity": 9, "inner": 25, "outer": 40})";
const char* kPoint = R"({"type": "point", "position": [0.3, 1.5, 0], "intensity": 2})";

std::vector<test::Estimate> estimates(const Scene& scene, const std::string& method, const std::string& settings,
                                      int seeds, int passes) {
  std::vector<std::vector<double>> values(16);
  for (int seed = 0; seed < seeds; ++seed) {
    const Image image = test::render_with(
        scene, method,
        {.settings = settings, .passes = passes, .width = 4, .height = 4, .seed = 1000u + seed, .jitter = true});
    for (int i = 0; i < 16; ++i) values[i].push_back(image.pixels[3 * i + 1]);
  }
  std::vector<test::Estimate> result;
  for (const auto& v : values) result.push_back(test::estimate(v));
  return result;
}

struct Transport {
  std::string name, scene, vpl, path;
};
void PrintTo(const Transport& t, std::ostream* out) { *out << t.name; }

class VplTendsToPath : public testing::TestWithParam<Transport> {};

TEST_P(VplTendsToPath, without_a_clamp) {
  const Scene scene = test::scene_from(GetParam().scene);
  const auto vpl = estimates(scene, "vpl", GetParam().vpl, 40, 8);
  const auto path = estimates(scene, "path", GetParam().path, 40, 64);
  double mean = 0, truth = 0, variance = 0;
  for (int i = 0; i < 16; ++i) {
    EXPECT_GT(test::t_test_p(vpl[i], path[i]), 0.001 / 16)
        << "pixel " << i << ": vpl " << vpl[i].mean << " +- " << vpl[i].standard_error << ", path " << path[i].mean
        << " +- " << path[i].standard_error;
    mean += vpl[i].mean, truth += path[i].mean;
    variance += std::pow(vpl[i].standard_error, 2) + std::pow(path[i].standard_error, 2);
  }
  // Pixels of one picture share their lights, so their errors may add up: 4 x the sum of standard errors at most.
  EXPECT_LT(std::abs(mean - truth), 4 * std::sqrt(16 * variance));
  EXPECT_LT(std::sqrt(16 * variance), 0.05 * truth) << "too noisy to mean anything";
}

INSTANTIATE_TEST_SUITE_P(
    Transports, VplTendsToPath,
    testing::Values(
        Transport{"one_bounce_sphere", room(kDiffuse, kSphere), R"({"lights": 64})", R"({"max_bounces": 1})"},
        Transport{"three_bounces_sphere", room(kDiffuse, kSphere), R"({"lights": 64, "bounces": 3})", R"({"max_bounces": 3})"},
        Transport{"spot_grid", room(kDiffuse, kSpot), R"({"lights": 64})", R"({"max_bounces": 1})"},
        Transport{"spot_paths", room(kDiffuse, kSpot), R"({"lights": 64, "distribution": "paths"})", R"({"max_bounces": 1})"},
        Transport{"point_grid", room(kDiffuse, kPoint), R"({"lights": 96})", R"({"max_bounces": 1})"},
        Transport{"glossy_spot", room(kGlossy, kSpot), R"({"lights": 64})", R"({"max_bounces": 1})"},
        Transport{"unoccluded", room(kDiffuse, kSpot), R"({"lights": 64, "occlusion": "none"})",
                  R"({"max_bounces": 1, "occlusion": "none"})"},
        Transport{"indirect_only", room(kDiffuse, std::string(kSpot) + "," + kSphere),
                  R"({"lights": 64, "direct": "none"})", R"({"min_bounces": 1, "max_bounces": 1})"}),
    [](const auto& info) { return info.param.name; });

double mean_luminance(const Image& image) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += luminance(image.rgb(x, y));
  return sum / (image.width * image.height);
}

TEST(Vpl, the_clamp_takes_the_energy_it_says) {
  const Scene scene = test::scene_from(room(kDiffuse, kSphere));
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
  const Scene scene = test::scene_from(room(kDiffuse, kPoint));
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
      EXPECT_NEAR(kernel::vpl_yuksel(d * d, r), truth, 4e-7 * truth) << "d " << d << " r " << r;  // a few roundings
    }
  }
  EXPECT_NEAR(kernel::vpl_yuksel(1e8f, 1e-3f) * 1e8, 1, 1e-6);  // far away: 1/d^2
}

TEST(VplKernel, geometry_is_cosines_over_squared_distance) {
  vec3 w;
  const float g = kernel::vpl_geometry(vec3(3, 4, 0), vec3(1, 0, 0), vec3(0, -1, 0), 1 / 25.0f, w);
  EXPECT_FLOAT_EQ(g, 0.6f * 0.8f / 25);
  EXPECT_EQ(kernel::vpl_geometry(vec3(-3, 4, 0), vec3(1, 0, 0), vec3(0, -1, 0), 1, w), 0);  // behind the point
  EXPECT_EQ(kernel::vpl_geometry(vec3(0), vec3(1, 0, 0), vec3(0, -1, 0), 1, w), 0);
}

}  // namespace
}  // namespace zonal
