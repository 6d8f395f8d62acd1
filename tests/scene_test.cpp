/// Rays and surfaces of a Scene against closed forms in double and brute force over all triangles.

#include "core/scene.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/sampling.h"
#include "tests/geometry_support.h"

using namespace zonal;
using namespace zonal::test;
using glm::dvec3;

TEST(Scene, a_ray_meets_a_sphere_where_the_quadratic_says) {
  for (const float scale : {1e-3f, 1.0f, 1e4f}) {
    const vec3 center = scale * vec3(0.3f, -0.2f, 0.5f);
    const float radius = 0.7f * scale;
    const Scene scene(sphere_scene(center, radius));
    HashRandom random(1);
    int found = 0;
    for (int i = 0; i < 20000; ++i) {
      const vec3 origin = scale * 3.0f * (random.vector() - 0.5f), w = random.direction();
      const dvec3 oc = dvec3(origin) - dvec3(center), d(w);
      const double a = dot(d, d), b = dot(oc, d), c = dot(oc, oc) - double(radius) * radius,
                   disc = b * b - a * c;
      if (std::abs(disc) < 1e-9 * radius * radius) continue;  // too close to call in this formula
      double expected = HUGE_VAL;
      if (disc > 0) {
        const double t0 = (-b - std::sqrt(disc)) / a, t1 = (-b + std::sqrt(disc)) / a;
        expected = t0 > 0 ? t0 : t1 > 0 ? t1 : HUGE_VAL;
      }
      const Hit hit = scene.intersect(origin, w);
      ASSERT_EQ(hit.found(), expected != HUGE_VAL) << "scale " << scale << " ray " << i;
      EXPECT_EQ(scene.occluded(origin, w, 0, kInfinity), hit.found());
      if (!hit.found()) continue;
      ++found;
      // t is rounded to float once.
      EXPECT_NEAR(hit.t, expected, 1e-7 * expected) << "scale " << scale << " ray " << i;
      const Surface s = scene.surface(hit, w);
      const dvec3 p = dvec3(origin) + expected * d, n = normalize(p - dvec3(center));
      // The normal travels as two floats near 1 (6e-8 each, up to 3 times that on the sphere); the position
      // adds its own rounding.
      EXPECT_LT(length(dvec3(s.position) - p), 4e-7 * scale);
      EXPECT_LT(length(dvec3(s.normal) * (s.front ? 1.0 : -1.0) - n), 4e-7);
      EXPECT_EQ(s.front, dot(oc, oc) > double(radius) * radius);
    }
    EXPECT_GT(found, 1000);
  }
}

TEST(Scene, nearest_hits_and_all_hits_agree_with_brute_force) {
  HashRandom random(2);
  const ShapeData soup = triangle_soup(300, random);
  SceneParts parts;
  parts.shapes.push_back(soup);
  parts.shapes.push_back(sphere({0.5f, 0.5f, 0.5f}, 0.2f));
  const Scene scene(std::move(parts));
  std::vector<Hit> all;
  size_t total = 0;
  for (int i = 0; i < 5000; ++i) {
    const vec3 origin = random.vector() * 3.0f - 1.0f, w = random.direction();
    std::vector<double> expected = brute_force(soup.mesh, origin, w);
    for (const double t : sphere_roots({0.5, 0.5, 0.5}, 0.2f, origin, w)) expected.push_back(t);
    std::sort(expected.begin(), expected.end());
    scene.intersect_all(origin, w, 0, &all);
    ASSERT_EQ(all.size(), expected.size()) << "ray " << i;
    for (size_t k = 0; k < all.size(); ++k) {
      // Embree works on corners seen from the origin, up to 4 m away; needles of the soup multiply that by up
      // to 100.
      EXPECT_NEAR(all[k].t, expected[k], 4 * 6e-8 * 100) << "ray " << i << " hit " << k;
    }
    const Hit nearest = scene.intersect(origin, w);
    ASSERT_EQ(nearest.found(), !expected.empty());
    EXPECT_EQ(scene.occluded(origin, w, 0, kInfinity), nearest.found());
    if (nearest.found()) {
      EXPECT_EQ(nearest.shape, all[0].shape);
      EXPECT_EQ(nearest.primitive, all[0].primitive);
      // The interval's ends are honoured.
      EXPECT_FALSE(scene.occluded(origin, w, 0, 0.999f * nearest.t));
    }
    total += all.size();
  }
  EXPECT_GT(total, 1000u);
}

