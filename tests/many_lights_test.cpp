// What the four many-light methods share: BRDFs in arrays, the order of points, shadow rays, splitting over
// passes.
#include "integrators/many_lights.h"

#include <gtest/gtest.h>

#include "core/sampling.h"
#include "integrators/bsdf_arrays.h"
#include "integrators/hvl/hvl.h"
#include "integrators/vpl/vpl.h"
#include "integrators/vsl/vsl.h"
#include "tests/support.h"
#include "tests/virtual_light_support.h"

namespace zonal {
namespace {

/// One material of every kind that reflects, rough and smooth.
std::vector<std::unique_ptr<Material>> materials() {
  std::vector<std::unique_ptr<Material>> all;
  for (const float roughness : {0.01f, 0.2f, 0.7f, 1.0f}) {
    auto metal = std::make_unique<ConductorMaterial>();
    metal->roughness.value = roughness, metal->anisotropy = 0.4f;
    auto coated = std::make_unique<CoatedMaterial>();
    coated->roughness.value = roughness, coated->albedo.value = vec3(0.7f, 0.2f, 0.4f);
    auto stretched = std::make_unique<CoatedMaterial>();
    stretched->roughness.value = roughness, stretched->anisotropy = -0.5f;
    auto gltf = std::make_unique<MetallicRoughnessMaterial>();
    gltf->roughness.value = roughness, gltf->metallic.value = 0.3f;
    all.push_back(std::move(metal)), all.push_back(std::move(coated));
    all.push_back(std::move(stretched)), all.push_back(std::move(gltf));
  }
  all.push_back(std::make_unique<LambertMaterial>());
  all.push_back(std::make_unique<BlinnPhongMaterial>());
  return all;
}

vec3 random_direction(uint32_t key) {
  const float u = unit_float(hash32(key, 1)), v = unit_float(hash32(key, 2));
  vec3 w = uniform_sphere({u, v});
  w.z = std::fabs(w.z) + 1e-4f;
  return glm::normalize(w);
}

class BrdfsInArrays : public testing::TestWithParam<Lobes> {};

TEST_P(BrdfsInArrays, have_the_values_of_one_at_a_time) {
  const auto all = materials();
  constexpr int kCount = 200;
  std::vector<Bsdf> bsdfs;
  std::vector<BsdfContext> views;
  BsdfArrays arrays(kCount);
  for (int i = 0; i < kCount; ++i) {
    bsdfs.push_back(all[hash32(i) % all.size()]->at({}));
    const bool light = i % 3 == 0;
    vec3 out = random_direction(7 * i);
    if (i % 17 == 0) out.z = -out.z;  // seen from below: black
    views.push_back(prepare(bsdfs.back(), out, light ? PathEnd::light : PathEnd::camera));
    arrays.set(i, bsdfs.back(), views.back(), GetParam());
  }
  arrays.finish();

  std::array<std::vector<float>, 3> w, f, one;
  std::vector<float> density(kCount);
  for (int c = 0; c < 3; ++c) f[c].resize(kCount), one[c].resize(kCount);
  for (int i = 0; i < kCount; ++i) {
    // Half of the directions near the mirror's, where lobes are high; some from below.
    vec3 in = random_direction(11 * i + 3);
    const vec3 o = views[i].w_out;
    if (i % 2) in = glm::normalize(vec3(-o.x, -o.y, o.z) + 0.02f * in);
    if (i % 13 == 0) in.z = -in.z;
    for (int c = 0; c < 3; ++c) w[c].push_back(in[c]);
  }
  const int first = 5, end = kCount - 3;  // a part, off the vectors' places
  arrays.evaluate_with_pdf(first, end, &w[0][first], &w[1][first], &w[2][first], f[0].data(), f[1].data(),
                           f[2].data(), density.data());
  for (int i = first; i < end; ++i) {
    const vec3 in(w[0][i], w[1][i], w[2][i]);
    const vec3 truth = evaluate(bsdfs[i], views[i], in, GetParam());
    // The narrowest lobe (alpha 1e-4) falls by a factor of e within 1e-4 of the half vector, whose components
    // are rounded to 6e-8 in either code: 1e-3 and some; the others agree far better.
    const float share = bsdfs[i].alpha_x < 0.01f ? 5e-3f : 2e-5f;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(f[c][i - first], truth[c], share * truth[c] + 1e-7f) << "entry " << i << " channel " << c;
    if (GetParam() == Lobes::all) {
      const float p = pdf(bsdfs[i], views[i], in);
      EXPECT_NEAR(density[i - first], p, share * p + 1e-7f) << "entry " << i;
    }
  }
  for (int i = 0; i < kCount; i += 23) {
    arrays.evaluate_one(i, kCount, w[0].data(), w[1].data(), w[2].data(), one[0].data(), one[1].data(),
                        one[2].data());
    for (int k = 0; k < kCount; ++k) {
      const vec3 truth = evaluate(bsdfs[i], views[i], {w[0][k], w[1][k], w[2][k]}, GetParam());
      const float share = bsdfs[i].alpha_x < 0.01f ? 5e-3f : 2e-5f;
      EXPECT_NEAR(one[1][k], truth.y, share * truth.y + 1e-7f) << "entry " << i << " direction " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lobes, BrdfsInArrays, testing::Values(Lobes::all, Lobes::diffuse, Lobes::specular),
                         [](const auto& info) {
                           return info.param == Lobes::all       ? "all"
                                  : info.param == Lobes::diffuse ? "diffuse"
                                                                 : "specular";
                         });

/// A corner of two glossy walls and a floor, its lights on the walls.
Scene corner(const test::Similarity& s) {
  std::vector<std::unique_ptr<Material>> all;
  for (const float roughness : {0.3f, 0.6f}) {
    auto material = std::make_unique<MetallicRoughnessMaterial>();
    material->roughness.value = roughness, material->metallic.value = 0.3f;
    all.push_back(std::move(material));
  }
  return test::scene_of({{{-1, 0, -1}, {0, 0, 3}, {3, 0, 0}, 0},
                         {{-1, 0, -1}, {3, 0, 0}, {0, 2, 0}, 1},
                         {{-1, 0, -1}, {0, 2, 0}, {0, 0, 3}, 1}},
                        std::move(all), test::camera_at({1.6f, 1.2f, 1.5f}, {-0.3f, 0.3f, -0.4f}, 8, 0.7f),
                        s);
}
VirtualLightSet lights_in_the_corner(const Scene& scene) {
  VirtualLightSet set;
  for (uint32_t i = 0; i < 60; ++i) {
    const float u = unit_float(hash32(i, 1)), v = unit_float(hash32(i, 2));
    const vec3 in(0.5f, 0.4f + u, 0.7f);
    set.lights.push_back(i % 2 ? test::light_at({-1, 1.8f * u + 0.1f, 2 * v - 0.9f}, {1, 0, 0}, in,
                                                vec3(1, 2, 3), *scene.materials()[1])
                               : test::light_at({2 * v - 0.9f, 1.8f * u + 0.1f, -1}, {0, 0, 1}, in,
                                                vec3(2, 2, 1), *scene.materials()[0]));
  }
  return set;
}

/// Renders the corner as it is and turned, scaled and shifted with its lights; the largest relative
/// difference.
template <class Method, class Params>
double change_under(const test::Similarity& s, const Params& params) {
  const Scene here = corner({}), there = corner(s);
  Method method(params), moved(params);
  const VirtualLightSet set = lights_in_the_corner(here);
  method.gather_from(set), moved.gather_from(test::transformed(set, s));
  const Image image = test::image_of(here, method, 8), other = test::image_of(there, moved, 8);
  double worst = 0, mean = 0;
  for (const float v : image.pixels) mean += v / double(image.pixels.size());
  for (size_t i = 0; i < image.pixels.size(); ++i)
    worst = std::max(worst, std::abs(double(image.pixels[i]) - other.pixels[i]) / mean);
  EXPECT_GT(mean, 0);
  return worst;
}

TEST(ManyLights, turning_and_scaling_scene_and_lights_changes_nothing) {
  test::Similarity s;
  s.turn = mat3(glm::rotate(mat4(1), 2.1f, glm::normalize(vec3(1, -2, 0.5f))));
  s.scale = 0.013f, s.shift = {0.02f, -0.01f, 0.03f};
  VplParams vpl;
  vpl.direct = ManyLightsParams::Direct::none;
  vpl.occlusion = Occlusion::center, vpl.clamp = 0.1f;
  const double vpl_change = change_under<VplIntegrator>(s, vpl);
  EXPECT_LT(vpl_change, 1e-4);
  VslParams vsl;
  vsl.direct = ManyLightsParams::Direct::none;
  for (const auto sampling : {VslParams::Sampling::cone, VslParams::Sampling::mis}) {
    vsl.sampling = sampling;
    // Noise included: directions are measured from the scene's own.
    const double vsl_change = change_under<VslIntegrator>(s, vsl);
    EXPECT_LT(vsl_change, 1e-4);
  }
  // It does see what it should: other units without the lights' powers following.
  test::Similarity grown;
  grown.scale = 2;
  VirtualLightSet set = test::transformed(lights_in_the_corner(corner({})), grown);
  for (VirtualLight& v : set.lights) v.power *= 0.25f;
  VplIntegrator method(vpl), dim(vpl);
  method.gather_from(lights_in_the_corner(corner({}))), dim.gather_from(set);
  const double full = test::image_of(corner({}), method, 8).pixels[96];
  EXPECT_NEAR(test::image_of(corner(grown), dim, 8).pixels[96], 0.25 * full, 1e-4 * full);
}

TEST(ManyLights, shadow_rays_are_spared_only_where_nothing_arrives) {
  // Pixels times lights, less those whose contribution is exactly zero: counted one by one.
  const Scene scene = corner({});
  const VirtualLightSet set = lights_in_the_corner(scene);
  VplParams params;
  params.direct = ManyLightsParams::Direct::none;
  VplIntegrator method(params);
  method.gather_from(set);
  Film film(8, 8);
  const RenderReport report = render(scene, method, film, {.passes = 1}, {.threads = 1});
  uint64_t lit = 0;
  Camera camera = scene.camera();
  camera.width = camera.height = 8;
  for (int i = 0; i < 64; ++i) {
    const vec3 view = camera.direction({float(i % 8) + 0.5f, float(i / 8) + 0.5f});
    const Hit hit = scene.intersect(camera.position, view);
    if (!hit.found()) continue;
    const Surface s = scene.surface(hit, view);
    for (const VirtualLight& v : set.lights) {
      const vec3 w = glm::normalize(v.position - s.position);
      lit += glm::dot(w, s.normal) > 0 && glm::dot(w, v.normal) < 0;
    }
  }
  ASSERT_GT(lit, 500u);
  // A light in a point's own plane may fall to either side by rounding.
  EXPECT_NEAR(double(report.counters.shadow_rays), double(lit), 0.01 * double(lit));
}

TEST(ManyLights, lights_without_a_surface_leave_a_black_image_and_one_warning) {
  const Scene scene = test::scene_from(R"({"camera": {"position": [0, 1, 3], "look_at": [0, 0, 0]},
    "materials": [{"name": "a", "type": "lambert"}],
    "objects": [{"name": "o", "type": "quad", "corner": [-2, 0, 2], "edges": [[4, 0, 0], [0, 0, -4]], "material": "a"}],
    "lights": [{"type": "spot", "name": "torch", "position": [0, 1, 0], "look_at": [0, 2, 0], "intensity": 4}]})");
  for (const IntegratorRow& row : integrator_table()) {
    if (row.name != "vpl" && row.name != "vsl" && row.name != "hvl" && row.name != "vsgl") continue;
    const auto method = row.make(nlohmann::json::parse(R"({"direct": "none"})"), "", nullptr);
    Film film(8, 8);
    const RenderReport report = render(scene, *method, film, {.passes = 3}, {});
    for (const float v : film.radiance().pixels) EXPECT_EQ(v, 0);
    ASSERT_EQ(report.pass.warnings.size(), 1u) << row.name;
    EXPECT_NE(report.pass.warnings[0].find("torch"), std::string::npos) << report.pass.warnings[0];
  }
}

/// The methods without the test of whole tiles against horizons.
template <class Method>
struct Unhidden : Method {
  using Method::Method;
  bool horizons_hide() const override { return false; }
};

TEST(ManyLights, leaving_out_lights_behind_horizons_changes_no_bit) {
  const Scene scene = corner({});
  VirtualLightSet set = lights_in_the_corner(scene);
  // Some on the walls' other sides, as multi-bounce lights are, and some below the floor.
  for (uint32_t i = 0; i < 20; ++i) {
    VirtualLight v = set.lights[i];
    v.normal = -v.normal, v.frame = Frame(v.normal), v.w_in = v.normal;
    set.lights.push_back(v);
    v.normal = {0, 1, 0}, v.position.y -= 3;
    set.lights.push_back(v);
  }
  VplParams vpl;
  vpl.direct = ManyLightsParams::Direct::none;
  VslParams vsl;
  vsl.direct = ManyLightsParams::Direct::none, vsl.radius.rule = RadiusRule::metres, vsl.radius.metres = 0.3f;
  const auto compare = [&](ManyLights& whole, ManyLights& part) {
    whole.gather_from(set), part.gather_from(set);
    Film all(40, 40), some(40, 40);
    const RenderReport a = render(scene, whole, all, {.passes = 1}, {.threads = 1});
    const RenderReport b = render(scene, part, some, {.passes = 1}, {.threads = 1});
    EXPECT_EQ(all.radiance().pixels, some.radiance().pixels);
    EXPECT_LT(b.counters.light_evaluations, 0.95 * double(a.counters.light_evaluations));
  };
  Unhidden<VplIntegrator> all_vpl(vpl);
  VplIntegrator some_vpl(vpl);
  compare(all_vpl, some_vpl);
  Unhidden<VslIntegrator> all_vsl(vsl);
  VslIntegrator some_vsl(vsl);
  compare(all_vsl, some_vsl);
  HvlParams hvl;
  hvl.direct = ManyLightsParams::Direct::none, hvl.radius = vsl.radius;
  hvl.product = HvlParams::Product::zonal, hvl.emission = HvlParams::Emission::brdf;
  for (const Occlusion occlusion : {Occlusion::none, Occlusion::center}) {
    hvl.occlusion = occlusion;
    Unhidden<HvlIntegrator> all_hvl(hvl);
    HvlIntegrator some_hvl(hvl);
    compare(all_hvl, some_hvl);
  }
}

TEST(ManyLights, skipping_loses_no_more_than_its_bound_says) {
  const Scene scene = test::scene_from(R"({"camera": {"position": [0, 1, 1.9], "look_at": [0, 0.9, -2]},
    "materials": [{"name": "wall", "type": "lambert", "albedo": 0.5}, {"name": "metal", "type": "metallic_roughness", "roughness": 0.6}],
    "objects": [{"name": "room", "type": "box", "low": [-1, 0, -9], "high": [1, 2, 2], "material": "wall"},
                {"name": "block", "type": "box", "low": [-0.6, 0, -1], "high": [-0.2, 0.5, -0.6], "material": "metal"}],
    "lights": [{"type": "point", "position": [0.3, 1.2, -1], "intensity": 9}]})");
  const auto run = [&](const char* method, float skip, TileStats* stats) {
    const nlohmann::json settings = {{"lights", 800}, {"direct", "none"}, {"skip", skip}};
    const auto integrator = find_integrator(method, "").make(settings, "", nullptr);
    Film film(64, 64);
    *stats = render(scene, *integrator, film, {.passes = 1}, {.seed = 4}).counters;
    return film.radiance();
  };
  for (const auto& [method, skip] : {std::pair("vpl", 2e-3f), std::pair("vsl", 3e-3f)}) {
    TileStats none, some;
    const Image all = run(method, 0, &none), fewer = run(method, skip, &some);
    EXPECT_EQ(none.skipped_pairs, 0u);
    EXPECT_GT(double(some.skipped_pairs), 0.03 * double(none.light_evaluations)) << method;
    double lost = 0, total = 0;
    for (size_t i = 0; i < all.pixels.size(); i += 3) {
      const vec3 whole(all.pixels[i], all.pixels[i + 1], all.pixels[i + 2]);
      const vec3 part(fewer.pixels[i], fewer.pixels[i + 1], fewer.pixels[i + 2]);
      EXPECT_GE(luminance(whole - part), -1e-5 * luminance(whole)) << method;  // sums in another order
      lost += luminance(whole - part), total += luminance(whole);
    }
    EXPECT_GT(lost, 0) << method;
    EXPECT_LE(lost, some.skipped_bound) << method;
    EXPECT_LE(some.skipped_bound, 0.5 * some.skipped_total) << method;
    EXPECT_NEAR(some.skipped_total, total - lost, 1e-4 * total) << method;
  }
}

/// A room corner lit by a spot: points lie beside the lights' surfaces.
const char* kLitCorner = R"({"camera": {"position": [1, 1, 1], "look_at": [-1, 0.2, -1], "vertical_fov": 50},
    "materials": [{"name": "a", "type": "metallic_roughness", "roughness": 0.7, "metallic": 0.2}],
    "objects": [{"name": "room", "type": "box", "low": [-1, 0, -1], "high": [1.5, 2, 1.5], "material": "a"}],
    "lights": [{"type": "spot", "position": [0.8, 1.5, 0.8], "look_at": [-1, 0.6, -0.5], "power": 30, "inner": 20, "outer": 35}]})";

