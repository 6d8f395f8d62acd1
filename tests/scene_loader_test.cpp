// What a scene file says is what the scene holds: cameras, materials and their textures, lights, imported
// files.

#include "core/scene_loader.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "tests/paths.h"
#include "tests/support.h"

namespace zonal {
namespace {

using test::scene_from;

const std::string kCamera = R"("camera": {"position": [0, 0, 9], "look_at": [0, 0, 0]})";

Scene scene_with(const std::string& rest) {
  return scene_from("{" + kCamera + ", " + rest + "}");
}

bool noted(const Scene& scene, const std::string& text) {
  for (const std::string& note : scene.notes())
    if (note.find(text) != std::string::npos) return true;
  return false;
}

// ---- the file as a whole -----------------------------------------------------------------------------

TEST(scene_loader, a_scene_that_uses_every_key_loads) {
  SceneSettings settings;
  const Scene scene = load_scene(test::source_dir() + "/tests/scene_files/everything.json", {}, &settings);
  EXPECT_EQ(scene.name(), "every key there is");
  EXPECT_EQ(settings.passes, 4);
  EXPECT_EQ(nlohmann::json::parse(settings.integrator_json),
            nlohmann::json::parse(R"({"type": "path", "max_bounces": 3})"));
  EXPECT_TRUE(scene.environment());
  // 12 under "lights"; glow, board, crate, flag; lamp (Ke of room.obj); statue's two shapes; the bulb of
  // sail.gltf.
  EXPECT_EQ(scene.lights().size(), 12u + 4 + 1 + 2 + 1);
  // Quads and panels 2 each, box 12, triangles 1: board, crate, flag, room without banner 4, statue without
  // floor 3, boat, panel, sliver; hatch 64, arrow and window 2 each.
  EXPECT_EQ(scene.triangle_count(), 2u + 12 + 1 + 4 + 3 + 1 + 2 + 1 + 64 + 2 + 2);
}

TEST(scene_loader, the_least_scene_there_is) {
  SceneSettings settings{"old", 7};
  const Scene scene = parse_scene(R"({"camera": {"position": [0, 0, 9], "look_at": [0, 0, 0]}})",
                                  "here/least.json", {}, &settings);
  EXPECT_EQ(scene.name(), "least");
  EXPECT_EQ(settings.integrator_json, "{}");
  EXPECT_EQ(settings.passes, 0);
  EXPECT_TRUE(noted(scene, "no lights"));
  EXPECT_FALSE(scene.intersect({0, 0, 9}, {0, 0, -1}).found());
}

TEST(scene_loader, every_bundled_scene_loads_or_asks_for_the_data_folder) {
  const char* before = std::getenv("ZONAL_DATA");
  const std::string kept = before ? before : "";
  unsetenv("ZONAL_DATA");
  size_t loaded = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_dir() + "/scenes")) {
    const std::string file = entry.path().string();
    if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") continue;
    if (file.find("/sweeps/") != std::string::npos) continue;  // those are comparisons
    try {
      const Scene scene = load_scene(file);
      for (const std::string& note : scene.notes()) ADD_FAILURE() << file << ": " << note;
      ++loaded;
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()).find("ZONAL_DATA is not set"), std::string::npos) << error.what();
    }
  }
  if (before) setenv("ZONAL_DATA", kept.c_str(), 1);
  EXPECT_GE(loaded, 5u);  // cornell, atrium and the three analytic ones at least
}

TEST(scene_loader, a_camera_inside_a_closed_box_is_fine) {
  const Scene scene =
      scene_with(R"("objects": [{"type": "box", "low": [-10, -10, -10], "high": [10, 10, 10]}])");
  EXPECT_FLOAT_EQ(scene.intersect(scene.camera().position, scene.camera().forward).t, 19);
}

// ---- camera ------------------------------------------------------------------------------------------

