/// Rays that leave a surface never meet it again, and light reaches what it touches, at any scale.

#include <gtest/gtest.h>

#include "tests/geometry_support.h"

using namespace zonal;
using namespace zonal::test;

namespace {

/// Shoots rays at a convex shape from outside, then on from the hit to the side the ray came from: nothing
/// can be there. Returns how many of them met something all the same.
int self_hits(const Scene& scene, vec3 center, float size, int rays, HashRandom& random) {
  int wrong = 0, tried = 0;
  for (int i = 0; i < rays; ++i) {
    const vec3 origin = center + 3 * size * random.direction();
    const vec3 target = center + size * (random.vector() - 0.5f);
    const vec3 w = glm::normalize(target - origin);
    const Hit hit = scene.intersect(origin, w);
    if (!hit.found()) continue;
    const Surface s = scene.surface(hit, w);
    vec3 away = random.direction();
    if (dot(away, s.normal) < 0) away = -away;
    // Every other ray grazes: that is where rounding shows.
    if (i % 2) away = glm::normalize(away - s.normal * (dot(away, s.normal) - 1e-3f * random.number()));
    ++tried;
    const bool ray = scene.occluded(offset_origin(s, away), away, 0, kInfinity);
    const bool segment = scene.occluded(s, s.position + 10 * size * away);
    if (ray || segment) ++wrong;
  }
  EXPECT_GT(tried, rays / 20);
  return wrong;
}

}  // namespace

TEST(SelfShadow, a_single_triangle_of_any_size_and_place_never_shadows_itself) {
  HashRandom random(11);
  for (const float size : {1e-3f, 1.0f, 1e4f}) {
    for (const float distance : {0.0f, 1.0f, 1e2f}) {
      for (int i = 0; i < 20; ++i) {
        const vec3 center = distance * size * random.direction();
        ShapeData shape;
        for (int k = 0; k < 3; ++k) shape.mesh.positions.push_back(center + size * (random.vector() - 0.5f));
        // Every fourth one is a needle, 100 times as long as wide.
        if (i % 4 == 0) {
          const vec3 a = shape.mesh.positions[0], b = shape.mesh.positions[1];
          shape.mesh.positions[2] = 0.5f * (a + b) + 0.01f * (shape.mesh.positions[2] - a);
        }
        shape.mesh.triangles = {{0, 1, 2}};
        const vec3 middle =
            (shape.mesh.positions[0] + shape.mesh.positions[1] + shape.mesh.positions[2]) / 3.0f;
        const Scene scene(one_shape(shape));
        int wrong = 0;
        for (int r = 0; r < 2000; ++r) {
          // Aim at a point of the triangle.
          const vec2 b = uniform_triangle({random.number(), random.number()});
          const auto& p = shape.mesh.positions;
          const vec3 target = (1 - b.x - b.y) * p[0] + b.x * p[1] + b.y * p[2];
          const vec3 origin = middle + 2 * size * random.direction(), w = glm::normalize(target - origin);
          const Hit hit = scene.intersect(origin, w);
          if (!hit.found()) continue;
          const Surface s = scene.surface(hit, w);
          vec3 away = random.direction();
          if (dot(away, s.normal) < 0) away = -away;
          wrong += scene.occluded(offset_origin(s, away), away, 0, kInfinity);
          wrong += scene.occluded(s, s.position + size * away);
          // Through the surface: the other side is left just as well.
          wrong += scene.occluded(offset_origin(s, -away), -away, 0, kInfinity);
        }
        EXPECT_EQ(wrong, 0) << "size " << size << " distance " << distance << " triangle " << i;
      }
    }
  }
}

