// Random numbers: the stratification they promise, and the maps and distributions built on them.
#include "core/sampling.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace zonal {
namespace {

/// 5 standard deviations of a mean of n numbers of variance `variance`: passed by chance but once in 1.7
/// million.
double five_sigma(double variance, int n) {
  return 5 * std::sqrt(variance / n);
}

/// Chi-square statistic, and the value that chance exceeds once in a million (Wilson and Hilferty 1931).
double chi_square(const std::vector<int>& observed, const std::vector<double>& expected) {
  double sum = 0;
  for (size_t i = 0; i < observed.size(); ++i)
    sum += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
  return sum;
}
double chi_square_limit(double freedom) {
  const double c = 2 / (9 * freedom);
  return freedom * std::pow(1 - c + 4.75 * std::sqrt(c), 3);
}

TEST(sampler, every_elementary_interval_of_a_block_of_passes_holds_one_sample) {
  for (const uint64_t seed : {0ull, 1ull, 123456789012345ull}) {
    for (int dimension = 0; dimension < 3; ++dimension) {
      for (int k = 0; k <= 10; ++k) {
        for (const uint32_t block : {0u, 1u, 5u, 1000u}) {
          const uint32_t n = 1u << k;
          std::vector<vec2> points;
          for (uint32_t pass = block * n; pass < (block + 1) * n; ++pass) {
            Sampler sampler(seed, 77, pass);
            for (int d = 0; d < dimension; ++d) sampler.next_2d();
            points.push_back(sampler.next_2d());
          }
          // Boxes 2^-a wide and 2^-(k-a) high: the definition of a (0,2)-sequence in base 2.
          for (int a = 0; a <= k; ++a) {
            std::vector<int> count(n, 0);
            for (const vec2 p : points) {
              const auto x = static_cast<uint32_t>(std::ldexp(p.x, a));
              const auto y = static_cast<uint32_t>(std::ldexp(p.y, k - a));
              ++count[(y << a) | x];
            }
            for (const int c : count)
              ASSERT_EQ(c, 1) << "seed " << seed << " dimension " << dimension << " block " << block << " of "
                              << n << " boxes 2^-" << a;
          }
        }
      }
    }
  }
}

TEST(sampler, every_interval_of_a_block_of_passes_holds_one_1d_sample) {
  for (const uint32_t block : {0u, 3u}) {
    std::vector<int> count(4096, 0);
    for (uint32_t pass = block * 4096; pass < (block + 1) * 4096; ++pass) {
      Sampler sampler(9, 4, pass);
      sampler.next_2d();
      ++count[static_cast<size_t>(sampler.next_1d() * 4096)];
    }
    for (const int c : count) ASSERT_EQ(c, 1);
  }
}

TEST(sampler, same_seed_stream_pass_and_order_give_the_same_numbers) {
  Sampler a(5, 6, 7), b(5, 6, 7);
  for (int i = 0; i < 20; ++i) {
    const vec2 p = a.next_2d(), q = b.next_2d();
    EXPECT_EQ(p, q);
    EXPECT_EQ(a.next_1d(), b.next_1d());
  }
}

TEST(sampler, single_passes_are_uniform_over_streams) {
  // One pass of many pixels: independent numbers, mean 1/2 and variance 1/12 each.
  const int n = 1 << 16;
  for (uint32_t pass : {0u, 1u, 2u}) {
    double sum_x = 0, sum_y = 0, product = 0;
    for (int stream = 0; stream < n; ++stream) {
      const vec2 p = Sampler(3, static_cast<uint32_t>(stream), pass).next_2d();
      sum_x += p.x, sum_y += p.y, product += (p.x - 0.5) * (p.y - 0.5);
    }
    EXPECT_NEAR(sum_x / n, 0.5, five_sigma(1.0 / 12, n)) << "pass " << pass;
    EXPECT_NEAR(sum_y / n, 0.5, five_sigma(1.0 / 12, n)) << "pass " << pass;
    EXPECT_NEAR(product / n, 0, five_sigma(1.0 / 144, n)) << "pass " << pass;
  }
}

TEST(sampler, seeds_streams_and_dimensions_are_uncorrelated) {
  // The product of two independent centred uniforms has variance 1/144.
  const int n = 1 << 14;
  const auto correlation = [&](auto&& a, auto&& b) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += (a(uint32_t(i)) - 0.5) * (b(uint32_t(i)) - 0.5);
    return sum / n;
  };
  const auto first = [](uint64_t seed, uint32_t stream) {
    return [=](uint32_t pass) { return static_cast<double>(Sampler(seed, stream, pass).next_2d().x); };
  };
  const auto later = [](int dimension) {
    return [=](uint32_t pass) {
      Sampler sampler(1, 1, pass);
      for (int d = 0; d < dimension; ++d) sampler.next_2d();
      return static_cast<double>(sampler.next_2d().x);
    };
  };
  const double limit = five_sigma(1.0 / 144, n);
  for (uint32_t other = 2; other < 10; ++other) {
    EXPECT_NEAR(correlation(first(1, 1), first(other, 1)), 0, limit) << "seed " << other;
    EXPECT_NEAR(correlation(first(1, 1), first(1ull + (uint64_t{other} << 32), 1)), 0, limit)
        << "high seed " << other;
    EXPECT_NEAR(correlation(first(1, 1), first(1, other)), 0, limit) << "stream " << other;
    EXPECT_NEAR(correlation(later(0), later(int(other))), 0, limit) << "dimension " << other;
  }
}

