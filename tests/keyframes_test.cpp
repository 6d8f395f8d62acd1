// Movement: each key is linear between the keyframes that give it, held outside, and replaces what rests.

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/scene_loader.h"
#include "lights/light.h"

namespace zonal {
namespace {

const char* kMoving = R"({
  "camera": {"position": [0, 0, 9], "look_at": [0, 0, 0], "vertical_fov": 40, "exposure": 2},
  "objects": [{"name": "ball", "type": "sphere", "radius": 0.5, "transform": {"translate": [99, 99, 99]}},
              {"name": "rest", "type": "sphere", "radius": 0.25, "center": [0, 50, 0]}],
  "lights": [{"name": "lamp", "type": "point", "position": [0, 5, 0], "power": 3},
             {"name": "torch", "type": "spot", "position": [0, 2, 0], "direction": [1, 0, 0], "intensity": 1}],
  "keyframes": {
    "camera": [{"frame": 10, "position": [0, 0, 8]},
               {"frame": 20, "vertical_fov": 60},
               {"frame": 30, "position": [4, 0, 8], "vertical_fov": 80}],
    "objects": {"ball": [{"frame": 0, "transform": {"translate": [0, 0, 0]}},
                         {"frame": 4, "transform": {"translate": [8, 0, 0], "scale": 3}}]},
    "lights": {"lamp": [{"frame": 0, "intensity": [1, 2, 3]}, {"frame": 10, "intensity": 5, "position": [1, 5, 0]}],
               "torch": [{"frame": 0, "look_at": [0, 0, 0]}, {"frame": 2, "look_at": [2, 2, 0]}]}
  }})";

Scene at(int frame) {
  return parse_scene(kMoving, "moving.json", {.frame = frame});
}

const float kDegree = kPi / 180;

TEST(keyframes, each_key_runs_between_the_keyframes_that_give_it) {
  EXPECT_EQ(at(20).camera().position, vec3(2, 0, 8));  // half way from 10 to 30; frame 20 gives no position
  EXPECT_EQ(at(15).camera().position, vec3(1, 0, 8));
  EXPECT_FLOAT_EQ(at(25).camera().vertical_fov, 70 * kDegree);
}

TEST(keyframes, values_are_held_before_the_first_and_after_the_last) {
  EXPECT_EQ(at(-5).camera().position, vec3(0, 0, 8));
  EXPECT_EQ(at(10).camera().position, vec3(0, 0, 8));
  EXPECT_EQ(at(1000).camera().position, vec3(4, 0, 8));
  EXPECT_FLOAT_EQ(at(0).camera().vertical_fov, 60 * kDegree);
  EXPECT_FLOAT_EQ(at(99).camera().vertical_fov, 80 * kDegree);
}

TEST(keyframes, what_does_not_move_keeps_its_place) {
  EXPECT_EQ(at(20).camera().exposure, 2.0f);
  EXPECT_NEAR(at(20).intersect({0, 60, 0}, {0, -1, 0}).t, 9.75f, 1e-5f);
}

TEST(keyframes, the_camera_keeps_looking_at_its_target) {
  const Camera camera = at(20).camera();
  const vec3 towards = glm::normalize(vec3(0, 0, 0) - camera.position);
  EXPECT_LT(glm::length(camera.forward - towards), 1e-6f);
}

TEST(keyframes, a_transform_left_out_is_no_movement) {
  // Frame 1 of 4: a quarter of the way to (8, 0, 0), scale a quarter of the way from 1 to 3.
  const Scene scene = at(1);
  EXPECT_NEAR(scene.intersect({2, 0, 9}, {0, 0, -1}).t, 9 - 0.5f * 1.5f, 1e-5f);
  EXPECT_FALSE(at(4).intersect({2, 0, 9}, {0, 0, -1}).found());
  EXPECT_NEAR(at(4).intersect({8, 0, 9}, {0, 0, -1}).t, 9 - 1.5f, 1e-5f);
}

TEST(keyframes, lights_move_and_a_moving_key_replaces_its_alternative) {
  // "intensity" replaces the resting "power", "look_at" the resting "direction".
  const Scene scene = at(5);
  const auto* lamp = dynamic_cast<const PointLight*>(scene.lights()[0].get());
  ASSERT_TRUE(lamp);
  EXPECT_EQ(lamp->intensity, vec3(3, 3.5f, 4));
  EXPECT_EQ(lamp->position, vec3(1, 5, 0));
  const Scene later = at(2);
  const auto* torch = dynamic_cast<const SpotLight*>(later.lights()[1].get());
  ASSERT_TRUE(torch);
  EXPECT_EQ(torch->direction, vec3(1, 0, 0));
  const Scene earlier = at(0);
  EXPECT_EQ(dynamic_cast<const SpotLight*>(earlier.lights()[1].get())->direction, vec3(0, -1, 0));
}

TEST(keyframes, a_bad_value_is_found_whatever_the_frame) {
  const char* text = R"({"camera": {"position": [0, 0, 9], "look_at": [0, 0, 0]},
                         "keyframes": {"camera": [{"frame": 0, "vertical_fov": 40}, {"frame": 9, "vertical_fov": 200}]}})";
  try {
    parse_scene(text, "m.json", {.frame = 0});
    FAIL() << "200 degrees were accepted";
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(),
                 "m.json: /keyframes/camera/1/vertical_fov: found 200, expected a number in (0, 180)");
  }
}

}  // namespace
}  // namespace zonal
