// `hvl` where methods break: threads, units, measured materials, hard numbers, wrong settings.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "core/error.h"
#include "materials/measured_brdf.h"
#include "tests/hvl_support.h"

namespace zonal {
namespace {

using namespace hvl_test;
using dvec3 = glm::dvec3;

TEST(Hvl, is_one_picture_on_any_number_of_threads) {
  const Scene scene = test::scene_from(kBox);
  for (const char* settings :
       {R"({"lights": 300, "occlusion": "sphere"})", R"({"lights": 300, "product": "zonal"})"}) {
    EXPECT_EQ(hvl_image(scene, settings, 24, 24, 1).pixels, hvl_image(scene, settings, 24, 24, 2).pixels);
  }
}

/// facing_walls turned and scaled: x -> scale R x.
std::string turned_walls(const glm::dmat3& R, double scale) {
  const auto text = [&](dvec3 v, double size) {
    const dvec3 t = R * v * size;
    return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", t.x, t.y, t.z);
  };
  const auto quad = [&](const char* name, dvec3 corner, dvec3 u, dvec3 v) {
    return fmt::format(
        R"({{"type": "quad", "name": "{0}", "material": "{0}", "corner": {1}, "edges": [{2}, {3}]}})", name,
        text(corner, scale), text(u, scale), text(v, scale));
  };
  return fmt::format(
      R"({{"camera": {{"position": {}, "look_at": {}, "up": {}, "vertical_fov": 50, "resolution": [8, 8]}},
    "materials": [{{"name": "left", {}}}, {{"name": "right", {}}}],
    "objects": [{}, {}],
    "lights": [{{"type": "spot", "position": {}, "look_at": {}, "power": {}, "inner": 0, "outer": 30}}]}})",
      text({-0.5, 0, 0}, scale), text({1, 0.3, 0.1}, scale), text({0, 1, 0}, 1), kGlossy, kGlossy,
      quad("left", {-1, -9, 9}, {0, 0, -18}, {0, 18, 0}), quad("right", {1, -9, -9}, {0, 0, 18}, {0, 18, 0}),
      text({0.9, 0, 0}, scale), text({-1, 0, 0}, scale), 100 * scale * scale);
}

TEST(Hvl, turning_and_scaling_the_scene_with_its_lights_changes_nothing) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 3));
  const glm::dmat3 R(glm::rotate(glm::dmat4(1), 1.1, axis));
  const float scale = 3.7f;
  const Scene scene = test::scene_from(turned_walls(glm::dmat3(1), 1)),
              turned = test::scene_from(turned_walls(R, scale));
  for (const char* settings : {R"({"lights": 64, "direct": "none", "radius": "density"})",
                               R"({"lights": 64, "direct": "none", "product": "zonal", "occlusion": "none"})",
                               R"({"lights": 64, "direct": "none", "soft_edge": 0.5, "window": "hann"})"}) {
    HvlIntegrator here(params(settings)), there(params(settings));
    const Image image = rendered(scene, here, 8, 8);
    VirtualLightSet set = here.light_set();
    const mat3 turn(R);
    for (VirtualLight& light : set.lights) {
      light.position = turn * light.position * scale, light.shadow_point = turn * light.shadow_point * scale;
      light.normal = turn * light.normal, light.w_in = turn * light.w_in;
      light.frame.x = turn * light.frame.x, light.frame.y = turn * light.frame.y,
      light.frame.z = turn * light.frame.z;
      light.power *= scale * scale, light.primary_distance *= scale, light.footprint *= scale * scale;
    }
    there.gather_from(set);
    ASSERT_GT(mean(image), 0);
    EXPECT_LT(largest_difference(rendered(turned, there, 8, 8), image), 1e-4) << settings;
  }
}

/// A measured material that measures a known one.
struct AsMeasured : MeasuredBrdf {
  Bsdf known;
  vec3 evaluate(vec3 w_out, vec3 w_in) const override {
    return zonal::evaluate(known, prepare(known, w_out), w_in);
  }
  vec3 sample_direction(vec3 w_out, float u_lobe, vec2 u) const override {
    return sample(known, prepare(known, w_out), u_lobe, u).w_in;
  }
  float pdf(vec3 w_out, vec3 w_in) const override { return zonal::pdf(known, prepare(known, w_out), w_in); }
  bool isotropic() const override { return true; }
  const char* format() const override { return "test"; }
};
TEST(Hvl, takes_measured_materials_at_light_and_receiver) {
  const std::string walls = facing_walls(kGlossy, kGlossy, 0.9, 30);
  const Scene scene = test::scene_from(walls), measured = test::scene_from(walls);
  // In the place of a file's.
  auto& materials = const_cast<std::vector<std::unique_ptr<Material>>&>(measured.materials());
  for (auto& material : materials) {
    auto brdf = std::make_shared<AsMeasured>();
    brdf->known = material->at(vec2(0.5f)), brdf->albedo = albedo(brdf->known);
    auto stand_in = std::make_unique<MeasuredMaterial>();
    stand_in->name = material->name, stand_in->brdf = brdf;
    material = std::move(stand_in);
  }
  for (const char* settings : {R"({"lights": 64, "direct": "none", "emission_bands": 5})",
                               R"({"lights": 64, "direct": "none", "emission": "brdf"})"}) {
    const Image truth = hvl_image(scene, settings);
    ASSERT_GT(mean(truth), 0);
    // Two projections of one function, each good to 1e-3, on lights whose powers were drawn alike.
    EXPECT_LT(largest_difference(hvl_image(measured, settings), truth), 5e-3) << settings;
  }
  try {
    hvl_image(measured, R"({"product": "zonal"})");
    FAIL() << "a measured material has no zonal lobe";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("\"left\""), std::string::npos) << error.what();
  }
}

