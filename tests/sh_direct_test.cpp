// `sh_direct` beside closed forms, beside its own alternatives, and beside the path tracer without occlusion.
#include "integrators/sh_direct/sh_direct.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sh/clamped_cosine.h"
#include "sh/products.h"
#include "sh/projection.h"
#include "sh/rotation.h"
#include "sh/zonal.h"
#include "tests/center_reference.h"

namespace zonal {
namespace {

/// One pixel that looks straight down on a grey floor lit by one sphere of half angle 0.01 rad, `degrees` off
/// the normal and 10 m away.
std::string lambert_under_small_light(double degrees) {
  const double t = degrees * M_PI / 180;
  return fmt::format(
      R"({{"camera": {{"position": [0, 1, 0], "look_at": [0, 0, 0], "up": [0, 0, -1], "vertical_fov": 0.01, "resolution": [1, 1]}},
      "materials": [{{"name": "grey", "type": "lambert", "albedo": 0.5}}],
      "objects": [{{"name": "floor", "type": "quad", "corner": [-2, 0, 2], "edges": [[4, 0, 0], [0, 0, -4]], "material": "grey"}}],
      "lights": [{{"type": "sphere", "center": [{}, {}, 0], "radius": 0.09999833334, "radiance": 100}}]}})",
      10 * std::sin(t), 10 * std::cos(t));
}

double one_pixel(const Scene& scene, const std::string& settings) {
  return test::render_with(scene, "sh_direct", {.settings = settings, .width = 1, .height = 1}).pixels[0];
}

/// E/pi albedo of the series cut to N bands, in double: (Eq. 3.10) as printed, and the clamped cosine's
/// closed form (Ramamoorthi and Hanrahan 2001).
double cut_series(int bands, double half_angle, double cos_theta, double radiance_times_albedo) {
  std::vector<double> at_alpha(bands + 2), at_theta(bands + 2);
  const auto legendre = [](std::vector<double>& P, double x) {
    P[0] = 1, P[1] = x;
    for (size_t l = 2; l < P.size(); ++l) P[l] = ((2.0 * l - 1) * x * P[l - 1] - (l - 1.0) * P[l - 2]) / l;
  };
  legendre(at_alpha, std::cos(half_angle)), legendre(at_theta, cos_theta);
  double sum = 0;
  for (int l = 0; l < bands; ++l) {
    const double light = l == 0 ? std::sqrt(M_PI) * (1 - at_alpha[1])
                                : std::sqrt(M_PI / (2 * l + 1)) * (at_alpha[l - 1] - at_alpha[l + 1]);
    double cosine = 0;  // sqrt(4 pi/(2l+1)) times the zonal coefficient
    if (l == 0) cosine = M_PI;
    if (l == 1) cosine = 2 * M_PI / 3;
    if (l > 1 && l % 2 == 0)
      cosine = 2 * M_PI * (l / 2 % 2 ? 1 : -1) / ((l + 2.0) * (l - 1)) * std::tgamma(l + 1) /
               (std::pow(2.0, l) * sqr(std::tgamma(l / 2 + 1)));
    sum += light * cosine * std::sqrt((2 * l + 1) / (4 * M_PI)) * at_theta[l];
  }
  return radiance_times_albedo / M_PI * sum;
}

TEST(ShDirect, lambert_under_a_small_light_is_the_cut_series) {
  // The thesis' bands, and how far the series is from the truth, pi sin^2 a cos theta: what `path` converges
  // to.
  for (const auto& [bands, most] : {std::pair{3, 0.055}, {5, 0.026}, {9, 0.011}}) {
    double squares = 0, mean = 0;
    int count = 0;
    for (int degrees = 0; degrees <= 80; degrees += 5, ++count) {
      const Scene scene = test::scene_from(lambert_under_small_light(degrees));
      const double cos_theta = std::cos(degrees * M_PI / 180);
      const double value = one_pixel(scene, fmt::format(R"({{"bands": {0}, "light_bands": {0}}})", bands));
      const double truth = 0.5 * 100 * sqr(std::sin(0.01)) * cos_theta;
      EXPECT_NEAR(value, cut_series(bands, 0.01, cos_theta, 50), 1e-5 * 50 * sqr(0.01))
          << degrees << " degrees";
      squares += sqr(value - truth), mean += truth;
    }
    const double error = std::sqrt(squares / count) / (mean / count);
    fmt::print("{} bands: RMSE over mean {:.4f}\n", bands, error);
    EXPECT_LT(error, most) << bands << " bands";
    EXPECT_GT(error, most / 4) << "the series cannot be that good";
  }
}

