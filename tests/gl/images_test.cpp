// Pictures of every twin against its CPU twin's: the same lights, nothing occluded, over the pixels that see
// the same primitive; and what the command says where there is no twin.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/scene_shapes.h"
#include "gl/gbuffer.h"
#include "gl/render.h"
#include "gl/twin.h"
#include "tests/gl/support.h"
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
      const bool same = p.shape == hit.shape && (!hit.found() || shapes_of(scene)[hit.shape].radius > 0 ||
                                                 p.primitive == hit.primitive);
      result.same.push_back(same);
      count += same;
    }
  result.share = double(count) / (kWidth * kHeight);
  return result;
}

const char* kScenes[] = {"furnace", "sphere_over_plane", "box_lit_by_sphere", "cornell", "atrium"};

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
  const Scene scene = test::bundled_scene(scene_name);
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
                           return std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param);
                         });

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
