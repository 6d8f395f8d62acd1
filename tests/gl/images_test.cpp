// Pictures of every twin against its CPU twin's: the same lights, nothing occluded, over the pixels that see
// the same primitive; and what the command says where there is no twin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/metrics.h"
#include "core/scene_impl.h"
#include "core/scene_loader.h"
#include "gl/direct.h"
#include "gl/gbuffer.h"
#include "gl/render.h"
#include "gl/twin.h"
#include "tests/gl/support.h"
#include "tests/paths.h"
#include "tests/support.h"

namespace zonal {
namespace {

constexpr int kWidth = 160, kHeight = 90;

Camera test_camera(const Scene& scene) {
  Camera camera = scene.camera();
  camera.width = kWidth, camera.height = kHeight;
  return camera;
}

std::vector<gl::GBuffer::Pixel> seen_by_gpu(const Scene& scene) {
  const gl::SceneBuffers buffers(scene);
  gl::GBuffer points(test::shader_text(), kWidth, kHeight);
  points.draw(buffers, test_camera(scene), vec2(0.5f), scene.bounds().radius);
  test::gl_context()->check("points");
  return points.read();
}

/// What the pixel's ray meets by Embree, and whether the GPU's point is the same primitive.
struct Agreement {
  std::vector<bool> same;
  double share = 0;
};
Agreement agreement(const Scene& scene, const std::vector<gl::GBuffer::Pixel>& pixels) {
  const Camera camera = test_camera(scene);
  Agreement result;
  int count = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Hit hit = scene.intersect(camera.position, camera.direction(vec2(x + 0.5f, y + 0.5f)));
      const auto& p = pixels[size_t(y) * kWidth + x];
      const bool same = p.shape == hit.shape && (!hit.found() || scene.shapes()[hit.shape].radius > 0 ||
                                                 p.primitive == hit.primitive);
      result.same.push_back(same);
      count += same;
    }
  result.share = double(count) / (kWidth * kHeight);
  return result;
}

const char* kScenes[] = {"furnace", "sphere_over_plane", "box_lit_by_sphere", "cornell", "atrium"};

/// "cornell", or "direct_lights/moving" with the folder.
Scene scene_of(const std::string& name) {
  if (name.find('/') == std::string::npos) return test::bundled_scene(name);
  return load_scene(test::source_dir() + "/scenes/" + name + ".json");
}

/// For names of tests.
std::string word(std::string name) {
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

class PointsOnTheGpu : public testing::TestWithParam<const char*> {};

TEST_P(PointsOnTheGpu, are_those_the_rays_meet) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  const Scene scene = test::bundled_scene(GetParam());
  const auto pixels = seen_by_gpu(scene);
  const Agreement agree = agreement(scene, pixels);
  EXPECT_GE(agree.share, 0.99);
  const Camera camera = test_camera(scene);
  for (int i = 0; i < kWidth * kHeight; ++i) {
    if (!agree.same[i]) continue;
    const vec3 d = camera.direction(vec2(i % kWidth + 0.5f, i / kWidth + 0.5f));
    const Hit hit = scene.intersect(camera.position, d);
    if (!hit.found()) continue;
    const Surface s = scene.surface(hit, d);
    // A float ray meets a slanted surface to within a few roundings of the distance over the cosine.
    const float cosine = std::fmax(-glm::dot(s.normal, d), 0.01f);
    ASSERT_NEAR(pixels[i].depth, hit.t, 2e-6f * (hit.t + glm::length(camera.position)) / cosine) << i;
    ASSERT_LT(glm::length(pixels[i].normal - s.shading.z), 1e-3f) << i;
    ASSERT_LT(glm::length(pixels[i].albedo - scene.bsdf(s).diffuse), 1e-3f) << i;
    ASSERT_LT(glm::length(pixels[i].emitted - scene.emitted(s)), 1e-5f * (1 + glm::length(scene.emitted(s))))
        << i;
  }
}

INSTANTIATE_TEST_SUITE_P(bundled, PointsOnTheGpu, testing::ValuesIn(kScenes),
                         [](const auto& info) { return std::string(info.param); });

/// A method and its settings beside those every picture has.
struct TwinCase {
  const char* name;
  const char* method;
  const char* settings;
};
void PrintTo(const TwinCase& c, std::ostream* out) {
  *out << c.name;
}

const TwinCase kTwins[] = {
    {"vpl", "vpl", R"({"lights": 64, "direct": "none", "occlusion": "none", "clamp": 0.05})"},
    {"vpl_yuksel_diffuse", "vpl",
     R"({"lights": 64, "direct": "none", "occlusion": "none", "attenuation": "yuksel", "clamp": 0.05, "emission": "diffuse"})"},
    {"vsl", "vsl", R"({"lights": 25, "samples": 4, "direct": "none", "occlusion": "none"})"},
    {"hvl", "hvl", R"({"lights": 64, "direct": "none", "occlusion": "none"})"},
    {"hvl_5_bands_brdf", "hvl",
     R"({"lights": 25, "bands": 5, "emission": "brdf", "soft_edge": 0.5, "window": "hann", "direct": "none", "occlusion": "none"})"},
    {"hvl_zonal", "hvl",
     R"({"lights": 25, "bands": 10, "product": "zonal", "direct": "none", "occlusion": "none"})"},
    {"vsgl_2024", "vsgl", R"({"lights": 16, "block_texels": 4, "direct": "none", "occlusion": "none"})"},
    {"vsgl_2015", "vsgl",
     R"({"lights": 16, "block_texels": 4, "direct": "none", "occlusion": "none", "generation": "2015"})"},
};

class TwinPictures : public testing::TestWithParam<std::tuple<TwinCase, const char*>> {};

TEST_P(TwinPictures, agree) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  const auto& [twin, scene_name] = GetParam();
  const Scene scene = scene_of(scene_name);
  const auto make = [&] {
    return find_integrator(twin.method, "test").make(nlohmann::json::parse(twin.settings), "test", nullptr);
  };
  Film expected(kWidth, kHeight), found(kWidth, kHeight);
  render(scene, *make(), expected, {.passes = 1}, {.seed = 3});
  const auto cpu = make();
  gl::render(*test::gl_context(), test::shader_text(), scene, *cpu, twin.method, found, {.passes = 1},
             {.seed = 3});
  const Image a = expected.radiance(), b = found.radiance();
  EXPECT_EQ(found.bad_samples(), 0);

