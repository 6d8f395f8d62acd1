// Virtual lights: the flux they hold and the irradiance they bring, against closed forms and quadrature.
#include "lights/virtual_lights.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

#include "tests/light_support.h"

namespace zonal {
namespace {

using namespace test;
using glm::dvec3;
using Options = VirtualLightOptions;

/// A scene of Lambert quads (corner, edge, edge), all of one albedo.
struct Quad {
  vec3 corner, u, v;
};
Scene scene_of(const std::vector<Quad>& quads, std::vector<std::unique_ptr<Light>> lights,
               float albedo = 0.5f) {
  SceneParts parts;
  auto material = std::make_unique<LambertMaterial>();
  material->albedo.value = vec3(albedo);
  parts.materials.push_back(std::move(material));
  ShapeData shape;
  for (const Quad& q : quads) {
    const auto first = static_cast<uint32_t>(shape.mesh.positions.size());
    for (const vec3 p : {q.corner, q.corner + q.u, q.corner + q.u + q.v, q.corner + q.v})
      shape.mesh.positions.push_back(p);
    shape.mesh.triangles.push_back({first, first + 1, first + 2});
    shape.mesh.triangles.push_back({first, first + 2, first + 3});
  }
  shape.material = 0;
  parts.shapes.push_back(std::move(shape));
  parts.lights = std::move(lights);
  return Scene(std::move(parts));
}

/// The closed box [-1,1] x [0,3] x [-2,2].
std::vector<Quad> box() {
  const vec3 x(2, 0, 0), y(0, 3, 0), z(0, 0, 4), low(-1, 0, -2);
  return {{low, x, y}, {low, y, z}, {low, z, x}, {low + z, x, y}, {low + x, y, z}, {low + y, z, x}};
}

std::unique_ptr<PointLight> point(vec3 position, vec3 intensity) {
  auto light = std::make_unique<PointLight>();
  light->position = position, light->intensity = intensity;
  return light;
}
std::unique_ptr<SpotLight> spot(vec3 position, vec3 direction, vec3 intensity) {
  auto light = std::make_unique<SpotLight>();
  light->position = position, light->direction = glm::normalize(direction), light->intensity = intensity;
  light->cone = {0.3f, 0.9f};
  return light;
}

std::vector<std::unique_ptr<Light>> lamps_in_the_box() {
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(point({0.3f, 1, 0.5f}, {1, 2, 3}));
  lights.push_back(spot({0, 2.5f, 0}, {0.2f, -1, 0.4f}, {9, 7, 5}));
  auto sphere = std::make_unique<SphereLight>(ball({-0.5f, 2, -1}, 0.2f));
  lights.push_back(std::move(sphere));
  lights.push_back(std::make_unique<MeshLight>(quad({0, 2.9f, 0}, {0.3f, 0, 0}, {0, 0, 0.3f})));
  return lights;
}

/// The mean over passes of a number of the set. Passes are stratified together: the error, from their
/// scatter, is too large rather than too small.
Mean over_passes(const Scene& scene, Options options, int passes,
                 const std::function<double(const VirtualLightSet&)>& of) {
  options.pass = 0;
  return mean_of(passes, [&] {
    const VirtualLightSet set = make_virtual_lights(scene, options, {});
    ++options.pass;
    return of(set);
  });
}

double flux(const VirtualLightSet& set, uint32_t bounce, uint32_t primary = kNone) {
  double sum = 0;
  for (const VirtualLight& v : set.lights)
    if (v.bounce == bounce && (primary == kNone || v.primary == primary)) sum += v.power.y;
  return sum;
}

TEST(virtual_lights, of_the_first_bounce_hold_all_the_flux_in_a_closed_box) {
  const Scene scene = scene_of(box(), lamps_in_the_box());
  for (const auto distribution : {Options::paths, Options::grid}) {
    SCOPED_TRACE(distribution);
    const Options options{.lights = 301, .distribution = distribution, .seed = 5};
    double total = 0;
    for (uint32_t i = 0; i < scene.lights().size(); ++i) {
      const double power = scene.lights()[i]->power().y;
      total += power;
      EXPECT_MEAN(over_passes(scene, options, 400, [&](const VirtualLightSet& s) { return flux(s, 1, i); }),
                  power);
    }
    EXPECT_MEAN(over_passes(scene, options, 400, [](const VirtualLightSet& s) { return flux(s, 1); }), total);
    EXPECT_NEAR(make_virtual_lights(scene, options, {}).emitted_power.y, total, 1e-5 * total);
  }
}

TEST(virtual_lights, of_later_bounces_hold_what_the_walls_reflect) {
  // In a closed box of albedo a the flux that arrives after b reflections is a^b of the first.
  const float albedo = 0.6f;
  const Scene scene = scene_of(box(), lamps_in_the_box(), albedo);
  const double total = make_virtual_lights(scene, {}, {}).emitted_power.y;
  for (const auto distribution : {Options::paths, Options::grid}) {
    const Options options{.lights = 400, .bounces = 4, .distribution = distribution};
    for (uint32_t bounce = 1; bounce <= 4; ++bounce) {
      SCOPED_TRACE(testing::Message() << "bounce " << bounce << " distribution " << distribution);
      EXPECT_MEAN(over_passes(scene, options, 200, [&](const VirtualLightSet& s) { return flux(s, bounce); }),
                  total * std::pow(double(albedo), bounce - 1));
    }
  }
}

TEST(virtual_lights, from_outside_hold_what_the_boxes_silhouette_catches) {
  // Directional: irradiance times projected area. Constant sky on a convex body: pi L times its surface.
  for (const auto distribution : {Options::paths, Options::grid}) {
    std::vector<std::unique_ptr<Light>> lights;
    auto sun = std::make_unique<DirectionalLight>();
    sun->direction = glm::normalize(vec3(1, -2, 0.5f)), sun->irradiance = vec3(4);
    const dvec3 d(sun->direction);
    lights.push_back(std::move(sun));
    lights.push_back(std::make_unique<EnvironmentLight>(1, 1, std::vector<vec3>{vec3(0.5f)}, 0.0f));
    const Scene scene = scene_of(box(), std::move(lights));
    const Options options{.lights = 300, .distribution = distribution};
    EXPECT_MEAN(over_passes(scene, options, 400, [](const VirtualLightSet& s) { return flux(s, 1, 0); }),
                4 * (std::abs(d.x) * 12 + std::abs(d.y) * 8 + std::abs(d.z) * 6));
    EXPECT_MEAN(over_passes(scene, options, 400, [](const VirtualLightSet& s) { return flux(s, 1, 1); }),
                M_PI * 0.5 * 2 * (12 + 8 + 6));
  }
}

/// The irradiance (VL-1) brings to x facing n, unoccluded.
double gathered(const VirtualLightSet& set, vec3 x, vec3 n) {
  double sum = 0;
  for (const VirtualLight& v : set.lights) {
    const vec3 to_x = x - v.position;
    const float d2 = glm::dot(to_x, to_x);
    const vec3 w = to_x / std::sqrt(d2);
    const vec3 f = evaluate(v.bsdf, prepare(v.bsdf, v.frame.to_local(v.w_in)), v.frame.to_local(w));
    sum += double(v.power.y) * f.y * std::max(0.0f, glm::dot(v.normal, w)) * std::max(0.0f, -glm::dot(n, w)) /
           d2;
  }
  return sum;
}

TEST(virtual_lights, bring_the_irradiance_that_quadrature_over_the_floor_gives) {
  const vec3 x(1, 2, -0.5f), n = glm::normalize(vec3(0.2f, -1, 0.1f));
  const auto lamp_at = [](bool cone) {
    std::vector<std::unique_ptr<Light>> lights;
    if (cone)
      lights.push_back(spot({0.2f, 1, 0.1f}, {0.3f, -1, 0}, vec3(5)));
    else
      lights.push_back(point({0.2f, 1, 0.1f}, vec3(5)));
    return lights;
  };
  for (const bool cone : {false, true}) {
    const Scene scene = scene_of({{{-6, 0, -6}, {0, 0, 12}, {12, 0, 0}}}, lamp_at(cone));
    // Midpoints of 1 cm^2: the integrand bends over half a metre, so they err by about (0.01/0.5)^2/24 =
    // 2e-5.
    double truth = 0;
    for (int i = 0; i < 1200; ++i) {
      for (int j = 0; j < 1200; ++j) {
        const vec3 y(-6 + 0.01f * (float(i) + 0.5f), 0, -6 + 0.01f * (float(j) + 0.5f));
        const LightSample s = scene.lights()[0]->sample(y, {});
        if (s.pdf == 0) continue;
        const dvec3 to_x = dvec3(x) - dvec3(y);
        const double d2 = glm::dot(to_x, to_x), d = std::sqrt(d2);
        truth += s.radiance.y * s.w_in.y * 0.5 / M_PI * (to_x.y / d) *
                 std::max(0.0, -glm::dot(dvec3(n), to_x) / d) / d2 * 1e-4;
      }
    }
    for (const auto distribution : {Options::paths, Options::grid}) {
      const Mean m = over_passes(scene, {.lights = 600, .distribution = distribution}, 400,
                                 [&](const VirtualLightSet& s) { return gathered(s, x, n); });
      SCOPED_TRACE(testing::Message() << "cone " << cone << " distribution " << distribution);
      EXPECT_LT(m.error, 0.005 * truth);
      EXPECT_NEAR(m.value, truth, 5 * m.error + 1e-4 * truth);
    }
  }
}

TEST(virtual_lights, are_as_many_as_asked_and_report_their_grid) {
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(point({0, 1, 0}, vec3(1)));
  const Scene one = scene_of(box(), std::move(lights));
  const VirtualLightSet grid = make_virtual_lights(one, {.lights = 600}, {});
  EXPECT_EQ(grid.lights.size(), 600u);
  EXPECT_EQ(grid.rays, 600u);
  EXPECT_EQ(grid.columns, 10);
  EXPECT_EQ(grid.rows, 10);
  const VirtualLightSet paths = make_virtual_lights(one, {.lights = 333, .distribution = Options::paths}, {});
  EXPECT_EQ(paths.lights.size(), 333u);
  EXPECT_EQ(paths.columns, 0);
  const VirtualLightSet deep =
      make_virtual_lights(one, {.lights = 400, .bounces = 5, .distribution = Options::paths}, {});
  // A path stores 1 to 5 lights, scatter about 1.1 around 2: 200 paths and the pilot's 256 give sigma 21.
  EXPECT_NEAR(static_cast<double>(deep.lights.size()), 400, 5 * 21);

  // More lights than virtual lights: no grid can serve them, and the number is kept.
  std::vector<std::unique_ptr<Light>> crowd;
  for (int i = 0; i < 1000; ++i) crowd.push_back(point({0.001f * float(i) - 0.5f, 1, 0}, vec3(1 + i % 3)));
  const Scene many = scene_of(box(), std::move(crowd));
  EXPECT_EQ(make_virtual_lights(many, {.lights = 400}, {}).lights.size(), 400u);
  EXPECT_MEAN(over_passes(many, {.lights = 400}, 100, [](const VirtualLightSet& s) { return flux(s, 1); }),
              4 * M_PI * 1999);
}

TEST(virtual_lights, know_where_they_lie_and_where_their_light_came_from) {
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(point({0.2f, 1, 0.3f}, vec3(1)));
  const Scene scene = scene_of(box(), std::move(lights));
  for (const VirtualLight& v :
       make_virtual_lights(scene, {.lights = 200, .bounces = 2, .distribution = Options::paths}, {}).lights) {
    EXPECT_NEAR(glm::length(v.w_in), 1, 1e-6);
    EXPECT_GT(glm::dot(v.normal, v.w_in), 0);
    EXPECT_GT(glm::dot(v.normal, vec3(0, 1.5f, 0) - v.position), 0) << "the lit side is the inside";
    if (v.bounce > 1) continue;
    const vec3 back = v.position + v.w_in * v.primary_distance;
    EXPECT_NEAR(glm::length(back - vec3(0.2f, 1, 0.3f)), 0, 1e-5);
  }
}

bool same_bits(const VirtualLightSet& a, const VirtualLightSet& b) {
  const auto equal = [](const VirtualLight& p, const VirtualLight& q) {
    return p.position == q.position && p.power == q.power && p.w_in == q.w_in && p.bounce == q.bounce;
  };
  return a.rays == b.rays &&
         std::equal(a.lights.begin(), a.lights.end(), b.lights.begin(), b.lights.end(), equal);
}

TEST(virtual_lights, depend_on_seed_and_pass_and_not_on_threads) {
  const Scene scene = scene_of(box(), lamps_in_the_box());
  for (const auto distribution : {Options::paths, Options::grid}) {
    const Options options{.lights = 3000, .bounces = 3, .distribution = distribution, .seed = 7, .pass = 3};
    const VirtualLightSet first = make_virtual_lights(scene, options, {});
    {
      const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
      EXPECT_TRUE(same_bits(first, make_virtual_lights(scene, options, {})));
    }
    Options other = options;
    other.seed = 8;
    EXPECT_FALSE(same_bits(first, make_virtual_lights(scene, other, {})));
    other = options, other.pass = 4;
    EXPECT_FALSE(same_bits(first, make_virtual_lights(scene, other, {})));
  }
}

/// A spot over the middle of a floor that its whole cone falls on.
Scene spot_over_floor(vec3 axis = {0.2f, -1, 0.1f}) {
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(spot({0.2f, 1, 0.1f}, axis, vec3(5)));
  return scene_of({{{-6, 0, -6}, {0, 0, 12}, {12, 0, 0}}}, std::move(lights));
}

TEST(virtual_lights, of_a_map_hold_the_flux_of_their_light_in_every_single_pass) {
  // Cells carry their integrated flux, so nothing is left to chance where nothing escapes.
  const Scene scene = spot_over_floor();
  const double power = scene.lights()[0]->power().y;
  for (const int lights : {30, 400}) {
    for (const int block : {1, 3}) {
      for (const auto placement : {Options::sampled, Options::center}) {
        const VirtualLightSet set = make_virtual_lights(
            scene, {.lights = lights, .seed = 9, .block_texels = block, .placement = placement}, {});
        EXPECT_NEAR(flux(set, 1), power, 1e-4 * power)
            << lights << " lights, blocks of " << block << " placement " << placement;
      }
    }
  }
  // What they emit over all directions, by quadrature of (VL-1)'s flux: the floor's albedo times that.
  const VirtualLightSet set = make_virtual_lights(scene, {.lights = 100}, {});
  double emitted = 0;
  constexpr int kSide = 40;
  for (const VirtualLight& v : set.lights) {
    const BsdfContext view = prepare(v.bsdf, v.frame.to_local(v.w_in), PathEnd::light);
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const float z = (float(i) + 0.5f) / kSide, phi = 2 * kPi * (float(j) + 0.5f) / kSide;
        const vec3 w(safe_sqrt(1 - z * z) * std::cos(phi), safe_sqrt(1 - z * z) * std::sin(phi), z);
        emitted += double(v.power.y) * evaluate(v.bsdf, view, w).y * z * 2 * M_PI / (kSide * kSide);
      }
    }
  }
  EXPECT_NEAR(emitted, 0.5 * power, 1e-3 * power);
}