const char* kFewLights =
    R"({"camera": {"position": [0, 3, 5], "look_at": [0, 0.4, 0], "vertical_fov": 40, "resolution": [32, 24]},
  "materials": [{"name": "matt", "type": "lambert", "albedo": [0.7, 0.6, 0.5]},
                {"name": "rough", "type": "metallic_roughness", "base_color": [0.8, 0.5, 0.3], "metallic": 0.4, "roughness": 0.75}],
  "objects": [{"name": "floor", "type": "quad", "corner": [-4, 0, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "matt"},
              {"name": "ball", "type": "sphere", "center": [0.8, 0.7, 0], "radius": 0.7, "material": "rough"},
              {"name": "other", "type": "sphere", "center": [-0.8, 0.7, 0], "radius": 0.7, "material": "matt"}],
  "lights": [{"type": "sphere", "center": [2, 2.5, 1], "radius": 0.5, "radiance": [8, 2, 2]},
             {"type": "sphere", "center": [-3, 3, 2], "radius": 0.7, "radiance": [2, 8, 2]},
             {"type": "sphere", "center": [0, 4, -2], "radius": 0.6, "radiance": [2, 2, 12]},
             {"type": "quad", "corner": [-1, 3, 3], "edges": [[2, 0, 0], [0, 0.7, 0.7]], "radiance": 3, "two_sided": true},
             {"type": "spot", "position": [1, 5, 0], "look_at": [0, 0, 0], "intensity": 10, "inner": 5, "outer": 30},
             {"type": "environment", "radiance": 0.1}]})";

/// RMSE over the mean.
double relative_rmse(const Image& a, const Image& b) {
  double error = 0, mean = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    error += sqr(double(a.pixels[i]) - b.pixels[i]), mean += b.pixels[i];
  return std::sqrt(error / double(a.pixels.size())) / (mean / double(a.pixels.size()));
}

Image sh_image(const Scene& scene, const std::string& settings, int threads = 2) {
  return test::render_with(scene, "sh_direct",
                           {.settings = settings, .width = 32, .height = 24, .threads = threads});
}

TEST(ShDirect, tends_to_the_path_tracer_without_occlusion_as_bands_grow) {
  const Scene scene = test::scene_from(kFewLights);
  const test::CenterReference reference(scene, R"({"max_bounces": 0, "direct_occlusion": "none"})", 32, 24,
                                        100);
  double before = 1;
  // What the clamped cosine and the lobe of roughness 0.75 leave to higher bands. A half's noise is 8 % a
  // pixel; the product of two halves' noise, averaged over 2,304 values, leaves 1.2 % of the mean (the root
  // of 0.08^2/48).
  for (const auto& [bands, most] : {std::pair{2, 0.15}, {3, 0.035}, {5, 0.025}, {9, 0.02}}) {
    const double error =
        reference.error(sh_image(scene, fmt::format(R"({{"bands": {0}, "light_bands": {0}}})", bands)));
    fmt::print("{} bands: RMSE over mean {:.4f}\n", bands, error);
    EXPECT_LT(error, most) << bands;
    EXPECT_LE(error, before) << bands;
    before = error;
  }
}

TEST(ShDirect, the_cosines_own_matrix_loses_less_than_the_general_product) {
  // Caps of many sizes above and about the horizon; the truth is the product of 40 bands cut to 9.
  constexpr int kBands = 9, kMany = 40;
  std::vector<float> zonal(kMany), cap(kMany), cosine(81), light(kMany * kMany), exact(kMany * kMany),
      own(81), general(81);
  sh::clamped_cosine_zonal(kBands, zonal.data());
  sh::rotate_zonal(kBands, vec3(0, 0, 1), zonal.data(), cosine.data());
  double own_error = 0, general_error = 0;
  for (int i = 0; i < 40; ++i) {
    const float theta = 0.05f * float(i), size = 0.02f + 0.01f * float(i % 7);
    sh::cap_zonal(kMany, sh::cap_from_half_angle(size), cap.data());
    sh::rotate_zonal(kMany, vec3(std::sin(theta), 0, std::cos(theta)), cap.data(), light.data());
    sh::clamped_cosine_product(kMany, light.data(), exact.data());
    sh::clamped_cosine_product(kBands, light.data(), own.data());
    sh::product(kBands, light.data(), cosine.data(), general.data());
    for (int k = 0; k < 81; ++k)
      own_error += sqr(double(own[k]) - exact[k]), general_error += sqr(double(general[k]) - exact[k]);
  }
  fmt::print("squared error of the cosine's own matrix over the general product's: {:.3f}\n",
             own_error / general_error);
  EXPECT_LT(own_error, general_error);
  EXPECT_GT(own_error, 0);
}

