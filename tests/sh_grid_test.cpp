// The grid of sh_direct: how fast its error falls, that it has no seams, that it holds what was asked for.
#include "integrators/sh_direct/sh_grid.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "integrators/sh_direct/sh_seen.h"
#include "tests/light_support.h"
#include "tests/shaped_light_support.h"
#include "tests/support.h"

namespace zonal {
namespace {

using Interpolation = ShScheme::Interpolation;
using Mixed = ShScheme::Mixed;

/// Spheres and a quad around the unit cube, none nearer than half a metre.
ShLights lights_around(int bands) {
  std::vector<std::unique_ptr<Light>> lights;
  std::mt19937 bits(7);
  std::uniform_real_distribution<float> number(-1, 1);
  while (lights.size() < 20) {
    const vec3 center = vec3(0.5f) + 2.5f * vec3(number(bits), number(bits), number(bits));
    const vec3 out = glm::max(glm::abs(center - vec3(0.5f)) - 0.5f, 0.0f);
    if (glm::length(out) < 0.8f) continue;
    lights.push_back(std::make_unique<SphereLight>(test::ball(center, 0.1f + 0.1f * std::abs(number(bits)))));
  }
  lights.push_back(std::make_unique<TriangleLight>(
      test::shaped_quad(vec3(-1, 2, -1), vec3(2, 0, 0), vec3(0, 0, 2), true)));
  return ShLights(lights, {.bands = bands});
}

std::vector<vec3> points_in_the_cube(int count) {
  std::mt19937 bits(11);
  std::uniform_real_distribution<float> number(0.001f, 0.999f);
  std::vector<vec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(number(bits), number(bits), number(bits));
  return points;
}

/// Relative RMSE of the coefficients at points in the cube, of a grid with so many cells a side.
double grid_error(const ShLights& lights, const ShScheme& scheme, int cells, int bands) {
  const std::vector<vec3> points = points_in_the_cube(300);
  ShGrid grid({vec3(0), vec3(1)}, ivec3(cells + 1), scheme, bands);
  grid.need(points);
  grid.build(lights, {});
  const int n = 3 * sh::count(bands);
  std::vector<float> L(n), exact(n);
  double error = 0, size = 0;
  for (const vec3 x : points) {
    EXPECT_TRUE(grid.interpolate(x, bands, L.data()));
    lights.coefficients(bands, x, exact.data());
    for (int i = 0; i < n; ++i) error += sqr(double(L[i]) - exact[i]), size += sqr(double(exact[i]));
  }
  return std::sqrt(error / size);
}

TEST(ShGrid, errors_fall_as_fast_as_the_schemes_promise) {
  // Linear and Taylor drop second derivatives, Hermite without mixed derivatives too; with them it is of
  // third order or better (bars: 1.9 and 2.8, which leaves a tenth for the grids that are still coarse).
  const int bands = 5;
  const ShLights lights = lights_around(bands);
  struct Case {
    const char* name;
    ShScheme scheme;
    double slope;
  };
  for (const Case& c :
       {Case{"linear", {Interpolation::linear}, 1.9}, Case{"taylor", {Interpolation::taylor}, 1.9},
        Case{"hermite, zero", {Interpolation::hermite, Mixed::zero}, 1.9},
        Case{"hermite, differences", {Interpolation::hermite, Mixed::differences}, 2.8},
        Case{"hermite, hessian", {Interpolation::hermite, Mixed::hessian}, 2.8}}) {
    std::vector<double> errors;
    for (const int cells : {2, 4, 8, 16}) errors.push_back(grid_error(lights, c.scheme, cells, bands));
    const double slope = std::log2(errors.front() / errors.back()) / 3;
    fmt::print("{:22} {:.2e} {:.2e} {:.2e} {:.2e}  slope {:.2f}\n", c.name, errors[0], errors[1], errors[2],
               errors[3], slope);
    EXPECT_GE(slope, c.slope) << c.name;
  }
}

TEST(ShGrid, hessians_are_slopes_of_gradients) {
  const int bands = 4, n = sh::count(bands);
  const ShLights lights = lights_around(bands);
  const vec3 x(0.3f, 0.4f, 0.6f);
  std::vector<float> L(3 * n), gradient(9 * n), hessian(18 * n), before(9 * n), after(9 * n);
  lights.hessian(bands, x, 0.01f, L.data(), gradient.data(), hessian.data());
  const int place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (int along = 0; along < 3; ++along) {
    vec3 h(0);
    h[along] = 1.0f / 128;
    std::vector<float> ignored(3 * n);
    lights.gradient(bands, x - h, ignored.data(), before.data());
    lights.gradient(bands, x + h, ignored.data(), after.data());
    for (int axis = 0; axis < 3; ++axis)
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < n; ++i) {
          const int from = (c * 3 + axis) * n + i;
          // Gradients of 3/m and less, rounded in the seventh digit; third order terms of h^2 = 6e-5.
          EXPECT_NEAR(hessian[(c * 6 + place[axis][along]) * n + i], (after[from] - before[from]) * 64, 1e-2)
              << along << axis << ' ' << i;
        }
  }
}

TEST(ShGrid, neighbouring_cells_agree_on_the_face_they_share) {
  const int bands = 5, n = 3 * sh::count(bands);
  const ShLights lights = lights_around(bands);
  for (const ShScheme& scheme :
       {ShScheme{Interpolation::linear}, ShScheme{Interpolation::hermite, Mixed::differences},
        ShScheme{Interpolation::hermite, Mixed::hessian}, ShScheme{Interpolation::hermite, Mixed::zero}}) {
    const std::vector<vec3> points = points_in_the_cube(100);
    ShGrid grid({vec3(0), vec3(1)}, ivec3(3), scheme, bands);
    grid.need(points);
    grid.build(lights, {});
    std::vector<float> left(n), right(n);
    for (vec3 x : points)
      for (int axis = 0; axis < 3; ++axis) {
        vec3 a = x, b = x;
        a[axis] = std::nextafter(0.5f, 0.0f), b[axis] = 0.5f;
        ASSERT_TRUE(grid.interpolate(a, bands, left.data()) && grid.interpolate(b, bands, right.data()));
        // Sums of 32 products in float, of coefficients up to 10.
        for (int i = 0; i < n; ++i) ASSERT_NEAR(left[i], right[i], 2e-5);
      }
  }
}

/// What a cell of side h makes of one sphere of radius 1 whose surface is `gap` from the cell's first corner:
/// the largest of its coefficients and that of the truth, outside the sphere.
std::pair<double, double> beside_a_sphere(float h, float gap, Mixed mixed, float cell) {
  const int bands = 5, n = 3 * sh::count(bands);
  const vec3 away = glm::normalize(vec3(0.5f, 0.3f, 0.8f));
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(std::make_unique<SphereLight>(test::ball(-away * (1 + gap), 1)));
  const ShLights sphere(lights, {.bands = bands});
  const ShScheme scheme{Interpolation::hermite, mixed};
  std::vector<float> parts[8], L(n), exact(n);
  std::array<const float*, 8> corners;
  for (int k = 0; k < 8; ++k) {
    parts[k].resize(size_t(scheme.parts()) * n);
    compute_grid_point(sphere, scheme, bands, h * vec3(k & 1, k >> 1 & 1, k >> 2), 0.03f * h, cell,
                       parts[k].data());
    corners[k] = parts[k].data();
  }
  double most = 0, truth = 0;
  for (const vec3 t : points_in_the_cube(300)) {
    combine(scheme, cell_weights(scheme, t, vec3(h)), corners, n / 3, n / 3, L.data());
    sphere.coefficients(bands, h * t, exact.data());
    for (int i = 0; i < n; ++i)
      most = std::max(most, double(std::abs(L[i]))), truth = std::max(truth, double(std::abs(exact[i])));
  }
  return {most, truth};
}

TEST(ShGrid, a_corner_beside_a_sphere_does_not_spoil_its_cell) {
  for (const Mixed mixed : {Mixed::differences, Mixed::hessian})
    for (const float h : {0.2f, 1.0f, 5.0f})
      for (const float gap : {1e-6f, 1e-4f, 1e-2f}) {
        const auto [bounded, truth] = beside_a_sphere(h, gap, mixed, h);
        const double wild = beside_a_sphere(h, gap, mixed, 0).first;
        SCOPED_TRACE(fmt::format("mixed {} h {} gap {}", int(mixed), h, gap));
        // Values weigh 1 in all. A slope weighs 4/27 h and is at most 3/h of a coefficient's growth with 1 -
        // cos a, 2 pi sqrt((2l+1)/4pi) <= 5.3, thrice the L_00 of a hemisphere: 1.33, and sqrt(3) times that
        // along three axes. Sideways and mixed ones add 4/27 of 3 and less.
        EXPECT_LT(bounded / truth, 4);
        if (gap == 1e-6f) EXPECT_GT(wild / truth, 20) << "nothing was bounded";
      }
}

TEST(ShGrid, hermite_weights_are_exact_for_cubic_polynomials) {
  // f = 2 + x y z + x^2 y - z^3 with its derivatives, in a box of 0.5 x 2 x 1: all within the tricubic space,
  // and the mixed third derivative, constant here, is what differences find.
  const vec3 size(0.5f, 2, 1);
  const ShScheme scheme{Interpolation::hermite, Mixed::hessian};
  const auto f = [](vec3 p) { return 2 + p.x * p.y * p.z + p.x * p.x * p.y - p.z * p.z * p.z; };
  for (const vec3 t : points_in_the_cube(50)) {
    const CellWeights w = cell_weights(scheme, t, size);
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
      const vec3 p = vec3(k & 1, k >> 1 & 1, k >> 2) * size;
      const float parts[7] = {f(p),
                              p.y * p.z + 2 * p.x * p.y,
                              p.x * p.z + p.x * p.x,
                              p.x * p.y - 3 * p.z * p.z,
                              p.z + 2 * p.x,
                              p.y,
                              p.x};
      for (int part = 0; part < 7; ++part) sum += w[k][part] * parts[part];
    }
    EXPECT_NEAR(sum, f(t * size), 1e-5);
  }
}

