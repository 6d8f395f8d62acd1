// `path` against closed forms and quadrature: Student's t decides pixel by pixel, so no tolerance is chosen by hand.
#include "integrators/path/path.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support.h"

namespace zonal {
namespace {

constexpr double kPiD = 3.14159265358979323846;

/// Renders `seeds` independent one-pass pictures (pixel centres) and returns each pixel's green channel as an estimate.
std::vector<test::Estimate> pixel_estimates(const Scene& scene, const std::string& settings, int size, int seeds,
                                            int passes_each = 1) {
  std::vector<std::vector<double>> values(size * size);
  for (int seed = 0; seed < seeds; ++seed) {
    std::vector<double> sums(size * size, 0.0);
    for (int pass = 0; pass < passes_each; ++pass) {
      const Image image = test::render_with(scene, "path",
                                            {.settings = settings, .width = size, .height = size,
                                             .seed = static_cast<uint64_t>(seed) * passes_each + pass + 1});
      for (int i = 0; i < size * size; ++i) sums[i] += image.pixels[3 * i + 1] / passes_each;
    }
    for (int i = 0; i < size * size; ++i) values[i].push_back(sums[i]);
  }
  std::vector<test::Estimate> estimates;
  for (const auto& pixel : values) estimates.push_back(test::estimate(pixel));
  return estimates;
}

/// Every pixel by Student's t at the Bonferroni threshold of a 0.1 % test, and the whole picture within 4 standard
/// errors, that error being below 0.2 % of the value: an estimate too noisy to say anything fails.
void expect_agreement(const std::vector<test::Estimate>& pixels, const std::function<double(int)>& truth) {
  double mean = 0, variance = 0, truth_mean = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    EXPECT_GT(test::t_test_p(pixels[i], truth(i)), 0.001 / pixels.size())
        << "pixel " << i << ": " << pixels[i].mean << " +- " << pixels[i].standard_error << ", truth " << truth(i);
    mean += pixels[i].mean / pixels.size();
    truth_mean += truth(i) / pixels.size();
    variance += pixels[i].standard_error * pixels[i].standard_error / (pixels.size() * pixels.size());
  }
  const double error = std::sqrt(variance);
  EXPECT_LT(error, 0.002 * truth_mean);
  EXPECT_LT(std::abs(mean - truth_mean), 4 * error + 2e-6 * truth_mean);  // + float rounding of the picture
}

TEST(Path, furnace_inside_a_glowing_sphere_shows_emission_over_one_minus_albedo) {
  const Scene scene = test::scene_from(R"({
    "camera": {"position": [0.2, 0.1, 0.3], "look_at": [1, 0.2, 0], "vertical_fov": 60, "resolution": [8, 8]},
    "materials": [{"name": "wall", "type": "lambert", "albedo": 0.6}],
    "objects": [{"name": "shell", "type": "sphere", "center": [0, 0, 0], "radius": 2, "material": "wall",
                 "emission": {"radiance": 0.5, "two_sided": true}}]})");
  // L = E + rho L everywhere.
  expect_agreement(pixel_estimates(scene, "{}", 4, 64, 40), [](int) { return 0.5 / (1 - 0.6); });
}

/// Camera ray of pixel i of a size x size picture, to compute what it should see.
vec3 ray(const Scene& scene, int i, int size) {
  Camera camera = scene.camera();
  camera.width = camera.height = size;
  return camera.direction(vec2(i % size + 0.5f, i / size + 0.5f));
}

TEST(Path, sphere_light_over_a_plane_has_the_irradiance_of_its_solid_angle) {
  const Scene scene = test::scene_from(R"({
    "camera": {"position": [0, 1.5, 3], "look_at": [0, 0, 0.3], "vertical_fov": 30, "resolution": [8, 8]},
    "materials": [{"name": "floor", "type": "lambert", "albedo": 0.8}],
    "objects": [{"name": "floor", "type": "quad", "corner": [-20, 0, 20], "edges": [[40, 0, 0], [0, 0, -40]], "material": "floor"}],
    "lights": [{"type": "sphere", "center": [0.5, 2, -0.5], "radius": 0.4, "radiance": 10}]})");
  const auto truth = [&](int i) {
    const vec3 d = ray(scene, i, 6), origin = scene.camera().position;
    const double t = -double(origin.y) / d.y;
    const double dx = origin.x + t * d.x - 0.5, dz = origin.z + t * d.z + 0.5, h = 2, r = 0.4;
    const double d2 = dx * dx + h * h + dz * dz;
    // Whole sphere above the horizon: E = pi L sin^2 a cos(theta) (Mézières 2022, Eq. 3.10 for l = 1 says the same).
    const double irradiance = kPiD * 10 * (r * r / d2) * (h / std::sqrt(d2));
    return 0.8 / kPiD * irradiance;
  };
  expect_agreement(pixel_estimates(scene, R"({"max_bounces": 0})", 6, 200), truth);
}

