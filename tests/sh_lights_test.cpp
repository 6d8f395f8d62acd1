// All lights of a scene on spherical harmonics, beside the forms of one light and beside differences.
#include "lights/sh_lights.h"

#include <gtest/gtest.h>

#include "sh/polygon.h"
#include "sh/projection.h"
#include "sh/simple_lights.h"
#include "sh/sphere_light.h"
#include "tests/light_support.h"
#include "tests/shaped_light_support.h"

namespace zonal {
namespace {

using Lights = std::vector<std::unique_ptr<Light>>;
using Polygons = ShLightOptions::Polygons;

template <class SomeLight>
void put(Lights& lights, SomeLight light) {
  lights.push_back(std::make_unique<SomeLight>(std::move(light)));
}

/// Relative L2 distance.
double distance(const std::vector<float>& a, const std::vector<float>& b) {
  double error = 0, size = 0;
  for (size_t i = 0; i < a.size(); ++i) error += sqr(double(a[i]) - b[i]), size += sqr(double(b[i]));
  return std::sqrt(error / size);
}

std::vector<float> coefficients(const ShLights& lights, int bands, vec3 x) {
  std::vector<float> L(3 * size_t(sh::count(bands)));
  lights.coefficients(bands, x, L.data());
  return L;
}

SpotLight spot() {
  SpotLight light;
  light.position = vec3(1, 3, -1), light.direction = glm::normalize(vec3(-0.4f, -1, 0.2f));
  light.intensity = vec3(5, 4, 3), light.cone = SpotCone(0.2f, 0.9f);
  return light;
}

/// One light of every kind that hangs on the point.
Lights mixed() {
  Lights lights;
  put(lights, test::ball(vec3(0.5f, 2, 0), 0.4f));
  put(lights, test::ball(vec3(-2, 1, 1), 0.2f));
  PointLight point;
  point.position = vec3(0, 1.5f, 2), point.intensity = vec3(3, 2, 1);
  put(lights, point);
  put(lights, spot());
  put(lights, test::shaped_quad(vec3(1, 2, 1), vec3(0.9f, 0, 0.1f), vec3(0, 0, 0.7f)));
  return lights;
}

TEST(ShLights, sum_what_each_light_sends_alone) {
  const int bands = 7, n = sh::count(bands);
  const vec3 x(0.1f, -0.2f, 0.3f);
  Lights lights = mixed();
  DirectionalLight sun;
  sun.direction = glm::normalize(vec3(0.3f, -1, 0.1f)), sun.irradiance = vec3(0.2f, 0.4f, 0.6f);
  put(lights, sun);
  std::vector<double> expected(3 * size_t(n)), one(n);
  const auto add = [&](vec3 colour) {
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < n; ++i) expected[size_t(c * n + i)] += double(colour[c]) * one[size_t(i)];
  };
  const glm::dvec3 p(x);
  sh::sphere_light<double>(bands, p, {0.5, 2, 0}, 0.4f, one.data()), add(vec3(1, 2, 3));
  sh::sphere_light<double>(bands, p, {-2, 1, 1}, 0.2f, one.data()), add(vec3(1, 2, 3));
  sh::point_light<double>(bands, p, {0, 1.5, 2}, 1, one.data()), add(vec3(3, 2, 1));
  const sh::SpotCone<double> cone{glm::dvec3(spot().direction), std::cos(0.2f), std::cos(0.9f)};
  sh::spot_light<double>(bands, p, {1, 3, -1}, 1, cone, one.data()), add(vec3(5, 4, 3));
  const vec3 a(1, 2, 1), u(0.9f, 0, 0.1f), v(0, 0, 0.7f);
  const glm::dvec3 corners[4] = {a, a + u, a + u + v, a + v};
  ASSERT_GT(glm::dot(glm::cross(u, v), x - a), 0) << "the quad faces the point";
  sh::polygon_light<double>(bands, 4, corners, p, one.data()), add(vec3(1, 2, 3));
  sh::directional_light<double>(bands, glm::dvec3(sun.direction), 1, one.data()), add(sun.irradiance);
  const std::vector<float> L = coefficients(ShLights(lights, {.bands = bands}), bands, x);
  // Sums of six numbers in float, of which the largest coefficient is some 3.
  for (size_t i = 0; i < L.size(); ++i) EXPECT_NEAR(L[i], expected[i], 1e-5) << i;
}

TEST(ShLights, fewer_bands_are_the_first_of_more) {
  Lights lights = mixed();
  put(lights, PictureLight(2, 2, {vec3(1), vec3(2), vec3(3), vec3(4)}, 0.3f));
  const ShLights projected(lights, {.bands = 8});
  const std::vector<float> many = coefficients(projected, 8, vec3(0.2f)),
                           few = coefficients(projected, 3, vec3(0.2f));
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(few[c * 9 + i], many[c * 64 + i], 1e-6 * std::abs(many[c * 64]));
}

TEST(ShLights, gradients_are_those_of_differences) {
  const int bands = 5, n = sh::count(bands);
  const Lights lights = mixed();
  for (const Polygons polygons : {Polygons::exact, Polygons::main, Polygons::alternative,
                                  Polygons::compromise_radius, Polygons::compromise_angle}) {
    for (const float tolerance : {1e-4f, 1e-1f}) {
      const ShLights projected(lights, {.bands = bands, .polygons = polygons, .tolerance = tolerance});
      const vec3 x(0.1f, -0.2f, 0.3f);
      std::vector<float> L(3 * size_t(n)), gradient(9 * size_t(n));
      projected.gradient(bands, x, L.data(), gradient.data());
      EXPECT_LT(distance(L, coefficients(projected, bands, x)), 1e-6);
      for (int axis = 0; axis < 3; ++axis) {
        vec3 step(0);
        step[axis] = 1.0f / 128;
        const std::vector<float> after = coefficients(projected, bands, x + step),
                                 before = coefficients(projected, bands, x - step);
        for (int c = 0; c < 3; ++c)
          for (int i = 0; i < n; ++i) {
            const double slope = (double(after[c * n + i]) - before[c * n + i]) * 64;
            // Rounding of values near 3, 1e-7 each, times 64; the third derivative of Y_4 at 1.5 m and more,
            // a sixth of h^2 times some 20 a metre.
            EXPECT_NEAR(gradient[(c * 3 + axis) * n + i], slope, 4e-4)
                << "polygons " << int(polygons) << " axis " << axis << " colour " << c << " coefficient "
                << i;
          }
      }
    }
  }
}

TEST(ShLights, one_sided_lights_are_black_from_behind) {
  Lights one, two;
  put(one, test::shaped_quad(vec3(-1, 1, -1), vec3(2, 0, 0), vec3(0, 0, 2)));
  put(two, test::shaped_quad(vec3(-1, 1, -1), vec3(2, 0, 0), vec3(0, 0, 2), true));
  for (const Polygons polygons : {Polygons::exact, Polygons::main, Polygons::alternative}) {
    const ShLights back(one, {.polygons = polygons}), both(two, {.polygons = polygons});
    const vec3 lit(0.3f, 0, 0), dark(0.3f, 2, 0);  // cross(u, v) points down
    EXPECT_EQ(coefficients(back, 5, dark)[0], 0) << int(polygons);
    EXPECT_GT(coefficients(both, 5, dark)[0], 0.1f);
    EXPECT_EQ(coefficients(back, 5, lit)[0], coefficients(both, 5, lit)[0]);
  }
}

TEST(ShLights, the_sky_has_the_moments_of_its_texels) {
  // Exact in any picture: the integrals of 1 and of y over a band of latitude are 2 pi (c0 - c1) and
  // pi (c0^2 - c1^2), c the cosines of its edges.
  std::vector<vec3> texels;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) texels.emplace_back(1 + row, column, row * column);
  double mean = 0, up = 0;
  for (int row = 0; row < 3; ++row) {
    const double c0 = std::cos(M_PI * row / 3), c1 = std::cos(M_PI * (row + 1) / 3);
    mean += (1 + row) * 2 * M_PI * (c0 - c1), up += (1 + row) * M_PI * (c0 * c0 - c1 * c1);
  }
  Lights lights;
  put(lights, PictureLight(4, 3, texels, 0.7f));
  const std::vector<float> L = coefficients(ShLights(lights, {.bands = 4}), 4, vec3(0));
  EXPECT_NEAR(L[0], mean * std::sqrt(0.25 / M_PI), 1e-4);
  // Middles of parts a 32nd of 4 bands high: (h^2/24) with h = pi/126.
  EXPECT_NEAR(L[sh::index(1, -1)], -std::sqrt(0.75 / M_PI) * up, 1e-3);
  // And what `radiance` says, by quadrature with as many points as texel edges need.
  const auto nodes = sh::fibonacci_nodes<double>(200000);
  std::vector<double> values(size_t(nodes.size())), expected(16);
  for (int k = 0; k < nodes.size(); ++k)
    values[size_t(k)] = lights[0]->radiance({}, -vec3(nodes.direction(k))).y;
  sh::project_values(4, nodes, values.data(), expected.data());
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(L[size_t(16 + i)], expected[size_t(i)], 5e-3) << i;
}