TEST(camera, looks_where_it_is_told) {
  const Camera camera =
      scene_from(R"({"camera": {"position": [1, 2, 3], "look_at": [4, 2, -1], "up": [0, 2, 0],
      "vertical_fov": 60, "resolution": [400, 200], "exposure": 2}})")
          .camera();
  EXPECT_EQ(camera.width, 400);
  EXPECT_EQ(camera.height, 200);
  EXPECT_EQ(camera.exposure, 2.0f);
  EXPECT_FLOAT_EQ(camera.vertical_fov, kPi / 3);
  // (3, 0, -4) / 5 by hand; right is forward x up = (4, 0, 3) / 5.
  EXPECT_LT(glm::length(camera.forward - vec3(0.6f, 0, -0.8f)), 1e-6f);
  EXPECT_LT(glm::length(camera.right - vec3(0.8f, 0, 0.6f)), 1e-6f);
  EXPECT_LT(glm::length(camera.up - vec3(0, 1, 0)), 1e-6f);
  // The middle of the film looks forward; its upper edge lies half the field of view above that.
  EXPECT_LT(glm::length(camera.direction({200, 100}) - camera.forward), 1e-6f);
  EXPECT_NEAR(camera.direction({200, 0}).y, std::sin(kPi / 6), 1e-6f);
}

TEST(camera, straight_down_with_the_default_up_puts_north_on_top) {
  const Camera camera = scene_from(R"({"camera": {"position": [0, 5, 0], "look_at": [0, 0, 0]}})").camera();
  EXPECT_LT(glm::length(camera.up - vec3(0, 0, -1)), 1e-6f);
  EXPECT_LT(glm::length(camera.right - vec3(1, 0, 0)), 1e-6f);
}

TEST(camera, the_command_line_replaces_the_resolution) {
  const std::string text =
      R"({"camera": {"position": [0, 5, 0], "look_at": [0, 0, 0], "resolution": [64, 32]}})";
  const Camera camera = parse_scene(text, "x.json", {.width = 100, .height = 50}).camera();
  EXPECT_EQ(camera.width, 100);
  EXPECT_EQ(camera.height, 50);
}

TEST(camera, comes_from_an_imported_file_and_keeps_what_is_not_replaced) {
  const std::string objects =
      R"("objects": [{"name": "boat", "type": "mesh", "file": "scene_files/sail.gltf", "metres_per_unit": 2}])";
  // The file's camera stands at (0, 0, 7) units of 2 m, looks along -z, and sees 0.5 radians.
  for (const char* from : {R"("from": "eye")", R"("from": 0)", R"("from": "eye", "object": "boat")"}) {
    const Camera camera =
        scene_from("{\"camera\": {" + std::string(from) + R"(, "resolution": [64, 48]}, )" + objects + "}")
            .camera();
    EXPECT_LT(glm::length(camera.position - vec3(0, 0, 14)), 1e-5f) << from;
    EXPECT_LT(glm::length(camera.forward - vec3(0, 0, -1)), 1e-6f) << from;
    EXPECT_NEAR(camera.vertical_fov, 0.5f, 1e-6f) << from;
    EXPECT_EQ(camera.width, 64) << from;
    EXPECT_EQ(camera.height, 48) << from;
  }
  const Camera turned =
      scene_from(R"({"camera": {"from": "eye", "look_at": [14, 0, 14], "vertical_fov": 90}, )" + objects +
                 "}")
          .camera();
  EXPECT_LT(glm::length(turned.position - vec3(0, 0, 14)), 1e-5f);
  EXPECT_LT(glm::length(turned.forward - vec3(1, 0, 0)), 1e-6f);
  EXPECT_FLOAT_EQ(turned.vertical_fov, kPi / 2);
}

TEST(camera, a_wrong_name_lists_the_files_cameras) {
  try {
    scene_from(
        R"({"camera": {"from": "eyes"}, "objects": [{"type": "mesh", "file": "scene_files/sail.gltf"}]})");
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"eye\"?"), std::string::npos) << error.what();
  }
}

// ---- lights ------------------------------------------------------------------------------------------