TEST(ShDirect, every_way_to_shade_agrees_on_what_it_shares) {
  // On Lambert coefficient 0 of the product is the double product whatever the way, as long as the cosine
  // keeps the light's bands (Eq. 4.4).
  const Scene matt = test::scene_from(lambert_under_small_light(40));
  const double table = one_pixel(matt, R"({"bands": 5, "light_bands": 5})");
  for (const char* shading : {"cosine", "general", "turned"}) {
    EXPECT_NEAR(
        one_pixel(matt, fmt::format(R"({{"bands": 5, "light_bands": 5, "shading": "{}"}})", shading)) / table,
        1, 1e-5)
        << shading;
    EXPECT_NEAR(
        one_pixel(matt, fmt::format(R"({{"bands": 9, "light_bands": 5, "shading": "{}"}})", shading)) / table,
        1, 1e-5)
        << shading;
  }
  // With a cosine of 3 bands it is the series of 3.
  const double three = one_pixel(matt, R"({"bands": 3, "light_bands": 3})");
  EXPECT_NEAR(
      one_pixel(matt, R"({"bands": 9, "light_bands": 9, "shading": "turned", "cosine_bands": 3})") / three, 1,
      1e-5);
  EXPECT_NEAR(
      one_pixel(
          matt,
          R"({"bands": 9, "light_bands": 9, "shading": "cosine", "diffuse": "irradiance", "cosine_bands": 3})") /
          three,
      1, 1e-5);
  EXPECT_GT(std::abs(table / three - 1), 0.01) << "nothing was tested";

  // On a rough lobe the ways differ by what their cuts lose: a tenth at 9 bands.
  const Scene scene = test::scene_from(kFewLights);
  const Image whole = sh_image(scene, R"({"bands": 9, "light_bands": 9})");
  for (const char* shading : {"cosine", "general", "turned"}) {
    const double error = relative_rmse(
        sh_image(scene, fmt::format(R"({{"bands": 9, "light_bands": 9, "shading": "{}"}})", shading)), whole);
    fmt::print("{}: {:.4f} off the table\n", shading, error);
    EXPECT_LT(error, 0.1) << shading;
  }
}

TEST(ShDirect, the_zonal_product_is_the_full_one_on_lambert_and_near_it_on_lobes) {
  // Lambert's F' is zonal: both are the same series. On a lobe the cosine at a small light's middle is nearly
  // the truth.
  const char* kOnly =
      R"({"camera": {"position": [0, 3, 5], "look_at": [0, 0.4, 0], "vertical_fov": 40, "resolution": [32, 24]},
    "materials": [{"name": "m", %s}],
    "objects": [{"name": "floor", "type": "quad", "corner": [-4, 0, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "m"},
                {"name": "ball", "type": "sphere", "center": [0.8, 0.7, 0], "radius": 0.7, "material": "m"}],
    "lights": [{"type": "sphere", "center": [2, 2.5, 1], "radius": 0.2, "radiance": [80, 20, 20]},
               {"type": "quad", "corner": [-1, 3, 3], "edges": [[0.4, 0, 0], [0, 0.2, 0.2]], "radiance": 30, "two_sided": true},
               {"type": "point", "position": [-2, 2, 0], "intensity": 5},
               {"type": "spot", "position": [1, 5, 0], "look_at": [0, 0, 0], "intensity": 10, "inner": 5, "outer": 30},
               {"type": "environment", "radiance": 0.1}]})";
  const auto scene_with = [&](const std::string& material) {
    std::string text = kOnly;
    return test::scene_from(text.replace(text.find("%s"), 2, material));
  };
  const std::string shared = R"("bands": 7, "light_bands": 7, "polygons": "main")";
  const Scene matt = scene_with(R"("type": "lambert", "albedo": 0.6)");
  // Sums in another order, in float.
  EXPECT_LT(relative_rmse(sh_image(matt, "{" + shared + R"(, "product": "zonal"})"),
                          sh_image(matt, "{" + shared + "}")),
            1e-5);
  const Scene satin = scene_with(R"("type": "metallic_roughness", "metallic": 0.5, "roughness": 0.7)");
  const double off = relative_rmse(sh_image(satin, "{" + shared + R"(, "product": "zonal"})"),
                                   sh_image(satin, "{" + shared + "}"));
  fmt::print("zonal product on satin: {:.4f} off\n", off);
  EXPECT_LT(off, 0.1);
  EXPECT_GT(off, 1e-4);
  EXPECT_THROW(sh_image(satin, R"({"product": "zonal", "at": "grid"})"), SceneError);
}