const char* kBoxLitBySphere = R"({
  "camera": {"position": [0, 1, 1.9], "look_at": [0, 0.6, 0], "vertical_fov": 50, "resolution": [8, 8]},
  "materials": [{"name": "wall", "type": "lambert", "albedo": 0.5}],
  "objects": [{"name": "room", "type": "box", "low": [-1, 0, -2], "high": [1, 2, 2], "material": "wall"}],
  "lights": [{"type": "sphere", "center": [0, 1.5, 0], "radius": 0.1, "radiance": 50}]})";

struct BoxPoint {
  double p[3], n[3];
};

/// Where the camera ray of pixel i meets the inside of the box [-1,1]x[0,2]x[-2,2].
BoxPoint box_point(const Scene& scene, int i, int size) {
  const vec3 d = ray(scene, i, size), o = scene.camera().position;
  const double low[3] = {-1, 0, -2}, high[3] = {1, 2, 2};
  double best = 1e9;
  BoxPoint hit{};
  for (int axis = 0; axis < 3; ++axis) {
    const double t = ((d[axis] > 0 ? high[axis] : low[axis]) - o[axis]) / d[axis];
    if (!(t > 0) || t >= best) continue;
    best = t;
    hit = {};
    hit.n[axis] = d[axis] > 0 ? -1 : 1;
  }
  for (int axis = 0; axis < 3; ++axis) hit.p[axis] = o[axis] + best * d[axis];
  return hit;
}

/// Irradiance of the sphere light on a wall point: the sphere lies wholly in front of every wall.
double direct_irradiance(const BoxPoint& x) {
  const double to[3] = {0 - x.p[0], 1.5 - x.p[1], 0 - x.p[2]}, r = 0.1;
  const double d2 = to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
  const double cosine = (to[0] * x.n[0] + to[1] * x.n[1] + to[2] * x.n[2]) / std::sqrt(d2);
  return kPiD * 50 * r * r / d2 * cosine;
}

TEST(Path, direct_light_in_a_box_is_the_sphere_lights_closed_form) {
  const Scene scene = test::scene_from(kBoxLitBySphere);
  expect_agreement(pixel_estimates(scene, R"({"max_bounces": 0})", 5, 150),
                   [&](int i) { return 0.5 / kPiD * direct_irradiance(box_point(scene, i, 5)); });
}

/// One unoccluded bounce: rho/pi times the integral of the walls' direct radiosity over their area, by the midpoint rule
/// on n x n cells a wall (every wall but the point's own: its cosine is zero).
double one_bounce(const BoxPoint& x, int n) {
  const double low[3] = {-1, 0, -2}, high[3] = {1, 2, 2};
  double irradiance = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      const double area = (high[b] - low[b]) * (high[c] - low[c]) / (n * n);
      for (int cell = 0; cell < n * n; ++cell) {
        BoxPoint y{};
        y.n[axis] = side ? -1 : 1;
        y.p[axis] = side ? high[axis] : low[axis];
        y.p[b] = low[b] + (high[b] - low[b]) * (cell % n + 0.5) / n;
        y.p[c] = low[c] + (high[c] - low[c]) * (cell / n + 0.5) / n;
        double d2 = 0, cos_x = 0, cos_y = 0;
        for (int k = 0; k < 3; ++k) {
          const double to = y.p[k] - x.p[k];
          d2 += to * to, cos_x += to * x.n[k], cos_y -= to * y.n[k];
        }
        if (cos_x <= 0 || cos_y <= 0) continue;
        irradiance += 0.5 / kPiD * direct_irradiance(y) * cos_x * cos_y / (d2 * d2) * area;
      }
    }
  }
  return 0.5 / kPiD * irradiance;
}

