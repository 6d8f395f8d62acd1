// What blocks light in sh_direct: the ratio of shadowed to unshadowed light, and ambient openness.
#include "integrators/sh_direct/sh_occlusion.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/center_reference.h"

namespace zonal {
namespace {

// A ball that shadows a floor from two lamps, one of them large; the floor is matt, so that bands leave
// little out.
const char* kShadows =
    R"({"camera": {"position": [0, 3, 5], "look_at": [0, 0.3, 0], "vertical_fov": 40, "resolution": [24, 18]},
  "materials": [{"name": "matt", "type": "lambert", "albedo": [0.7, 0.6, 0.5]}],
  "objects": [{"name": "floor", "type": "quad", "corner": [-4, 0, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "matt"},
              {"name": "ball", "type": "sphere", "center": [0, 0.8, 0], "radius": 0.7, "material": "matt"}],
  "lights": [{"type": "sphere", "center": [2.5, 3, 0], "radius": 0.8, "radiance": [8, 2, 2]},
             {"type": "sphere", "center": [-2.5, 3, 1], "radius": 0.2, "radiance": [20, 80, 20]}]})";

Image image(const Scene& scene, const std::string& name, const std::string& settings, uint64_t seed = 1) {
  return test::render_with(scene, name, {.settings = settings, .width = 24, .height = 18, .seed = seed});
}

TEST(ShOcclusion, ratio_tends_to_the_shadowed_image_within_the_band_error) {
  const Scene scene = test::scene_from(kShadows);
  const test::CenterReference open(scene, R"({"max_bounces": 0, "direct_occlusion": "none"})", 24, 18, 200);
  const test::CenterReference shadowed(scene, R"({"max_bounces": 0})", 24, 18, 200);
  const std::string bands = R"("bands": 9, "light_bands": 9, )";
  const Image without = image(scene, "sh_direct", "{" + bands + R"("occlusion": "none"})");
  const double band_error = open.error(without);
  EXPECT_GT(shadowed.error(without), 0.2) << "there is no shadow to find";
  for (const int groups : {1, 2}) {
    double before = 1;
    for (const int rays : {1, 8, 64, 512}) {
      const double error = shadowed.error(
          image(scene, "sh_direct",
                fmt::format(R"({{{}"occlusion": "ratio", "rays": {}, "groups": {}}})", bands, rays, groups)));
      fmt::print("{} groups, {} rays: {:.4f} off; bands alone {:.4f}\n", groups, rays, error, band_error);
      EXPECT_LT(error, before) << rays;
      before = error;
    }
    // 512 rays leave half of a light's contrast over sqrt(512) in penumbras, which are a tenth of the
    // picture: 1 %; the halves' noise leaves 1 % too.
    EXPECT_LT(before, band_error + 0.02);
  }
}

TEST(ShOcclusion, ratio_is_exactly_one_where_nothing_is_in_the_way) {
  // A floor alone: no pixel has noise.
  const Scene scene =
      test::scene_from(R"({"camera": {"position": [0, 3, 5], "look_at": [0, 0.3, 0], "resolution": [24, 18]},
    "materials": [{"name": "m", "type": "metallic_roughness", "roughness": 0.5, "metallic": 0.5}],
    "objects": [{"name": "floor", "type": "quad", "corner": [-4, 0, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "m"}],
    "lights": [{"type": "sphere", "center": [2.5, 3, 0], "radius": 0.3, "radiance": [8, 2, 2]},
               {"type": "spot", "position": [-2, 3, 1], "look_at": [0, 0, 0], "intensity": 5},
               {"type": "environment", "radiance": 0.2}]})");
  EXPECT_EQ(image(scene, "sh_direct", R"({"occlusion": "ratio", "rays": 2})").pixels,
            image(scene, "sh_direct", R"({"occlusion": "none"})").pixels);
}

TEST(ShOcclusion, openness_is_that_of_half_a_sphere_cut_by_a_wall) {
  // At the foot of an endless wall half of the cosine-weighted directions are free; far from it all are.
  const Scene scene = test::scene_from(R"({"camera": {"position": [0, 3, 5], "look_at": [0, 0, 0]},
    "materials": [{"name": "m", "type": "lambert"}],
    "objects": [{"name": "floor", "type": "quad", "corner": [-400, 0, 400], "edges": [[800, 0, 0], [0, 0, -400.02]], "material": "m"},
                {"name": "wall", "type": "quad", "corner": [-400, 0, 0], "edges": [[800, 0, 0], [0, 400, 0]], "material": "m"}],
    "lights": [{"type": "point", "position": [0, 1, 1], "intensity": 1}]})");
  Sampler sampler(1, 2, 3);
  TileStats stats;
  const auto openness = [&](float z, float reach) {
    const Hit hit = scene.intersect(vec3(0, 1, z), vec3(0, -1, 0));
    const Surface s = scene.surface(hit, vec3(0, -1, 0));
    return ambient_openness(scene, s, 40000, reach, sampler, stats);
  };
  // Five standard errors of a share of 40,000: 0.0125.
  EXPECT_NEAR(openness(0.001f, kInfinity), 0.5, 0.0125);
  EXPECT_EQ(openness(2, 1), 1);
  EXPECT_LT(openness(0.5f, 1), 0.95);
}

TEST(ShOcclusion, groups_are_neighbours_and_hold_every_light_once) {
  std::vector<std::unique_ptr<Light>> lights;
  for (int i = 0; i < 20; ++i) {
    auto light = std::make_unique<PointLight>();
    light->position = vec3(float(i % 2) * 100 + float(i), 0, 0);
    lights.push_back(std::move(light));
  }
  lights.push_back(std::make_unique<DirectionalLight>());
  EXPECT_EQ(light_groups(lights, 1).size(), 1u);
  const auto groups = light_groups(lights, 3);
  ASSERT_EQ(groups.size(), 3u);
  size_t held = 0;
  for (const auto& group : groups) held += group.size();
  EXPECT_EQ(held, 21u);
  for (int g = 0; g < 2; ++g)
    for (const Light* light : groups[g])
      EXPECT_EQ(static_cast<const PointLight*>(light)->position.x > 60,
                static_cast<const PointLight*>(groups[g][0])->position.x > 60);
}

}  // namespace
}  // namespace zonal