TEST(maps, have_the_moments_of_their_densities) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  const int n = 1 << 17;
  double disk = 0, cosine = 0, sphere_z2 = 0, cone = 0, triangle_x = 0, triangle_xy = 0;
  vec3 sphere(0);
  for (int i = 0; i < n; ++i) {
    const vec2 u(uniform(random), uniform(random));
    disk += glm::dot(concentric_disk(u), concentric_disk(u));
    cosine += cosine_hemisphere(u).z;
    const vec3 s = uniform_sphere(u);
    ASSERT_NEAR(glm::length(s), 1, 1e-6);
    sphere += s, sphere_z2 += s.z * s.z;
    cone += 1 - uniform_cone(u, 0.5f).z;
    const vec2 t = uniform_triangle(u);
    ASSERT_TRUE(t.x >= 0 && t.y >= 0 && t.x + t.y <= 1 + 1e-6f);
    triangle_x += t.x, triangle_xy += t.x * t.y;
  }
  // Means and variances by integrating the densities; variances rounded up.
  EXPECT_NEAR(disk / n, 0.5, five_sigma(1.0 / 12, n));        // r^2 is uniform
  EXPECT_NEAR(cosine / n, 2.0 / 3, five_sigma(1.0 / 18, n));  // density 2 cos d(cos)
  EXPECT_NEAR(sphere_z2 / n, 1.0 / 3, five_sigma(4.0 / 45, n));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sphere[k] / n, 0, five_sigma(1.0 / 3, n));
  EXPECT_NEAR(cone / n, 0.25, five_sigma(0.25 / 12, n));  // 1 - cos is uniform in [0, 1/2]
  EXPECT_NEAR(triangle_x / n, 1.0 / 3, five_sigma(1.0 / 18, n));
  EXPECT_NEAR(triangle_xy / n, 1.0 / 12, five_sigma(1.0 / 180, n));  // E = 1/12; E of its square = 1/90
}

TEST(maps, tiny_cones_keep_their_shape) {
  // sin^2 of the angle is uniform in [0, 2 versine] to first order, far below where 1 - cos can be told from
  // 0.
  const float versine = 1e-14f;
  for (const float u : {0.1f, 0.5f, 0.9f}) {
    const vec3 w = uniform_cone({u, 0.3f}, versine);
    const double sine2 = double(w.x) * w.x + double(w.y) * w.y;
    EXPECT_NEAR(sine2 / (2.0 * versine * u), 1, 1e-5);
  }
}

