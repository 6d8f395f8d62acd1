// Every metric against small pictures worked out by hand, and SSIM against scikit-image.
#include "core/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/error_map.h"
#include "core/sampling.h"
#include "tests/paths.h"
#include "tests/patterns.h"

namespace zonal {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// One row of grey pixels.
Image row(const std::vector<float>& values) {
  Image image(static_cast<int>(values.size()), 1);
  for (size_t i = 0; i < values.size(); ++i) std::fill_n(image.at(int(i), 0), 3, values[i]);
  return image;
}

Image constant(int width, int height, float value) {
  Image image(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), value);
  return image;
}

TEST(LinearMetrics, match_the_formulas_worked_out_by_hand) {
  // Differences 1, -1, 0, 2. Mean of r is 2, so relMSE's floor is 0.2 and its square 0.04.
  const LinearMetrics m = linear_metrics(row({2, 1, 0, 7}), row({1, 2, 0, 5}));
  EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(6.0 / 4));
  EXPECT_DOUBLE_EQ(m.mae, 1);
  EXPECT_DOUBLE_EQ(m.bias, 0.5);
  EXPECT_NEAR(m.relmse, (1 / 1.04 + 1 / 4.04 + 0 + 4 / 25.04) / 4, 1e-15);
  EXPECT_NEAR(m.smape, (2.0 / 3 + 2.0 / 3 + 0 + 4.0 / 12) / 4, 1e-15);
  EXPECT_EQ(m.nan, 0u);
  EXPECT_FALSE(m.mse_unbiased);
  EXPECT_FALSE(m.reference_floor);
}

TEST(LinearMetrics, channels_count_alike) {
  Image x(1, 1), r(1, 1);
  x.pixels = {1, 2, 3}, r.pixels = {1, 1, 1};
  const LinearMetrics m = linear_metrics(x, r);
  EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(5.0 / 3));
  EXPECT_DOUBLE_EQ(m.bias, 1);
  EXPECT_NEAR(m.relmse, (1 + 4) / 1.01 / 3, 1e-15);
}

TEST(LinearMetrics, of_a_picture_with_itself_are_zero) {
  Image x(20, 20);
  for (size_t i = 0; i < x.pixels.size(); ++i) x.pixels[i] = unit_float(hash32(uint32_t(i)));
  const LinearMetrics m = linear_metrics(x, x, &x, &x);
  for (const double value : {m.rmse, m.mae, m.relmse, m.relmse_trimmed, m.smape, m.bias, m.fireflies})
    EXPECT_EQ(value, 0);
  EXPECT_EQ(*m.mse_unbiased, 0);
  EXPECT_EQ(*m.reference_floor, 0);
}

TEST(LinearMetrics, trimming_drops_the_worst_thousandth) {
  // 2000 pixels, r = 1: two are wrong by 10 and 20, two by 1. The floor is 0.1, the denominators 1.01.
  Image x = constant(50, 40, 1);
  const Image r = x;
  const float wrong[4] = {11, 2, 21, 2};
  for (int i = 0; i < 4; ++i) std::fill_n(x.at(7 * i, 3 * i), 3, wrong[i]);
  const LinearMetrics m = linear_metrics(x, r);
  EXPECT_NEAR(m.relmse, (100 + 400 + 1 + 1) / 1.01 / 2000, 1e-14);
  EXPECT_NEAR(m.relmse_trimmed, (1 + 1) / 1.01 / 1998, 1e-15);
}

TEST(LinearMetrics, nan_pixels_are_counted_and_left_out) {
  Image x = row({2, kNaN, 0, 7, 1}), r = row({1, 2, 0, 5, kInfinity});
  x.at(2, 0)[1] = -kInfinity;
  const LinearMetrics m = linear_metrics(x, r), clean = linear_metrics(row({2, 7}), row({1, 5}));
  EXPECT_EQ(m.nan, 3u);
  EXPECT_EQ(m.rmse, clean.rmse);
  EXPECT_EQ(m.relmse, clean.relmse);
  EXPECT_EQ(m.smape, clean.smape);
  EXPECT_EQ(m.bias, clean.bias);
  const LinearMetrics none = linear_metrics(row({kNaN}), row({1}));
  EXPECT_EQ(none.nan, 1u);
  EXPECT_TRUE(std::isnan(none.rmse) && std::isnan(none.relmse) && std::isnan(none.fireflies));
}

TEST(LinearMetrics, something_where_the_whole_reference_is_black_is_infinitely_wrong) {
  EXPECT_EQ(linear_metrics(row({0, 1}), row({0, 0})).relmse, kInfinity);
  EXPECT_EQ(linear_metrics(row({0, 0}), row({0, 0})).relmse, 0);
  EXPECT_DOUBLE_EQ(linear_metrics(row({0, 1}), row({0, 0})).smape, 1);  // (0 + 2) / 2
}

