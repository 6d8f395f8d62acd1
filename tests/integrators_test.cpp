// Every row of the table on every analytic scene and on the inputs where renderers break.
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support.h"

namespace zonal {
namespace {

void expect_sound(const Image& image, const std::string& what) {
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    ASSERT_TRUE(std::isfinite(image.pixels[i]) && image.pixels[i] >= 0)
        << what << ": channel " << i % 3 << " of pixel " << i / 3 << " is " << image.pixels[i];
  }
}

/// Renders and counts what the film had to repair: the methods themselves must not leave NaN behind.
void expect_sound_render(const Scene& scene, const IntegratorRow& row, const std::string& what,
                         const std::string& settings = "{}") {
  const auto method = row.make(nlohmann::json::parse(settings), "test", nullptr);
  Film film(12, 9);
  // A method that is nothing but lights may refuse a scene without.
  if (row.name == "sh_direct" && scene.lights().empty()) {
    EXPECT_THROW(render(scene, *method, film, {.passes = 2}, {.seed = 3, .threads = 2}), SceneError) << what;
    return;
  }
  render(scene, *method, film, {.passes = 2}, {.seed = 3, .threads = 2});
  EXPECT_EQ(film.bad_samples(), 0u) << what;
  expect_sound(film.radiance(), what);
}

struct Hard {
  const char *name, *text;
};
void PrintTo(const Hard& hard, std::ostream* out) { *out << hard.name; }

const Hard kHardScenes[] = {
    {"nothing", R"({"camera": {"position": [0,0,0], "look_at": [0,0,-1]}})"},
    {"no_lights", R"({"camera": {"position": [0,1,3], "look_at": [0,0,0]}, "materials": [{"name":"a","type":"lambert"}],
      "objects": [{"name":"o","type":"sphere","center":[0,0,0],"radius":1,"material":"a"}]})"},
    {"light_touches_floor", R"({"camera": {"position": [0,1,3], "look_at": [0,0,0]},
      "materials": [{"name":"a","type":"coated","roughness":0.1}],
      "objects": [{"name":"o","type":"quad","corner":[-2,0,2],"edges":[[4,0,0],[0,0,-4]],"material":"a"}],
      "lights": [{"type":"sphere","center":[0,0.25,0],"radius":0.25,"radiance":4},
                 {"type":"quad","corner":[-1,0,-1],"edges":[[2,0,0],[0,1,0]],"radiance":2,"two_sided":true}]})"},
    {"light_on_the_surface", R"({"camera": {"position": [0,1,3], "look_at": [0,0,0]},
      "materials": [{"name":"a","type":"lambert"}],
      "objects": [{"name":"o","type":"quad","corner":[-2,0,2],"edges":[[4,0,0],[0,0,-4]],"material":"a"}],
      "lights": [{"type":"point","position":[0,0,0],"intensity":4}]})"},
    {"inside_the_light", R"({"camera": {"position": [0,0.2,0.3], "look_at": [0,0,0]},
      "materials": [{"name":"a","type":"lambert"}],
      "objects": [{"name":"o","type":"quad","corner":[-2,0,2],"edges":[[4,0,0],[0,0,-4]],"material":"a"}],
      "lights": [{"type":"sphere","center":[0,0,0],"radius":1,"radiance":4}]})"},
    {"grazing", R"({"camera": {"position": [0,0.0001,3], "look_at": [0,0,0]},
      "materials": [{"name":"a","type":"conductor","metal":"gold","roughness":0.01}],
      "objects": [{"name":"o","type":"quad","corner":[-2,0,2],"edges":[[4,0,0],[0,0,-4]],"material":"a"}],
      "lights": [{"type":"directional","direction":[0,-0.00001,-1],"irradiance":3},{"type":"environment","radiance":1}]})"},
    {"thin_triangles", R"({"camera": {"position": [0,1,3], "look_at": [0,0,0]},
      "materials": [{"name":"a","type":"blinn_phong","exponent":5000,"specular":0.5}],
      "objects": [{"name":"t","type":"triangle","vertices":[[-1,0,0],[1,0,0],[0,0.000001,0]],"material":"a"},
                  {"name":"u","type":"triangle","vertices":[[-1,-0.1,0],[1,-0.1,0],[0,1,0]],"material":"a"}],
      "lights": [{"type":"triangle","vertices":[[-1,2,0],[1,2,0],[0,2,0.000001]],"radiance":1000},
                 {"type":"spot","position":[0,2,2],"look_at":[0,0,0],"intensity":3,"inner":10,"outer":20}]})"},
    {"mirror_and_rough", R"({"camera": {"position": [0,1,3], "look_at": [0,0,0]},
      "materials": [{"name":"a","type":"conductor","metal":"silver","roughness":0},
                    {"name":"b","type":"metallic_roughness","metallic":0.5,"roughness":1,"base_color":1}],
      "objects": [{"name":"o","type":"sphere","center":[-0.6,0,0],"radius":0.5,"material":"a"},
                  {"name":"p","type":"sphere","center":[0.6,0,0],"radius":0.5,"material":"b"}],
      "lights": [{"type":"point","position":[0,3,0],"intensity":40},{"type":"sphere","center":[0,2,1],"radius":0.0001,"radiance":1e8}]})"},
};

using Case = std::tuple<IntegratorRow, Hard>;
class EveryMethodOnHardScenes : public testing::TestWithParam<Case> {};

TEST_P(EveryMethodOnHardScenes, leaves_no_nan_infinity_or_negative_radiance) {
  const auto& [row, hard] = GetParam();
  expect_sound_render(test::scene_from(hard.text), row, row.name + " on " + hard.name);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryMethodOnHardScenes,
                         testing::Combine(testing::ValuesIn(integrator_table().begin(), integrator_table().end()),
                                          testing::ValuesIn(kHardScenes)),
                         [](const auto& info) {
                           return std::get<0>(info.param).name + "_" + std::get<1>(info.param).name;
                         });

class EveryMethodOnAnalyticScenes : public testing::TestWithParam<std::tuple<IntegratorRow, std::string>> {};

TEST_P(EveryMethodOnAnalyticScenes, renders_soundly) {
  const auto& [row, name] = GetParam();
  expect_sound_render(test::bundled_scene(name), row, row.name + " on " + name);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryMethodOnAnalyticScenes,
                         testing::Combine(testing::ValuesIn(integrator_table().begin(), integrator_table().end()),
                                          testing::Values("furnace", "sphere_over_plane", "box_lit_by_sphere")),
                         [](const auto& info) {
                           return std::get<0>(info.param).name + "_" + std::get<1>(info.param);
                         });

}  // namespace
}  // namespace zonal
