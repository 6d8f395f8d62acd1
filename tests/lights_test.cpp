// Every light against closed forms, and its three faces (sample, pdf and hit, emission) against each other.
#include "lights/light.h"

#include <gtest/gtest.h>

#include "tests/light_support.h"

namespace zonal {
namespace {

using namespace test;
using glm::dvec3;

/// The irradiance of a surface at x facing n, by sampling the light; green channel.
Mean irradiance(const Light& light, vec3 x, vec3 n, int samples = 1 << 15) {
  return mean_of(samples, [&] {
    const LightSample s = light.sample(x, random_pair());
    return s.pdf > 0 ? double(s.radiance.y) * std::max(0.0f, glm::dot(n, s.w_in)) / s.pdf : 0.0;
  });
}

/// Lambert's formula for the irradiance of a uniform polygon above the horizon of n (Lambert 1760; Baum et
/// al. 1989).
double polygon_irradiance(std::vector<dvec3> vertices, dvec3 n) {
  double sum = 0;
  for (size_t i = 0; i < vertices.size(); ++i) {
    const dvec3 a = glm::normalize(vertices[i]), b = glm::normalize(vertices[(i + 1) % vertices.size()]);
    const dvec3 cross = glm::cross(a, b);
    sum += std::atan2(glm::length(cross), glm::dot(a, b)) * glm::dot(n, glm::normalize(cross));
  }
  return std::abs(sum) / 2;
}

TEST(point_light, follows_the_inverse_square) {
  PointLight light;
  light.position = {1, 2, 3}, light.intensity = {1, 5, 2};
  const LightSample s = light.sample({1, 2, 7}, {0.5f, 0.5f});
  EXPECT_FLOAT_EQ(s.radiance.y, 5.0f / 16);
  EXPECT_EQ(s.w_in, vec3(0, 0, -1));
  EXPECT_FLOAT_EQ(s.distance, 4);
  EXPECT_TRUE(s.delta);
  EXPECT_FLOAT_EQ(light.power().y, 4 * kPi * 5);
}

TEST(spot_light, is_full_inside_half_way_down_in_the_middle_of_the_edge_and_dark_outside) {
  SpotLight light;
  light.direction = {0, 0, -1}, light.intensity = vec3(8), light.cone = {0.2f, 0.5f};
  const float middle = std::acos(0.5f * (std::cos(0.2f) + std::cos(0.5f)));
  const auto at = [&](float angle) {
    return light.sample(2.0f * vec3(std::sin(angle), 0, -std::cos(angle)), {}).radiance.y;
  };
  EXPECT_FLOAT_EQ(at(0), 2);
  EXPECT_FLOAT_EQ(at(0.199f), 2);
  // The smoothstep is steepest here, 3/2 per width of 0.1 in cosine: a rounding of the cosine moves it by
  // 1e-6.
  EXPECT_NEAR(at(middle), 1, 4e-6);
  EXPECT_EQ(light.sample(vec3(std::sin(0.501f), 0, -std::cos(0.501f)), {}).pdf, 0);
  EXPECT_EQ(light.importance(vec3(std::sin(0.501f), 0, -std::cos(0.501f))), 0);
  EXPECT_EQ(light.sample({0, 0, 1}, {}).pdf, 0);
}

TEST(spot_light, power_is_the_integral_of_its_falloff) {
  for (const vec2 angles : {vec2(0.2f, 0.5f), vec2(0.4f, 0.4f), vec2(0, 1.5f), vec2(0, 1e-4f)}) {
    SpotLight light;
    light.cone = {angles.x, angles.y};
    // Midpoints in the angle: 20000 steps leave 1e-8 of a smooth integrand, 1e-4 of one that jumps at the
    // end.
    double integral = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double angle = (i + 0.5) / n * angles.y, half = std::sin(angle / 2);
      integral += 2 * M_PI * std::sin(angle) * light.falloff_versine(float(2 * half * half)) * angles.y / n;
    }
    EXPECT_NEAR(light.power().y / integral, 1, 1e-4) << angles.x << " " << angles.y;
  }
}

TEST(directional_light, brings_its_irradiance_to_what_faces_it) {
  DirectionalLight light;
  light.direction = {0, -0.6f, 0.8f}, light.irradiance = {1, 4, 2};
  EXPECT_MEAN(irradiance(light, {5, 6, 7}, {0, 1, 0}, 1), 4 * 0.6);
  light.set_scene_bounds({{1, 2, 3}, 2});
  EXPECT_FLOAT_EQ(light.power().y, 4 * kPi * 4);
}

TEST(sphere_light, irradiance_is_pi_L_sin2_cos_for_any_size) {
  for (const double ratio : {1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9}) {
    // Tilted as far as keeps the whole ball above the horizon.
    const double tilt = std::max(0.0, M_PI / 2 - std::asin(ratio)) * 0.9;
    const SphereLight light = ball({0, 0, 10}, static_cast<float>(10 * ratio));
    const double r = light.radius;
    const vec3 n(std::sin(tilt), 0, std::cos(tilt));
    SCOPED_TRACE(ratio);
    EXPECT_MEAN(irradiance(light, vec3(0), n), M_PI * 2 * r * r / 100 * n.z);
  }
}

TEST(sphere_light, density_times_exact_solid_angle_is_one_up_to_touching) {
  for (const double gap : {1e6, 1e3, 1.0, 1e-2, 1e-4, 1e-6}) {
    const float radius = 1,
                d = static_cast<float>(1 + gap);  // d rounds: the truth is computed for what it became
    const SphereLight light = ball({0, 0, 0}, radius);
    const long double ratio = 1.0L / d,
                      solid_angle = 2 * M_PIl * ratio * ratio / (1 + std::sqrt((1 - ratio) * (1 + ratio)));
    EXPECT_NEAR(light.pdf({0, d, 0}, {}) * solid_angle, 1, 1e-6) << "d " << d;
    for (int i = 0; i < 1000; ++i) {
      const LightSample s = light.sample({0, d, 0}, random_pair());
      ASSERT_GT(s.pdf, 0);
      ASSERT_EQ(s.pdf, light.pdf({0, d, 0}, {}));
      ASSERT_NEAR(glm::length(s.w_in), 1, 1e-6);
      // The sampled point lies on the ball. Seen from d it is known to d roundings, and to sqrt(rounding) of
      // the radius along the ray at the silhouette, which moves it off the ball by half a rounding only.
      const dvec3 p = dvec3(0, d, 0) + dvec3(s.w_in) * double(s.distance);
      ASSERT_NEAR(glm::length(p), radius, 4e-7 * (1 + d)) << "d " << d << " distance " << s.distance;
    }
  }
}

TEST(sphere_light, from_inside_it_is_dark_or_a_furnace) {
  const vec3 x(0.3f, -0.4f, 0.1f);
  EXPECT_EQ(irradiance(ball(vec3(0), 1), x, {0, 1, 0}).value, 0);
  EXPECT_EQ(ball(vec3(0), 1).pdf(x, {}), 0);
  EXPECT_EQ(ball(vec3(0), 1).importance(x), 0);
  const SphereLight furnace = ball(vec3(0), 1, true);
  EXPECT_MEAN(irradiance(furnace, x, {0, 1, 0}), M_PI * 2);
  EXPECT_FLOAT_EQ(furnace.pdf(x, {}), 1 / (4 * kPi));
  for (int i = 0; i < 1000; ++i) {
    const LightSample s = furnace.sample(x, random_pair());
    ASSERT_NEAR(glm::length(x + s.w_in * s.distance), 1, 1e-6);
  }
  // On the wall itself only the inward half of the directions meets it.
  EXPECT_MEAN(irradiance(furnace, {0, 1, 0}, {0, -1, 0}), M_PI * 2);
  EXPECT_EQ(irradiance(furnace, {0, 1, 0}, {0, 1, 0}).value, 0);
}

TEST(mesh_light, quad_irradiance_is_lamberts) {
  const MeshLight light = quad({-1, 3, -1}, {2, 0, 0.5f}, {0, 0.3f, 2});
  const MeshLight facing_away = quad({-1, 3, -1}, {0, 0.3f, 2}, {2, 0, 0.5f});
  const std::vector<dvec3> vertices = {{-1, 3, -1}, {1, 3, -0.5f}, {1, 3.3f, 1.5f}, {-1, 3.3f, 1}};
  const bool first_faces_down = glm::cross(vec3(2, 0, 0.5f), vec3(0, 0.3f, 2)).y < 0;
  const MeshLight& down = first_faces_down ? light : facing_away;
  const MeshLight& up = first_faces_down ? facing_away : light;
  for (const vec3 x : {vec3(0), vec3(0.7f, 1, 0.2f), vec3(-3, 0, 1)}) {
    std::vector<dvec3> seen;
    for (const dvec3& v : vertices) seen.push_back(v - dvec3(x));
    EXPECT_MEAN(irradiance(down, x, {0, 1, 0}), 2 * polygon_irradiance(seen, {0, 1, 0}));
    EXPECT_EQ(irradiance(up, x, {0, 1, 0}).value, 0);
    EXPECT_MEAN(irradiance(quad({-1, 3, -1}, {2, 0, 0.5f}, {0, 0.3f, 2}, true), x, {0, 1, 0}),
                2 * polygon_irradiance(seen, {0, 1, 0}));
  }
}

/// Distance along w from x to the triangle, in double (Moller and Trumbore 1997); negative: missed.
double triangle_distance(const MeshLight::Triangle& t, dvec3 x, dvec3 w) {
  const dvec3 ab = dvec3(t.b) - dvec3(t.a), ac = dvec3(t.c) - dvec3(t.a), p = glm::cross(w, ac),
              s = x - dvec3(t.a);
  const double det = glm::dot(ab, p);
  if (det == 0) return -1;
  const double u = glm::dot(s, p) / det;
  const dvec3 q = glm::cross(s, ab);
  const double v = glm::dot(w, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 ? glm::dot(ac, q) / det : -1;
}

TEST(mesh_light, density_integrates_to_one_over_all_directions) {
  // A two-sided tent of three unequal triangles, one without area; the densities of all hits along a ray are
  // summed.
  const std::vector<MeshLight::Triangle> triangles = {{{-1, -0.5f, 2}, {1, -0.5f, 2}, {0, 1, 1.5f}},
                                                      {{2, 0, 0}, {2, 0, 0}, {2, 1, 0}},
                                                      {{-1, 1, -1}, {-1, 2, -2}, {-2, 2, 0.5f}},
                                                      {{-2, -2, -3}, {2, -2, -3}, {2, 2, -3}}};
  const MeshLight light(triangles, vec3(1), true);
  const vec3 x(0.1f, 0.2f, 0);
  const int rows = 600, columns = 1200;
  double integral = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double z = 1 - 2 * (row + 0.5) / rows, phi = 2 * M_PI * (column + 0.5) / columns,
                   r = std::sqrt(1 - z * z);
      const dvec3 w(r * std::cos(phi), r * std::sin(phi), z);
      for (uint32_t i = 0; i < triangles.size(); ++i) {
        const double distance = triangle_distance(triangles[i], dvec3(x), w);
        if (distance <= 0) continue;
        const MeshLight::Triangle& t = triangles[i];
        const dvec3 normal = glm::normalize(glm::cross(dvec3(t.b) - dvec3(t.a), dvec3(t.c) - dvec3(t.a)));
        integral += light.pdf(x, {vec3(dvec3(x) + w * distance), vec3(normal), {}, i});
      }
    }
  }
  // Some 4000 of 70000 lit cells are cut by an edge, each wrong by at most half: 0.03 in the worst case, and
  // 1/sqrt(4000) of that, 0.0005, when they are wrong at random. Allow four times the latter.
  EXPECT_NEAR(integral * 4 * M_PI / (rows * columns), 1, 0.002);
}