TEST(LinearMetrics, a_firefly_outshines_its_neighbourhood_ten_times) {
  // r = 1 everywhere: the threshold is 1 + 10 = 11.
  const Image r = constant(10, 10, 1);
  Image x = r;
  std::fill_n(x.at(2, 2), 3, 10.99f);
  EXPECT_EQ(linear_metrics(x, r).fireflies, 0);
  std::fill_n(x.at(2, 2), 3, 11.01f);
  EXPECT_DOUBLE_EQ(linear_metrics(x, r).fireflies, 0.01);
  // A lamp of 50 two pixels away allows 50 + 10 (50 + 24) / 25 = 79.6; three pixels away it allows nothing.
  Image lamp = r;
  std::fill_n(lamp.at(4, 4), 3, 50.0f);
  std::fill_n(x.at(2, 2), 3, 79.0f);
  EXPECT_EQ(linear_metrics(x, lamp).fireflies, 0);
  std::fill_n(x.at(2, 2), 3, 80.0f);
  EXPECT_DOUBLE_EQ(linear_metrics(x, lamp).fireflies, 0.01);
  std::fill_n(x.at(2, 2), 3, 1.0f);
  std::fill_n(x.at(1, 4), 3, 79.0f);
  EXPECT_DOUBLE_EQ(linear_metrics(x, lamp).fireflies, 0.01);
}

TEST(LinearMetrics, a_faint_glow_in_a_black_corner_is_no_firefly) {
  // Left half black, right half 2: mean 1, so in the dark a tenth of it, 0.1, is allowed.
  Image r = constant(40, 10, 0), x;
  for (int y = 0; y < 10; ++y) {
    for (int i = 20; i < 40; ++i) std::fill_n(r.at(i, y), 3, 2.0f);
  }
  x = r;
  std::fill_n(x.at(3, 3), 3, 0.099f);
  EXPECT_EQ(linear_metrics(x, r).fireflies, 0);
  std::fill_n(x.at(3, 3), 3, 0.101f);
  EXPECT_DOUBLE_EQ(linear_metrics(x, r).fireflies, 1.0 / 400);
}

TEST(LinearMetrics, halves_take_the_reference_noise_out) {
  // Truth 0; A and B are independent, uniform in [-1, 1]: variance 1/3. The picture is off by 0.2 everywhere.
  // E (x-A)(x-B) = 0.04. Its variance a value: E(x-A)^2 E(x-B)^2 - 0.04^2 = (0.04 + 1/3)^2 - 0.0016 = 0.1378.
  const int side = 200;
  const double n = 3.0 * side * side;
  Image x = constant(side, side, 0.2f), a(side, side), b(side, side), r(side, side);
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    a.pixels[i] = 2 * unit_float(hash32(uint32_t(i), 1)) - 1;
    b.pixels[i] = 2 * unit_float(hash32(uint32_t(i), 2)) - 1;
    r.pixels[i] = 0.5f * (a.pixels[i] + b.pixels[i]);
  }
  const LinearMetrics m = linear_metrics(x, r, &a, &b);
  EXPECT_NEAR(*m.mse_unbiased, 0.04, 4 * std::sqrt(0.1378 / n));
  // The naive error holds the reference's variance 1/6 as well.
  EXPECT_NEAR(m.rmse * m.rmse, 0.04 + 1.0 / 6, 0.01);
  // Floor squared estimates 1/6; (A-B)^2/4 has variance (E(A-B)^4 - (2/3)^2)/16 = (16/15 - 4/9)/16 = 0.0389.
  EXPECT_NEAR(*m.reference_floor * *m.reference_floor, 1.0 / 6, 4 * std::sqrt(0.0389 / n));
  EXPECT_TRUE(m.reference_limited());  // 0.04 < 9/6
  x = constant(side, side, 2);
  EXPECT_FALSE(linear_metrics(x, r, &a, &b).reference_limited());  // 4 > 9/6
}

TEST(LinearMetrics, a_variance_alone_gives_the_floor) {
  const Image x = row({1, 2}), variance = row({0.01f, 0.03f});
  const LinearMetrics m = linear_metrics(x, x, nullptr, nullptr, &variance);
  // As floats the two are off by up to 2^-31 and 2^-30, their mean by 7e-10, its root by 7e-10 / (2 *
  // 0.1414).
  EXPECT_NEAR(*m.reference_floor, std::sqrt(0.02), 3e-9);
  EXPECT_FALSE(m.reference_limited());
}

TEST(Metrics, of_pictures_of_different_sizes_are_refused_naming_both) {
  try {
    linear_metrics(constant(3, 4, 1), constant(5, 6, 1));
    FAIL() << "expected a SceneError";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("3x4"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("5x6"), std::string::npos) << error.what();
  }
  EXPECT_THROW(display_metrics(constant(12, 12, 1), constant(12, 13, 1)), SceneError);
}

TEST(DisplayMetrics, match_the_formulas_worked_out_by_hand) {
  const DisplayMetrics m = display_metrics(row({0.5f, 0.25f, 0, 1}), row({0.25f, 0.5f, 0, 1}));
  EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(0.125 / 4));
  EXPECT_DOUBLE_EQ(m.mae, 0.125);
  EXPECT_NEAR(m.psnr, -10 * std::log10(0.125 / 4), 1e-12);
  EXPECT_TRUE(std::isnan(m.ssim)) << "a picture below 11x11 has no window";
}

