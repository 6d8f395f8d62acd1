/// Materials of type "measured" in scenes: how files are named and shared, what is said of wrong ones, and
/// that the methods show what the data say. With ZONAL_DATA set the real files are in it too.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>

#include "core/error.h"
#include "materials/material.h"
#include "materials/measured_brdf.h"
#include "tests/bsdf_cases.h"
#include "tests/bsdf_quadrature.h"
#include "tests/measured_files.h"
#include "tests/mesh_files.h"
#include "tests/support.h"

namespace zonal {
namespace {

using namespace test;

/// A ball of each file, all of them names relative to the folder.
std::string balls(const std::vector<std::string>& files) {
  nlohmann::json scene = {{"camera", {{"position", {0, 0, 9}}, {"look_at", {0, 0, 0}}}}};
  for (const std::string& file : files) {
    const std::string name = "m" + std::to_string(scene["objects"].size());
    scene["materials"].push_back({{"name", name}, {"type", "measured"}, {"file", file}});
    scene["objects"].push_back({{"type", "sphere"}, {"material", name}});
  }
  return scene.dump();
}

const MeasuredMaterial& measured(const Scene& scene, uint32_t index) {
  return dynamic_cast<const MeasuredMaterial&>(scene.material(index));
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeasuredScene, a_file_is_read_once_however_often_it_is_named) {
  const Folder folder;
  write_isotropic_rgl(folder.path(""), 0.5);
  write_isotropic_rgl(folder.path(""), 0.2);
  const Scene scene = parse_scene(balls({"ggx_0.5_rgb.bsdf", "ggx_0.2_rgb.bsdf", "./ggx_0.5_rgb.bsdf"}),
                                  folder.path("scene.json"));
  EXPECT_EQ(measured(scene, 0).brdf, measured(scene, 2).brdf);
  EXPECT_NE(measured(scene, 0).brdf, measured(scene, 1).brdf);
  EXPECT_STREQ(measured(scene, 0).type(), "measured");
  EXPECT_STREQ(measured(scene, 0).brdf->format(), "RGL");
  EXPECT_EQ(measured(scene, 0).brdf->description, "Analytic GGX");
  const Bsdf bsdf = measured(scene, 1).at(vec2(0));
  EXPECT_EQ(bsdf.measured, measured(scene, 1).brdf.get());
}

TEST(MeasuredScene, files_may_stand_in_the_data_folder) {
  const Folder folder;
  write_isotropic_rgl(folder.path(""), 0.5);
  const char* before = std::getenv("ZONAL_DATA");
  const std::string kept = before ? before : "";
  setenv("ZONAL_DATA", folder.path("").c_str(), 1);
  EXPECT_EQ(error_of([] { scene_from(balls({"${ZONAL_DATA}/ggx_0.5_rgb.bsdf"})); }), "no error");
  if (before)
    setenv("ZONAL_DATA", kept.c_str(), 1);
  else
    unsetenv("ZONAL_DATA");
}

TEST(MeasuredScene, wrong_files_are_told) {
  const Folder folder;
  const auto error = [&](const std::string& file) {
    return error_of([&] { parse_scene(balls({file}), folder.path("scene.json")); });
  };
  const std::string where = folder.path("scene.json") + ": /materials/0/file: ";
  EXPECT_EQ(error("no.bsdf"), where + "there is no file \"" + folder.path("no.bsdf") + "\", expected one");
  folder.write("cut.bsdf",
               rgl_tensors({.surface = {}, .elevations = 3, .facets = 5, .side = 4}).bytes().substr(0, 500));
  EXPECT_EQ(error("cut.bsdf").find(where + folder.path("cut.bsdf") + ": field \""), 0u) << error("cut.bsdf");
  folder.write("other.bsdf", "not a tensor file at all");
  EXPECT_EQ(error("other.bsdf"),
            where + folder.path("other.bsdf") +
                ": found \"not a tensor\" in front, expected \"tensor_file\" and a zero byte");
  folder.write("text.binary", "neither the one nor the other");
  EXPECT_EQ(error("text.binary").find(where + folder.path("text.binary")), 0u) << error("text.binary");
  EXPECT_NE(error_of([] {
              scene_from(R"({"camera": {"position": [0, 0, 9], "look_at": [0, 0, 0]},
                             "materials": [{"name": "m", "type": "measured"}]})");
            }).find("/materials/0: found no \"file\""),
            std::string::npos);
}

// ---- pictures --------------------------------------------------------------------------------------------

struct Surface {
  std::string name, file;
};
std::vector<Surface> surfaces(const Folder& folder) {
  std::vector<Surface> all = {{"isotropic", write_isotropic_rgl(folder.path(""), 0.3)},
                              {"anisotropic", write_anisotropic_rgl(folder.path(""))}};
  for (const std::string& file : published_rgl_files())
    all.push_back({std::filesystem::path(file).stem().string(), file});
  return all;
}

/// A floor of the material at y = 0, seen from `degrees` off its normal by a camera of very small angle; its
/// tangent, u, is x and the camera stands on that side. `lights` is JSON.
Scene floor_scene(const std::string& file, double degrees, const nlohmann::json& objects,
                  const nlohmann::json& lights) {
  const double t = degrees * kPiDouble / 180;
  nlohmann::json scene = {
      {"camera",
       {{"position", {0.9 * std::sin(t), 0.9 * std::cos(t), 0}},
        {"look_at", {0, 0, 0}},
        {"up", {0, 0, 1}},
        {"vertical_fov", 0.05}}},
      {"materials",
       {{{"name", "m"}, {"type", "measured"}, {"file", file}},
        {{"name", "black"}, {"type", "lambert"}, {"albedo", 0}}}},
      {"objects",
       {{{"type", "quad"}, {"corner", {-1, 0, 1}}, {"edges", {{2, 0, 0}, {0, 0, -2}}}, {"material", "m"}}}},
      {"lights", lights}};
  for (const auto& object : objects) scene["objects"].push_back(object);
  return scene_from(scene.dump());
}

TEST(MeasuredScene, a_directional_light_shows_the_brdf_itself) {
  const Folder folder;
  for (const Surface& surface : surfaces(folder)) {
    const auto brdf = load_measured(surface.file);
    for (const double degrees : {20.0, 65.0}) {
      // The quad's tangent is x and its normal y, so the shading frame's y is -z of the world.
      const vec3 w_out = direction(float(degrees), 0), w_in = glm::normalize(vec3(-0.5f, 0.3f, 0.6f));
      const nlohmann::json light = {
          {{"type", "directional"}, {"direction", {-w_in.x, -w_in.z, w_in.y}}, {"irradiance", {2, 2, 2}}}};
      const Scene scene = floor_scene(surface.file, degrees, nlohmann::json::array(), light);
      const vec3 truth = brdf->evaluate(w_out, w_in) * (2 * w_in.z);
      for (const char* method : {"path", "vpl"}) {
        const Image image = render_with(scene, method, {.width = 3, .height = 3});
        // The camera's rays leave by 0.05 degrees about the middle one: 1e-3 rad over lobes of at least 0.05.
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(image.at(1, 1)[k], truth[k], 0.02f * max_component(truth) + 1e-5f)
              << surface.name << " " << method << " " << degrees;
      }
    }
  }
}

TEST(MeasuredScene, a_furnace_returns_the_albedo_and_no_more) {
  // Five walls and a ceiling of radiance 1 that reflect nothing: what the floor shows is its directional
  // albedo, which quadrature of evaluate() gives too.
  const auto wall = [](nlohmann::json corner, nlohmann::json edges) -> nlohmann::json {
    return {{"type", "quad"},
            {"corner", corner},
            {"edges", edges},
            {"material", "black"},
            {"emission", {{"radiance", 1}}}};
  };
  const nlohmann::json walls = {
      wall({-1, 1, -1}, {{2, 0, 0}, {0, 0, 2}}), wall({-1, 0, -1}, {{2, 0, 0}, {0, 1, 0}}),
      wall({1, 0, 1}, {{-2, 0, 0}, {0, 1, 0}}), wall({-1, 0, 1}, {{0, 0, -2}, {0, 1, 0}}),
      wall({1, 0, -1}, {{0, 0, 2}, {0, 1, 0}})};
  const Folder folder;
  for (const Surface& surface : surfaces(folder)) {
    const auto brdf = load_measured(surface.file);
    for (const double degrees : {25.0, 75.0}) {
      const vec3 w_out = direction(float(degrees), 0);
      Vec truth(0);
      SphericalGrid(w_out, 0.02).integrate([&](vec3 w, double weight) {
        truth += Vec(brdf->evaluate(w_out, w)) * (weight * w.z);
      });
      const Scene scene = floor_scene(surface.file, degrees, walls, nlohmann::json::array());
      const Image image = render_with(scene, "path", {.passes = 4, .width = 16, .height = 16});
      for (int k = 0; k < 3; ++k) {
        std::vector<double> pixels;
        for (int y = 0; y < 16; ++y)
          for (int x = 0; x < 16; ++x) pixels.push_back(image.at(x, y)[k]);
        const Estimate e = estimate(pixels);
        // Half a percent: quadrature across the kinks of the interpolation. Five standard errors: 80
        // comparisons.
        EXPECT_NEAR(e.mean, truth[k], 5 * e.standard_error + 5e-3 * truth[k] + 1e-5)
            << surface.name << " " << degrees << " channel " << k;
        EXPECT_LT(e.mean, 1) << surface.name;
      }
    }
  }
}

TEST(MeasuredScene, the_albedo_is_shown) {
  const Folder folder;
  const std::string file = write_isotropic_rgl(folder.path(""), 0.3);
  const auto brdf = load_measured(file);
  const nlohmann::json light = {{{"type", "directional"}, {"direction", {0, -1, 0}}, {"irradiance", 1}}};
  const Image image =
      render_with(floor_scene(file, 30, nlohmann::json::array(), light), "albedo", {.width = 1, .height = 1});
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(image.at(0, 0)[k], brdf->albedo[k], 1e-5f);
  // The analytic surface's, by quadrature: mean over elevations, cosine weighted. 0.01: the coarse grid near
  // the horizon, and 4096 samples.
  const Ggx surface{0.3, 0.3};
  Vec mean(0);
  constexpr int kSteps = 24;
  for (int i = 0; i < kSteps; ++i) {
    const double sine2 = (i + 0.5) / kSteps;  // equal steps of sin^2 weigh by the cosine
    const Vec w_out(std::sqrt(sine2), 0, std::sqrt(1 - sine2));
    SphericalGrid(w_out, 0.1).integrate([&](vec3 w, double weight) {
      mean += surface.f(w_out, Vec(w)) * (weight * w.z / kSteps);
    });
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(brdf->albedo[k], mean[k], 0.01);
}

}  // namespace
}  // namespace zonal