TEST(ShGrid, derivatives_of_hermite_weights_are_their_slopes) {
  const vec3 size(0.5f, 2, 1), t(0.3f, 0.6f, 0.45f);
  const ShScheme scheme{Interpolation::hermite, Mixed::hessian};
  for (int derivative = 1; derivative < 8; ++derivative) {
    // Along one axis of it, from the weights with one derivative less.
    int axis = 0;
    while (!(derivative >> axis & 1)) ++axis;
    vec3 h(0);
    h[axis] = 1.0f / 256;
    const CellWeights after = cell_weights(scheme, t + h, size, derivative & ~(1 << axis)),
                      before = cell_weights(scheme, t - h, size, derivative & ~(1 << axis)),
                      slope = cell_weights(scheme, t, size, derivative);
    for (int k = 0; k < 8; ++k)
      for (int part = 0; part < kCellParts; ++part)
        // A cubic's third derivative is at most 12: h^2/6 of it is 3e-5, over sizes of half a metre.
        EXPECT_NEAR(slope[k][part], (after[k][part] - before[k][part]) * 128 / size[axis], 2e-3)
            << derivative;
  }
}

TEST(ShGrid, holds_only_what_is_needed) {
  ShGrid grid({vec3(0), vec3(1)}, ivec3(11), {}, 3);
  const std::vector<vec3> points{vec3(0.05f), vec3(0.95f)};
  grid.need(points);
  grid.build(lights_around(3), {});
  EXPECT_EQ(grid.built_points(), 16);
  float L[27];
  EXPECT_TRUE(grid.interpolate(vec3(0.01f), 3, L));
  EXPECT_FALSE(grid.interpolate(vec3(0.5f), 3, L));
  EXPECT_FALSE(grid.interpolate(vec3(1.5f), 3, L));
}