  const Agreement agree = agreement(scene, seen_by_gpu(scene));
  double mean = 0, square = 0;
  int count = 0;
  for (size_t i = 0; i < agree.same.size(); ++i) {
    if (!agree.same[i]) continue;
    for (int c = 0; c < 3; ++c, ++count) {
      const double e = a.pixels[3 * i + c], f = b.pixels[3 * i + c];
      mean += e, square += (e - f) * (e - f);
    }
  }
  mean /= count;
  const double rmse = std::sqrt(square / count);
  RecordProperty("rmse_of_mean", std::to_string(rmse / mean));
  // A plane alone receives nothing of itself: in one of the scenes both are black.
  EXPECT_LE(rmse, 1e-3 * mean) << "mean " << mean;
}

INSTANTIATE_TEST_SUITE_P(bundled, TwinPictures,
                         testing::Combine(testing::ValuesIn(kTwins), testing::ValuesIn(kScenes)),
                         [](const auto& info) {
                           return word(std::string(std::get<0>(info.param).name) + "_" +
                                       std::get<1>(info.param));
                         });

const TwinCase kShDirect[] = {
    {"table", "sh_direct", "{}"},
    {"many_bands", "sh_direct", R"({"light_bands": 9})"},
    {"cosine", "sh_direct",
     R"({"shading": "cosine", "bands": 5, "spheres": "disk", "diffuse": "irradiance"})"},
    {"general", "sh_direct", R"({"shading": "general", "bands": 4, "light_bands": 3, "polygons": "main"})"},
    {"turned", "sh_direct",
     R"({"shading": "turned", "bands": 5, "cosine_bands": 3, "window": "auto", "windowed": "material"})"},
    {"zonal", "sh_direct", R"({"product": "zonal", "polygons": "main", "window": "hann"})"},
    {"grid_linear", "sh_direct", R"({"at": "grid", "interpolation": "linear", "grid": 6})"},
    {"grid_taylor_forward", "sh_direct",
     R"({"at": "grid", "interpolation": "taylor", "grid": 6, "loops": "forward", "polygons": "main"})"},
    {"grid_hermite", "sh_direct", R"({"at": "grid", "light_bands": 6})"},
    {"grid_hermite_forward", "sh_direct",
     R"({"at": "grid", "light_bands": 4, "loops": "forward", "mixed": "zero"})"}};
/// Named by case and scene.
std::string case_name(const testing::TestParamInfo<std::tuple<TwinCase, const char*>>& info) {
  return word(std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param));
}
INSTANTIATE_TEST_SUITE_P(sh_direct, TwinPictures,
                         testing::Combine(testing::ValuesIn(kShDirect),
                                          testing::Values("cornell", "direct_lights/spheres_30")),
                         case_name);
INSTANTIATE_TEST_SUITE_P(
    sh_direct_everywhere, TwinPictures,
    testing::Combine(testing::Values(kShDirect[0], kShDirect[8]),
                     testing::Values("furnace", "sphere_over_plane", "box_lit_by_sphere", "atrium",
                                     "direct_lights/moving", "direct_lights/near_and_far",
                                     "direct_lights/spheres_242", "direct_lights/spheres_512")),
    case_name);
// Exact triangles of these two take a software renderer a minute at pixels.
INSTANTIATE_TEST_SUITE_P(
    sh_direct_triangles, TwinPictures,
    testing::Combine(testing::Values(TwinCase{"main", "sh_direct", R"({"polygons": "main"})"}),
                     testing::Values("direct_lights/tessellated_square", "direct_lights/textured_panel")),
    case_name);