TEST(virtual_lights, of_a_block_hold_what_its_texels_hold) {
  const Scene scene = scene_of(box(), lamps_in_the_box());
  for (const auto placement : {Options::sampled, Options::center}) {
    const VirtualLightSet set = make_virtual_lights(
        scene, {.lights = 100, .bounces = 2, .block_texels = 4, .placement = placement, .keep_texels = true},
        {});
    size_t gridded = 0;
    for (const VirtualLight& v : set.lights) {
      if (v.grid == kNone) {
        EXPECT_EQ(v.texel_count, 0u);
        continue;
      }
      ++gridded;
      ASSERT_LE(v.texel_count, 16u);
      double sum = 0, area = 0;
      bool stands_at_one = false;
      for (uint32_t t = v.first_texel; t < v.first_texel + v.texel_count; ++t) {
        const VirtualLight& texel = set.texels[t];
        sum += texel.power.y, area += texel.footprint;
        EXPECT_EQ(texel.grid, v.grid);
        EXPECT_EQ(texel.cell, v.cell);
        stands_at_one = stands_at_one || texel.position == v.position;
      }
      EXPECT_NEAR(v.power.y, sum, 1e-5 * sum);
      EXPECT_NEAR(v.footprint, area, 1e-5 * area);
      EXPECT_TRUE(stands_at_one);
    }
    EXPECT_GT(gridded, 50u);
  }
}