const char* kRoom =
    R"({"camera": {"position": [0, 3, 5], "look_at": [0, 0.4, 0], "vertical_fov": 40, "resolution": [32, 24]},
  "materials": [{"name": "matt", "type": "lambert", "albedo": [0.7, 0.6, 0.5]},
                {"name": "bronze", "type": "metallic_roughness", "base_color": [0.8, 0.5, 0.3], "metallic": 1, "roughness": 0.4}],
  "objects": [{"name": "floor", "type": "quad", "corner": [-4, 0, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "matt"},
              {"name": "ball", "type": "sphere", "center": [0.8, 0.7, 0], "radius": 0.7, "material": "bronze"}],
  "lights": [{"type": "sphere", "name": "lamp", "center": [2, 2.5, 1], "radius": 0.5, "radiance": [8, 2, 2]},
             {"type": "sphere", "center": [-3, 3, 2], "radius": 0.7, "radiance": [2, 8, 2]},
             {"type": "sphere", "center": [-1, 1, 0.5], "radius": 0.05, "radiance": [90, 90, 120]}],
  "keyframes": {"lights": {"lamp": [{"frame": 0, "center": [2, 2.5, 1]}, {"frame": 10, "center": [-1, 1.5, 1]}]}}})";

double relative_rmse(const Image& a, const Image& b) {
  double error = 0, mean = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    error += sqr(double(a.pixels[i]) - b.pixels[i]), mean += b.pixels[i];
  return std::sqrt(error / double(a.pixels.size())) / (mean / double(a.pixels.size()));
}

