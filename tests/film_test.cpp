// The film's means and variances against closed forms, and what happens to bad numbers and discarded passes.
#include "core/film.h"

#include <gtest/gtest.h>

#include <thread>

namespace zonal {
namespace {

/// Adds a pass in which every pixel has this radiance.
void add_pass(Film& film, vec3 radiance) {
  film.begin_pass();
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) film.add(x, y, radiance, vec3(0.5f), vec3(0, 0, 1), 2.0f);
  }
  film.commit_pass();
}

TEST(Film, without_passes_is_black) {
  const Film film(3, 2);
  EXPECT_EQ(film.passes(), 0);
  EXPECT_EQ(film.radiance().pixels, std::vector<float>(18, 0.0f));
  EXPECT_EQ(film.variance_of_mean().pixels, std::vector<float>(18, 0.0f));
  EXPECT_EQ(film.resolve().layers.at("depth").channels, 1);
}

TEST(Film, means_and_variances_of_one_to_n_match_the_closed_form) {
  // Of 1..n: mean (n+1)/2, sample variance n(n+1)/12, so the mean's variance is (n+1)/12. Integers are exact
  // in double, the only rounding is the last one to float.
  Film film(2, 2);
  const int n = 100;
  for (int i = 1; i <= n; ++i) add_pass(film, vec3(i, 2 * i, 7));
  EXPECT_EQ(film.passes(), n);
  EXPECT_FLOAT_EQ(film.radiance().at(1, 1)[0], (n + 1) / 2.0f);
  EXPECT_FLOAT_EQ(film.variance_of_mean().at(1, 1)[0], (n + 1) / 12.0f);
  EXPECT_FLOAT_EQ(film.variance_of_mean().at(0, 1)[1], 4 * (n + 1) / 12.0f);
  EXPECT_EQ(film.variance_of_mean().at(0, 0)[2], 0);
  EXPECT_EQ(film.bad_samples(), 0u);
}

TEST(Film, a_million_small_values_do_not_get_lost) {
  // In float, 0.1 summed 10^5 times is off by more than 1e-3 of it; in double by 1e-11.
  Film film(1, 1);
  for (int i = 0; i < 100000; ++i) add_pass(film, vec3(0.1f));
  EXPECT_FLOAT_EQ(film.radiance().at(0, 0)[0], 0.1f);
  // The scatter of a constant is rounding alone: n terms of 2^-53 relative to 0.01, over n.
  EXPECT_LT(film.variance_of_mean().at(0, 0)[0], 0.01f * 1.2e-16f);
}

TEST(Film, one_pass_has_no_variance) {
  Film film(1, 1);
  add_pass(film, vec3(3));
  EXPECT_EQ(film.variance_of_mean().at(0, 0)[0], 0);
}

TEST(Film, layers_are_means_over_passes) {
  Film film(2, 1);
  for (int i = 0; i < 4; ++i) {
    film.begin_pass();
    film.add(1, 0, vec3(1), vec3(0.25f * i), vec3(i % 2, 0, 1), 2.0f * i);
    film.commit_pass();
  }
  const ImageFile file = film.resolve();
  EXPECT_EQ(file.layers.at("albedo").rgb(1, 0), vec3(0.375f));
  EXPECT_EQ(file.layers.at("normal").rgb(1, 0), vec3(0.5f, 0, 1));
  EXPECT_EQ(file.layers.at("depth").at(1, 0)[0], 3.0f);
  EXPECT_EQ(file.layers.at("depth").at(0, 0)[0], 0.0f);
}

TEST(Film, a_discarded_pass_leaves_no_trace) {
  Film film(1, 1);
  add_pass(film, vec3(2));
  film.begin_pass();
  film.add(0, 0, vec3(std::numeric_limits<float>::quiet_NaN()), vec3(1), vec3(1), 9);
  film.discard_pass();
  EXPECT_EQ(film.passes(), 1);
  EXPECT_EQ(film.bad_samples(), 0u);
  add_pass(film, vec3(4));
  EXPECT_EQ(film.radiance().rgb(0, 0), vec3(3));
  EXPECT_EQ(film.resolve().layers.at("depth").at(0, 0)[0], 2.0f);
}

TEST(Film, bad_samples_are_counted_and_replaced_by_black) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  Film film(4, 1);
  add_pass(film, vec3(2));
  film.begin_pass();
  film.add(0, 0, vec3(1, kNaN, 1), vec3(0), vec3(0), 0);
  film.add(1, 0, vec3(1, 1, kInfinity), vec3(0), vec3(0), 0);
  film.add(2, 0, vec3(-1e-20f, 1, 1), vec3(0), vec3(0), 0);
  film.add(3, 0, vec3(4), vec3(0), vec3(0), kNaN);  // a bad layer: the radiance stays
  film.commit_pass();
  EXPECT_EQ(film.bad_samples(), 4u);
  for (int x = 0; x < 3; ++x) EXPECT_EQ(film.radiance().rgb(x, 0), vec3(1)) << "pixel " << x;
  EXPECT_EQ(film.radiance().rgb(3, 0), vec3(3));
  EXPECT_EQ(film.resolve().layers.at("depth").at(3, 0)[0], 1.0f);
}

TEST(Film, distinct_pixels_may_be_added_from_several_threads) {
  Film film(64, 64);
  film.begin_pass();
  const auto add_rows = [&](int first) {
    for (int y = first; y < 64; y += 2) {
      for (int x = 0; x < 64; ++x) film.add(x, y, vec3(x + 64 * y), vec3(0), vec3(0), 0);
    }
  };
  std::thread other(add_rows, 1);
  add_rows(0);
  other.join();
  film.commit_pass();
  const Image image = film.radiance();
  for (int i = 0; i < 64 * 64; ++i) ASSERT_EQ(image.at(i % 64, i / 64)[2], float(i));
}

}  // namespace
}  // namespace zonal
