// Where things end up in the world: transforms against numbers worked out by hand, shapes seen by rays.

#include "core/transform.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/basic_shapes.h"
#include "tests/support.h"

namespace zonal {
namespace {

using nlohmann::json;
using test::scene_from;

vec3 moved(const char* transform, vec3 p) {
  return vec3(read_transform(json::parse(transform), "t").matrix() * vec4(p, 1));
}

const std::string kCamera = R"("camera": {"position": [0, 0, 9], "look_at": [0, 0, 0]})";

Scene scene_with_object(const std::string& object) {
  return scene_from("{" + kCamera + R"(, "objects": [)" + object + "]}");
}

TEST(transform, scales_then_rotates_about_x_y_z_then_translates) {
  // (1, 2, 3) -> scale (2, 2, 3) -> 90 about x: y to z (2, -3, 2) -> 90 about y: z to x (2, -3, -2)
  //           -> 90 about z: x to y (3, 2, -2) -> translate (13, 22, 28). Right angles are exact.
  EXPECT_EQ(moved(R"({"scale": [2, 1, 1], "rotate": [90, 90, 90], "translate": [10, 20, 30]})", {1, 2, 3}),
            vec3(13, 22, 28));
  EXPECT_EQ(moved(R"({"rotate": [90, 0, 0]})", {0, 1, 0}), vec3(0, 0, 1));
  EXPECT_EQ(moved(R"({"rotate": [0, 90, 0]})", {0, 0, 1}), vec3(1, 0, 0));
  EXPECT_EQ(moved(R"({"rotate": [0, 0, 90]})", {1, 0, 0}), vec3(0, 1, 0));
  EXPECT_EQ(moved(R"({"scale": 3})", {1, 2, 3}), vec3(3, 6, 9));
}

TEST(transform, any_angle_turns_like_rodrigues_formula) {
  // v cos a + (k x v) sin a + k (k . v)(1 - cos a); the matrix is made of sines and cosines placed by hand.
  const vec3 v(0.3f, -1.2f, 0.7f);
  for (const int axis : {0, 1, 2})
    for (const float degrees : {30.0f, -77.0f, 123.4f, 400.0f}) {
      vec3 k(0), rotate(0);
      k[axis] = 1, rotate[axis] = degrees;
      const double a = degrees * M_PI / 180;
      const vec3 expected =
          v * float(cos(a)) + glm::cross(k, v) * float(sin(a)) + k * glm::dot(k, v) * float(1 - cos(a));
      Transform t;
      t.rotate = rotate;
      // Three float products of numbers near 1: 1e-6 is eight roundings.
      EXPECT_LT(glm::length(vec3(t.matrix() * vec4(v, 1)) - expected), 1e-6f) << axis << " " << degrees;
    }
}

TEST(transform, matrices_are_written_row_by_row) {
  EXPECT_EQ(moved(R"({"matrix": [1, 2, 0, 10,  0, 1, 0, 20,  0, 0, 1, 30,  0, 0, 0, 1]})", {1, 1, 1}),
            vec3(13, 21, 31));
}

TEST(transform, knows_mirrors_and_uniform_scales) {
  const auto m = [](const char* text) { return read_transform(json::parse(text), "t").matrix(); };
  EXPECT_FALSE(mirrors(m(R"({"scale": [-1, -1, 2], "rotate": [10, 20, 30]})")));
  EXPECT_TRUE(mirrors(m(R"({"scale": -2, "rotate": [10, 20, 30]})")));
  // Rounding the rotation to float leaves 1e-7 of 2.5.
  EXPECT_NEAR(uniform_scale(m(R"({"scale": 2.5, "rotate": [10, 20, 30]})")).value(), 2.5f, 1e-6f);
  EXPECT_FALSE(uniform_scale(m(R"({"scale": [1, 1, 1.01]})")));
  EXPECT_FALSE(uniform_scale(m(R"({"matrix": [1, 0.1, 0, 0,  0, 1, 0, 0,  0, 0, 1, 0,  0, 0, 0, 1]})")));
}

// ---- shapes ------------------------------------------------------------------------------------------

/// Whether the ray meets the outside of what it hits.
bool meets_front(const Scene& scene, vec3 origin, vec3 direction, vec3* normal = nullptr) {
  const Hit hit = scene.intersect(origin, direction);
  EXPECT_TRUE(hit.found());
  if (!hit.found()) return false;
  const Surface s = scene.surface(hit, direction);
  if (normal) *normal = s.normal;
  return s.front;
}

/// All six directions a box can be looked at from.
const vec3 kSides[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

TEST(shapes, boxes_face_outwards_also_mirrored) {
  for (const char* transform :
       {"{}", R"({"scale": [-1, 1, 1]})", R"({"scale": -1})", R"({"scale": [1, -2, -1]})",
        R"({"matrix": [0,1,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1]})"}) {
    const Scene scene = scene_with_object(
        std::string(R"({"type": "box", "low": [-1, -1, -1], "high": [1, 1, 1], "transform": )") + transform +
        "}");
    EXPECT_EQ(scene.triangle_count(), 12u);
    for (const vec3 side : kSides) {
      const vec3 aside = vec3(side.y, side.z, side.x) * 0.3f + vec3(side.z, side.x, side.y) * 0.1f;
      vec3 normal;
      EXPECT_TRUE(meets_front(scene, side * 5.0f + aside, -side, &normal))
          << transform << " " << side.x << side.y;
      EXPECT_LT(glm::length(normal - side), 1e-6f);
      EXPECT_FALSE(meets_front(scene, aside, side)) << transform << " seen from inside";
    }
  }
}

TEST(shapes, box_corners_are_low_and_high) {
  const Scene scene = scene_with_object(R"({"type": "box", "low": [1, 2, 3], "high": [4, 6, 8]})");
  EXPECT_FLOAT_EQ(scene.intersect({2, 4, 20}, {0, 0, -1}).t, 12);
  EXPECT_FLOAT_EQ(scene.intersect({2, 4, -20}, {0, 0, 1}).t, 23);
  EXPECT_FLOAT_EQ(scene.intersect({20, 4, 4}, {-1, 0, 0}).t, 16);
  EXPECT_FLOAT_EQ(scene.intersect({2, 20, 4}, {0, -1, 0}).t, 14);
  EXPECT_FALSE(scene.intersect({4.1f, 4, 20}, {0, 0, -1}).found());
}

TEST(shapes, a_quads_normal_is_the_cross_product_of_its_edges_and_a_mirror_keeps_its_front) {
  const std::string quad = R"({"type": "quad", "corner": [-1, -1, 0], "edges": [[2, 0, 0], [0, 2, 0]])";
  const Scene plain = scene_with_object(quad + "}");
  EXPECT_TRUE(meets_front(plain, {0.3f, 0.2f, 5}, {0, 0, -1}));
  EXPECT_FALSE(meets_front(plain, {0.3f, 0.2f, -5}, {0, 0, 1}));
  // Mirrored in x the plane's outside still shows along +z; mirrored in z it shows along -z.
  const Scene in_x = scene_with_object(quad + R"(, "transform": {"scale": [-1, 1, 1]}})");
  EXPECT_TRUE(meets_front(in_x, {0.3f, 0.2f, 5}, {0, 0, -1}));
  const Scene in_z = scene_with_object(quad + R"(, "transform": {"scale": [1, 1, -1]}})");
  EXPECT_FALSE(meets_front(in_z, {0.3f, 0.2f, 5}, {0, 0, -1}));
}

TEST(shapes, an_imported_mesh_keeps_its_front_under_a_mirror) {
  const std::string mesh = R"({"type": "mesh", "file": "bad_input/triangle.obj", "transform": )";
  EXPECT_TRUE(meets_front(scene_with_object(mesh + "{}}"), {0.2f, 0.2f, 5}, {0, 0, -1}));
  EXPECT_TRUE(
      meets_front(scene_with_object(mesh + R"({"scale": [-1, 1, 1]}})"), {-0.2f, 0.2f, 5}, {0, 0, -1}));
}

TEST(shapes, texture_coordinates_run_over_each_face) {
  const Scene scene = scene_with_object(R"({"type": "box", "low": [0, 0, 0], "high": [2, 4, 1]})");
  // Seen from +z, u goes right and v up.
  const vec3 way(0, 0, -1);
  const Surface s = scene.surface(scene.intersect({0.5f, 3, 5}, way), way);
  EXPECT_NEAR(s.uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(s.uv.y, 0.75f, 1e-6f);
  const Scene quad =
      scene_with_object(R"({"type": "quad", "corner": [0, 0, 0], "edges": [[2, 0, 0], [1, 2, 0]]})");
  const Surface q = quad.surface(quad.intersect({0.25f * 2 + 0.75f * 1, 0.75f * 2, 5}, way), way);
  EXPECT_NEAR(q.uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(q.uv.y, 0.75f, 1e-6f);
}

TEST(shapes, a_sphere_moves_turns_and_grows) {
  const Scene scene = scene_with_object(
      R"({"type": "sphere", "center": [1, 0, 0], "radius": 0.5,
          "transform": {"scale": 2, "rotate": [0, 90, 0], "translate": [0, 3, 0]}})");
  // (1, 0, 0) -> scaled (2, 0, 0) -> 90 about y: x to -z (0, 0, -2) -> (0, 3, -2); radius 1.
  EXPECT_NEAR(scene.intersect({0, 3, 9}, {0, 0, -1}).t, 10.0f, 1e-5f);
  EXPECT_NEAR(scene.intersect({0, 9, -2}, {0, -1, 0}).t, 5.0f, 1e-5f);
}

TEST(shapes, surface_area_in_closed_form) {
  EXPECT_DOUBLE_EQ(surface_area(box_mesh({0, 0, 0}, {1, 2, 3})), 2 * (1 * 2 + 2 * 3 + 1 * 3));
  EXPECT_DOUBLE_EQ(surface_area(quad_mesh({5, 5, 5}, {2, 0, 0}, {1, 3, 0})), 6);
  EXPECT_DOUBLE_EQ(surface_area(triangle_mesh({0, 0, 0}, {2, 0, 0}, {0, 0, 2})), 2);
}

}  // namespace
}  // namespace zonal