TEST(mesh_light, sample_and_pdf_agree) {
  const MeshLight light = quad({-1, 3, -1}, {0, 0, 2}, {2, 0, 0}, true);
  for (int i = 0; i < 1000; ++i) {
    const vec3 x(0.3f, 3 - 3.0f * unit_float(random_bits()), 0.1f);
    const LightSample s = light.sample(x, random_pair());
    if (s.pdf == 0) continue;
    const LightHit hit{x + s.w_in * s.distance, {0, 1, 0}, {}, 0};
    // Grazing, the cosine is known to some roundings of the hit's height: 3e-7 absolute.
    const double cosine = std::abs(s.w_in.y);
    ASSERT_NEAR(light.pdf(x, hit) / s.pdf, 1, 1e-5 + 3e-6 / (cosine * s.distance)) << "height " << 3 - x.y;
  }
}

TEST(mesh_light, edge_on_behind_and_without_area_nothing_arrives) {
  const MeshLight light = quad({0, 0, 0}, {1, 0, 0}, {0, 0, 1});  // faces down
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(light.sample({2, 0, 0.5f}, random_pair()).pdf, 0);
    EXPECT_EQ(light.sample({0.5f, 1, 0.5f}, random_pair()).pdf, 0);
    EXPECT_GT(light.sample({0.5f, -1, 0.5f}, random_pair()).pdf, 0);
  }
  EXPECT_EQ(light.pdf({2, 0, 0.5f}, {{1, 0, 0.5f}, {0, -1, 0}, {}, 0}), 0);
  EXPECT_EQ(light.radiance({{0, 0, 0}, {0, -1, 0}, {}, 0}, {0, 1, 0}), vec3(0));

  const MeshLight flat({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, vec3(1), true);
  EXPECT_EQ(flat.power(), vec3(0));
  EXPECT_EQ(flat.importance({0, 1, 0}), 0);
  EXPECT_EQ(flat.sample({0, 1, 0}, {0.5f, 0.5f}).pdf, 0);
  EXPECT_EQ(flat.pdf({0, 1, 0}, {}), 0);
  EXPECT_EQ(flat.sample_emission({0.5f, 0.5f}, {0.5f, 0.5f}).power, vec3(0));
  EXPECT_EQ(MeshLight({}, vec3(1), false).sample({0, 1, 0}, {0.5f, 0.5f}).pdf, 0);
}