TEST(virtual_lights, placed_at_centres_stay_where_they_are_from_pass_to_pass) {
  const Scene scene = spot_over_floor();
  Options options{.lights = 64, .block_texels = 3, .placement = Options::center};
  const VirtualLightSet first = make_virtual_lights(scene, options, {});
  options.pass = 5, options.seed = 77;
  EXPECT_TRUE(same_bits(first, make_virtual_lights(scene, options, {})));
}

TEST(virtual_lights, know_their_neighbours_in_the_map) {
  const Scene scene = spot_over_floor({0, -1, 0.001f});
  const VirtualLightSet set = make_virtual_lights(scene, {.lights = 400}, {});
  ASSERT_EQ(set.grids.size(), 1u);
  const VirtualLightGrid& grid = set.grids[0];
  EXPECT_EQ(grid.columns, set.columns);
  EXPECT_TRUE(grid.spot);
  EXPECT_NEAR(grid.fov, 2 * 0.9f, 1e-5);
  // On a plane one metre below, cells are squares of this size: neighbours lie within two diagonals.
  const float side = 2 * std::tan(0.9f) / float(grid.columns);
  for (uint32_t i = 0; i < set.lights.size(); ++i) {
    int count = 0;
    for (const uint32_t n : set.neighbours(i)) {
      if (n == kNone) continue;
      ++count;
      EXPECT_LT(glm::distance(set.lights[i].position, set.lights[n].position),
                2 * std::sqrt(2.0f) * side * 1.01f);
      const auto back = set.neighbours(n);
      EXPECT_NE(std::find(back.begin(), back.end(), i), back.end());
    }
    EXPECT_GT(count, 0);
    // The footprint is the light's patch of floor: (GRID-1)'s solid angle projected back onto the plane.
    const vec3 p = set.lights[i].position - vec3(0.2f, 0, 0.1f);
    if (glm::length(vec2(p.x, p.z)) + side < std::tan(0.3f))
      EXPECT_NEAR(set.lights[i].footprint, side * side, 0.15f * side * side);
  }
}