TEST(Path, one_bounce_without_occlusion_is_a_plain_integral_over_the_walls) {
  const Scene scene = test::scene_from(kBoxLitBySphere);
  const auto truth = [&](int i) {  // Richardson: the midpoint rule's error falls with the square of the cell
    const BoxPoint x = box_point(scene, i, 4);
    return (4 * one_bounce(x, 240) - one_bounce(x, 120)) / 3;
  };
  expect_agreement(pixel_estimates(scene, R"({"min_bounces": 1, "max_bounces": 1, "occlusion": "none"})", 4, 100, 400), truth);
}

TEST(Path, bounces_asked_for_apart_add_up_to_the_whole) {
  const Scene scene = test::scene_from(kBoxLitBySphere);
  const auto whole = pixel_estimates(scene, "{}", 3, 60, 30);
  const auto direct = pixel_estimates(scene, R"({"max_bounces": 0})", 3, 60, 30);
  const auto indirect = pixel_estimates(scene, R"({"min_bounces": 1})", 3, 60, 30);
  for (size_t i = 0; i < whole.size(); ++i) {
    const double sum = direct[i].mean + indirect[i].mean;
    const double error = std::hypot(direct[i].standard_error, indirect[i].standard_error);
    EXPECT_GT(test::t_test_p(whole[i], {sum, error, 60}), 0.001 / whole.size())
        << "pixel " << i << ": " << whole[i].mean << " against " << sum;
  }
}

TEST(Path, without_anything_in_the_way_occlusion_makes_no_difference) {
  // An empty convex box seen from inside, lit by a point: no wall hides another.
  const Scene scene = test::scene_from(R"({
    "camera": {"position": [0, 1, 1.9], "look_at": [0, 0.6, 0], "vertical_fov": 50, "resolution": [8, 8]},
    "materials": [{"name": "wall", "type": "lambert", "albedo": 0.5}],
    "objects": [{"name": "room", "type": "box", "low": [-1, 0, -2], "high": [1, 2, 2], "material": "wall"}],
    "lights": [{"type": "point", "position": [0, 1.5, 0], "intensity": 3}]})");
  const auto blocked = pixel_estimates(scene, R"({"max_bounces": 3})", 3, 50, 20);
  const auto open = pixel_estimates(scene, R"({"max_bounces": 3, "occlusion": "none", "direct_occlusion": "none"})", 3, 50, 20);
  for (size_t i = 0; i < open.size(); ++i)
    EXPECT_GT(test::t_test_p(blocked[i], open[i]), 0.001 / open.size()) << blocked[i].mean << " " << open[i].mean;
}

TEST(Path, a_shadowed_floor_is_lit_without_direct_occlusion) {
  const Scene scene = test::scene_from(R"({
    "camera": {"position": [0, 0.5, 2], "look_at": [0, 0, 0], "vertical_fov": 10, "resolution": [8, 8]},
    "materials": [{"name": "floor", "type": "lambert", "albedo": 0.5}],
    "objects": [{"name": "floor", "type": "quad", "corner": [-3, 0, 3], "edges": [[6, 0, 0], [0, 0, -6]], "material": "floor"},
                {"name": "lid", "type": "quad", "corner": [-3, 1, 3], "edges": [[6, 0, 0], [0, 0, -6]], "material": "floor"}],
    "lights": [{"type": "point", "position": [0, 2, 0], "intensity": 4}]})");
  const Image dark = test::render_with(scene, "path", {.settings = R"({"max_bounces": 0})", .width = 3, .height = 3});
  EXPECT_EQ(dark.rgb(1, 1), vec3(0));
  const Image lit = test::render_with(
      scene, "path", {.settings = R"({"max_bounces": 0, "direct_occlusion": "none"})", .width = 3, .height = 3});
  EXPECT_NEAR(lit.rgb(1, 1).y, 0.5 / kPiD * 4 / 4, 2e-3);  // rho/pi I/h^2 under the light; the pixel's centre looks there to within its own size
}

}  // namespace
}  // namespace zonal