TEST(environment_light, constant_sky_is_a_furnace) {
  const EnvironmentLight sky(1, 1, {vec3(1, 2, 3)}, 0.3f);
  EXPECT_MEAN(irradiance(sky, {1, 2, 3}, glm::normalize(vec3(1, 2, -3))), M_PI * 2);
  EXPECT_FLOAT_EQ(sky.sample({}, {0.2f, 0.7f}).pdf, 1 / (4 * kPi));
}

TEST(environment_light, the_picture_hangs_where_the_header_says) {
  // Texels carry their own number: 0 to 3 above the horizon, 4 to 7 below.
  std::vector<vec3> texels;
  for (int i = 0; i < 8; ++i) texels.emplace_back(float(i));
  const EnvironmentLight sky(4, 2, texels, 0), turned(4, 2, texels, kPi / 2);
  const auto seen = [](const EnvironmentLight& light, vec3 w) {
    return light.radiance({}, -glm::normalize(w)).x;
  };
  // u = 0.5 is the border of columns 1 and 2 and looks along -z; to its right (+x) begins column 2.
  EXPECT_EQ(seen(sky, {0.1f, 0.5f, -1}), 2);
  EXPECT_EQ(seen(sky, {-0.1f, 0.5f, -1}), 1);
  EXPECT_EQ(seen(sky, {0.1f, -0.5f, 1}), 4 + 3);
  EXPECT_EQ(seen(sky, {-0.1f, -0.5f, 1}), 4 + 0);
  // A quarter turn about +y carries what was at -z to -x.
  EXPECT_EQ(seen(turned, {-1, 0.5f, -0.1f}), 2);
  EXPECT_EQ(seen(turned, {-1, 0.5f, 0.1f}), 1);
}