TEST(virtual_lights, are_none_and_say_why) {
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(spot({0, 1, 0}, {0, 1, 0}, vec3(1)));
  lights[0]->name = "flashlight";
  const Quad floor{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}};
  const VirtualLightSet missed = make_virtual_lights(scene_of({floor}, std::move(lights)), {}, {});
  EXPECT_TRUE(missed.lights.empty());
  ASSERT_EQ(missed.warnings.size(), 1u);
  EXPECT_NE(missed.warnings[0].find("flashlight"), std::string::npos) << missed.warnings[0];
  // A light without a name goes by its number.
  std::vector<std::unique_ptr<Light>> nameless;
  nameless.push_back(spot({0, 1, 0}, {0, 1, 0}, vec3(1)));
  const VirtualLightSet again = make_virtual_lights(scene_of({floor}, std::move(nameless)), {}, {});
  ASSERT_EQ(again.warnings.size(), 1u);
  EXPECT_NE(again.warnings[0].find("spot light 0"), std::string::npos) << again.warnings[0];

  const VirtualLightSet dark = make_virtual_lights(scene_of({floor}, {}), {}, {});
  EXPECT_TRUE(dark.lights.empty());
  EXPECT_EQ(dark.warnings.size(), 1u);
}

TEST(virtual_lights, stop_when_asked) {
  const Scene scene = scene_of(box(), lamps_in_the_box());
  const std::atomic<bool> asked = true;
  const VirtualLightSet set =
      make_virtual_lights(scene, {.lights = 1000000}, Stop(&asked, Clock::time_point::max()));
  EXPECT_EQ(set.rays, 0u);
  EXPECT_TRUE(set.warnings.empty());
}

}  // namespace
}  // namespace zonal