TEST(ShLights, triangles_are_cut_until_their_spheres_are_good_enough) {
  // A narrow triangle, seen from one metre: aspect 40.
  Lights lights;
  lights.push_back(std::make_unique<TriangleLight>(
      std::vector<MeshLight::Triangle>{{vec3(-1, 1, 0), vec3(1, 1, 0), vec3(0, 1, 0.05f)}}, vec3(1), true));
  const std::vector<float> exact = coefficients(ShLights(lights, {.bands = 5}), 5, vec3(0));
  const double whole =
      distance(coefficients(ShLights(lights, {.bands = 5, .polygons = Polygons::main}), 5, vec3(0)), exact);
  const ShLights cut(lights,
                     {.bands = 5, .polygons = Polygons::main, .split_error = 0.01f, .split_distance = 1});
  EXPECT_GT(whole, 0.1);
  EXPECT_LT(distance(coefficients(cut, 5, vec3(0)), exact), 0.01);
  EXPECT_GT(cut.count(), 8);
  EXPECT_LT(cut.count(), 4096);
}

TEST(ShLights, are_finite_wherever_the_point_is) {
  Lights lights;
  put(lights, test::ball(vec3(0), 1));
  lights.push_back(std::make_unique<TriangleLight>(
      std::vector<MeshLight::Triangle>{{vec3(0, 0, 0), vec3(1, 0, 0), vec3(0.5f, 1e-6f, 0)}}, vec3(1), true));
  PointLight point;
  put(lights, point);
  for (const Polygons polygons : {Polygons::exact, Polygons::main, Polygons::alternative,
                                  Polygons::compromise_radius, Polygons::compromise_angle}) {
    const ShLights projected(lights, {.bands = 9, .polygons = polygons});
    std::vector<float> L(243), gradient(729);
    // Touching, inside, at the centre, 1e6 radii away, in the triangle's plane, on its corner, on its edge.
    for (const vec3 x : {vec3(1, 0, 0), vec3(0, 0.5f, 0), vec3(0), vec3(0, 1e6f, 0), vec3(2, 2, 0),
                         vec3(0.5f, 1e-6f, 0), vec3(0.5f, 0, 0), vec3(0, 1.0000001f, 0)}) {
      projected.coefficients(9, x, L.data());
      for (const float v : L)
        EXPECT_TRUE(std::isfinite(v)) << x.x << ' ' << x.y << ' ' << x.z << " of " << int(polygons);
      EXPECT_GE(L[0], 0);
      projected.gradient(9, x, L.data(), gradient.data());
      for (const float v : gradient)
        EXPECT_TRUE(std::isfinite(v)) << x.x << ' ' << x.y << ' ' << x.z << " of " << int(polygons);
    }
  }
}

}  // namespace
}  // namespace zonal