TEST(discrete, probability_is_exactly_the_share_of_numbers_mapped_to_an_index) {
  const std::array<float, 6> weights = {3, 0, 1e-20f, 5, 0.001f, 0};
  const Discrete distribution(weights);
  std::vector<uint32_t> count(weights.size(), 0);
  for (uint32_t bits = 0; bits < (1u << 24); ++bits) ++count[distribution.sample(unit_float(bits << 8))];
  for (uint32_t i = 0; i < weights.size(); ++i)
    EXPECT_EQ(count[i] * 0x1p-24f, distribution.probability(i)) << i;
  EXPECT_EQ(count[1], 0u);
  EXPECT_EQ(count[5], 0u);
  EXPECT_GE(count[2], 1u);  // a positive weight is never lost
  // Three cells at most are off what exact proportions would give.
  for (uint32_t i = 0; i < weights.size(); ++i)
    EXPECT_NEAR(distribution.probability(i), weights[i] / 8.001, 4 * 0x1p-24);
  EXPECT_NEAR(distribution.total(), 8.001, 1e-6);
}

TEST(discrete, what_is_left_of_the_number_is_uniform_even_among_a_million) {
  std::mt19937 random(2);
  for (const size_t size : {3u, 1000000u}) {
    const Discrete distribution(std::vector<float>(size, 1.0f));
    std::vector<int> count(64, 0);
    const int n = 1 << 16;
    double probability = 0;
    for (uint32_t i = 0; i < size; ++i) probability += distribution.probability(i);
    EXPECT_EQ(probability, 1.0);
    for (int i = 0; i < n; ++i) {
      float left = -1;
      distribution.sample(unit_float(random()), &left);
      ASSERT_TRUE(left >= 0 && left < 1);
      ++count[static_cast<size_t>(left * 64)];
    }
    EXPECT_LT(chi_square(count, std::vector<double>(64, n / 64.0)), chi_square_limit(63))
        << size << " indices";
  }
}

TEST(discrete, unusable_weights_count_as_zero_and_all_zero_is_uniform) {
  const std::array<float, 4> odd = {NAN, -1, INFINITY, 2};
  EXPECT_EQ(Discrete(odd).probability(3), 1.0f);
  const std::array<float, 4> none = {0, 0, 0, 0};
  for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(Discrete(none).probability(i), 0.25f);
  EXPECT_EQ(Discrete(none).total(), 0);
  EXPECT_EQ(Discrete().size(), 0u);
  EXPECT_EQ(Discrete().probability(0), 0.0f);
}

TEST(piecewise_2d, samples_follow_the_weights_and_the_density_integrates_to_one) {
  const int width = 5, height = 3;
  const std::vector<float> weights = {1, 2, 3, 4, 5, 0, 0, 0, 0, 0, 7, 0, 1, 0, 2};
  const Piecewise2D distribution(weights, width, height);
  double integral = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      integral += distribution.pdf({(x + 0.5f) / width, (y + 0.5f) / height}) / (width * height);
  EXPECT_NEAR(integral, 1, 1e-6);

  std::mt19937 random(3);
  const int n = 1 << 17;
  std::vector<int> count(weights.size(), 0);
  for (int i = 0; i < n; ++i) {
    float pdf = 0;
    const vec2 p = distribution.sample({unit_float(random()), unit_float(random())}, &pdf);
    ASSERT_EQ(pdf, distribution.pdf(p));
    ++count[static_cast<size_t>(p.y * height) * width + static_cast<size_t>(p.x * width)];
  }
  std::vector<int> observed;
  std::vector<double> expected;
  for (size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0) EXPECT_EQ(count[i], 0) << "texel " << i;
    if (weights[i] > 0) observed.push_back(count[i]), expected.push_back(n * weights[i] / 25.0);
  }
  EXPECT_LT(chi_square(observed, expected), chi_square_limit(double(observed.size()) - 1));
}

}  // namespace
}  // namespace zonal
