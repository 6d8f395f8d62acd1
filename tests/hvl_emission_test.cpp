// Automatic bands of `hvl`'s emission: as many as the light that leaves the surface needs, which is weighted
// by a cosine, however steep the BRDF itself is at the horizon.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "integrators/hvl/hvl.h"
#include "tests/measured_files.h"
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

// F' of Lambert's law holds 99.2 % in three bands, F 94.9 % in four: automatic is three, not six.
TEST(HvlEmission, a_matt_surface_takes_the_three_bands_of_its_reflected_light) {
  const Scene scene = lit_floor(R"("type": "lambert", "albedo": [0.8, 0.5, 0.3])");
  const Image automatic = with_emission(scene, "\"auto\"");
  EXPECT_GT(max_component(automatic.rgb(4, 4)), 0);
  EXPECT_EQ(automatic.pixels, with_emission(scene, "3").pixels);
  EXPECT_NE(automatic.pixels, with_emission(scene, "6").pixels);
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