template <class Kind>
const Kind& only_light(const Scene& scene) {
  const auto* light = dynamic_cast<const Kind*>(scene.lights().at(0).get());
  if (!light) throw std::runtime_error("another kind of light");
  return *light;
}

TEST(light, point_spot_and_sun_with_their_numbers) {
  const Scene a = scene_with(
      R"("lights": [{"name": "a", "type": "point", "position": [1, 2, 3], "intensity": [4, 5, 6]}])");
  EXPECT_EQ(only_light<PointLight>(a).position, vec3(1, 2, 3));
  EXPECT_EQ(only_light<PointLight>(a).intensity, vec3(4, 5, 6));
  EXPECT_EQ(a.lights()[0]->name, "a");
  const Scene b =
      scene_with(R"("lights": [{"type": "spot", "position": [0, 5, 0], "look_at": [3, 1, 0], "intensity": 7,
                                            "inner": 10, "outer": 25}])");
  EXPECT_LT(glm::length(only_light<SpotLight>(b).direction - vec3(0.6f, -0.8f, 0)), 1e-6f);
  EXPECT_FLOAT_EQ(only_light<SpotLight>(b).cone.inner, 10 * kPi / 180);
  EXPECT_FLOAT_EQ(only_light<SpotLight>(b).cone.outer, 25 * kPi / 180);
  EXPECT_EQ(only_light<SpotLight>(b).intensity, vec3(7));
  const Scene c =
      scene_with(R"("lights": [{"type": "directional", "direction": [0, -4, 3], "irradiance": [3, 2, 1]}])");
  EXPECT_LT(glm::length(only_light<DirectionalLight>(c).direction - vec3(0, -0.8f, 0.6f)), 1e-6f);
  EXPECT_EQ(only_light<DirectionalLight>(c).irradiance, vec3(3, 2, 1));
}

TEST(light, power_becomes_intensity_or_radiance) {
  // Phi = 4 pi I.
  const Scene point =
      scene_with(R"("lights": [{"type": "point", "position": [0, 1, 0], "power": [10, 20, 30]}])");
  EXPECT_FLOAT_EQ(only_light<PointLight>(point).intensity.y, 20 / (4 * kPi));
  // A sharp cone of half angle 60 degrees: Phi = 2 pi (1 - cos 60) I = pi I.
  const Scene spot = scene_with(
      R"("lights": [{"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0], "inner": 60, "outer": 60, "power": 5}])");
  EXPECT_NEAR(only_light<SpotLight>(spot).intensity.x, 5 / kPi, 1e-5f);
  // Phi = pi A L: A = 4 pi r^2 for the ball, 6 for the quad, which shines to two sides.
  const Scene ball =
      scene_with(R"("lights": [{"type": "sphere", "center": [0, 0, 0], "radius": 2, "power": 100}])");
  EXPECT_FLOAT_EQ(only_light<SphereLight>(ball).emission.x, 100 / (kPi * 4 * kPi * 4));
  const Scene quad =
      scene_with(R"("lights": [{"type": "quad", "corner": [0, 0, 0], "edges": [[2, 0, 0], [0, 3, 0]],
                                               "power": 60, "two_sided": true}])");
  EXPECT_FLOAT_EQ(quad.lights()[0]->radiance({{1, 1, 0}, {0, 0, 1}, {}, 0}, {0, 0, 1}).x, 60 / (2 * kPi * 6));
  EXPECT_FLOAT_EQ(quad.lights()[0]->radiance({{1, 1, 0}, {0, 0, 1}, {}, 0}, {0, 0, -1}).x,
                  60 / (2 * kPi * 6));
  EXPECT_FLOAT_EQ(quad.lights()[0]->power().x, 60);
}

