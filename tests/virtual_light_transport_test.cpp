// vpl, vsl and hvl against the path tracer for the same transport: grids and paths, lamps without and with an
// area, one bounce and several.
#include <gtest/gtest.h>

#include "tests/support.h"
#include "tests/virtual_light_support.h"

namespace zonal {
namespace {

using namespace test;

std::vector<Estimate> estimates(const Scene& scene, const std::string& method, const std::string& settings,
                                int seeds, int passes) {
  std::vector<std::vector<double>> values(16);
  for (int seed = 0; seed < seeds; ++seed) {
    const Image image = render_with(scene, method,
                                    {.settings = settings,
                                     .passes = passes,
                                     .width = 4,
                                     .height = 4,
                                     .seed = 1000u + seed,
                                     .jitter = true});
    for (int i = 0; i < 16; ++i) values[i].push_back(image.pixels[3 * i + 1]);
  }
  std::vector<Estimate> result;
  for (const auto& v : values) result.push_back(estimate(v));
  return result;
}

struct Transport {
  std::string name, scene, method, settings, path;
};
void PrintTo(const Transport& t, std::ostream* out) {
  *out << t.name;
}

class TendsToPath : public testing::TestWithParam<Transport> {};

TEST_P(TendsToPath, without_a_clamp_or_a_sphere_of_note) {
  const Scene scene = scene_from(GetParam().scene);
  const auto found = estimates(scene, GetParam().method, GetParam().settings, 40, 8);
  const auto path = estimates(scene, "path", GetParam().path, 40, 64);
  double mean = 0, truth = 0, variance = 0;
  for (int i = 0; i < 16; ++i) {
    EXPECT_GT(t_test_p(found[i], path[i]), 0.001 / 16)
        << "pixel " << i << ": " << GetParam().method << " " << found[i].mean << " +- "
        << found[i].standard_error << ", path " << path[i].mean << " +- " << path[i].standard_error;
    mean += found[i].mean, truth += path[i].mean;
    variance += std::pow(found[i].standard_error, 2) + std::pow(path[i].standard_error, 2);
  }
  // Pixels of one picture share their lights, so their errors may add up: 4 x the sum of standard errors at
  // most.
  EXPECT_LT(std::abs(mean - truth), 4 * std::sqrt(16 * variance));
  EXPECT_LT(std::sqrt(16 * variance), 0.05 * truth) << "too noisy to mean anything";
}

INSTANTIATE_TEST_SUITE_P(
    Transports, TendsToPath,
    testing::Values(
        Transport{"vpl_one_bounce_sphere", room(kDiffuse, kSphere), "vpl", R"({"lights": 64})",
                  R"({"max_bounces": 1})"},
        Transport{"vpl_three_bounces_sphere", room(kDiffuse, kSphere), "vpl",
                  R"({"lights": 64, "bounces": 3})", R"({"max_bounces": 3})"},
        Transport{"vpl_spot_grid", room(kDiffuse, kSpot), "vpl", R"({"lights": 64})",
                  R"({"max_bounces": 1})"},
        Transport{"vpl_spot_paths", room(kDiffuse, kSpot), "vpl",
                  R"({"lights": 64, "distribution": "paths"})", R"({"max_bounces": 1})"},
        Transport{"vpl_point_grid", room(kDiffuse, kPoint), "vpl", R"({"lights": 96})",
                  R"({"max_bounces": 1})"},
        Transport{"vpl_glossy_spot", room(kGlossy, kSpot), "vpl", R"({"lights": 64})",
                  R"({"max_bounces": 1})"},
        Transport{"vpl_unoccluded", room(kDiffuse, kSpot), "vpl", R"({"lights": 64, "occlusion": "none"})",
                  R"({"max_bounces": 1, "occlusion": "none"})"},
        Transport{"vpl_indirect_only", room(kDiffuse, std::string(kSpot) + "," + kSphere), "vpl",
                  R"({"lights": 64, "direct": "none"})", R"({"min_bounces": 1, "max_bounces": 1})"},
        // Spheres of millimetres: what they blur is a ten-thousandth. Matt walls, where zonal hvl is exact.
        Transport{"vsl_lamp_three_bounces", room(kDiffuse, kSphere), "vsl",
                  R"({"lights": 64, "bounces": 3, "samples": 4, "radius": 0.003})", R"({"max_bounces": 3})"},
        Transport{"vsl_glossy_lamp_two_bounces", room(kGlossy, kSphere), "vsl",
                  R"({"lights": 64, "bounces": 2, "samples": 4, "radius": 0.003})", R"({"max_bounces": 2})"},
        Transport{"hvl_lamp_one_bounce", room(kDiffuse, kSphere), "hvl",
                  R"({"lights": 64, "product": "zonal", "radius": 0.003})", R"({"max_bounces": 1})"},
        Transport{"hvl_lamp_three_bounces", room(kDiffuse, kSphere), "hvl",
                  R"({"lights": 64, "bounces": 3, "product": "zonal", "radius": 0.003})",
                  R"({"max_bounces": 3})"},
        Transport{"hvl_spot_three_bounces", room(kDiffuse, kSpot), "hvl",
                  R"({"lights": 64, "bounces": 3, "product": "zonal", "radius": 0.003})",
                  R"({"max_bounces": 3})"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace zonal
