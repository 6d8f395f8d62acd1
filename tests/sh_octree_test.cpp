// The octree of sh_direct: no cracks, fine where the light asks for it, nothing where nobody looks.
#include "integrators/sh_direct/sh_octree.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/light_support.h"

namespace zonal {
namespace {

/// Points on a floor of 4 x 4 m.
std::vector<vec3> floor_points(int count) {
  std::mt19937 bits(11);
  std::uniform_real_distribution<float> number(-2, 2);
  std::vector<vec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(number(bits), 0.01f * number(bits), number(bits));
  return points;
}

/// A few lamps a hand above the floor, many far ones.
ShLights near_and_far(int bands) {
  std::vector<std::unique_ptr<Light>> lights;
  std::mt19937 bits(7);
  std::uniform_real_distribution<float> number(-1, 1);
  for (int i = 0; i < 40; ++i)
    lights.push_back(std::make_unique<SphereLight>(
        test::ball(6.0f * glm::normalize(vec3(number(bits), 1.2f + number(bits), number(bits))), 0.3f)));
  for (const vec3 p : {vec3(0.5f, 0.3f, 0.2f), vec3(-1, 0.25f, 0.7f), vec3(0.1f, 0.4f, -1.3f)})
    lights.push_back(std::make_unique<SphereLight>(test::ball(p, 0.05f)));
  return ShLights(lights, {.bands = bands});
}

/// RMSE of the coefficients, absolute.
template <class Field>
double error_of(const Field& field, const ShLights& lights, int bands, const std::vector<vec3>& points) {
  const int n = 3 * sh::count(bands);
  std::vector<float> L(n), exact(n);
  double error = 0;
  for (const vec3 x : points) {
    EXPECT_TRUE(field.interpolate(x, bands, L.data()));
    lights.coefficients(bands, x, exact.data());
    for (int i = 0; i < n; ++i) error += sqr(double(L[i]) - exact[i]);
  }
  return std::sqrt(error / double(points.size()));
}

TEST(ShOctree, beats_a_uniform_grid_of_as_many_points_by_ten_decibels) {
  const int bands = 5;
  const ShLights lights = near_and_far(bands);
  const std::vector<vec3> points = floor_points(3000);
  const Box box = Box::around(points);
  ShGrid grid(box, {24, 2, 24}, {}, bands);
  grid.need(points);
  grid.build(lights, {});
  ShOctree tree(box, bands, points);
  tree.build(lights, grid.built_points(), [] { return false; }, {});
  const double uniform = error_of(grid, lights, bands, points),
               adaptive = error_of(tree, lights, bands, points);
  fmt::print("{} points: uniform {:.3e}, {} points: octree {:.3e}: {:.1f} dB\n", grid.built_points(), uniform,
             tree.points(), adaptive, 20 * std::log10(uniform / adaptive));
  EXPECT_LE(tree.points(), grid.built_points());
  EXPECT_GT(20 * std::log10(uniform / adaptive), 10);
}

TEST(ShOctree, what_a_light_within_a_cell_may_cost_is_not_underrated) {
  // One small sphere in and around a cell of 1 m, the truth at the cell's positions against the tricubic
  // between its corners: root mean square over positions of the coefficients' norms.
  const int bands = 5, n = 3 * sh::count(bands);
  const ShScheme scheme{ShScheme::Interpolation::hermite, ShScheme::Mixed::hessian};
  std::mt19937 bits(5);
  std::uniform_real_distribution<float> number(0, 1);
  for (int trial = 0; trial < 40; ++trial) {
    const float spread = 1 + 0.1f * float(trial);
    const vec3 center = 0.5f + spread * (vec3(number(bits), number(bits), number(bits)) - 0.5f);
    std::vector<std::unique_ptr<Light>> one;
    one.push_back(std::make_unique<SphereLight>(test::ball(center, 0.05f)));
    const ShLights light(one, {.bands = bands});
    std::vector<float> parts[8], L(n), exact(n);
    std::array<const float*, 8> corners;
    for (int k = 0; k < 8; ++k) {
      parts[k].resize(size_t(kCellParts) * n);
      compute_grid_point(light, scheme, bands, vec3(k & 1, k >> 1 & 1, k >> 2), 0.03f, 1, parts[k].data());
      corners[k] = parts[k].data();
    }
    double error = 0, rated = 0;
    for (int i = 0; i < 500; ++i) {
      const vec3 t(number(bits), number(bits), number(bits));
      combine(scheme, cell_weights(scheme, t, vec3(1)), corners, n / 3, n / 3, L.data());
      light.coefficients(bands, t, exact.data());
      for (int c = 0; c < n; ++c) error += sqr(double(L[c]) - exact[c]);
      rated += sqr(double(light.missed(bands, t, 1)));
    }
    // A corner beside the light spoils more of the cell than the places beside it.
    EXPECT_LT(std::sqrt(error / rated), 2) << center.x << ' ' << center.y << ' ' << center.z;
    fmt::print("{:.2f} ", std::sqrt(error / rated));
  }
  fmt::print("\n");
}

TEST(ShOctree, stops_where_it_is_told_to) {
  const ShLights lights = near_and_far(3);
  const std::vector<vec3> points = floor_points(500);
  double before = 1e9;
  for (const int most : {100, 400, 1600}) {
    ShOctree tree(Box::around(points), 3, points);
    tree.build(lights, most, [] { return false; }, {});
    EXPECT_LE(tree.points(), most);
    EXPECT_GT(tree.points(), most / 2);
    const double error = error_of(tree, lights, 3, points);
    EXPECT_LT(error, before);
    before = error;
  }
  int rounds = 0;
  ShOctree tree(Box::around(points), 3, points);
  tree.build(lights, 1000000, [&] { return ++rounds == 3; }, {});
  EXPECT_EQ(rounds, 3);
}

TEST(ShOctree, has_no_cracks_between_leaves_of_any_size) {
  const int bands = 5, n = 3 * sh::count(bands);
  const ShLights lights = near_and_far(bands);
  // Where points fill space, leaves of many sizes meet.
  std::vector<vec3> points;
  for (const vec3 p : floor_points(6000)) points.emplace_back(p.x, p.y * 50 + 0.6f, p.z);
  ShOctree tree(Box::around(points), bands, points);
  tree.build(lights, 3000, [] { return false; }, {});
  std::vector<float> inside(n), outside(n);
  double worst = 0, mean = 0;
  int faces = 0, steps = 0;
  for (const vec3 p : points) {
    Box box;
    ASSERT_TRUE(tree.leaf(p, &box));
    for (int axis = 0; axis < 3; ++axis)
      for (const bool high : {false, true}) {
        vec3 a = p, b = p;
        const float wall = high ? box.high[axis] : box.low[axis],
                    hair = 1e-6f * (box.high[axis] - box.low[axis]) + 1e-7f;
        a[axis] = wall + (high ? -hair : hair), b[axis] = wall + (high ? hair : -hair);
        Box other;
        if (!tree.leaf(b, &other) || !tree.interpolate(a, bands, inside.data()) ||
            !tree.interpolate(b, bands, outside.data()))
          continue;
        ++faces;
        steps += std::abs((other.high.x - other.low.x) / (box.high.x - box.low.x) - 1) > 0.1f;
        for (int i = 0; i < n; ++i)
          worst = std::max(worst, double(std::abs(inside[i] - outside[i]))), mean += std::abs(inside[i]);
      }
  }
  mean /= double(faces) * n;
  fmt::print("{} faces, {} between sizes; worst step {:.1e} of the mean\n", faces, steps, worst / mean);
  EXPECT_GT(steps, 1000);
  EXPECT_LT(worst / mean, 1e-4);
}

TEST(ShOctree, holds_nothing_where_nobody_looks) {
  const ShLights lights = near_and_far(3);
  const std::vector<vec3> points{vec3(0), vec3(1, 1, 1)};
  ShOctree tree({vec3(-0.1f), vec3(1.1f)}, 3, points);
  tree.build(lights, 60, [] { return false; }, {});
  float L[27];
  EXPECT_TRUE(tree.interpolate(vec3(0.001f), 3, L));
  EXPECT_FALSE(tree.interpolate(vec3(0.5f, 0.1f, 0.9f), 3, L));
  EXPECT_FALSE(tree.interpolate(vec3(5), 3, L));
  EXPECT_FALSE(ShOctree().interpolate(vec3(0), 3, L));
}

}  // namespace
}  // namespace zonal