/// Both backends' pictures with direct light.
struct Pair {
  Image cpu, gpu;
};
Pair with_direct(const Scene& scene, int width, int height) {
  const auto settings = nlohmann::json::parse(R"({"lights": 16, "occlusion": "none", "clamp": 0.05})");
  Film expected(width, height), found(width, height);
  const auto first = find_integrator("vpl", "test").make(settings, "test", nullptr);
  render(scene, *first, expected, {.passes = 1}, {.seed = 5});
  const auto second = find_integrator("vpl", "test").make(settings, "test", nullptr);
  gl::render(*test::gl_context(), test::shader_text(), scene, *second, "vpl", found, {.passes = 1},
             {.seed = 5});
  return {expected.radiance(), found.radiance()};
}

TEST(DirectLight, where_nothing_blocks_it_is_that_of_the_cpu) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  for (
      const char* light :
      {R"({"type": "point", "position": [0.5, 2, 0.3], "intensity": 5})",
       R"({"type": "spot", "position": [0.5, 2, 0.3], "look_at": [0, 0, -0.2], "intensity": 9, "inner": 20, "outer": 40})",
       R"({"type": "directional", "direction": [0.3, -1, 0.2], "irradiance": 2})"}) {
    const Scene scene = test::scene_from(std::string(
                                             R"({"camera": {"position": [0, 3, 4], "look_at": [0, 0, 0]},
      "materials": [{"name": "a", "type": "coated", "albedo": [0.6, 0.4, 0.2], "roughness": 0.5}],
      "objects": [{"name": "o", "type": "quad", "corner": [-3, 0, 3], "edges": [[6, 0, 0], [0, 0, -6]], "material": "a"}],
      "lights": [)") + light + "]}");
    const Pair pair = with_direct(scene, kWidth, kHeight);
    double mean = 0, square = 0;
    for (size_t i = 0; i < pair.cpu.pixels.size(); ++i) {
      // Pixels on the quad's edge may see it on one side alone.
      if ((pair.cpu.pixels[i] == 0) != (pair.gpu.pixels[i] == 0)) continue;
      mean += pair.cpu.pixels[i], square += std::pow(double(pair.cpu.pixels[i]) - pair.gpu.pixels[i], 2);
    }
    const double n = double(pair.cpu.pixels.size());
    EXPECT_LT(std::sqrt(square / n), 1e-3 * mean / n) << light;
    EXPECT_GT(mean, 0) << light;
  }
}

TEST(DirectLight, shadows_fall_where_the_rays_say) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  const Scene scene = test::bundled_scene("atrium");
  const Pair pair = with_direct(scene, 320, 180);
  const float exposure = scene.camera().exposure;
  const double similarity = ssim(to_display(pair.gpu, exposure), to_display(pair.cpu, exposure));
  RecordProperty("ssim", std::to_string(similarity));
  // Filtered edges are a few pixels wide: 0.995 measured. A map that is off by a texel's width of bias loses
  // contacts first.
  EXPECT_GT(similarity, 0.98);
}

TEST(DirectLight, an_area_light_is_refused_by_name) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  const Scene scene = test::bundled_scene("cornell");
  try {
    const gl::DirectLight direct(test::shader_text(), scene);
    FAIL() << "not refused";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("\"lamp\""), std::string::npos) << error.what();
  }
}

TEST(Twins, a_method_or_setting_without_one_is_told_in_a_line) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  const Scene scene = test::bundled_scene("cornell");
  const auto message = [&](const std::string& method, const std::string& settings) -> std::string {
    const auto cpu = find_integrator(method, "test").make(nlohmann::json::parse(settings), "test", nullptr);
    try {
      gl::make_twin(method, test::shader_text(), *cpu, scene);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "none";
  };
  const std::string path = message("path", "{}"), center = message("vpl", R"({"direct": "none"})");
  EXPECT_NE(path.find("\"path\""), std::string::npos) << path;
  EXPECT_NE(path.find("vpl"), std::string::npos) << path;
  EXPECT_NE(center.find("/occlusion: found \"center\", expected \"none\""), std::string::npos) << center;
}

TEST(LightBuffer, more_lights_than_a_buffer_holds_are_gathered_in_chunks) {
  if (!test::gl_context()) GTEST_SKIP() << test::no_gl_reason();
  VirtualLightSet set;
  set.lights.resize(10);
  const LightArrays lights(set, 8);
  gl::CoatTables coats;
  const gl::LightBuffer buffer(lights, Lobes::all, coats, 4 * gl::LightBuffer::kTexels + 3);
  ASSERT_EQ(buffer.chunks().size(), 3u);
  EXPECT_EQ(buffer.chunks()[1].first, 4);
  EXPECT_EQ(buffer.chunks()[2].count, 2);
}

}  // namespace
}  // namespace zonal
