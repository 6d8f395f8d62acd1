// Many triangles at once, beside one polygon at a time in double.
#include "sh/triangle_batch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "sh/polygon.h"

namespace zonal::sh {
namespace {

using dvec3 = Vec3<double>;

/// Relative L2 distance.
template <class T>
double distance(const std::vector<T>& a, const std::vector<double>& b) {
  double error = 0, size = 0;
  for (size_t i = 0; i < b.size(); ++i) error += (a[i] - b[i]) * (a[i] - b[i]), size += b[i] * b[i];
  return std::sqrt(error / size);
}

struct Random {
  std::mt19937 bits{3};
  std::uniform_real_distribution<float> number{-1, 1};
  Vec3<float> point() { return {number(bits), number(bits), number(bits)}; }
};

TEST(ShTriangleBatch, each_rule_stays_within_the_tolerance) {
  Random random;
  for (const int bands : {1, 2, 3, 5, 6, 9}) {
    const int n = count(bands);
    for (const double tolerance : {1e-2, 1e-4}) {
      double worst = 0, worst_slope = 0;
      int batched = 0;
      for (int trial = 0; trial < 400; ++trial) {
        TriangleBatch<double> batch;
        dvec3 corner[3];
        for (dvec3& c : corner) c = dvec3(random.point());
        batch.add(corner[0], corner[1], corner[2], dvec3(1), true);
        // From beside the triangle to a hundred times its size away.
        const dvec3 x = glm::normalize(dvec3(random.point())) *
                        std::pow(10.0, 0.2 + 0.9 * (1 + double(random.number(random.bits))));
        if (batch.near(bands, x, tolerance)) continue;
        ++batched;
        std::vector<double> L(3 * size_t(n)), gradient(9 * size_t(n)), exact(n), slopes(3 * size_t(n));
        std::vector<dvec3> slope(n);
        batch.accumulate(bands, x, tolerance, L.data(), gradient.data());
        polygon_light<double>(bands, 3, corner, x, exact.data(), slope.data());
        L.resize(n);
        // Edge-on triangles are judged by their light at its largest coefficient too: the bound is for |n.p|
        // = |p|.
        const double facing =
            std::abs(glm::dot(glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0])),
                              glm::normalize((corner[0] + corner[1] + corner[2]) / 3.0 - x)));
        worst = std::max(worst, distance(L, exact) * std::min(1.0, facing * 4));
        for (int i = 0; i < n; ++i)
          for (int axis = 0; axis < 3; ++axis) slopes[size_t(axis * n + i)] = slope[i][axis];
        gradient.resize(3 * size_t(n));
        worst_slope = std::max(worst_slope, distance(gradient, slopes) * std::min(1.0, facing * 4));
      }
      fmt::print("{} bands, tolerance {}: {:.1e}, gradient {:.1e}, {} batched\n", bands, tolerance, worst,
                 worst_slope, batched);
      EXPECT_GT(batched, 150);
      EXPECT_LT(worst, tolerance) << bands;
      // A derivative is of one degree more, l + 4 for l + 3 and one binomial on: some ten times.
      EXPECT_LT(worst_slope, 10 * tolerance) << bands;
    }
  }
}

TEST(ShTriangleBatch, sums_near_and_far_ones_in_their_colours_and_by_their_sides) {
  Random random;
  for (const int bands : {4, 7}) {
    const int n = count(bands);
    TriangleBatch<float> batch;
    std::vector<double> expected(3 * size_t(n)), one(n), expected_slope(9 * size_t(n));
    std::vector<dvec3> slope(n);
    const Vec3<float> x(0.1f, 0.2f, -0.1f);
    for (int k = 0; k < 200; ++k) {
      const Vec3<float> at = 4.0f * random.point();
      if (glm::length(at) < 1) continue;
      const Vec3<float> a = at + 0.3f * random.point(), b = at + 0.3f * random.point(),
                        c = at + 0.3f * random.point();
      const Vec3<float> colour = glm::abs(random.point());
      const bool both = k % 3 == 0;
      batch.add(a, b, c, colour, both);
      if (!both && !(glm::dot(glm::cross(b - a, c - a), x - a) > 0)) continue;
      const dvec3 corner[3] = {a, b, c};
      polygon_light<double>(bands, 3, corner, dvec3(x), one.data(), slope.data());
      for (int i = 0; i < n; ++i)
        for (int channel = 0; channel < 3; ++channel) {
          expected[size_t(channel * n + i)] += colour[channel] * one[i];
          for (int axis = 0; axis < 3; ++axis)
            expected_slope[size_t((channel * 3 + axis) * n + i)] += colour[channel] * slope[i][axis];
        }
    }
    const int near = batch.near(bands, x, 1e-4f);
    EXPECT_GT(near, 0);
    EXPECT_LT(near, batch.count() / 2);
    std::vector<float> L(3 * size_t(n)), gradient(9 * size_t(n));
    batch.accumulate(bands, x, 1e-4f, L.data(), gradient.data());
    EXPECT_LT(distance(L, expected), 1e-5);
    EXPECT_LT(distance(gradient, expected_slope), 1e-4);
    std::vector<float> alone(3 * size_t(n));
    batch.accumulate(bands, x, 1e-4f, alone.data());
    EXPECT_LT(distance(alone, expected), 1e-5);
  }
}

TEST(ShTriangleBatch, needles_and_edges_on_stay_finite) {
  TriangleBatch<float> batch;
  batch.add({-1, 1, 0}, {1, 1, 0}, {0, 1.000001f, 0}, Vec3<float>(1), true);  // 1:1e6
  batch.add({-1, 0, 2}, {1, 0, 2}, {0, 0, 3}, Vec3<float>(1), true);          // edge-on from the plane y = 0
  batch.add({1, 1, 1}, {1, 1, 1}, {2, 1, 1}, Vec3<float>(1), true);           // no area
  for (const Vec3<float> x :
       {Vec3<float>(0), Vec3<float>(0, 1, -1e-3f), Vec3<float>(0, 1, -1e6f), Vec3<float>(0.5f, 1, 0)}) {
    std::vector<float> L(3 * 81), gradient(9 * 81);
    batch.accumulate(9, x, 1e-4f, L.data(), gradient.data());
    for (const float v : L) EXPECT_TRUE(std::isfinite(v));
    for (const float v : gradient) EXPECT_TRUE(std::isfinite(v));
    EXPECT_GE(L[0], 0);
  }
}

}  // namespace
}  // namespace zonal::sh
