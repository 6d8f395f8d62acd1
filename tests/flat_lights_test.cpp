// Disks, polygons and pictures that glow: their meshes, the light they bring by sampling and on spherical
// harmonics.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "core/basic_shapes.h"
#include "core/error.h"
#include "core/flat_shapes.h"
#include "core/image.h"
#include "lights/sh_lights.h"
#include "tests/center_reference.h"
#include "tests/light_support.h"
#include "tests/shaped_light_support.h"

namespace zonal {
namespace {

using namespace test;
using glm::dvec3;

/// Twice the area vector, m^2 (Newell).
dvec3 newell(const std::vector<vec3>& p) {
  dvec3 sum(0);
  for (size_t i = 0; i < p.size(); ++i) sum += glm::cross(dvec3(p[i]), dvec3(p[(i + 1) % p.size()]));
  return sum;
}

TEST(polygon_mesh, tiles_any_simple_polygon_facing_its_front) {
  std::mt19937 bits(3);
  std::uniform_real_distribution<float> number(0.2f, 1);
  for (int trial = 0; trial < 200; ++trial) {
    // Stars about the origin never meet themselves; turned and moved into some plane, wound either way.
    const int corners = 3 + trial % 20;
    const Frame frame(glm::normalize(vec3(number(bits), -number(bits), number(bits))));
    std::vector<vec3> p;
    for (int i = 0; i < corners; ++i) {
      const float angle = (trial % 2 ? 1.0f : -1.0f) * 2 * kPi * float(i) / float(corners);
      p.push_back(vec3(3, -2, 1) + number(bits) * (frame.x * std::cos(angle) + frame.y * std::sin(angle)));
    }
    const MeshData mesh = polygon_mesh(p);
    ASSERT_EQ(mesh.triangles.size(), p.size() - 2);
    // Triangles that all face the front and have the polygon's area together do not overlap.
    const dvec3 whole = newell(p);
    double sum = 0;
    for (const uvec3 t : mesh.triangles) {
      const dvec3 part = newell({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
      EXPECT_GT(glm::dot(part, whole), 0);
      sum += glm::length(part);
    }
    EXPECT_NEAR(sum / glm::length(whole), 1, 1e-4) << "corners off the plane by roundings of 4";
  }
}

TEST(polygon_mesh, takes_corners_in_line_and_hollows) {
  const std::vector<vec3> comb{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0},
                               {3, 2, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}};
  EXPECT_NEAR(surface_area(polygon_mesh(comb)), 0.5 * glm::length(newell(comb)), 1e-12);
  EXPECT_THROW(polygon_mesh(std::vector<vec3>{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0, 0}, {0, 2, 0}}),
               SceneError)
      << "a corner touches an edge";
}

TEST(disk_mesh, has_the_disks_area_and_nearly_its_edge) {
  const vec3 center(1, 2, 3), normal = glm::normalize(vec3(1, -2, 0.5f));
  const MeshData mesh = disk_mesh(center, normal, 0.7f);
  EXPECT_NEAR(surface_area(mesh) / (M_PI * 0.49), 1, 1e-6);
  for (const uvec3 t : mesh.triangles) {
    const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    EXPECT_NEAR(glm::dot(glm::normalize(glm::cross(b - a, c - a)), normal), 1, 1e-4);
    EXPECT_NEAR(glm::length(b - center) / 0.7f, 1, 0.0009);  // sqrt(step/sin(step)), step 2 pi/64
    EXPECT_NEAR(glm::length(0.5f * (b + c) - center) / 0.7f, 1, 0.0009);  // and that times cos(step/2)
  }
}

/// The irradiance of a surface at x facing n; green channel.
Mean irradiance(const Light& light, vec3 x, vec3 n) {
  return mean_of(1 << 16, [&] {
    const LightSample s = light.sample(x, random_pair());
    return s.pdf > 0 ? double(s.radiance.y) * std::max(0.0f, glm::dot(n, s.w_in)) / s.pdf : 0.0;
  });
}

TEST(textured_light, brings_what_its_texels_bring) {
  for (const bool two_sided : {false, true}) {
    const TexturedLight panel = bright_panel({-1, 1.5f, -1}, {2, 0, 0.3f}, {0, 0.4f, 1.5f}, two_sided);
    for (const vec3 x : {vec3(0), vec3(0.8f, 0.3f, -0.5f), vec3(-3, 1, 2)}) {
      double truth = 0, variance = 0;
      for (const TriangleLight& texel : texels_of(panel)) {
        const Mean one = irradiance(texel, x, {0, 1, 0});
        truth += one.value, variance += sqr(one.error);
      }
      const Mean all = irradiance(panel, x, {0, 1, 0});
      EXPECT_NEAR(all.value, truth, 5 * std::sqrt(sqr(all.error) + variance) + 1e-12);
      EXPECT_GE(panel.importance(x) * 1.0001f, luminance(vec3(1, 2, 3)) / 2 * (all.value - 5 * all.error));
    }
    vec3 power(0);
    for (const TriangleLight& texel : texels_of(panel)) power += texel.power();
    EXPECT_NEAR(panel.power().y / power.y, 1, 1e-6);
  }
}

TEST(textured_light, sample_and_pdf_agree) {
  const vec3 corner(-1, 3, -1), u(2, 0, 0), v(0, 0, 1.5f), x(0.3f, 0.5f, 0.1f);  // faces down
  const TexturedLight panel = bright_panel(corner, u, v);
  int compared = 0;
  for (int i = 0; i < 1000; ++i) {
    const LightSample s = panel.sample(x, random_pair());
    ASSERT_GT(s.pdf, 0);
    const vec3 p = x + s.w_in * s.distance - corner;
    const vec2 uv(p.x / 2, p.z / 1.5f);
    // On a texel's edge rounding decides.
    const vec2 inside = glm::abs(glm::fract(uv * vec2(5, 3)) - 0.5f);
    if (std::max(inside.x, inside.y) > 0.499f) continue;
    const LightHit hit{corner + p, {0, -1, 0}, uv, 0};
    EXPECT_NEAR(panel.pdf(x, hit) / s.pdf, 1, 1e-5);
    EXPECT_EQ(panel.radiance(hit, -s.w_in), s.radiance);
    EXPECT_EQ(panel.radiance(hit, {0, 1, 0}), vec3(0)) << "its back";
    ++compared;
  }
  EXPECT_GT(compared, 900);
}

/// A floor under lamps of the three kinds; the picture has 4 x 2 texels.
Scene lamps(const std::string& picture, const char* size = "[32, 24]") {
  return scene_from(
      R"({"camera": {"position": [0, 3, 5], "look_at": [0, 0.4, 0], "vertical_fov": 40, "resolution": )" +
      std::string(size) + R"(},
    "materials": [{"name": "matt", "type": "lambert", "albedo": 0.7}],
    "objects": [{"name": "floor", "type": "quad", "corner": [-4, 0, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "matt"},
                {"name": "ball", "type": "sphere", "center": [0, 0.6, 0], "radius": 0.6, "material": "matt"}],
    "lights": [{"type": "disk", "center": [2, 3, 1], "normal": [-1, -1, 0], "radius": 0.5, "radiance": [8, 2, 2]},
               {"type": "polygon", "vertices": [[-3, 3, 0], [-2, 3, 0], [-2, 3, 1], [-2.5, 3, 0.4], [-3, 3, 1]], "power": 40},
               {"type": "textured", "corner": [-1, 3, -2], "edges": [[2, 0, 0], [0, 0.5, 0.5]], "file": ")" +
      picture + R"(", "scale": 2}]})");
}

struct FlatLights : testing::Test {
  std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "flat_lights";
  std::string picture = (folder / "panel.exr").string();
  void SetUp() override {
    std::filesystem::create_directories(folder);
    Image image(4, 2);
    for (int i = 0; i < 24; ++i) image.pixels[size_t(i)] = float(i) * 0.25f;
    write_image(picture, {.layers = {{"", image}}}, 1);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
};

TEST_F(FlatLights, the_picture_hangs_upright) {
  const Scene scene = lamps(picture);
  // Seen from the front: corner lower left. Texel (column, row from the top) holds 0.25 (3 (4 row + column)),
  // twice.
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column) {
      const vec3 p = vec3(-1, 3, -2) + vec3(2, 0, 0) * ((float(column) + 0.5f) / 4) +
                     vec3(0, 0.5f, 0.5f) * ((1.5f - float(row)) / 2);
      const vec3 front = glm::normalize(glm::cross(vec3(2, 0, 0), vec3(0, 0.5f, 0.5f)));
      for (const float side : {1.0f, -1.0f}) {
        const Hit hit = scene.intersect(p + side * front, -side * front);
        ASSERT_TRUE(hit.found());
        const float seen = scene.emitted(scene.surface(hit, -side * front)).x;
        EXPECT_FLOAT_EQ(seen, side > 0 ? 1.5f * float(4 * row + column) : 0.0f);
      }
    }
}

TEST_F(FlatLights, sh_direct_tends_to_the_path_tracer) {
  const Scene scene = lamps(picture);
  const CenterReference reference(scene, R"({"max_bounces": 0, "direct_occlusion": "none"})", 32, 24, 100);
  // Whatever is exact: what 9 bands leave of the clamped cosine, and the reference's noise, as in
  // sh_direct_test.cpp. Spheres for triangles as near as these are coarser: Sec. 4.2.
  for (const auto& [settings, most] : {std::pair{R"("polygons": "exact", "texture_error": 0)", 0.02},
                                       {R"("polygons": "exact")", 0.02},
                                       {R"("polygons": "factorized")", 0.02},
                                       {R"("polygons": "main", "texture_error": 0)", 0.06}}) {
    const double error = reference.error(
        render_with(scene, "sh_direct",
                    {.settings = std::string(R"({"bands": 9, "light_bands": 9, )") + settings + "}",
                     .width = 32,
                     .height = 24}));
    std::printf("%s: RMSE over mean %.4f\n", settings, error);
    EXPECT_LT(error, most) << settings;
  }
}

std::vector<float> coefficients(const std::vector<const Light*>& lights, const ShLightOptions& options,
                                vec3 x) {
  std::vector<float> L(3 * size_t(sh::count(options.bands)));
  ShLights(lights, options).coefficients(options.bands, x, L.data());
  return L;
}

TEST(sh_lights_of_pictures, are_those_of_the_texels_within_the_light_that_is_moved) {
  // A smooth picture with an edge, 32 x 16 texels.
  std::vector<vec3> texels;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) texels.push_back(vec3(1 + float(x), 2 + float(y), x > 20 ? 30 : 1));
  const vec3 corner(-1, 2, -1), u(2, 0, 0), v(0, 0, 1);
  const TexturedLight panel(corner, u, v, 32, 16, texels, false);
  const vec3 x(0.2f, 0, 0.3f);
  std::vector<TriangleLight> quads = texels_of(panel);
  std::vector<const Light*> pointers;
  for (const TriangleLight& quad : quads) pointers.push_back(&quad);
  const int bands = 5;
  const ShLightOptions whole{.bands = bands, .texture_error = 0};
  const std::vector<float> truth = coefficients(pointers, whole, x), all = coefficients({&panel}, whole, x);
  for (size_t i = 0; i < truth.size(); ++i) EXPECT_NEAR(all[i], truth[i], 1e-5 * truth[0]);