TEST(Scene, a_triangles_surface_interpolates_position_normal_and_uv) {
  ShapeData shape;
  shape.mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  const vec3 tilted = glm::normalize(vec3(0.2f, 0.1f, 1));
  shape.mesh.normals = {{0, 0, 1}, tilted, {0, 0, 1}};
  shape.mesh.uvs = {{0, 0}, {1, 0}, {0, 3}};
  shape.mesh.triangles = {{0, 1, 2}};
  const Scene scene(one_shape(shape));
  const vec3 origin(0.5f, 0.25f, 1);
  for (const float side : {1.0f, -1.0f}) {
    const vec3 w(0, 0, -side);
    const Hit hit = scene.intersect(origin * vec3(1, 1, side), w);
    ASSERT_TRUE(hit.found());
    const Surface s = scene.surface(hit, w);
    EXPECT_LT(length(s.position - vec3(0.5f, 0.25f, 0)), 2e-7f);
    EXPECT_EQ(s.normal, vec3(0, 0, side));
    EXPECT_EQ(s.front, side > 0);
    EXPECT_EQ(s.light_hit().normal, vec3(0, 0, 1));  // as wound, whatever the ray's side
    EXPECT_LT(length(s.uv - vec2(0.25f, 0.375f)), 3e-7f);
    // Barycentrics 0.625, 0.25, 0.125.
    const vec3 n = side * glm::normalize(0.75f * vec3(0, 0, 1) + 0.25f * tilted);
    EXPECT_LT(length(s.shading.z - n), 5e-7f);
    EXPECT_NEAR(dot(s.shading.x, s.shading.z), 0, 3e-7f);
    EXPECT_GT(dot(cross(s.shading.x, s.shading.y), s.shading.z), 0.999999f);
  }
}

TEST(Scene, shading_normals_never_face_away_from_the_viewer) {
  // Vertex normals that point anywhere at all.
  HashRandom random(3);
  ShapeData soup = triangle_soup(200, random);
  for (size_t i = 0; i < soup.mesh.positions.size(); ++i) soup.mesh.normals.push_back(random.direction());
  const Scene scene(one_shape(soup));
  int found = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3 w = random.direction();
    const Hit hit = scene.intersect(random.vector(), w);
    if (!hit.found()) continue;
    ++found;
    const Surface s = scene.surface(hit, w);
    EXPECT_GT(dot(s.shading.z, s.w_out), 0);
    EXPECT_GT(dot(s.shading.z, s.normal), 0);
    EXPECT_GE(dot(s.normal, s.w_out), 0);
    EXPECT_NEAR(length(s.shading.z), 1, 1e-6f);
  }
  EXPECT_GT(found, 5000);
}

TEST(Scene, a_normal_map_tilts_towards_growing_u_and_v_on_both_sides_of_plain_and_mirrored_maps) {
  // Map normal (0.6, 0, 0.8) and (0, 0.6, 0.8): towards +u, towards +v.
  for (const bool along_v : {false, true}) {
    for (const float mirror : {1.0f, -1.0f}) {
      for (const float side : {1.0f, -1.0f}) {
        SceneParts parts;
        const vec3 n = along_v ? vec3(0, 0.6f, 0.8f) : vec3(0.6f, 0, 0.8f);
        parts.textures.push_back(
            std::make_unique<Texture>(1, 1, std::vector<vec4>{vec4(0.5f * n + 0.5f, 1)}));
        parts.materials.push_back(std::make_unique<LambertMaterial>());
        parts.materials[0]->normal_map = parts.textures[0].get();
        ShapeData shape = quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});  // u along x, v along y
        for (vec2& uv : shape.mesh.uvs) uv.x *= mirror;             // u now grows along mirror * x
        shape.material = 0;
        parts.shapes.push_back(shape);
        const Scene scene(std::move(parts));
        const vec3 w(0, 0, -side);
        const Surface s = scene.surface(scene.intersect({0.1f, 0.2f, side}, w), w);
        // Seen from behind, the relief is the same surface, so its normal is the opposite one.
        const vec3 world = along_v ? vec3(0, 0.6f, 0.8f) : vec3(mirror * 0.6f, 0, 0.8f);
        EXPECT_LT(length(s.shading.z - side * world), 1e-6f)
            << "along v " << along_v << " mirror " << mirror << " side " << side;
      }
    }
  }
}