TEST(SelfShadow, convex_shapes_never_shadow_themselves) {
  HashRandom random(12);
  for (const float size : {1e-3f, 1.0f, 1e4f}) {
    for (const float distance : {0.0f, 10.0f}) {
      const vec3 center = distance * size * random.direction();
      const Scene ball(sphere_scene(center, 0.5f * size));
      EXPECT_EQ(self_hits(ball, center, size, 20000, random), 0)
          << "ball, size " << size << " at " << distance;
      const Scene cube(one_shape(box(center - 0.5f * size, center + 0.5f * size)));
      EXPECT_EQ(self_hits(cube, center, size, 20000, random), 0)
          << "cube, size " << size << " at " << distance;
    }
  }
}

TEST(SelfShadow, a_ball_of_ten_kilometres_under_the_origin_is_flat_ground) {
  // The surface near the origin has small coordinates and a large radius: an offset scaled by position alone
  // fails.
  const Scene scene(sphere_scene({0, -1e4f, 0}, 1e4f));
  HashRandom random(13);
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3 origin = vec3(0, 2, 0) + random.vector(),
               w = glm::normalize(random.direction() - vec3(0, 1.5f, 0));
    const Hit hit = scene.intersect(origin, w);
    if (!hit.found()) continue;
    const Surface s = scene.surface(hit, w);
    vec3 away = random.direction();
    if (dot(away, s.normal) < 0) away = -away;
    wrong += scene.occluded(offset_origin(s, away), away, 0, kInfinity);
  }
  EXPECT_EQ(wrong, 0);
}

TEST(SelfShadow, offsets_stay_small_and_go_to_the_asked_side) {
  for (const float scale : {1e-3f, 1.0f, 1e4f}) {
    const vec3 position = scale * vec3(0.4f, -0.7f, 0.2f), normal = glm::normalize(vec3(1, 2, 3));
    for (const float side : {1.0f, -1.0f}) {
      const vec3 moved = offset_origin(position, normal, side * normal) - position;
      EXPECT_GT(side * dot(moved, normal), 0) << scale;
      EXPECT_LT(length(moved), 1e-5f * scale) << scale;
    }
  }
}

TEST(SelfShadow, a_lamp_standing_on_the_floor_lights_the_floor_beside_it) {
  for (const float scale : {1e-3f, 1.0f, 1e4f}) {
    SceneParts parts;
    parts.shapes.push_back(quad(scale * vec3(-5, 0, 5), scale * vec3(10, 0, 0), scale * vec3(0, 0, -10)));
    // An upright lamp, its lower edge on the floor, facing +z.
    parts.shapes.push_back(quad({0, 0, 0}, scale * vec3(1, 0, 0), scale * vec3(0, 1, 0)));
    const Scene scene(std::move(parts));
    HashRandom random(14);
    int wrong = 0;
    for (int i = 0; i < 20000; ++i) {
      const vec3 below = scale * vec3(random.number(), 0, 0.001f + random.number());
      const vec3 w(0, -1, 0);
      const Surface s = scene.surface(scene.intersect(below + vec3(0, scale, 0), w), w);
      const vec3 lamp = scale * vec3(random.number(), 0.001f + 0.999f * random.number(), 0);
      wrong += scene.occluded(s, lamp);
    }
    EXPECT_EQ(wrong, 0) << "scale " << scale;
  }
}

TEST(SelfShadow, a_closed_room_does_not_leak) {
  // Rays aimed at the shared edges and corners of a box from inside, at a place where floats are coarse.
  const vec3 center(100.3f, -57.1f, 33.7f);
  const Scene scene(one_shape(box(center - 0.5f, center + 0.5f)));
  HashRandom random(15);
  for (int i = 0; i < 200000; ++i) {
    const vec3 origin = center + 0.9f * (random.vector() - 0.5f);
    vec3 target = random.vector() - 0.5f;
    // Two of three coordinates on a wall: an edge; the diagonals of the walls come by themselves.
    target[i % 3] = random.bits() & 1 ? 0.5f : -0.5f;
    target[(i + 1) % 3] = random.bits() & 1 ? 0.5f : -0.5f;
    const vec3 w = glm::normalize(center + target - origin);
    ASSERT_TRUE(scene.intersect(origin, w).found()) << "ray " << i;
  }
}