  int before = ShLights(std::vector<const Light*>{&panel}, whole).count();
  for (const float error : {0.02f, 0.1f, 0.5f}) {
    const ShLightOptions options{.bands = bands, .texture_error = error};
    const int cells = ShLights(std::vector<const Light*>{&panel}, options).count();
    EXPECT_LT(cells, before), before = cells;
    const std::vector<float> some = coefficients({&panel}, options, x);
    // |Y_lm| <= sqrt((2l+1)/4pi); light from a square metre is at most cos/d^2 <= 1/4, from 2 m below: no
    // cosine and no distance here exceeds that. All colours of the picture's light together may move by
    // `error`.
    const vec3 mean = panel.mean();
    const double most = error * std::sqrt(9 / (4 * M_PI)) * 0.25 * panel.area() * (mean.x + mean.y + mean.z);
    double worst = 0;
    for (size_t i = 0; i < truth.size(); ++i) worst = std::max(worst, std::abs(double(some[i]) - truth[i]));
    std::printf("texture_error %.2f: %d triangles, %.1e of the largest coefficient off\n", error, cells,
                worst / truth[0]);
    EXPECT_LT(worst, most);
    EXPECT_GT(worst, 0);
  }
}

TEST(sh_lights_of_disks, one_sphere_stands_for_a_far_one) {
  const vec3 center(0.5f, 2, 0), normal = glm::normalize(vec3(0.3f, -1, 0.2f));
  std::vector<MeshLight::Triangle> triangles;
  const MeshData mesh = disk_mesh(center, normal, 0.4f);
  for (const uvec3 t : mesh.triangles)
    triangles.push_back({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
  const DiskLight disk(triangles, vec3(1, 2, 3), false, center, normal, 0.4f);
  const ShLightOptions main{.bands = 4, .polygons = ShLightOptions::Polygons::main};
  EXPECT_EQ(ShLights(std::vector<const Light*>{&disk}, main).count(), 1);
  double before = 1;
  for (const float distance : {1.0f, 2.0f, 4.0f, 8.0f}) {
    const vec3 x = center + distance * glm::normalize(normal + vec3(0.4f, 0, 0));
    const auto exact = coefficients({&disk}, {.bands = 4, .tolerance = 1e-5f}, x),
               sphere = coefficients({&disk}, main, x);
    double error = 0, size = 0;
    for (size_t i = 0; i < exact.size(); ++i)
      error += sqr(double(exact[i]) - sphere[i]), size += sqr(double(exact[i]));
    const double off = std::sqrt(error / size);
    std::printf("%.0f m away: %.1e off\n", distance, off);
    // Both tend to a point with the disk's power and the cosine: what is left falls with the square of the
    // distance.
    EXPECT_LT(off, before / 3), before = off;
  }
}

}  // namespace
}  // namespace zonal