TEST(light, area_lights_are_black_things_that_can_be_seen) {
  const Scene scene = scene_with(R"("lights": [
      {"type": "sphere", "center": [0, 0, 0], "radius": 1, "radiance": [1, 2, 3]},
      {"type": "quad", "corner": [2, -1, 0], "edges": [[2, 0, 0], [0, 2, 0]], "radiance": 5},
      {"type": "triangle", "vertices": [[-4, -1, 0], [-2, -1, 0], [-4, 1, 0]], "radiance": 7}])");
  const vec3 way(0, 0, -1);
  const auto seen = [&](float x) { return scene.surface(scene.intersect({x, -0.5f, 9}, way), way); };
  EXPECT_EQ(scene.emitted(seen(0)), vec3(1, 2, 3));
  EXPECT_EQ(scene.emitted(seen(3)), vec3(5));
  EXPECT_EQ(scene.emitted(seen(-3.5f)), vec3(7));
  EXPECT_EQ(scene.bsdf(seen(0)).kind, BsdfKind::black);
  // One-sided: dark from behind.
  const Surface behind = scene.surface(scene.intersect({3, -0.5f, -9}, -way), -way);
  EXPECT_EQ(scene.emitted(behind), vec3(0));
}

TEST(light, objects_glow_by_emission_and_keep_their_material) {
  const Scene scene = scene_with(R"("materials": [{"name": "m", "type": "lambert", "albedo": 0.25}],
      "objects": [{"type": "box", "low": [-1, -1, -1], "high": [1, 1, 1], "material": "m", "emission": {"power": 48}}])");
  const vec3 way(0, 0, -1);
  const Surface s = scene.surface(scene.intersect({0.2f, 0.3f, 9}, way), way);
  EXPECT_FLOAT_EQ(scene.emitted(s).x, 48 / (kPi * 24));  // area 6 x 4
  EXPECT_EQ(scene.bsdf(s).diffuse, vec3(0.25f));
}

TEST(light, a_constant_environment_and_a_picture_that_turns) {
  const Scene constant = scene_with(R"("lights": [{"type": "environment", "radiance": [1, 2, 3]}])");
  EXPECT_EQ(constant.environment()->radiance({}, {0, 1, 0}), vec3(1, 2, 3));
  // sky.hdr: the upper half is red, green, blue, yellow from left to right; its middle (u = 0.5) lies along
  // -z, so u = 0.375 (green) lies 45 degrees left of it and u = 0.625 (blue) right. Below it is grey 0.5.
  const auto from = [](const Scene& scene, vec3 towards) {
    return scene.environment()->radiance({}, -glm::normalize(towards));
  };
  const Scene sky =
      scene_with(R"("lights": [{"type": "environment", "file": "scene_files/sky.hdr", "scale": 2}])");
  EXPECT_EQ(from(sky, {-1, 1.2f, -1}), vec3(0, 2, 0));
  EXPECT_EQ(from(sky, {1, 1.2f, -1}), vec3(0, 0, 2));
  EXPECT_EQ(from(sky, {1, -1.2f, -1}), vec3(1));
  // A quarter turn about +y (counter-clockwise from above) brings what lay along -z to -x.
  const Scene turned =
      scene_with(R"("lights": [{"type": "environment", "file": "scene_files/sky.hdr", "rotation": 90}])");
  EXPECT_EQ(from(turned, {-1, 1.2f, -1}), vec3(0, 0, 1));
}

// ---- imported files ----------------------------------------------------------------------------------

Scene room(const std::string& keys, const std::string& rest = "") {
  return scene_with(R"("objects": [{"name": "room", "type": "mesh", "file": "scene_files/room.obj")" + keys +
                    "}]" + rest);
}

/// What is seen looking down on the floor, from under the lamp.
Surface floor_of(const Scene& scene) {
  return scene.surface(scene.intersect({0.1f, 1, 0.2f}, {0, -1, 0}), {0, -1, 0});
}
Surface lamp_of(const Scene& scene) {
  return scene.surface(scene.intersect({0.1f, 1, 0.2f}, {0, 1, 0}), {0, 1, 0});
}

TEST(import, exclusion_leaves_out_by_name_and_by_pattern) {
  // The banner's picture does not exist: the file loads only without it.
  EXPECT_THROW(room(""), SceneError);
  EXPECT_EQ(room(R"(, "exclude": ["banner"])").triangle_count(), 4u);
  EXPECT_EQ(room(R"(, "exclude": ["bann*", "lamp"])").triangle_count(), 2u);
}

