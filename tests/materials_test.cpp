/// The materials against what is independent of them: closed forms, quadrature, textbook formulas in double
/// with complex numbers, and Pearson's chi-square test of every sampler against the density it claims.

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>

#include "materials/fresnel.h"
#include "materials/material.h"
#include "materials/microfacet.h"
#include "tests/bsdf_cases.h"
#include "tests/bsdf_quadrature.h"

namespace zonal {
namespace {

using namespace test;

/// Reflected share of light arriving evenly from everywhere, by quadrature of evaluate() alone.
vec3 reflected(const Case& c, vec3 w_out, Lobes lobes = Lobes::all) {
  const BsdfContext view = prepare(c.bsdf, w_out);
  vec3 sum(0);
  SphericalGrid(w_out, c.width).integrate([&](vec3 w, double weight) {
    sum += evaluate(c.bsdf, view, w, lobes) * float(weight * w.z);
  });
  return sum;
}

TEST(Materials, exchanging_the_directions_changes_nothing) {
  Random random(1);
  for (const Case& c : all_kinds()) {
    for (int i = 0; i < 2000; ++i) {
      const vec3 a = random.hemisphere(), b = random.hemisphere();
      const vec3 ab = evaluate(c.bsdf, prepare(c.bsdf, a), b), ba = evaluate(c.bsdf, prepare(c.bsdf, b), a);
      // Rounding only: a.h and b.h are equal in exact arithmetic and differ by some 1e-7 / (a.h) in float;
      // the steepest factor that contains them is Schlick's fifth power near grazing.
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(ab[k], ba[k], 1e-4f * (ab[k] + ba[k]) + 1e-12f) << c.name;
    }
  }
}

TEST(Materials, lambert_reflects_its_albedo) {
  // 1e-5: float sums of 40,000 terms.
  for (vec3 w : views()) EXPECT_NEAR(reflected(lambert(vec3(0.7f)), w).x, 0.7f, 1e-5f);
}

TEST(Materials, white_under_a_coat_reflects_everything) {
  // What the table of E lacks: linear interpolation misses h^2/8 |E''| per axis. Along t = cos^(1/4) (h =
  // 1/96) and alpha^(1/4) (h = 0.9/47) E has a dip of depth 0.2 and half width t/2 where the two are equal,
  // so E'' = 0.8 / t^2: 5e-3 at alpha = 1e-4, 1e-3 at 2.5e-3, 3e-4 at 0.02. To that comes 3e-4 of quadrature,
  // the table's and this one.
  for (float roughness : {0.0f, 0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.77f, 1.0f}) {
    const float tolerance = roughness < 0.1f ? 8e-3f : 2e-3f;
    for (vec3 w :
         {direction(0, 0), direction(47, 0), direction(75, 20), direction(88, 0), direction(89.8f, 0)}) {
      const float limit = w.z > 10 * roughness * roughness ? 1.5e-3f : tolerance;
      for (float ior : {1.3f, 1.5f, 2.2f}) {
        EXPECT_NEAR(reflected(coated(vec3(1), roughness, ior), w).y, 1, limit)
            << roughness << " ior " << ior << " cos " << w.z;
      }
      EXPECT_NEAR(reflected(metallic_roughness(vec3(1), 0, roughness), w).y, 1, limit)
          << roughness << " cos " << w.z;
    }
  }
}

TEST(Materials, white_under_an_anisotropic_coat_reflects_everything) {
  // As above, with 9 nodes along the azimuth: h^2/8 E'' = (1/8)^2/8 for E'' of order 1 in that coordinate,
  // 2e-3, where the coat is rough; three axes together 5e-3.
  for (float anisotropy : {-0.9f, 0.5f, 1.0f}) {
    for (float azimuth : {0.0f, 30.0f, 77.0f, 90.0f}) {
      for (float degrees : {20.0f, 60.0f, 80.0f}) {
        const vec3 w = direction(degrees, azimuth);
        EXPECT_NEAR(reflected(coated(vec3(1), 0.5f, 1.5f, anisotropy), w).y, 1, 5e-3f)
            << anisotropy << " " << azimuth;
      }
    }
  }
}

TEST(Materials, nothing_reflects_more_than_arrives) {
  std::vector<Case> cases = all_kinds();
  for (float r : {0.0f, 0.03f, 0.2f, 0.5f, 1.0f}) {
    cases.push_back(conductor("silver", r));
    cases.push_back(conductor("aluminium", r, 0.9f));
    cases.push_back(metallic_roughness(vec3(1), 1, r));
    cases.push_back(metallic_roughness(vec3(1), 0.3f, r));
  }
  for (float n : {0.0f, 0.5f, 2.0f, 7.0f, 100.0f, 1e4f}) {
    cases.push_back(blinn_phong(vec3(0), vec3(1), n));
    cases.push_back(blinn_phong(vec3(1), vec3(1), n));  // over-bright input, scaled back
  }
  // 3e-3: the coat's table (above) plus 5e-4 of quadrature on narrow lobes.
  for (const Case& c : cases) {
    for (vec3 w : views()) {
      const vec3 total = reflected(c, w);
      EXPECT_LE(max_component(total), 1 + 3e-3f) << c.name << " cos " << w.z;
      EXPECT_GE(std::min({total.x, total.y, total.z}), 0) << c.name;
    }
  }
}

TEST(Materials, blinn_phong_reflects_everything_at_normal_incidence) {
  // The integral that the normalisation is made from; 1e-3: quadrature in float.
  for (float n : {0.0f, 1.0f, 10.0f, 300.0f, 1e4f, 1e5f}) {
    EXPECT_NEAR(reflected(blinn_phong(vec3(0), vec3(1), n), vec3(0, 0, 1)).x, 1, 1e-3f) << n;
  }
}

TEST(Materials, a_metal_equals_the_textbook_formula_in_double) {
  using C = std::complex<double>;
  Random random(2);
  const std::vector<Case> cases = {conductor("gold", 0.1f), conductor("copper", 0.5f),
                                   conductor("silver", 1.0f), conductor("brass", 0.5f, 0.7f)};
  for (const Case& c : cases) {
    const double ax = c.bsdf.alpha_x, ay = c.bsdf.alpha_y;
    const auto lambda = [&](glm::dvec3 w) {  // Heitz 2014 eq. 72 and 80
      const double tan2 = (w.x * w.x * ax * ax + w.y * w.y * ay * ay) / (w.z * w.z);
      return 0.5 * (std::sqrt(1 + tan2) - 1);
    };
    for (int i = 0; i < 3000; ++i) {
      const vec3 o = random.hemisphere(), w = random.hemisphere();
      const glm::dvec3 od = glm::normalize(glm::dvec3(o)), wd = glm::normalize(glm::dvec3(w));
      if (od.z < 0.01 || wd.z < 0.01) continue;
      const glm::dvec3 h = glm::normalize(od + wd);
      const double slope2 = (h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay)) / (h.z * h.z);
      const double D = 1 / (3.141592653589793 * ax * ay * std::pow(h.z, 4) * std::pow(1 + slope2, 2));
      const double G = 1 / (1 + lambda(od) + lambda(wd));
      const double cosine = glm::dot(od, h);
      const vec3 f = evaluate(c.bsdf, prepare(c.bsdf, o), w);
      for (int k = 0; k < 3; ++k) {
        // Fresnel's amplitudes with a complex index (Born and Wolf section 1.5).
        const C n(c.bsdf.eta[k], c.bsdf.k[k]);
        const C ct = std::sqrt(1.0 - (1 - cosine * cosine) / (n * n));
        const C rs = (cosine - n * ct) / (cosine + n * ct), rp = (n * cosine - ct) / (n * cosine + ct);
        const double F = 0.5 * (std::norm(rs) + std::norm(rp));
        const double truth = F * D * G / (4 * od.z * wd.z);
        // Float half vectors err by 6e-8 per component, D by 4 * 6e-8 / alpha = 2e-5; 1e-4 leaves room for
        // grazing.
        ASSERT_NEAR(f[k], truth, 1e-4 * truth) << c.name;
      }
    }
  }
}

TEST(Materials, fresnel_has_its_known_values) {
  const float n = 1.5f, n2 = n * n;
  EXPECT_NEAR(fresnel_dielectric(1, n), 0.04f, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(0, n), 1, 1e-6f);
  // At Brewster's angle atan(n) the p part vanishes and the s part is ((n^2-1)/(n^2+1))^2.
  EXPECT_NEAR(fresnel_dielectric(1 / std::sqrt(1 + n2), n), 0.5f * sqr((n2 - 1) / (n2 + 1)), 1e-6f);
  EXPECT_EQ(fresnel_dielectric(0.3f, 1 / n), 1) << "beyond the critical angle";
  // Without absorption a conductor is a dielectric.
  for (float c : {0.01f, 0.3f, 0.7f, 1.0f}) {
    EXPECT_NEAR(fresnel_conductor(c, n, 0), fresnel_dielectric(c, n), 1e-5f) << c;
  }
  EXPECT_NEAR(fresnel_conductor(0, 0.2f, 3.0f), 1, 1e-4f);
}

TEST(Materials, metals_have_their_colours) {
  // Normal reflectances in linear Rec. 709 from spectra (Akenine-Moller et al. 2018, table 9.2). 0.08: three
  // wavelengths instead of a spectrum, and the scatter between published tables (0.03 for copper alone).
  const std::vector<std::pair<std::string, vec3>> published = {{"gold", {1.022f, 0.782f, 0.344f}},
                                                               {"silver", {0.972f, 0.960f, 0.915f}},
                                                               {"copper", {0.955f, 0.638f, 0.538f}},
                                                               {"aluminium", {0.913f, 0.922f, 0.924f}}};
  for (const auto& [name, colour] : published) {
    const auto metal =
        std::find_if(metals().begin(), metals().end(), [&](const Metal& m) { return m.name == name; });
    ASSERT_NE(metal, metals().end()) << name;
    for (int k = 0; k < 3; ++k) {
      const float R = fresnel_conductor(1, metal->eta, metal->k)[k];
      EXPECT_NEAR(R, colour[k], 0.08f) << name << " channel " << k;
      const float eta = metal->eta[k], extinction = metal->k[k];
      EXPECT_NEAR(R, (sqr(eta - 1) + sqr(extinction)) / (sqr(eta + 1) + sqr(extinction)), 1e-5f) << name;
    }
  }
}

TEST(Materials, samples_follow_their_density) {
  const std::vector<Case> cases = all_kinds();
  const double significance = 0.01 / double(cases.size() * views().size());  // Bonferroni
  uint32_t seed = 10;
  for (const Case& c : cases) {
    for (vec3 w_out : views()) {
      Random random(seed++);
      const BsdfContext view = prepare(c.bsdf, w_out);
      const auto draw = [&](vec3* w) {
        const float lobe = random.unit();
        const BsdfSample s = sample(c.bsdf, view, lobe, random.square());
        *w = s.w_in;
        return s.pdf > 0;
      };
      const auto result = chi_square(SphericalGrid(w_out, c.width), 150000, draw,
                                     [&](vec3 w) { return pdf(c.bsdf, view, w); });
      EXPECT_GT(result.p, significance) << c.name << " cos " << w_out.z << " cells " << result.cells;
      // The density of what stays above the horizon; 1e-3: quadrature.
      EXPECT_LE(result.mass, 1 + 1e-3) << c.name << " cos " << w_out.z;
    }
  }
}

TEST(Materials, the_chi_square_test_notices_a_wrong_density) {
  const Case truth = conductor("gold", 0.3f);
  Bsdf wrong = truth.bsdf;
  wrong.alpha_x *= 1.03f, wrong.alpha_y *= 1.03f;
  const vec3 w_out = direction(50, 0);
  const BsdfContext view = prepare(truth.bsdf, w_out), wrong_view = prepare(wrong, w_out);
  Random random(5);
  const auto draw = [&](vec3* w) {
    const BsdfSample s = sample(truth.bsdf, view, 0, random.square());
    *w = s.w_in;
    return s.pdf > 0;
  };
  const SphericalGrid grid(w_out, truth.width);
  EXPECT_LT(chi_square(grid, 150000, draw, [&](vec3 w) { return pdf(wrong, wrong_view, w); }).p, 1e-6);
  // Its p values rest on the incomplete gamma function, which has closed forms at a = 1 and a = 1/2.
  EXPECT_NEAR(gamma_q(1, 2.5), std::exp(-2.5), 1e-12);
  EXPECT_NEAR(gamma_q(0.5, 0.3), std::erfc(std::sqrt(0.3)), 1e-12);
}

TEST(Materials, a_sample_carries_value_times_cosine_over_density) {
  Random random(3);
  for (const Case& c : all_kinds()) {
    for (vec3 w_out : views()) {
      const BsdfContext view = prepare(c.bsdf, w_out);
      for (int i = 0; i < 500; ++i) {
        const float lobe = random.unit();
        const BsdfSample s = sample(c.bsdf, view, lobe, random.square());
        if (s.pdf == 0) continue;
        vec3 f;
        float density;
        evaluate_with_pdf(c.bsdf, view, s.w_in, &f, &density);
        const vec3 alone = evaluate(c.bsdf, view, s.w_in);
        ASSERT_FLOAT_EQ(density, pdf(c.bsdf, view, s.w_in)) << c.name;
        ASSERT_NEAR(s.pdf, density, 1e-5f * density) << c.name;
        for (int k = 0; k < 3; ++k) {
          ASSERT_FLOAT_EQ(f[k], alone[k]) << c.name;
          ASSERT_NEAR(s.weight[k] * s.pdf, f[k] * s.w_in.z, 1e-5f * f[k] * s.w_in.z) << c.name;
        }
      }
    }
  }
}

TEST(Materials, lobes_add_up) {
  Random random(4);
  for (const Case& c : all_kinds()) {
    const bool one_lobe = c.bsdf.kind == BsdfKind::lambert || c.bsdf.kind == BsdfKind::conductor;
    for (int i = 0; i < 500; ++i) {
      const vec3 o = random.hemisphere(), w = random.hemisphere();
      const BsdfContext view = prepare(c.bsdf, o);
      const vec3 all = evaluate(c.bsdf, view, w);
      const vec3 diffuse = evaluate(c.bsdf, view, w, Lobes::diffuse);
      const vec3 specular = evaluate(c.bsdf, view, w, Lobes::specular);
      for (int k = 0; k < 3; ++k) ASSERT_FLOAT_EQ(diffuse[k] + specular[k], all[k]) << c.name;
      if (one_lobe) {
        ASSERT_TRUE(is_black(c.bsdf.kind == BsdfKind::lambert ? specular : diffuse)) << c.name;
      }
    }
  }
}

TEST(Materials, extreme_input_stays_finite_and_not_negative) {
  std::vector<Case> cases = all_kinds();
  cases.push_back({"black", Bsdf{}, 1});
  for (float r : {0.0f, 1e-4f, 0.01f, 0.02f, 1.0f}) {
    for (float anisotropy : {0.0f, 1.0f, -1.0f}) cases.push_back(conductor("silver", r, anisotropy));
    cases.push_back(coated(vec3(1), r, 1.0f));
    cases.push_back(coated(vec3(1), r, 4.0f));
    cases.push_back(coated(vec3(0), r));
    cases.push_back(metallic_roughness(vec3(0), 1, r));
  }
  for (float n : {0.0f, 1e-3f, 1e5f, 1e7f}) cases.push_back(blinn_phong(vec3(0.5f), vec3(0.5f), n));
  Random random(6);
  const float heights[] = {1, 0.5f, 1e-2f, 1e-4f, 1e-7f, 1e-8f, 1e-20f, 0, -1e-7f, -1};
  const float numbers[] = {0, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1 - 0x1p-24f};
  const auto good = [](vec3 v) { return is_finite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0; };
  for (const Case& c : cases) {
    for (float height : heights) {
      const float r = safe_sqrt(1 - height * height);
      for (int turn = 0; turn < 8; ++turn) {
        const vec3 o(r * std::cos(turn * kPi / 4), r * std::sin(turn * kPi / 4), height);
        const BsdfContext view = prepare(c.bsdf, o);
        std::vector<vec3> directions = {o, vec3(-o.x, -o.y, o.z), -o, vec3(0, 0, 1)};
        for (float z : heights) {
          const float s = safe_sqrt(1 - z * z);
          directions.push_back({s * std::cos(turn * 1.1f), s * std::sin(turn * 1.1f), z});
          directions.push_back(r > 0 ? vec3(-o.x / r * s, -o.y / r * s, z) : vec3(s, 0, z));
        }
        for (int i = 0; i < 60; ++i) {
          const float x = i < 36 ? numbers[i % 6] : random.unit(),
                      y = i < 36 ? numbers[i / 6] : random.unit();
          const BsdfSample s = sample(c.bsdf, view, i % 7 / 7.0f, vec2(x, y));
          ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0 && good(s.weight) && is_finite(s.w_in))
              << c.name << " " << height;
          // One lobe returns at most 1; a mixture at most the sum of 1 / share of its two lobes' excess.
          ASSERT_LE(max_component(s.weight), 8) << c.name << " " << height << " u " << x << " " << y;
          if (s.pdf > 0) directions.push_back(s.w_in);
        }
        for (vec3 w : directions) {
          vec3 f;
          float density;
          evaluate_with_pdf(c.bsdf, view, w, &f, &density);
          ASSERT_TRUE(good(f) && std::isfinite(density) && density >= 0)
              << c.name << " " << height << " " << w.z;
          if (w.z <= 0 || o.z <= 0) {
            ASSERT_TRUE(is_black(f) && density == 0) << c.name;
          }
        }
        ASSERT_TRUE(good(albedo(c.bsdf)) && max_component(albedo(c.bsdf)) <= 1 + 1e-5f) << c.name;
      }
    }
  }
}