/// Renders, and expects numbers fit to be seen.
void expect_sound(const Scene& scene, const std::string& settings, int size, const char* what,
                  const VirtualLightSet* set = nullptr) {
  HvlIntegrator method(params(settings));
  if (set) method.gather_from(*set);
  Film film(size, size);
  render(scene, method, film, {.passes = 1}, {.seed = 3, .threads = 2});
  EXPECT_EQ(film.bad_samples(), 0u) << what << " " << settings;
  for (const float v : film.radiance().pixels)
    EXPECT_TRUE(std::isfinite(v) && v >= 0) << what << " " << settings;
}

TEST(Hvl, no_number_breaks) {
  const char* const methods[] = {
      R"("emission": "brdf")", R"("product": "zonal")", R"("bands": "auto", "soft_edge": 1)",
      R"("product": "zonal", "emission": "brdf", "bands": 20)", R"("radius": 1e-4)"};
  const auto text = [](const std::string& settings, int lights) {
    return "{" + settings + R"(, "occlusion": "none", "lights": )" + std::to_string(lights) + "}";
  };
  const Scene box = test::scene_from(kBox);
  for (const char* method : methods) expect_sound(box, text(method, 1), 8, "one light");
  for (const char* roughness : {"0.01", "0.1", "1"}) {
    const std::string shiny =
        std::string(R"("type": "metallic_roughness", "base_color": 0.9, "metallic": 1, "roughness": )") +
        roughness;
    const Scene walls = test::scene_from(facing_walls(shiny, shiny, 0.9, 40));
    for (const char* method : {R"("emission": "brdf")", R"("product": "zonal")",
                               R"("product": "zonal", "emission": "brdf", "bands": 64)"})
      expect_sound(walls, text(method, 40), 8, roughness);
  }
  expect_sound(box, text(methods[1], 100000), 2, "100,000 lights");
  expect_sound(box, text(methods[0], 100000), 2, "100,000 lights");

  // A camera that skims the floor, lights on the very points it sees, and lights behind the surface.
  const Scene floor = test::scene_from(R"({
    "camera": {"position": [0, 1e-4, 3], "look_at": [0, 0, -3], "vertical_fov": 20, "resolution": [8, 8]},
    "materials": [{"name": "m", "type": "metallic_roughness", "base_color": 0.7, "metallic": 0.5, "roughness": 0.4}],
    "objects": [{"name": "floor", "type": "quad", "corner": [-9, 0, 9], "edges": [[18, 0, 0], [0, 0, -18]], "material": "m"}],
    "lights": [{"type": "point", "position": [0, 2, 0], "intensity": 5}]})");
  HvlIntegrator donor(params(R"({"lights": 64})"));
  rendered(floor, donor, 8, 8);
  VirtualLightSet on_points = donor.light_set(), behind = donor.light_set();
  Tile tile;
  std::array<Sampler, kTilePixels> samplers;
  Camera camera = floor.camera();
  trace_tile(floor, camera, {0, 0}, 3, 0, false, &tile, samplers.data());
  ASSERT_GE(on_points.lights.size(), 32u);
  size_t moved = 0;
  for (int i = 0; i < tile.count && moved < on_points.lights.size(); ++i)
    if (tile.found(i)) on_points.lights[moved++].position = tile.surfaces[i].position;
  EXPECT_GT(moved, 0u);
  for (VirtualLight& light : behind.lights) light.position.y = -0.3f, light.shadow_point.y = -0.3f;
  for (const char* method : methods) {
    expect_sound(floor, text(method, 64), 8, "a grazing camera");
    expect_sound(floor, text(method, 64), 8, "lights on the points", &on_points);
    expect_sound(floor, text(method, 64), 8, "lights behind the surface", &behind);
  }
}

TEST(Hvl, refuses_what_it_cannot_do) {
  const auto error = [](const char* text) -> std::string {
    try {
      params(text);
    } catch (const SceneError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error(R"({"bands": 65})"), "hvl: /bands: found 65, expected auto or a whole number in [1, 64]");
  EXPECT_EQ(error(R"({"emission_bands": 0})"),
            "hvl: /emission_bands: found 0, expected auto or a whole number in [1, 64]");
  EXPECT_NE(error(R"({"radius_factor": 0})").find("found 0, expected a number"), std::string::npos);
  EXPECT_NE(error(R"({"product": "zh"})").find("expected one of sh, zonal"), std::string::npos);
}

}  // namespace
}  // namespace zonal