TEST(import, a_material_of_the_scene_replaces_the_one_of_its_name) {
  const Scene scene = room(R"(, "exclude": ["banner"])",
                           R"(, "materials": [{"name": "floor", "type": "lambert", "albedo": 0.125}])");
  EXPECT_EQ(scene.bsdf(floor_of(scene)).diffuse, vec3(0.125f));
  EXPECT_FALSE(noted(scene, "not used"));
  const Scene missing_picture =
      room("", R"(, "materials": [{"name": "banner", "type": "lambert", "albedo": 0.125}])");
  EXPECT_EQ(missing_picture.triangle_count(), 5u) << "a replaced material needs no textures";
}

TEST(import, the_objects_material_replaces_all_of_the_files) {
  const Scene scene = room(R"(, "material": "clay")",
                           R"(, "materials": [{"name": "clay", "type": "lambert", "albedo": 0.125}])");
  EXPECT_EQ(scene.materials().size(), 1u);
  EXPECT_EQ(scene.bsdf(floor_of(scene)).diffuse, vec3(0.125f));
  EXPECT_TRUE(scene.lights().empty()) << "the replaced lamp still shines";
}

TEST(import, glowing_materials_become_lights) {
  const Scene scene = room(R"(, "exclude": ["banner"])");
  ASSERT_EQ(scene.lights().size(), 1u);
  EXPECT_EQ(scene.emitted(lamp_of(scene)), vec3(3, 2, 1));  // Ke
  EXPECT_EQ(scene.emitted(floor_of(scene)), vec3(0));
  EXPECT_FLOAT_EQ(scene.lights()[0]->power().x, kPi * 4 * 3);
  const Scene replaced =
      room(R"(, "exclude": ["banner"])", R"(, "materials": [{"name": "lamp", "type": "lambert"}])");
  EXPECT_TRUE(replaced.lights().empty());
}

TEST(import, emission_covers_the_whole_object_and_its_power_is_shared_by_area) {
  const Scene scene =
      room(R"(, "exclude": ["banner"], "metres_per_unit": 2, "emission": {"power": [64, 32, 16]})");
  // Floor and lamp have (2 x 2 m)^2 = 16 square metres each: L = 64 / (pi 32).
  EXPECT_FLOAT_EQ(scene.emitted(floor_of(scene)).x, 64 / (kPi * 32));
  vec3 power(0);
  for (const auto& light : scene.lights()) power += light->power();
  EXPECT_FLOAT_EQ(power.x, 64);
  EXPECT_FLOAT_EQ(power.z, 16);
}

TEST(import, units_and_transform_scale_first_then_place) {
  const Scene scene =
      room(R"(, "exclude": ["banner"], "metres_per_unit": 0.5, "transform": {"translate": [0, 10, 0]})");
  EXPECT_FLOAT_EQ(scene.intersect({0.1f, 10.5f, 0.2f}, {0, -1, 0}).t, 0.5f);
  EXPECT_FLOAT_EQ(scene.intersect({0.1f, 10.5f, 0.2f}, {0, 1, 0}).t, 0.5f);
}

TEST(import, punctual_lights_come_along_unless_refused) {
  const std::string boat = R"("objects": [{"type": "mesh", "file": "scene_files/sail.gltf")";
  const Scene with = scene_with(boat + "}]"), without = scene_with(boat + R"(, "lights": false}])");
  ASSERT_EQ(with.lights().size(), 1u);
  const auto& bulb = only_light<PointLight>(with);
  EXPECT_LT(glm::length(bulb.position - vec3(0, 3, 0)), 1e-6f);
  EXPECT_LT(glm::length(bulb.intensity - vec3(2, 1, 0.5f)), 1e-6f);
  EXPECT_TRUE(without.lights().empty());
}

}  // namespace
}  // namespace zonal