TEST(DisplayMetrics, exposure_comes_before_the_clamp_and_srgb) {
  // 0.25 at exposure 2 is 0.5, sRGB 0.735357; 3 clamps to 1. Rounded to float: 2^-25, and the six digits.
  const Image shown = to_display(row({0.25f, 3, -1, kNaN}), 2);
  EXPECT_NEAR(shown.rgb(0, 0).y, 0.735357, 1e-6);
  EXPECT_EQ(shown.rgb(1, 0), vec3(1));
  EXPECT_EQ(shown.rgb(2, 0), vec3(0));
  EXPECT_TRUE(std::isnan(shown.rgb(3, 0).x));
}

// ---- SSIM
// -----------------------------------------------------------------------------------------------------------

TEST(Ssim, agrees_with_scikit_image) {
  const auto golden = nlohmann::json::parse(std::ifstream(test::source_dir() + "/tests/golden/ssim.json"));
  const int width = golden["width"], height = golden["height"];
  const Image truth = picture(width, height, pattern);
  const std::map<std::string, Image> pictures = {{"noisy", picture(width, height, noisy)},
                                                 {"blurred", picture(width, height, blurred)},
                                                 {"shifted", picture(width, height, shifted)}};
  ASSERT_EQ(golden["ssim"].size(), pictures.size());
  // Both sides compute in double; what differs is the order of sums, 1e-13 or so after the variances cancel.
  for (const auto& [name, image] : pictures) {
    EXPECT_NEAR(ssim(image, truth), golden["ssim"][name].get<double>(), 1e-9) << name;
    EXPECT_NEAR(ssim(truth, image), golden["ssim"][name].get<double>(), 1e-9) << name << " is symmetric";
  }
}

TEST(Ssim, of_two_flat_pictures_is_the_luminance_term) {
  // No structure: variances and covariance vanish, so ssim = (2ab + C1) / (a^2 + b^2 + C1).
  const double expected = (2 * 0.25 * 0.5 + 1e-4) / (0.0625 + 0.25 + 1e-4);
  EXPECT_NEAR(ssim(constant(11, 11, 0.25f), constant(11, 11, 0.5f)), expected, 1e-12);
  EXPECT_NEAR(ssim(constant(30, 12, 0.5f), constant(30, 12, 0.5f)), 1, 1e-12);
}

TEST(Ssim, leaves_out_the_windows_that_hold_a_nan) {
  // The top row of one picture is NaN, so only windows from row 1 on count: as if that row were cut off.
  Image x = picture(40, 30, noisy), r = picture(40, 30, pattern);
  Image below_x(40, 29), below_r(40, 29);
  std::copy(x.pixels.begin() + 120, x.pixels.end(), below_x.pixels.begin());
  std::copy(r.pixels.begin() + 120, r.pixels.end(), below_r.pixels.begin());
  std::fill_n(x.pixels.begin(), 120, kNaN);
  EXPECT_NEAR(ssim(x, r), ssim(below_x, below_r), 1e-12);
  const DisplayMetrics m = display_metrics(x, r), below = display_metrics(below_x, below_r);
  EXPECT_EQ(m.rmse, below.rmse);
}

// ---- error maps
// -----------------------------------------------------------------------------------------------------

TEST(ErrorMap, relative_error_is_the_root_of_relmse_a_pixel) {
  const Image error =
      relative_error(row({2, 1, 0, kNaN}), row({1, 2, 3, 1}));  // finite mean of r: 2, floor 0.2
  EXPECT_FLOAT_EQ(error.at(0, 0)[0], std::sqrt(1 / 1.04f));
  EXPECT_FLOAT_EQ(error.at(2, 0)[0], std::sqrt(9 / 9.04f));
  EXPECT_TRUE(std::isnan(error.at(3, 0)[0]));
}

TEST(ErrorMap, scale_ends_at_a_round_number_and_colours_rise_in_lightness) {
  Image error(100, 100, 1);
  for (int i = 0; i < 10000; ++i) error.pixels[i] = 0.3f * i / 9999;
  error.at(50, 0)[0] = kNaN;
  const ImageFile map = error_map(error);
  EXPECT_TRUE(map.display_referred);
  EXPECT_EQ(map.metadata.at("error_map_low"), "0");
  EXPECT_EQ(map.metadata.at("error_map_high"), "0.5");  // 99 % lie below 0.297
  const Image& picture = map.layers.at("");
  EXPECT_GT(picture.width, error.width);
  EXPECT_EQ(picture.rgb(50, 0), vec3(0, 1, 0));
  // The bar runs from bright at the top to dark at the bottom, strictly.
  for (int y = 1; y < 100; ++y) {
    ASSERT_LT(luminance(picture.rgb(picture.width - 1, y)), luminance(picture.rgb(picture.width - 1, y - 1)))
        << y;
  }
}

TEST(ErrorMap, of_no_error_is_dark) {
  const ImageFile map = error_map(Image(8, 8, 1));
  EXPECT_EQ(map.metadata.at("error_map_high"), "1");
  EXPECT_LT(luminance(map.layers.at("").rgb(3, 3)), 0.01f);
}

}  // namespace
}  // namespace zonal
