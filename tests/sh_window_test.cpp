// Windows and deringing: the published amounts of ringing, and reconstructions that stay non-negative.
#include "sh/window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "sh/extremum.h"
#include "sh/projection.h"
#include "sh/quick_dering.h"
#include "sh/rotation.h"
#include "sh/zonal.h"

namespace zonal::sh {
namespace {

using Dvec = std::vector<double>;
constexpr Window kAll[] = {Window::hann, Window::lanczos, Window::hamming};

Dvec delta_zonal(int bands) {
  Dvec zonal(bands);
  for (int l = 0; l < bands; ++l) zonal[l] = std::sqrt((2 * l + 1) / (4 * std::numbers::pi));
  return zonal;
}

/// A disc of half angle a: 2 pi integral of Y_l^0 over it, by (P_{l-1} - P_{l+1}).
Dvec cap_zonal(int bands, double a) {
  Dvec zonal(bands);
  for (int l = 0; l < bands; ++l) {
    const double difference =
        (l == 0 ? 1 : std::legendre(l - 1, std::cos(a))) - std::legendre(l + 1, std::cos(a));
    zonal[l] = std::sqrt(std::numbers::pi / (2 * l + 1)) * difference;
  }
  return zonal;
}

double zonal_value(const Dvec& zonal, double z) {
  double sum = 0;
  for (size_t l = 0; l < zonal.size(); ++l)
    sum += zonal[l] * std::sqrt((2 * l + 1) / (4 * std::numbers::pi)) * std::legendre(unsigned(l), z);
  return sum;
}

double lowest_of_many(int bands, const Dvec& f, int samples) {
  const auto nodes = fibonacci_nodes<double>(samples);
  Dvec values(samples);
  reconstruct(bands, f.data(), nodes.x.data(), nodes.y.data(), nodes.z.data(), samples, values.data());
  return *std::min_element(values.begin(), values.end());
}

TEST(sh_window, ringing_of_a_delta_at_9_bands) {
  const double expected[] = {-2.8, -4.3, -2.0};  // percent of the peak, with a window of 9
  for (int k = 0; k < 3; ++k) {
    Dvec zonal = delta_zonal(9);
    apply_window_zonal(9, kAll[k], 9, zonal.data());
    EXPECT_NEAR(100 * zonal_minimum(9, zonal.data()).value / zonal_value(zonal, 1), expected[k], 0.05);
  }
}

TEST(sh_window, ringing_of_a_small_cap) {
  // -15 % at 5 bands, -14 % at 9; Hann of that size -3.8 and -2.7 %.
  const struct {
    int bands;
    double plain, hann;
  } cases[] = {{5, -15, -3.8}, {9, -14, -2.7}};
  for (const auto& c : cases) {
    Dvec zonal = cap_zonal(c.bands, 0.05);
    EXPECT_NEAR(100 * zonal_minimum(c.bands, zonal.data()).value / zonal_value(zonal, 1), c.plain, 0.7);
    apply_window_zonal(c.bands, Window::hann, c.bands, zonal.data());
    EXPECT_NEAR(100 * zonal_minimum(c.bands, zonal.data()).value / zonal_value(zonal, 1), c.hann, 0.1);
  }
}

TEST(sh_window, weights_start_at_one_and_end_at_the_size) {
  for (const Window window : kAll) {
    EXPECT_EQ(window_weight(window, 0, 5), 1);
    EXPECT_EQ(window_weight(window, 6, 5), 0);
    EXPECT_NEAR(window_weight(window, 5, 5), window == Window::hamming ? 0.08 : 0, 1e-15);
    EXPECT_EQ(window_weight(window, 3, std::numeric_limits<double>::infinity()), 1);
    for (int l = 1; l < 5; ++l) EXPECT_LT(window_weight(window, l, 5), window_weight(window, l - 1, 5));
  }
  EXPECT_NEAR(window_weight(Window::hann, 2, 4), 0.5, 1e-15);
  EXPECT_NEAR(window_weight(Window::lanczos, 2, 4), 2 / std::numbers::pi, 1e-15);
  EXPECT_NEAR(window_weight(Window::hamming, 2, 4), 0.54, 1e-15);
}

// Sampling can only find more than the minimum; with 40 N^2 points it comes within curvature times spacing^2.
TEST(sh_window, the_minimum_found_is_below_every_sample) {
  for (const int bands : {1, 2, 3, 5, 9, 20, 40}) {
    std::mt19937 engine(bands);
    std::normal_distribution<double> normal;
    Dvec f(count(bands));
    for (double& x : f) x = normal(engine);
    const Minimum found = MinimumSearch(bands).minimum(f.data());
    const double sampled = lowest_of_many(bands, f, 40 * bands * bands);
    EXPECT_LE(found.value, sampled + 1e-12 * bands) << bands;
    EXPECT_GE(found.value, sampled - 0.05 * std::abs(sampled)) << bands;
    EXPECT_NEAR(found.value, reconstruct(bands, f.data(), found.direction), 1e-10) << bands;
  }
}

/// `window` none: the automatic one.
template <class T>
void check_deringed(int bands, Window window, const Dvec& function) {
  std::vector<T> f(function.begin(), function.end());
  const Dering found = window == Window::none ? dering(bands, f.data()) : dering(bands, window, f.data());
  EXPECT_TRUE(found.non_negative);
  const Dvec after(f.begin(), f.end());
  Dvec opposite(after);
  for (double& x : opposite) x = -x;
  const MinimumSearch search(bands);
  const double highest = -search.minimum(opposite.data()).value;
  EXPECT_GE(search.minimum(after.data()).value, -1e-6 * highest) << bands;
  EXPECT_GE(lowest_of_many(bands, after, 20 * bands * bands), -1e-6 * highest) << bands;
  if (window == Window::none) {
    EXPECT_LE(found.strength, 1 + 1e-6);  // the functions of this test were non-negative
    return;
  }
  // And it is the mildest: a window larger by a thousandth would ring.
  if (std::isinf(found.size) || found.size < 1) return;
  Dvec larger(function);
  apply_window(bands, window, 1.001 * found.size, larger.data());
  EXPECT_LT(search.minimum(larger.data()).value, 0) << bands << " bands, size " << found.size;
}

TEST(sh_dering, leaves_delta_cap_and_random_lights_non_negative) {
  for (const int bands : {2, 3, 5, 9, 16}) {
    const auto axis = glm::normalize(Vec3<double>(0.3, -0.5, 0.7));
    Dvec delta(count(bands)), cap(count(bands)), lights(count(bands));
    rotate_zonal(bands, axis, delta_zonal(bands).data(), delta.data());
    rotate_zonal(bands, -axis, cap_zonal(bands, 0.3).data(), cap.data());
    std::mt19937 engine(bands);
    std::normal_distribution<double> normal;
    Dvec one(count(bands));
    for (int k = 0; k < 4; ++k) {  // a few lights of different strength over a dim sky
      const auto w = glm::normalize(Vec3<double>(normal(engine), normal(engine), normal(engine)));
      rotate_zonal(bands, w, delta_zonal(bands).data(), one.data());
      for (int i = 0; i < count(bands); ++i) lights[i] += (k + 1) * one[i];
    }
    lights[0] += 0.5;
    for (const Window window : {Window::none, Window::hann, Window::lanczos, Window::hamming})
      for (const Dvec& f : {delta, cap, lights}) check_deringed<double>(bands, window, f);
    check_deringed<float>(bands, Window::hann, lights);
    check_deringed<float>(bands, Window::none, lights);
  }
}

TEST(sh_window, positive_weights_make_a_non_negative_kernel_with_a_high_peak) {
  for (const int bands : {1, 2, 3, 4, 5, 8, 9, 20, 21, kMaxBands}) {
    Dvec kernel = delta_zonal(bands), weights(bands);
    const double plain = zonal_value(kernel, 1);
    positive_weights(bands, weights.data());
    EXPECT_EQ(weights[0], 1);
    for (int l = 0; l < bands; ++l) kernel[l] *= weights[l];
    EXPECT_GE(zonal_minimum(bands, kernel.data()).value, -1e-13 * plain) << bands;
    // Odd N: the square of L+1 = (N+1)/2 bands has the peak (L+1)^2 / 4 pi against N^2 / 4 pi.
    if (bands % 2 == 1)
      EXPECT_NEAR(zonal_value(kernel, 1) / plain, std::pow((bands + 1) / 2.0 / bands, 2), 1e-12) << bands;
  }
}

TEST(sh_dering, automatic_window_goes_on_to_the_mean_where_the_function_was_negative) {
  Dvec f = {1, 0, 5, 0};  // 0.28 + 2.4 z: 1/3 of it is not enough
  const Dering found = dering(2, f.data());
  EXPECT_TRUE(found.non_negative);
  EXPECT_GT(found.strength, 1);
  EXPECT_LT(found.strength, 2);
  EXPECT_NEAR(f[2], 1 / std::sqrt(3), 1e-6);  // Y_0^0 = f[2] sqrt(3) Y_0^0
}

TEST(sh_dering, works_at_60_bands) {
  Dvec delta(count(60));
  rotate_zonal(60, glm::normalize(Vec3<double>(1, 2, 3)), delta_zonal(60).data(), delta.data());
  check_deringed<double>(60, Window::none, delta);
}

TEST(sh_dering, zonal_and_general_search_agree) {
  for (const Window window : kAll) {
    const int bands = 9;
    Dvec zonal = cap_zonal(bands, 0.2), f(count(bands));
    rotate_zonal(bands, glm::normalize(Vec3<double>(-1, 0.2, 0.1)), zonal.data(), f.data());
    const Dering one = dering_zonal(bands, window, zonal.data()), whole = dering(bands, window, f.data());
    EXPECT_NEAR(one.size, whole.size, 1e-3 * one.size);
  }
  Dvec zonal = cap_zonal(9, 0.2), f(81);
  rotate_zonal(9, glm::normalize(Vec3<double>(-1, 0.2, 0.1)), zonal.data(), f.data());
  EXPECT_NEAR(dering_zonal(9, zonal.data()).strength, dering(9, f.data()).strength, 1e-4);
}

TEST(sh_dering, leaves_alone_what_does_not_ring_and_says_when_it_cannot_help) {
  Dvec f = {3.5, 0.1, 0.2, -0.1};
  const Dvec before = f;
  EXPECT_TRUE(std::isinf(dering(2, Window::hann, f.data()).size));
  EXPECT_EQ(f, before);
  Dvec negative = {-1, 0.5, 0.2, 0.1};
  const Dering found = dering(2, Window::hann, negative.data());
  EXPECT_FALSE(found.non_negative);
  EXPECT_EQ(negative, (Dvec{-1, 0, 0, 0}));
}

TEST(sh_dering, batches_equal_single_vectors) {
  const int bands = 5, functions = 4;
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<float> f(count(bands) * functions), one(count(bands));
  for (float& x : f) x = uniform(engine);
  for (int k = 0; k < functions; ++k) f[k] = 2;
  const std::vector<float> before = f;
  Dering found[functions];
  dering(bands, Window::lanczos, functions, f.data(), found);
  for (int k = 0; k < functions; ++k) {
    for (int i = 0; i < count(bands); ++i) one[i] = before[i * functions + k];
    EXPECT_EQ(dering(bands, Window::lanczos, one.data()).size, found[k].size);
    for (int i = 0; i < count(bands); ++i) EXPECT_EQ(one[i], f[i * functions + k]);
  }
}

TEST(QuickDering, finds_the_strength_that_the_search_finds) {
  // Caps of many sizes over some grey: from none to nearly the whole kernel.
  for (const int bands : {3, 5, 9}) {
    const QuickDering quick(bands);
    const int n = count(bands);
    int some = 0;
    for (int trial = 0; trial < 30; ++trial) {
      std::vector<float> three(3 * size_t(n)), zonal(bands);
      std::vector<double> one(n);
      const Vec3<float> axis = spherical_fibonacci<float>(trial, 30);
      cap_zonal(bands, cap_from_half_angle(0.05f + 0.05f * float(trial)), zonal.data());
      rotate_zonal(bands, axis, zonal.data(), three.data());
      three[0] += 0.02f * float(trial % 7);
      for (int i = 0; i < n; ++i) one[i] = three[n + i] = three[2 * n + i] = three[i];
      float strength[3];
      quick.apply(three.data(), strength);
      const Dering found = dering(bands, one.data());
      // Sampled minima are up to 8 % of the ringing too high, and the strength is taken 8 % larger.
      EXPECT_NEAR(strength[0], found.strength, 0.09 * found.strength + 1e-6) << bands << ' ' << trial;
      EXPECT_EQ(strength[0], strength[2]);
      some += found.strength > 0.05;
      // What is left below zero, of the mean.
      std::vector<double> left(three.begin(), three.begin() + n);
      EXPECT_GT(MinimumSearch(bands).minimum(left.data()).value / (left[0] * 0.2821), -0.01);
    }
    EXPECT_GT(some, 5);
  }
}

}  // namespace
}  // namespace zonal::sh