TEST(Materials, the_albedo_layer_is_near_the_hemispherical_albedo) {
  // albedo() is a closed form; here the furnace is averaged over views with weights cos. The closed form
  // leaves out what single scattering loses (0.015 for this metal) and puts E(F0 = 1) at 1 (0.03 for the
  // last).
  for (const Case& c : {lambert(vec3(0.3f)), conductor("gold", 0.2f), coated(vec3(0.5f), 0.4f),
                        metallic_roughness(vec3(0.5f), 0.5f, 0.3f)}) {
    vec3 mean(0);
    constexpr int kViews = 24;
    for (int i = 0; i < kViews; ++i) {  // uniform in sin^2: the weight cos is in the density
      const float sine = std::sqrt((i + 0.5f) / kViews);
      mean += reflected(c, vec3(sine, 0, safe_sqrt(1 - sine * sine))) / float(kViews);
    }
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(albedo(c.bsdf)[k], mean[k], 0.03f) << c.name;
  }
}

TEST(Materials, textures_cannot_make_a_material_unphysical) {
  const Texture wild(1, 1, {vec4(7, -2, NAN, 1)});
  CoatedMaterial coat;
  coat.albedo = {vec3(1), &wild};
  coat.roughness = {1, &wild, 0};
  const Bsdf b = coat.at(vec2(0.5f));
  EXPECT_EQ(b.diffuse, vec3(1, 0, 0));
  EXPECT_EQ(b.alpha_x, 1);
  ConductorMaterial metal;
  metal.roughness = {1, &wild, 1};
  EXPECT_EQ(metal.at(vec2(0.5f)).alpha_y, kMinAlpha);
  MetallicRoughnessMaterial gltf;
  gltf.metallic = {1, &wild, 0}, gltf.roughness = {1, &wild, 2};
  EXPECT_EQ(gltf.at(vec2(0.5f)).diffuse, vec3(0));
  EXPECT_EQ(gltf.at(vec2(0.5f)).alpha_x, kMinAlpha);
}

TEST(Materials, a_bsdf_stays_small) {
  EXPECT_LE(sizeof(Bsdf), 96u) << "tiles hold 64 of them";
}

}  // namespace
}  // namespace zonal