TEST(ShDirect, the_automatic_window_leaves_nothing_negative) {
  // Small lights from all sides of a satin floor: the lobe's series rings where the lobe is dark, and through
  // the positive kernel it does not.
  const Scene scene =
      test::scene_from(R"({"camera": {"position": [0, 1, 2], "look_at": [0, 0, 0], "resolution": [24, 24]},
    "materials": [{"name": "m", "type": "conductor", "metal": "gold", "roughness": 0.5}],
    "objects": [{"name": "o", "type": "quad", "corner": [-4, 0, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "m"}],
    "lights": [{"type": "point", "position": [0, 2, -1], "intensity": 1}]})");
  const vec3 down = glm::normalize(vec3(0, -1, -2));
  const Surface s = scene.surface(scene.intersect(scene.camera().position, down), down);
  const auto lowest = [&](ShReceiverParams::Window window) {
    ShReceiverParams params;
    params.bands = params.light_bands = 7, params.window = window;
    const ShReceiver receiver(params, scene.materials(), {});
    float least = 0, most = 0;
    for (int i = 0; i < 500; ++i) {
      std::vector<std::unique_ptr<Light>> one;
      auto light = std::make_unique<PointLight>();
      light->position = s.position + sh::spherical_fibonacci<float>(i, 500);
      one.push_back(std::move(light));
      std::vector<float> L(3 * 49);
      ShLights(one, {.bands = 7}).coefficients(7, s.position, L.data());
      const vec3 r = receiver.shade(s, scene.bsdf(s), 7, L.data());
      least = std::min(least, r.x), most = std::max(most, r.x);
    }
    return least / most;
  };
  EXPECT_LT(lowest(ShReceiverParams::Window::none), -0.01f);
  // The tables of materials are quadratures with an error of their own.
  EXPECT_GT(lowest(ShReceiverParams::Window::automatic), -2e-3f);
  EXPECT_GT(lowest(ShReceiverParams::Window::dering), -2e-3f);
}

TEST(ShDirect, deringing_takes_what_a_points_light_needs) {
  // Light from all sides needs nothing; one lamp over a grey sky less than the whole kernel.
  const auto picture = [](const char* sky, const char* window) {
    const Scene scene = test::scene_from(fmt::format(
        R"({{"camera": {{"position": [0, 1, 2], "look_at": [0, 0, 0], "resolution": [8, 8]}},
      "materials": [{{"name": "m", "type": "lambert", "albedo": 0.5}}],
      "objects": [{{"name": "o", "type": "quad", "corner": [-4, 0, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "m"}}],
      "lights": [{{"type": "sphere", "center": [0, 3, -1], "radius": 0.3, "radiance": 20}}, {{"type": "environment", "radiance": {}}}]}})",
        sky));
    return test::render_with(
        scene, "sh_direct",
        {.settings = fmt::format(R"({{"window": "{}"}})", window), .width = 8, .height = 8});
  };
  EXPECT_LT(relative_rmse(picture("5", "dering"), picture("5", "none")), 1e-6);
  const double some = relative_rmse(picture("0.1", "dering"), picture("0.1", "none")),
               all = relative_rmse(picture("0.1", "auto"), picture("0.1", "none"));
  fmt::print("deringing changes {:.4f}, the whole kernel {:.4f}\n", some, all);
  EXPECT_LT(some, 0.95 * all);
  EXPECT_GT(some, 0.01 * all);
  const Scene scene = test::scene_from(kFewLights);
  EXPECT_THROW(sh_image(scene, R"({"window": "dering", "windowed": "material"})"), SceneError);
  EXPECT_THROW(sh_image(scene, R"({"window": "dering", "product": "zonal"})"), SceneError);
}

TEST(ShDirect, is_the_same_on_any_number_of_threads) {
  const Scene scene = test::scene_from(kFewLights);
  EXPECT_EQ(sh_image(scene, "{}", 1).pixels, sh_image(scene, "{}", 2).pixels);
}

TEST(ShDirect, refuses_a_scene_without_lights) {
  const Scene scene = test::scene_from(R"({"camera": {"position": [0, 1, 3], "look_at": [0, 0, 0]}})");
  try {
    sh_image(scene, "{}");
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("without lights"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace zonal
