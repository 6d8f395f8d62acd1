// Radii of virtual lights' spheres: on an even map each rule against its closed form, and where there is
// nothing to measure.
#include "lights/virtual_light_radius.h"

#include <gtest/gtest.h>

#include "tests/light_support.h"
#include "tests/support.h"

namespace zonal {
namespace {

using namespace test;

TEST(virtual_light_radius, of_each_rule_is_about_the_diagonal_spacing_on_an_even_map) {
  // A far spot with a narrow cone on a plane across it: cells are equal squares of this size.
  const Scene scene = scene_from(R"({"camera": {"position": [0, 1, 3], "look_at": [0, 0, 0]},
    "materials": [{"name": "a", "type": "lambert"}],
    "objects": [{"name": "o", "type": "quad", "corner": [-6, 0, 6], "edges": [[12, 0, 0], [0, 0, -12]], "material": "a"}],
    "lights": [{"type": "spot", "position": [0, 20, 0], "look_at": [0, 0, 0], "intensity": 5, "inner": 5.729578, "outer": 5.729578}]})");
  const VirtualLightSet set = make_virtual_lights(
      scene, {.lights = 800, .block_texels = 3, .placement = VirtualLightOptions::center}, {});
  const double spacing = 2 * 20 * std::tan(0.1) / set.columns;
  const auto median = [&](RadiusRule rule, float factor = 1) {
    auto r = virtual_light_radii(set, {.rule = rule, .factor = factor}, scene.bounds().radius);
    std::nth_element(r.begin(), r.begin() + r.size() / 2, r.end());
    return r[r.size() / 2];
  };
  const double diagonal = std::sqrt(2) * spacing;
  EXPECT_NEAR(median(RadiusRule::field_of_view), diagonal, 0.02 * diagonal);
  EXPECT_EQ(median(RadiusRule::automatic), median(RadiusRule::field_of_view));
  // The tenth neighbour of a square lattice is 2 spacings away: 2 sqrt(2 pi/10) = 1.585 of them.
  EXPECT_NEAR(median(RadiusRule::density), 1.585 * spacing, 0.02 * spacing);
  // The mean of 4 sides and 4 diagonals, nearly equal depths: (1 + sqrt 2)/2.
  EXPECT_NEAR(median(RadiusRule::neighbours), 0.5 * (1 + std::sqrt(2)) * spacing, 0.05 * spacing);
  EXPECT_NEAR(median(RadiusRule::density, 1.5f), 1.5 * 1.585 * spacing, 0.03 * spacing);
}

TEST(virtual_light_radius, of_a_texel_is_its_share_of_the_blocks) {
  // A floor and a wall under an oblique spot: footprints of all sizes.
  const Scene scene = scene_from(R"({"camera": {"position": [0, 1, 3], "look_at": [0, 0, 0]},
    "materials": [{"name": "a", "type": "lambert"}],
    "objects": [{"name": "o", "type": "quad", "corner": [-6, 0, 6], "edges": [[12, 0, 0], [0, 0, -12]], "material": "a"},
                {"name": "w", "type": "quad", "corner": [-6, 0, -1], "edges": [[12, 0, 0], [0, 5, 0]], "material": "a"}],
    "lights": [{"type": "spot", "position": [0, 3, 3], "look_at": [0, 0, -1], "intensity": 5, "inner": 20, "outer": 30}]})");
  const VirtualLightSet set =
      make_virtual_lights(scene, {.lights = 60, .block_texels = 4, .keep_texels = true}, {});
  VirtualLightSet both = set;
  both.lights.insert(both.lights.end(), set.texels.begin(), set.texels.end()), both.parts = set.texels.size();
  for (const RadiusParams& rule :
       {RadiusParams{}, RadiusParams{.rule = RadiusRule::density, .factor = 0.5f},
        RadiusParams{.rule = RadiusRule::neighbours}, RadiusParams{.rule = RadiusRule::metres}}) {
    const auto alone = virtual_light_radii(set, rule, 20), all = virtual_light_radii(both, rule, 20);
    ASSERT_EQ(all.size(), set.lights.size() + set.texels.size());
    for (size_t i = 0; i < set.lights.size(); ++i) {
      EXPECT_EQ(all[i], alone[i]);
      // Disks that share an area: their squares add up.
      double squares = 0;
      for (uint32_t t = 0; t < set.lights[i].texel_count; ++t)
        squares += std::pow(all[set.lights.size() + set.lights[i].first_texel + t], 2.0);
      EXPECT_NEAR(squares, alone[i] * alone[i], 1e-4 * alone[i] * alone[i]);
    }
  }
}

TEST(virtual_light_radius, is_positive_where_lights_share_a_place_or_are_alone) {
  VirtualLightSet set;
  for (const auto rule :
       {RadiusRule::automatic, RadiusRule::field_of_view, RadiusRule::density, RadiusRule::neighbours}) {
    set.lights.clear();
    EXPECT_TRUE(virtual_light_radii(set, {.rule = rule}, 2).empty());
    set.lights.resize(1);
    set.lights[0].primary_distance = 3;
    EXPECT_FLOAT_EQ(virtual_light_radii(set, {.rule = rule}, 2)[0], 1.5f);
    set.lights.resize(30);
    for (const float r : virtual_light_radii(set, {.rule = rule}, 2)) EXPECT_FLOAT_EQ(r, 2e-6f);
  }
}

TEST(virtual_light_radius, finds_the_same_nearest_distances_as_a_search_of_all) {
  std::vector<vec3> points;
  for (int i = 0; i < 700; ++i) {
    vec3 p(random_pair(), random_pair().x);
    if (i % 5 == 0) p.y = 0.25f;  // many on one plane
    if (i % 50 == 0 && i) p = points[i / 2];
    points.push_back(p);
  }
  const auto found = nearest_distances(points, 10);
  for (size_t i = 0; i < points.size(); ++i) {
    std::vector<float> all;
    for (size_t j = 0; j < points.size(); ++j)
      if (j != i) all.push_back(glm::distance(points[i], points[j]));
    std::nth_element(all.begin(), all.begin() + 9, all.end());
    EXPECT_FLOAT_EQ(found[i], all[9]) << i;
  }
}

}  // namespace
}  // namespace zonal