TEST(Scene, masks_let_rays_through_where_they_cut) {
  // Left half cut away: alpha 0 | 1, bilinear, so the edge is in the middle of the quad at u = 1/2.
  for (const bool is_sphere : {false, true}) {
    SceneParts parts;
    parts.textures.push_back(
        std::make_unique<Texture>(2, 1, std::vector<vec4>{vec4(1, 1, 1, 0), vec4(1, 1, 1, 1)}));
    parts.materials.push_back(std::make_unique<LambertMaterial>());
    parts.materials[0]->mask = parts.textures[0].get();
    parts.shapes.push_back(is_sphere ? sphere({0, 0, -1}, 1) : quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    parts.shapes[0].material = 0;
    parts.shapes.push_back(quad({-9, -9, -5}, {18, 0, 0}, {0, 18, 0}));
    const Scene scene(std::move(parts));
    const vec3 w(0, 0, -1), left(-0.4f, 0.1f, 3), right(0.4f, 0.1f, 3);
    EXPECT_EQ(scene.intersect(left, w).shape, 1u) << is_sphere;
    EXPECT_EQ(scene.intersect(right, w).shape, 0u) << is_sphere;
    EXPECT_FALSE(scene.occluded(left, w, 0, 7));
    EXPECT_TRUE(scene.occluded(right, w, 0, 7));
    std::vector<Hit> all;
    scene.intersect_all(left, w, 0, &all);
    EXPECT_EQ(all.size(), 1u);
    scene.intersect_all(right, w, 0, &all);
    // The ray meets a sphere twice, both times on its right half.
    EXPECT_EQ(all.size(), is_sphere ? 3u : 2u);
    const vec3 origins[8] = {left, right, left, right, left, right, left, right};
    EXPECT_EQ(scene.occluded8(origins, 0b00111111, vec3(0.1f, 0.1f, 3) - 7.0f * vec3(0, 0, 1)) & 0b11000000u,
              0u);
  }
}

TEST(Scene, eight_shadow_rays_at_once_equal_eight_single_ones) {
  HashRandom random(4);
  const Scene scene(one_shape(triangle_soup(300, random)));
  int blocked = 0;
  for (int i = 0; i < 2000; ++i) {
    const vec3 to = random.vector() * 2.0f - 0.5f;
    vec3 origins[8];
    for (vec3& o : origins) o = random.vector() * 2.0f - 0.5f;
    const uint32_t active = random.bits() & 0xff;
    const uint32_t together = scene.occluded8(origins, active, to);
    for (int k = 0; k < 8; ++k) {
      const bool wanted = (active >> k) & 1u;
      // The single call is told the same end of the ray: 1e-4 of its length before the point.
      const bool single = wanted && scene.occluded(origins[k], to - origins[k], 0, 1 - 1e-4f);
      EXPECT_EQ(bool((together >> k) & 1u), single) << "group " << i << " ray " << k;
      blocked += single;
    }
  }
  EXPECT_GT(blocked, 1000);
}

TEST(Scene, zero_area_triangles_are_dropped_and_the_others_keep_their_numbers) {
  ShapeData shape = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  shape.name = "patch";
  shape.mesh.positions.push_back({0.5f, 0, 0});
  shape.mesh.uvs.push_back({0.5f, 0});
  // A point, a line, then the two real ones.
  shape.mesh.triangles.insert(shape.mesh.triangles.begin(), {uvec3(1, 1, 1), uvec3(0, 4, 1)});
  const Scene scene(one_shape(shape));
  EXPECT_EQ(scene.triangle_count(), 2u);
  ASSERT_EQ(scene.notes().size(), 1u);
  EXPECT_EQ(scene.notes()[0], "2 zero-area triangles dropped from shape \"patch\"");
  const vec3 w(0, 0, -1);
  EXPECT_EQ(scene.surface(scene.intersect({0.6f, 0.3f, 1}, w), w).primitive, 2u);
  EXPECT_EQ(scene.surface(scene.intersect({0.3f, 0.6f, 1}, w), w).primitive, 3u);
}

TEST(Scene, bad_meshes_are_refused_by_name) {
  const auto message = [](const ShapeData& shape) -> std::string {
    try {
      Scene scene(one_shape(shape));
    } catch (const SceneError& e) {
      return e.what();
    }
    return "no error";
  };
  ShapeData shape = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  shape.name = "patch";
  ShapeData bad = shape;
  bad.mesh.triangles[1].y = 99;
  EXPECT_EQ(message(bad), "shape \"patch\": triangle 1 uses vertex 99, but there are 4 vertices");
  for (const float x : {std::numeric_limits<float>::quiet_NaN(), kInfinity}) {
    bad = shape;
    bad.mesh.positions[2].y = x;
    EXPECT_EQ(message(bad).find("shape \"patch\": vertex 2 is (1, "), 0u) << message(bad);
  }
  bad = sphere({0, 0, 0}, -1);
  EXPECT_NE(message(bad).find("radius -1"), std::string::npos) << message(bad);
  EXPECT_EQ(message(shape), "no error");
}

TEST(Scene, an_empty_scene_misses_every_ray) {
  SceneParts parts;
  parts.camera.position = {1, 2, 3};
  const Scene scene(std::move(parts));
  EXPECT_FALSE(scene.intersect({0, 0, 0}, {0, 0, 1}).found());
  EXPECT_FALSE(scene.occluded({0, 0, 0}, {0, 0, 1}, 0, kInfinity));
  std::vector<Hit> all;
  scene.intersect_all({0, 0, 0}, {0, 0, 1}, 0, &all);
  EXPECT_TRUE(all.empty());
  EXPECT_EQ(scene.bounds().center, vec3(1, 2, 3));
  EXPECT_EQ(scene.bounds().radius, 1);
}

TEST(Scene, the_bounding_sphere_is_the_smallest_one_and_turns_with_the_scene) {
  // A box's smallest sphere has its diagonal for a diameter. Allowed: 0.1 % too large.
  const float truth = 0.5f * length(vec3(2, 3, 5));
  HashRandom random(5);
  for (int turn = 0; turn < 20; ++turn) {
    const Frame frame(random.direction());
    ShapeData shape = box({-1, 0, 0}, {1, 3, 5});
    for (vec3& p : shape.mesh.positions) p = frame.to_world(p);
    const Scene scene(one_shape(shape));
    EXPECT_NEAR(scene.bounds().radius, truth, 1e-3f * truth);
    EXPECT_LT(length(scene.bounds().center - frame.to_world({0, 1.5f, 2.5f})), 0.05f * truth);
  }
  // Two balls of radii 1 and 2, 5 m apart: (1 + 5 + 2) / 2.
  SceneParts parts;
  parts.shapes = {sphere({0, 0, 0}, 1), sphere({5, 0, 0}, 2)};
  EXPECT_NEAR(Scene(std::move(parts)).bounds().radius, 4, 4e-3f);
}

TEST(Camera, film_points_map_to_directions) {
  Camera camera;  // looks along -z, up is y
  camera.width = 200, camera.height = 100, camera.vertical_fov = 0.5f * kPi;
  // tan 45 degrees = 1: the film is 2 high and 4 wide at distance 1.
  EXPECT_LT(length(camera.direction({100, 50}) - vec3(0, 0, -1)), 1e-6f);
  EXPECT_LT(length(camera.direction({0, 0}) - glm::normalize(vec3(-2, 1, -1))), 1e-6f);
  EXPECT_LT(length(camera.direction({200, 100}) - glm::normalize(vec3(2, -1, -1))), 1e-6f);
  EXPECT_LT(length(camera.direction({150, 25}) - glm::normalize(vec3(1, 0.5f, -1))), 1e-6f);
}
