// Automatic bands of `hvl`'s emission: as many as the light that leaves the surface needs, which is weighted
// by a cosine, however steep the BRDF itself is at the horizon.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "integrators/hvl/hvl.h"
#include "materials/measured_brdf.h"
#include "materials/sh_projector.h"
#include "tests/measured_files.h"
#include "tests/mesh_files.h"
#include "tests/support.h"

namespace zonal {
namespace {

/// A floor of the material below a spot; the camera sees a white wall that the floor lights.
Scene lit_floor(const std::string& material) {
  return test::scene_from(R"({
    "camera": {"position": [0, 1, 1], "look_at": [0, 1, -1], "vertical_fov": 60, "resolution": [8, 8]},
    "materials": [{"name": "floor", )" +
                          material + R"(},
                  {"name": "wall", "type": "lambert", "albedo": 0.7}],
    "objects": [
      {"type": "quad", "corner": [-1, 0, 1], "edges": [[2, 0, 0], [0, 0, -2]], "material": "floor"},
      {"type": "quad", "corner": [-1, 0, -1], "edges": [[2, 0, 0], [0, 2, 0]], "material": "wall"}],
    "lights": [{"type": "spot", "position": [0, 2, 0.3], "look_at": [0, 0, 0], "power": 100, "outer": 20}]})");
}

Image with_emission(const Scene& scene, const std::string& bands) {
  HvlIntegrator method(read_params<HvlParams>(
      nlohmann::json::parse(
          fmt::format(R"({{"lights": 40, "direct": "none", "bands": 3, "emission_bands": {}}})", bands)),
      "hvl"));
  Film film(8, 8);
  render(scene, method, film, {.passes = 1}, {.seed = 3, .threads = 2});
  return film.radiance();
}

// What a matt surface sends out is summed in closed form: its number of bands changes rounding alone, where
// three and six bands of the hemisphere's step would differ by percents.
TEST(HvlEmission, a_matt_surface_does_not_depend_on_bands) {
  const Scene scene = lit_floor(R"("type": "lambert", "albedo": [0.8, 0.5, 0.3])");
  const Image automatic = with_emission(scene, "\"auto\""), six = with_emission(scene, "6");
  const float peak = max_component(automatic.rgb(4, 4));
  EXPECT_GT(peak, 0);
  EXPECT_EQ(automatic.pixels, with_emission(scene, "3").pixels);
  // 40 lights, each a few operations of 6e-8: 1e-5 leaves room.
  for (size_t i = 0; i < six.pixels.size(); ++i)
    EXPECT_NEAR(automatic.pixels[i], six.pixels[i], 1e-5f * peak);
}

// Rough, with a share of what is stored that does not fall towards the horizon, where F is that over the
// cosine: most bands of F describe what the cosine then takes away.
TEST(HvlEmission, a_steep_horizon_does_not_cost_bands) {
  const test::Folder folder;
  const std::string file = folder.path("steep_rgb.bsdf");
  test::rgl_tensors({.surface = {0.9, 0.9}, .least = 0.02}).write(file);
  const auto brdf = load_measured(file);
  const Bsdf bsdf{.kind = BsdfKind::measured, .measured = brdf.get()};
  constexpr int kMany = 24;
  int cosine_bands = 0, brdf_bands = 0;
  for (const double degrees : {0.0, 30.0, 60.0}) {
    const BandStudy study = study_bands(bsdf, glm::radians(degrees), kMany);
    const auto needed = [&](ShTable table) { return BandStudy::bands(study.spherical[int(table)], 0.95); };
    cosine_bands = std::max(cosine_bands, needed(ShTable::brdf_cosine));
    const int own = needed(ShTable::brdf);
    brdf_bands = std::max(brdf_bands, own == 0 ? kMany : own);
  }
  ASSERT_GE(brdf_bands, 4 * cosine_bands) << "not the surface this test is about";

  const Scene scene = lit_floor(R"("type": "measured", "file": ")" + file + "\"");
  const Image automatic = with_emission(scene, "\"auto\""),
              few = with_emission(scene, std::to_string(cosine_bands)),
              many = with_emission(scene, std::to_string(kMany));
  const float peak = max_component(few.rgb(4, 4));
  float to_few = 0, to_many = 0;
  for (size_t i = 0; i < few.pixels.size(); ++i) {
    to_few = std::max(to_few, std::abs(automatic.pixels[i] - few.pixels[i]) / peak);
    to_many = std::max(to_many, std::abs(automatic.pixels[i] - many.pixels[i]) / peak);
  }
  RecordProperty("bands", fmt::format("F' {} F {}", cosine_bands, brdf_bands));
  RecordProperty("differences", fmt::format("{} {}", to_few, to_many));
  EXPECT_LT(to_few, 0.1f * to_many);
}

// F of the papers and felts spikes in the last degrees and would take 64 bands; F' needs three up to 60
// degrees.
TEST(HvlEmission, a_measured_paper_takes_few_bands_too) {
  const std::vector<std::string> files = test::published_rgl_files();
  const auto paper = std::find_if(files.begin(), files.end(),
                                  [](const std::string& f) { return f.find("paper_white") != f.npos; });
  if (paper == files.end()) GTEST_SKIP() << test::kNoPublishedFiles;
  const Scene scene = lit_floor(R"("type": "measured", "file": ")" + *paper + "\"");
  const Image automatic = with_emission(scene, "\"auto\""), three = with_emission(scene, "3");
  ASSERT_GT(max_component(three.rgb(4, 4)), 0);
  // The tables come from two sets of nodes, which agree to 1e-4 of a lobe's peak; 64 bands differ by
  // percents.
  for (size_t i = 0; i < three.pixels.size(); ++i)
    EXPECT_NEAR(automatic.pixels[i], three.pixels[i], 1e-3f * max_component(three.rgb(4, 4)));
}

}  // namespace
}  // namespace zonal
