// `vsl` against quadrature in double, its limits, and the inputs where renderers break.
#include "integrators/vsl/vsl.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/glsl.h"
#include "integrators/vpl/vpl.h"
#include "tests/support.h"
#include "tests/virtual_light_support.h"

namespace zonal {
namespace kernel {
#include "integrators/vsl/vsl.glsl"
}
namespace {

using glm::dvec3;
using Sampling = VslParams::Sampling;

std::unique_ptr<Material> lambert(vec3 albedo) {
  auto material = std::make_unique<LambertMaterial>();
  material->albedo.value = albedo;
  return material;
}
std::unique_ptr<Material> glossy(float roughness) {
  auto material = std::make_unique<MetallicRoughnessMaterial>();
  material->roughness.value = roughness, material->metallic.value = 0.4f;
  material->base_color.value = vec3(0.8f, 0.6f, 0.3f);
  return material;
}
std::vector<std::unique_ptr<Material>> list(std::unique_ptr<Material> a,
                                            std::unique_ptr<Material> b = nullptr) {
  std::vector<std::unique_ptr<Material>> all;
  all.push_back(std::move(a));
  if (b) all.push_back(std::move(b));
  return all;
}

/// A floor around the origin, looked at from above by four pixels close together.
const test::Patch kFloor{{-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, 0};
Camera above(int size = 2) {
  return test::camera_at({1, 1.5f, 2}, {0, 0, 0}, size, 0.05f);
}

VslParams params_of(Sampling sampling, float radius, int samples = 16) {
  VslParams p;
  p.sampling = sampling, p.samples = samples;
  p.radius.rule = RadiusRule::metres, p.radius.metres = radius;
  p.occlusion = Occlusion::none, p.direct = ManyLightsParams::Direct::none;
  return p;
}
VplParams plain_vpl() {
  VplParams p;
  p.occlusion = Occlusion::none, p.direct = ManyLightsParams::Direct::none;
  return p;
}
VirtualLightSet set_of(std::vector<VirtualLight> lights) {
  VirtualLightSet set;
  set.lights = std::move(lights);
  return set;
}

/// (VSL-1) at pixel (0, 0) by midpoints over the cone, the evaluation of BRDFs apart in double. Green.
double quadrature(const Scene& scene, const VirtualLight& light, double radius, bool frozen) {
  Camera camera = scene.camera();
  const vec3 view = camera.direction({0.5f, 0.5f});
  const Hit hit = scene.intersect(camera.position, view);
  const Surface s = scene.surface(hit, view);
  const Bsdf bsdf = scene.bsdf(s);
  const BsdfContext seen = prepare(bsdf, s.shading.to_local(s.w_out));
  const BsdfContext lit = prepare(light.bsdf, light.frame.to_local(light.w_in), PathEnd::light);
  const dvec3 to = dvec3(light.position) - dvec3(s.position);
  const double d = glm::length(to), cos_a = d > radius ? std::sqrt(1 - radius * radius / (d * d)) : 0;
  const dvec3 w = to / d;
  const dvec3 x = glm::normalize(glm::cross(w, std::abs(w.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dvec3 y = glm::cross(w, x);
  constexpr int kRings = 300, kTurns = 600;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double c = 1 - (1 - cos_a) * (i + 0.5) / kRings, sine = std::sqrt(1 - c * c);
    for (int j = 0; j < kTurns; ++j) {
      const double phi = 2 * M_PI * (j + 0.5) / kTurns;
      const dvec3 o = w * c + x * (sine * std::cos(phi)) + y * (sine * std::sin(phi));
      const dvec3 e = frozen ? w : o;
      const double cosines =
          std::max(0.0, glm::dot(o, dvec3(s.shading.z))) * std::max(0.0, -glm::dot(e, dvec3(light.normal)));
      if (cosines == 0) continue;
      sum += cosines * evaluate(bsdf, seen, s.shading.to_local(vec3(o))).y *
             evaluate(light.bsdf, lit, light.frame.to_local(vec3(-e))).y;
    }
  }
  const double solid_angle = 2 * M_PI * (1 - cos_a);
  return light.power.y / (M_PI * radius * radius) * sum * solid_angle / (kRings * kTurns);
}

struct Situation {
  const char* name;
  Sampling sampling;
  float radius, roughness;  // of the sphere; of both materials, 0: Lambert
  bool frozen;
};
void PrintTo(const Situation& s, std::ostream* out) {
  *out << s.name;
}

class VslIsItsIntegral : public testing::TestWithParam<Situation> {};

TEST_P(VslIsItsIntegral, by_quadrature) {
  const Situation& setup = GetParam();
  const auto material = [&] {
    return setup.roughness > 0 ? glossy(setup.roughness) : lambert(vec3(0.5f, 0.6f, 0.7f));
  };
  const Scene scene = test::scene_of({kFloor}, list(material()), above());
  const auto emitter = material();
  // A wall's light half a metre up, its normal towards the floor's middle; lit so that its lobe comes that
  // way.
  const VirtualLight light =
      test::light_at({-1, 0.6f, -1.2f}, {0.6f, 0.1f, 0.8f}, {0.3f, 0.8f, 1.2f}, vec3(3, 4, 5), *emitter);
  VslParams params = params_of(setup.sampling, setup.radius, setup.sampling == Sampling::cone ? 16 : 64);
  params.frozen = setup.frozen;
  VslIntegrator method(params);
  method.gather_from(set_of({light}));
  std::vector<double> values;
  for (uint64_t seed = 0; seed < 400; ++seed)
    values.push_back(test::image_of(scene, method, 2, seed, 1).pixels[1]);
  const test::Estimate estimate = test::estimate(values);
  const double truth = quadrature(scene, light, setup.radius, setup.frozen);
  ASSERT_GT(truth, 0);
  EXPECT_GT(test::t_test_p(estimate, truth), 1e-4)
      << estimate.mean << " +- " << estimate.standard_error << ", truth " << truth;
  EXPECT_LT(estimate.standard_error, 0.03 * truth) << "too noisy to mean anything";
}

INSTANTIATE_TEST_SUITE_P(Setups, VslIsItsIntegral,
                         testing::Values(Situation{"cone_matt", Sampling::cone, 0.8f, 0, false},
                                         Situation{"cone_glossy", Sampling::cone, 0.8f, 0.5f, false},
                                         Situation{"cone_small", Sampling::cone, 0.05f, 0.4f, false},
                                         Situation{"cone_inside", Sampling::cone, 3, 0.6f, false},
                                         Situation{"brdf_glossy", Sampling::brdf, 0.8f, 0.4f, false},
                                         Situation{"brdf_inside", Sampling::brdf, 3, 0.6f, false},
                                         Situation{"mis_glossy", Sampling::mis, 0.8f, 0.3f, false},
                                         Situation{"mis_matt", Sampling::mis, 0.8f, 0, false},
                                         Situation{"frozen_glossy", Sampling::cone, 0.8f, 0.5f, true},
                                         Situation{"frozen_mis", Sampling::mis, 0.8f, 0.4f, true}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Vsl, tends_to_vpl_as_the_radius_goes_to_0) {
  const Scene scene = test::scene_of({kFloor}, list(glossy(0.5f)), above(8));
  const auto emitter = glossy(0.6f);
  std::vector<VirtualLight> lights;
  for (int i = 0; i < 40; ++i)
    lights.push_back(test::light_at({-1 + 0.05f * float(i), 0.5f + 0.02f * float(i), -1.2f}, {0, -0.2f, 1},
                                    {0.3f, 0.8f, 1.2f}, vec3(3, 4, 5), *emitter));
  VplIntegrator vpl(plain_vpl());
  vpl.gather_from(set_of(lights));
  const Image truth = test::image_of(scene, vpl, 8);
  double last = 1e9;
  for (const float radius : {0.3f, 0.03f, 0.003f, 1e-5f}) {
    VslIntegrator vsl(params_of(Sampling::cone, radius));
    vsl.gather_from(set_of(lights));
    const Image image = test::image_of(scene, vsl, 8);
    double worst = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i)
      worst = std::max(worst, std::abs(double(image.pixels[i]) / truth.pixels[i] - 1));
    EXPECT_LT(worst, 0.3 * last) << "radius " << radius;
    last = worst;
  }
  EXPECT_LT(last, 1e-4);
}

TEST(Vsl, frozen_over_a_matt_floor_is_vpl_while_the_cap_is_above_the_horizon) {
  // The integral of the cosine over a cap above the horizon is pi sin^2(a) cos(theta) = pi r^2
  // cos(theta)/d^2.
  const Scene scene = test::scene_of({kFloor}, list(lambert(vec3(0.6f))), above(4));
  const auto emitter = glossy(0.4f);
  const VirtualLight light =
      test::light_at({-0.5f, 2, -0.7f}, {0.2f, -1, 0.3f}, {1, -0.2f, 1.2f}, vec3(3, 4, 5), *emitter);
  VplIntegrator vpl(plain_vpl());
  vpl.gather_from(set_of({light}));
  const Image truth = test::image_of(scene, vpl, 4);
  VslParams params = params_of(Sampling::cone, 0.9f, 1024);
  params.frozen = true;
  VslIntegrator vsl(params);
  vsl.gather_from(set_of({light}));
  const Image image = test::image_of(scene, vsl, 4);
  // A lattice of n points on a smooth function errs by about 1/n.
  for (size_t i = 0; i < image.pixels.size(); ++i) EXPECT_NEAR(image.pixels[i] / truth.pixels[i], 1, 2e-3);
}

TEST(Vsl, receives_in_a_closed_box_all_of_the_light_as_spheres_shrink) {
  // The same lights as points bring all of it; spheres lose what reaches behind walls and what lies around a
  // point.
  const Scene scene =
      test::scene_from(R"({"camera": {"position": [0, 1, 1.9], "look_at": [0, 0.9, -2], "vertical_fov": 80},
    "materials": [{"name": "wall", "type": "lambert", "albedo": 0.6}],
    "objects": [{"name": "room", "type": "box", "low": [-1, 0, -2], "high": [1, 2, 2], "material": "wall"}],
    "lights": [{"type": "point", "position": [0.3, 1.2, 0.4], "intensity": 9}]})");
  const auto sum = [&](const char* method, nlohmann::json settings) {
    settings.update({{"lights", 200}, {"direct", "none"}, {"occlusion", "none"}});
    double total = 0;
    for (const float v :
         test::render_with(scene, method, {.settings = settings.dump(), .width = 24, .height = 24}).pixels)
      total += v;
    return total;
  };
  const double all = sum("vpl", nlohmann::json::object());
  double last = 1;
  for (const float factor : {1.0f, 0.3f, 0.1f, 0.01f}) {
    const double deficit = 1 - sum("vsl", {{"radius_factor", factor}}) / all;
    EXPECT_LT(deficit, last) << "factor " << factor;
    EXPECT_GT(deficit, -0.01) << "factor " << factor;
    last = deficit;
  }
  EXPECT_NEAR(last, 0, 2e-3);
}

TEST(Vsl, is_the_same_on_any_number_of_threads_and_another_for_another_seed) {
  const Scene scene = test::scene_from(R"({"camera": {"position": [0, 1, 1.9], "look_at": [0, 0.9, -2]},
    "materials": [{"name": "wall", "type": "coated", "roughness": 0.5}],
    "objects": [{"name": "room", "type": "box", "low": [-1, 0, -2], "high": [1, 2, 2], "material": "wall"}],
    "lights": [{"type": "spot", "position": [0.3, 1.2, 1], "look_at": [0.9, 0.4, 0], "intensity": 9, "outer": 40}]})");
  for (const char* settings :
       {R"({"lights": 50, "occlusion": "sphere"})", R"({"lights": 50, "sampling": "mis"})"}) {
    const Image one =
        test::render_with(scene, "vsl", {.settings = settings, .passes = 2, .threads = 1, .seed = 1});
    const Image two =
        test::render_with(scene, "vsl", {.settings = settings, .passes = 2, .threads = 2, .seed = 1});
    const Image other =
        test::render_with(scene, "vsl", {.settings = settings, .passes = 2, .threads = 2, .seed = 2});
    EXPECT_EQ(one.pixels, two.pixels);
    EXPECT_NE(one.pixels, other.pixels);
  }
}

TEST(Vsl, leaves_no_nan_infinity_or_negative_radiance) {
  const auto check = [](const Scene& scene, std::vector<VirtualLight> lights, VslParams params,
                        const std::string& what) {
    VslIntegrator method(params);
    method.gather_from(set_of(std::move(lights)));
    Film film(3, 3);
    render(scene, method, film, {.passes = 1}, {.seed = 1, .threads = 2});
    EXPECT_EQ(film.bad_samples(), 0u) << what;
    for (const float v : film.radiance().pixels) EXPECT_TRUE(std::isfinite(v) && v >= 0) << what << ": " << v;
  };
  for (const Sampling sampling : {Sampling::cone, Sampling::brdf, Sampling::mis}) {
    for (const float roughness : {0.01f, 0.1f, 1.0f}) {
      const Camera grazing = test::camera_at({4, 1e-4f, 0}, {0, 0, 0}, 3, 0.05f);
      for (const Camera& camera : {above(3), grazing}) {
        const Scene scene = test::scene_of({kFloor}, list(glossy(roughness)), camera);
        const vec3 view = camera.direction({1.5f, 1.5f});
        const vec3 seen = scene.surface(scene.intersect(camera.position, view), view).position;
        const auto emitter = glossy(roughness);
        for (const float radius : {1e-7f, 0.3f, 100.0f}) {
          const VslParams params = params_of(sampling, radius, 8);
          const std::string what = testing::PrintToString(int(sampling)) + " roughness " +
                                   std::to_string(roughness) + " radius " + std::to_string(radius);
          const vec3 up(0, 1, 0), mirror(-view.x, -view.y, -view.z);
          check(scene, {test::light_at(seen, up, mirror, vec3(3), *emitter)}, params, what + " on the point");
          check(scene, {test::light_at(seen, -up, -mirror, vec3(3), *emitter)}, params,
                what + " on the point, reversed");
          check(scene, {test::light_at(seen - up, up, up, vec3(3), *emitter)}, params,
                what + " below the floor");
          check(scene, {test::light_at(seen + up, up, up, vec3(3), *emitter)}, params, what + " facing away");
          const vec3 away = glm::normalize(vec3(view.x, -view.y, view.z));
          check(scene, {test::light_at(seen + away, -away, -away, vec3(1e6f), *emitter)}, params,
                what + " in the mirror");
        }
      }
    }
  }
  const Scene box = test::bundled_scene("furnace");
  for (const char* settings :
       {R"({"lights": 1})", R"({"lights": 100000, "samples": 1, "occlusion": "none"})"}) {
    const Image image = test::render_with(box, "vsl", {.settings = settings, .width = 2, .height = 2});
    for (const float v : image.pixels) EXPECT_TRUE(std::isfinite(v) && v >= 0) << settings << ": " << v;
  }
}

TEST(Vsl, is_shadowed_at_its_centre_or_over_its_sphere) {
  // A screen between floor and light that hides the centre from the seen points but not the upper half of the
  // sphere.
  const test::Patch screen{{-3, -0.5f, -0.6f}, {6, 0, 0}, {0, 1.0f, 0}, 0};
  const auto emitter = lambert(vec3(0.8f));
  const VirtualLight light = test::light_at({0, 0.7f, -1.2f}, {0, 0, 1}, {0, 0.5f, 1}, vec3(4), *emitter);
  const auto mean = [&](const std::vector<test::Patch>& patches, Occlusion occlusion) {
    const Scene scene = test::scene_of(patches, list(lambert(vec3(0.5f))), above(4));
    VslParams params = params_of(Sampling::cone, 0.5f);
    params.occlusion = occlusion;
    VslIntegrator method(params);
    method.gather_from(set_of({light}));
    double sum = 0;
    for (uint64_t seed = 0; seed < 60; ++seed)
      for (const float v : test::image_of(scene, method, 4, seed).pixels) sum += v;
    return sum;
  };
  const double open = mean({kFloor}, Occlusion::none);
  EXPECT_EQ(mean({kFloor}, Occlusion::center), open);
  EXPECT_NEAR(mean({kFloor}, Occlusion::sphere), open, 1e-3 * open);
  EXPECT_EQ(mean({kFloor, screen}, Occlusion::center), 0);
  const double part = mean({kFloor, screen}, Occlusion::sphere);
  EXPECT_GT(part, 0.05 * open);
  EXPECT_LT(part, 0.95 * open);
}

TEST(Vsl, refuses_what_it_cannot_use_and_names_the_range) {
  const auto message = [](const char* settings) {
    try {
      find_integrator("vsl", "").make(nlohmann::json::parse(settings), "scene.json: /integrator", nullptr);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message(R"({"samples": 0})").find("[1, 4096]"), std::string::npos)
      << message(R"({"samples": 0})");
  EXPECT_NE(message(R"({"radius_factor": 0})").find("(0, "), std::string::npos)
      << message(R"({"radius_factor": 0})");
  EXPECT_NE(message(R"({"radius": 0})").find("(0, "), std::string::npos) << message(R"({"radius": 0})");
  EXPECT_NE(message(R"({"radius": "desnity"})").find("did you mean \"density\""), std::string::npos);
  EXPECT_NE(message(R"({"occlusion": "ambient"})").find("sphere"), std::string::npos);
}

TEST(VslKernel, cone_is_the_one_the_sphere_subtends) {
  for (const double d : {1e-3, 0.5, 1.0, 7.0, 1e4}) {
    for (const double ratio : {1e-6, 0.01, 0.5, 0.999, 1.0, 3.0}) {
      const double r = d * ratio;
      float per_radius2;
      const float got = kernel::vsl_cone(float(d * d), float(r), per_radius2);
      const double cosine = ratio < 1 ? std::sqrt((1 - ratio) * (1 + ratio)) : 0;
      const double truth = ratio < 1 ? ratio * ratio / (1 + cosine) : 1;
      // Near the sphere's surface the cosine is the root of a difference of rounded squares.
      const double share = ratio > 0.9 ? 2e-4 : 1e-6;
      EXPECT_NEAR(got, truth, share * truth) << "d " << d << " ratio " << ratio;
      EXPECT_NEAR(per_radius2 * r * r, truth, share * truth);
    }
  }
}

TEST(VslKernel, directions_fill_the_cone_evenly) {
  const vec3 w = glm::normalize(vec3(0.3f, -0.9f, 0.2f));
  vec3 x, y;
  kernel::vsl_frame(w, vec3(0, 0, 1), x, y);
  EXPECT_NEAR(dot(cross(x, y), w), 1, 1e-6);
  for (const float one_minus_cos : {1.0f, 0.3f, 1e-6f}) {
    dvec3 mean(0);
    constexpr int kSide = 64;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        float c, s;
        kernel::vsl_turn((float(j) + 0.5f) / kSide - 0.5f, c, s);
        EXPECT_NEAR(c * c + s * s, 1, 2e-6);
        const vec3 v = kernel::vsl_direction(w, x, y, one_minus_cos, (float(i) + 0.5f) / kSide, c, s);
        EXPECT_NEAR(glm::length(v), 1, 2e-6);
        EXPECT_LE(1 - dot(v, w), one_minus_cos + 2e-7f);
        mean += dvec3(v) / double(kSide * kSide);
      }
    }
    // The mean of a uniform cap lies on its axis, half the cap's height from its top.
    EXPECT_NEAR(glm::length(mean - dvec3(w) * (1 - 0.5 * one_minus_cos)), 0, 2e-6);
  }
}

TEST(VslKernel, turns_by_the_whole_circle) {
  for (int i = -50; i <= 50; ++i) {
    float c, s;
    kernel::vsl_turn(0.01f * float(i), c, s);
    EXPECT_NEAR(c, std::cos(0.02 * M_PI * i), 2e-6);
    EXPECT_NEAR(s, std::sin(0.02 * M_PI * i), 2e-6);
  }
}

}  // namespace
}  // namespace zonal
