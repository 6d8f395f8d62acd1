// The rays of flux that lights and their grids send out, against what sampling the same lights receives.
#include <gtest/gtest.h>

#include "lights/emission_grid.h"
#include "tests/light_support.h"
#include "tests/shaped_light_support.h"

namespace zonal {
namespace {

using namespace test;

/// Flux through the square of side 2 around the origin, normal +y, by emission rays and by the irradiance at
/// its points.
void expect_same_flux(const Light& light, const char* what) {
  const Mean emitted = mean_of(1 << 18, [&] {
    const vec2 u = random_pair();
    const EmissionSample ray = light.sample_emission(u, random_pair());
    const float t = -ray.origin.y / ray.direction.y;
    const vec3 p = ray.origin + t * ray.direction;
    return ray.direction.y < 0 && t > 0 && std::abs(p.x) < 1 && std::abs(p.z) < 1 ? double(ray.power.y) : 0.0;
  });
  const Mean received = mean_of(1 << 18, [&] {
    const vec2 p = 2.0f * random_pair() - vec2(1);
    const LightSample s = light.sample({p.x, 0, p.y}, random_pair());
    return s.pdf > 0 ? 4.0 * s.radiance.y * std::max(0.0f, s.w_in.y) / s.pdf : 0.0;
  });
  // Five standard errors of the difference. Both must be known to a few per cent, or the test says nothing.
  const double error = std::hypot(emitted.error, received.error);
  EXPECT_LT(error, 0.03 * received.value) << what;
  EXPECT_NEAR(emitted.value, received.value, 5 * error) << what;
}

TEST(emission, carries_the_flux_that_sampling_receives) {
  PointLight point;
  point.position = {0.5f, 0.8f, 0.2f};
  expect_same_flux(point, "point");
  SpotLight spot;
  spot.position = {0.3f, 2, -0.4f}, spot.direction = glm::normalize(vec3(0.1f, -1, 0.2f));
  spot.cone = {0.2f, 0.7f};
  expect_same_flux(spot, "spot");
  DirectionalLight sun;
  sun.direction = glm::normalize(vec3(0.5f, -1, 0.2f));
  sun.set_scene_bounds({{0.1f, 0.2f, -0.1f}, 2});
  expect_same_flux(sun, "directional");
  expect_same_flux(ball({0.2f, 1.5f, 0.3f}, 0.7f), "sphere");
  expect_same_flux(ball({0.2f, 0.5f, 0.3f}, 3, true), "sphere from inside");
  expect_same_flux(quad({-0.5f, 1, -0.5f}, {1, 0, 0.2f}, {0, 0.1f, 1}), "quad");
  expect_same_flux(quad({-0.5f, 1, -0.5f}, {0, 0.1f, 1}, {1, 0, 0.2f}, true), "two-sided quad");
  expect_same_flux(bright_panel({-0.5f, 1, -0.5f}, {1, 0, 0.2f}, {0, 0.1f, 1}), "textured");
  expect_same_flux(bright_panel({-0.5f, 1, -0.5f}, {0, 0.1f, 1}, {1, 0, 0.2f}, true), "two-sided textured");
  EnvironmentLight sky = sunny_sky(0.4f);
  sky.set_scene_bounds({{0.1f, 0.2f, -0.1f}, 2});
  expect_same_flux(sky, "environment");
}

TEST(emission, mean_power_is_the_total_power) {
  // Mesh and environment rays differ in power; their mean must be the closed form.
  const MeshLight mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{5, 0, 0}, {5, 1e-4f, 0}, {5, 0, 1e-4f}}},
                       vec3(1, 2, 3), true);
  EXPECT_MEAN(mean_of(1 << 15, [&] { return mesh.sample_emission(random_pair(), random_pair()).power.y; }),
              2 * M_PI * 2 * (0.5 + 0.5e-8));
  const SphereLight sphere = ball(vec3(1), 0.5f);
  EXPECT_MEAN(mean_of(100, [&] { return sphere.sample_emission(random_pair(), random_pair()).power.y; }),
              M_PI * 2 * 4 * M_PI * 0.25);
}