TEST(environment_light, density_and_irradiance_agree_with_quadrature) {
  EnvironmentLight sky = sunny_sky(1.1f);
  sky.set_scene_bounds({{0, 0, 0}, 2});
  const vec3 n = glm::normalize(vec3(-0.5f, 0.7f, 0.4f));
  // The steps follow the texels in latitude but not in azimuth, where the picture is turned: there a texel,
  // the sun among them, is 352 steps wide and wrong by one at most. Midpoints in theta err by (pi/128)^2/24
  // = 2.5e-5.
  const int rows = 16 * 8, columns = 32 * 352;
  double density = 0, truth = 0, fluence = 0;
  for (int row = 0; row < rows; ++row) {
    const double low = M_PI * row / rows, high = M_PI * (row + 1) / rows, theta = (low + high) / 2;
    const double solid_angle = 2 * M_PI / columns * (std::cos(low) - std::cos(high));
    for (int column = 0; column < columns; ++column) {
      const double phi = 2 * M_PI * (column + 0.5) / columns;
      const vec3 w(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      const double radiance = sky.radiance({}, -w).y;
      density += solid_angle * sky.pdf({}, {{}, w, {}, 0});
      fluence += solid_angle * radiance;
      truth += solid_angle * radiance * std::max(0.0f, glm::dot(n, w));
    }
  }
  EXPECT_NEAR(density, 1, 1.0 / 352);
  EXPECT_NEAR(sky.power().y / (fluence * 4 * M_PI), 1, 1.0 / 352);
  const Mean sampled = irradiance(sky, {}, n, 1 << 17);
  EXPECT_NEAR(sampled.value / truth, 1, 1.0 / 352 + 5 * sampled.error / truth);
  EXPECT_GE(sky.importance({}), sampled.value - 5 * sampled.error);
}

TEST(environment_light, sample_and_pdf_agree) {
  const EnvironmentLight sky = sunny_sky(0.4f);
  int differing = 0;
  for (int i = 0; i < 20000; ++i) {
    const LightSample s = sky.sample({}, random_pair());
    ASSERT_GT(s.pdf, 0);
    ASSERT_NEAR(glm::length(s.w_in), 1, 1e-6);
    if (sky.pdf({}, {{}, s.w_in, {}, 0}) != s.pdf || sky.radiance({}, -s.w_in) != s.radiance) ++differing;
  }
  // A direction rounded across a texel's edge sees the neighbour: 48 edges, some 2e-7 of the way around
  // wide, 20000 times: 0.2 on average, and 5 or more once in 400000.
  EXPECT_LE(differing, 4);
  EXPECT_TRUE(std::isfinite(sky.pdf({}, {{}, {0, 1, 0}, {}, 0})));
  EXPECT_TRUE(std::isfinite(sky.pdf({}, {{}, {0, -1, 0}, {}, 0})));
}

}  // namespace
}  // namespace zonal