TEST(ManyLights, a_light_split_into_its_texels_is_those_texels) {
  const Scene scene = test::scene_from(kLitCorner);
  VplParams params;
  params.direct = ManyLightsParams::Direct::none, params.occlusion = Occlusion::none;
  params.clamp = 0.01f, params.lights = 50, params.block_texels = 7;
  const auto image = [&](float split) {
    params.split = split;
    VplIntegrator method(params);
    return test::image_of(scene, method, 24);
  };
  VplIntegrator texels(params);
  VirtualLightSet set =
      make_virtual_lights(scene, {.lights = 50, .seed = 0, .block_texels = 7, .keep_texels = true}, Stop{});
  set.lights = std::move(set.texels);
  for (VirtualLight& v : set.lights) v.texel_count = 0;
  texels.gather_from(set);
  const Image none = image(0), nobody = image(1e-6f), all = image(1e6f), near = image(2);
  const Image truth = test::image_of(scene, texels, 24);
  EXPECT_EQ(none.pixels, nobody.pixels);
  EXPECT_EQ(all.pixels, truth.pixels);
  // Near the lights a block is not its one light, far from them it is.
  double before = 0, after = 0;
  for (size_t i = 0; i < truth.pixels.size(); ++i) {
    before += std::pow(none.pixels[i] - truth.pixels[i], 2.0);
    after += std::pow(near.pixels[i] - truth.pixels[i], 2.0);
  }
  EXPECT_LT(after, 0.1 * before);
  EXPECT_GT(after, 0);
}

TEST(ManyLights, no_direction_reflects_more_than_the_bound) {
  const auto all = materials();
  for (uint32_t i = 0; i < 400; ++i) {
    const Bsdf bsdf = all[i % all.size()]->at({});
    const BsdfContext view = prepare(bsdf, random_direction(5 * i));
    const Reflection bound = largest_reflection(bsdf, view);
    const vec3 o = view.w_out;
    for (uint32_t j = 0; j < 60; ++j) {
      vec3 in = random_direction(1000 * i + j);
      if (j % 2) in = glm::normalize(vec3(-o.x, -o.y, o.z) + 0.3f * unit_float(hash32(i, j)) * in);
      if (j % 5 == 0) in = glm::normalize(vec3(-o.x, -o.y, 0.01f * float(j + 1)));
      const vec3 f = evaluate(bsdf, view, in);
      EXPECT_LE(max_component(f) * in.z, bound.most(in.z) * 1.0001f) << "material " << i % all.size();
    }
  }
}

}  // namespace
}  // namespace zonal