Image room(const std::string& settings, int frame = 0, int threads = 2) {
  const Scene scene = parse_scene(kRoom, "room.json", {.frame = frame});
  return test::render_with(scene, "sh_direct",
                           {.settings = settings, .width = 32, .height = 24, .threads = threads});
}

TEST(ShDirectGrid, follows_lights_inside_it_that_move_over_glossy_receivers_of_nine_bands) {
  for (const int frame : {0, 5, 10}) {
    const Image pixel = room(R"({"bands": 9, "light_bands": 9})", frame);
    double before = 1;
    for (const int grid : {8, 16, 32}) {
      const double error = relative_rmse(
          room(fmt::format(R"({{"bands": 9, "light_bands": 9, "at": "grid", "grid": {}}})", grid), frame),
          pixel);
      fmt::print("frame {}, grid {}: {:.4f} off\n", frame, grid, error);
      EXPECT_LT(error, before) << grid << " at frame " << frame;
      before = error;
    }
    // A lamp of 5 cm half a metre above the floor: at 32 points a cell is 25 cm.
    EXPECT_LT(before, 0.03) << frame;
  }
}

TEST(ShSeen, thinned_probes_keep_means_and_dwell_beside_lamps) {
  const Scene scene = parse_scene(kRoom, "room.json", {.width = 320, .height = 240});
  const ShLights lights(scene.lights(), {.bands = 1});
  ShSeen seen = look_around(scene, scene.camera(), {});
  const auto light_at = [&](const ShSeen::Probe& p) {
    float L[3];
    lights.coefficients(1, p.surface.position, L);
    return double(L[0]) + L[1] + L[2];
  };
  double all = 0, all2 = 0, brightest = 0;
  for (const auto& p : seen.probes) {
    all += light_at(p), all2 += sqr(light_at(p));
    brightest = std::max(brightest, light_at(p));
  }
  const size_t before = seen.probes.size();
  const ShLights* pointer = &lights;
  seen.thin(256, {&pointer, 1});
  EXPECT_LE(seen.probes.size(), 257u);
  EXPECT_GT(seen.probes.size(), 200u);
  double weights = 0, some = 0, some2 = 0, most = 0;
  for (const auto& p : seen.probes) {
    weights += p.weight, some += p.weight * light_at(p), some2 += p.weight * sqr(light_at(p));
    most = std::max(most, light_at(p));
  }
  // Systematic sampling with weights within [0, 2]: an error of a few per cent of 256 samples' 1/16.
  EXPECT_NEAR(weights / double(before), 1, 0.06);
  EXPECT_NEAR(some / all, 1, 0.06);
  EXPECT_NEAR(some2 / all2, 1, 0.06);
  EXPECT_GT(most, 0.9 * brightest);
}

TEST(ShDirectGrid, automatic_resolution_meets_the_error_asked_for) {
  const Image pixel = room("{}");
  for (const double wanted : {0.05, 0.01}) {
    const double error = relative_rmse(
        room(fmt::format(R"({{"at": "grid", "grid": "auto", "grid_error": {}}})", wanted)), pixel);
    // It is judged at 256 of the 768 pixels: a fifth more may be found at all of them.
    EXPECT_LT(error, 1.5 * wanted);
    EXPECT_GT(error, 0);
  }
}

TEST(ShDirectGrid, is_the_same_on_any_number_of_threads) {
  EXPECT_EQ(room(R"({"at": "grid"})", 0, 1).pixels, room(R"({"at": "grid"})", 0, 2).pixels);
}

TEST(ShDirectGrid, refuses_no_points_and_more_than_memory_holds) {
  const auto message = [](const std::string& settings) -> std::string {
    try {
      room(settings);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(R"({"at": "grid", "grid": 0})").find("grid: found 0, expected"), std::string::npos);
  const std::string large = message(R"({"at": "grid", "grid": 100000})");
  // 1e15 points of 300 numbers and an index.
  EXPECT_NE(large.find("1.2e+18 bytes"), std::string::npos) << large;
}

}  // namespace
}  // namespace zonal