TEST(every_light, stays_finite_at_touching_coinciding_and_far_points) {
  PointLight point;
  SpotLight spot;
  DirectionalLight sun;
  const SphereLight sphere = ball(vec3(0), 1), furnace = ball(vec3(0), 1, true),
                    speck = ball(vec3(0), 1e-30f);
  const MeshLight mesh = quad({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, true);
  const TexturedLight panel = bright_panel({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, true);
  const EnvironmentLight sky = sunny_sky(0);
  const std::vector<const Light*> lights = {&point, &spot, &sun,   &sphere, &furnace,
                                            &speck, &mesh, &panel, &sky};
  const std::vector<vec3> places = {{0, 0, 0},           {1, 0, 0},          {0, 1, 0},
                                    {0.6f, 0.8f, 0},     {1.0000001f, 0, 0}, {0.5f, 0, 0},
                                    {0, 1e-30f, 0},      {1e15f, 0, 0},      {0, -1e25f, 0},
                                    {1e-15f, 1e-15f, 0}, {0.999999f, 0, 0},  {0.5f, 1e-7f, 0.5f}};
  for (const Light* light : lights) {
    for (const vec3 x : places) {
      SCOPED_TRACE(testing::Message() << light->type() << " from " << x.x << " " << x.y << " " << x.z);
      ASSERT_TRUE(std::isfinite(light->importance(x)) && light->importance(x) >= 0);
      for (int i = 0; i < 200; ++i) {
        const vec2 u = i == 0 ? vec2(0) : i == 1 ? vec2(0x1.fffffep-1f) : random_pair();
        const LightSample s = light->sample(x, u);
        ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0);
        if (s.pdf == 0) continue;
        ASSERT_TRUE(is_finite(s.radiance) && is_finite(s.w_in) && s.distance > 0);
        ASSERT_NEAR(glm::length(s.w_in), 1, 2e-6);
        ASSERT_GT(light->importance(x), 0) << "a light that reaches x may be chosen there";
        const float pdf = light->pdf(x, {x + s.w_in, -s.w_in, {}, 0});
        ASSERT_TRUE(std::isfinite(pdf) && pdf >= 0);
      }
    }
    for (int i = 0; i < 200; ++i) {
      const vec2 u = i == 0 ? vec2(0) : i == 1 ? vec2(0x1.fffffep-1f) : random_pair();
      const EmissionSample ray = light->sample_emission(u, i < 2 ? u : random_pair());
      ASSERT_TRUE(is_finite(ray.origin) && is_finite(ray.power)) << light->type();
      ASSERT_NEAR(glm::length(ray.direction), 1, 2e-6) << light->type();
    }
  }
}

TEST(emission_grid, takes_the_rectangle_nearest_to_the_number) {
  const SpotLight spot;
  const PointLight point;
  EXPECT_EQ(EmissionGrid(spot, 400).columns(), 20);
  EXPECT_EQ(EmissionGrid(spot, 400).rows(), 20);
  EXPECT_EQ(EmissionGrid(spot, 7).cells(), 6);
  EXPECT_EQ(EmissionGrid(spot, 1).cells(), 1);
  EXPECT_EQ(EmissionGrid(point, 600).cells(), 600);
  SpotLight wide;
  wide.cone = {0.3f, 1.5f};
  EXPECT_FALSE(EmissionGrid::suits(wide));
  EXPECT_FALSE(EmissionGrid::suits(ball(vec3(0), 1)));
}

TEST(emission_grid, rays_carry_the_intensity_times_the_solid_angle_of_any_cone) {
  PointLight point;
  point.intensity = vec3(3);
  SpotLight spot;
  spot.direction = glm::normalize(vec3(1, -2, 0.5f)), spot.intensity = vec3(3), spot.cone = {0.3f, 1.2f};
  // The point light's cone looks at a corner of the cube, where the cells fill the smallest solid angle.
  const vec3 corner = glm::normalize(vec3(1, 1, 1));
  struct Case {
    const Light* light;
    vec3 axis;
    float angle;
    double truth;
  };
  const double full = 2 * M_PI * (1 - std::cos(0.3)), edge = 2 * M_PI * (std::cos(0.3) - std::cos(1.2));
  const std::vector<Case> cases = {{&point, corner, 4, 4 * M_PI * 3},
                                   {&point, corner, 0.3f, 3 * full},
                                   {&spot, spot.direction, 4, 3 * (full + edge / 2)},
                                   {&spot, spot.direction, 0.3f, 3 * full}};
  for (const Case& c : cases) {
    const EmissionGrid grid(*c.light, 96);
    // One estimate: a jittered ray through every cell.
    const Mean flux = mean_of(4000, [&] {
      double sum = 0;
      for (int cell = 0; cell < grid.cells(); ++cell) {
        const EmissionSample ray = grid.sample(cell, random_pair());
        if (glm::dot(ray.direction, c.axis) > std::cos(std::min(c.angle, kPi))) sum += ray.power.y;
      }
      return sum;
    });
    // Cells at a cube's corner fill a fifth of the solid angle of those at its centre: 1.5 % tells.
    EXPECT_LT(flux.error, 0.015 * c.truth);
    EXPECT_NEAR(flux.value, c.truth, 5 * flux.error + 1e-5 * c.truth)
        << c.light->type() << " cone " << c.angle;
  }
}

TEST(emission_grid, of_the_sun_covers_the_scene_and_no_more) {
  DirectionalLight sun;
  sun.direction = glm::normalize(vec3(0.5f, -1, 0.2f)), sun.irradiance = vec3(2);
  sun.set_scene_bounds({{1, 2, 3}, 5});
  const EmissionGrid grid(sun, 100);
  const Mean flux = mean_of(2000, [&] {
    double sum = 0;
    for (int cell = 0; cell < grid.cells(); ++cell) {
      const EmissionSample ray = grid.sample(cell, random_pair());
      EXPECT_EQ(ray.direction, sun.direction);
      EXPECT_GE(glm::length(ray.origin - vec3(1, 2, 3)), 5);
      sum += ray.power.y;
    }
    return sum;
  });
  EXPECT_NEAR(flux.value, 2 * M_PI * 25, 5 * flux.error);
}

}  // namespace
}  // namespace zonal
