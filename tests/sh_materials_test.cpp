// The scene's materials on spherical harmonics against quadrature in double of the very Bsdf of a point.
#include "materials/sh_materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "materials/measured_brdf.h"
#include "materials/sh_projector.h"
#include "sh/quadrature.h"
#include "tests/sh_materials_support.h"

namespace zonal::test {
namespace {

constexpr double kPiD = 3.14159265358979323846;
using ShMaterialsTest = OwnCache;

Case at_point(const Material& m, vec2 uv) {
  const Bsdf b = m.at(uv);
  return {"", b,
          b.kind == BsdfKind::blinn_phong ? 1 / std::sqrt(b.exponent + 1) : std::min(b.alpha_x, b.alpha_y)};
}

constexpr int kBands = 7;

// Between tabulated elevations, 1 degree apart, a lobe in band l turns through l degrees and linear
// interpolation loses (l pi/180)^2/8 of it: 0.14 % for l = 6. At whole degrees what remains is both
// quadratures' error, 1e-3 at the discontinuity of F at the horizon (the table's own bar is 1e-4 of the
// peak).
TEST_F(ShMaterialsTest, constant_materials_are_their_projection) {
  const auto check = [](const List& list) {
    const ShMaterials materials(list, {.bands = kBands});
    const Case c = at_point(*list[0], vec2(0.5f));
    for (const vec3 w_out : {direction(0, 0), direction(31, 77), direction(62.4f, -140)}) {
      for (const ShTable table : {ShTable::brdf, ShTable::brdf_cosine}) {
        EXPECT_EQ(materials.bands(0, c.bsdf, table, w_out), kBands);
        const double error = relative_error(looked_up(materials, c.bsdf, table, w_out, kBands),
                                            by_quadrature(c, table, w_out, kBands, true));
        EXPECT_LT(error, 0.003) << list[0]->type() << (table == ShTable::brdf ? ", F, " : ", F', ")
                                << w_out.z;
      }
    }
  };
  MetallicRoughnessMaterial metallic;
  metallic.base_color.value = vec3(0.8f, 0.5f, 0.1f), metallic.metallic.value = 0.4f,
  metallic.roughness.value = 0.45f;
  check(list_of(metallic));
  CoatedMaterial coated;
  coated.albedo.value = vec3(0.1f, 0.9f, 0.4f), coated.roughness.value = 0.5f, coated.ior = 1.8f;
  check(list_of(coated));
  ConductorMaterial conductor;
  conductor.tint.value = vec3(1, 0.5f, 0.9f), conductor.roughness.value = 0.6f;
  check(list_of(conductor));
  BlinnPhongMaterial blinn_phong;
  blinn_phong.diffuse.value = vec3(0.5f, 0.2f, 0.3f), blinn_phong.specular.value = vec3(0.1f, 0.4f, 0.2f);
  blinn_phong.exponent = 25;
  check(list_of(blinn_phong));
}

/// 4 x 4 texels of red, green and blue in [low, high].
Texture speckled(float low, float high, uint32_t seed) {
  Random random(seed);
  std::vector<vec4> texels;
  for (int i = 0; i < 16; ++i) {
    const float r = random.unit(), g = random.unit(), b = random.unit();
    texels.emplace_back(low + (high - low) * r, low + (high - low) * g, low + (high - low) * b, 1);
  }
  return Texture(4, 4, std::move(texels));
}

// Colours enter linearly, so a texture of colour costs no accuracy: the same tolerance as for a constant.
TEST_F(ShMaterialsTest, textured_colours_are_exact) {
  const Texture colours = speckled(0, 1, 1);
  MetallicRoughnessMaterial m;
  m.base_color.texture = &colours;
  m.metallic.texture = &colours;
  m.roughness.value = 0.55f;
  const List list = list_of(m);
  const ShMaterials materials(list, {.bands = kBands});
  EXPECT_EQ(files().size(), 1u) << "one table for all colours";
  Random random(3);
  for (int i = 0; i < 4; ++i) {
    const Case c = at_point(m, random.square());
    const vec3 w_out = direction(20 * float(i), 50);
    for (const ShTable table : {ShTable::brdf, ShTable::brdf_cosine}) {
      EXPECT_LT(relative_error(looked_up(materials, c.bsdf, table, w_out, kBands),
                               by_quadrature(c, table, w_out, kBands, true)),
                0.003);
    }
  }
}

// Between levels of roughness 1/16 apart, alpha^2's curvature costs F' 1.3 % at most above roughness 0.3 and
// F 2 % (measured over all levels and elevations at 9 bands, docs/materials.md); at a level nothing.
TEST_F(ShMaterialsTest, textured_roughness_is_interpolated) {
  const Texture roughness = speckled(0.38f, 0.62f, 2);
  MetallicRoughnessMaterial m;
  m.base_color.value = vec3(0.9f, 0.4f, 0.2f), m.metallic.value = 0.5f;
  m.roughness.texture = &roughness, m.roughness.value = 1;
  const List list = list_of(m);
  const ShMaterials materials(list, {.bands = kBands});
  EXPECT_GE(files().size(), 4u);
  EXPECT_LE(files().size(), 5u) << "levels 6 to 10 of 16";
  Random random(4);
  for (int i = 0; i < 5; ++i) {
    Case c = at_point(m, random.square());
    double tolerance = 0.02;
    if (i == 4) c.bsdf.alpha_x = c.bsdf.alpha_y = 0.25f, c.width = 0.25f, tolerance = 0.003;
    const vec3 w_out = direction(18 * float(i), 200);
    for (const ShTable table : {ShTable::brdf, ShTable::brdf_cosine}) {
      EXPECT_LT(relative_error(looked_up(materials, c.bsdf, table, w_out, kBands),
                               by_quadrature(c, table, w_out, kBands, true)),
                tolerance)
          << "roughness " << std::sqrt(c.bsdf.alpha_x);
    }
  }
}

// Band 0 of F' is the integral over 2 sqrt(pi). Interpolating the elevation costs curvature of the albedo
// alone: 1e-3.
TEST_F(ShMaterialsTest, band_0_is_the_albedo) {
  CoatedMaterial coated;
  coated.albedo.value = vec3(0.2f, 0.6f, 1), coated.roughness.value = 0.4f;
  const ShMaterials materials(list_of(coated), {.bands = 3});
  const Case c = at_point(coated, vec2(0));
  for (float degrees : {0.0f, 22.3f, 51.0f, 74.6f}) {
    const vec3 w_out = direction(degrees, -30);
    const BsdfContext view = prepare(c.bsdf, w_out);
    glm::dvec3 albedo(0);
    SphericalGrid(w_out, c.width).integrate([&](vec3 w, double weight) {
      albedo += glm::dvec3(evaluate(c.bsdf, view, w)) * double(std::max(w.z, 0.0f)) * weight;
    });
    const Coefficients got = looked_up(materials, c.bsdf, ShTable::brdf_cosine, w_out, 3);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(got[size_t(k)][0] * 2 * std::sqrt(kPiD), albedo[k], 1e-3) << degrees;
  }
}

TEST_F(ShMaterialsTest, lambert_is_a_closed_form_in_any_number_of_bands) {
  const Texture colours = speckled(0, 1, 6);
  LambertMaterial m;
  m.albedo.texture = &colours, m.albedo.value = vec3(1);
  const ShMaterials materials(list_of(m), {});
  EXPECT_TRUE(files().empty());
  const Bsdf b = m.at(vec2(0.3f, 0.8f));
  // Polynomials of degree 12 times z: exact.
  const sh::GaussLegendre rule = sh::gauss_legendre(20, 0, 1);
  for (const ShTable table : {ShTable::brdf, ShTable::brdf_cosine}) {
    const Coefficients got = looked_up(materials, b, table, direction(40, 9), 12);
    for (int l = 0; l < 12; ++l) {
      double integral = 0;
      for (size_t i = 0; i < rule.nodes.size(); ++i) {
        const double z = rule.nodes[i];
        integral += rule.weights[i] * std::sqrt((2 * l + 1) * kPiD) * std::legendre(unsigned(l), z) *
                    (table == ShTable::brdf ? 1 : z) / kPiD;
      }
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(got[size_t(k)][size_t(sh_index(l, 0, true))], b.diffuse[k] * integral, 1e-6) << l;
        for (int order = 1; order <= l; ++order) {
          EXPECT_EQ(got[size_t(k)][size_t(sh_index(l, order, true))], 0) << l << " " << order;
        }
      }
    }
  }
  // F' holds 87.5 % in two bands and 99.2 % in three; F gets no more.
  EXPECT_EQ(materials.bands(0, b, ShTable::brdf_cosine, vec3(0, 0, 1)), 3);
  EXPECT_EQ(materials.bands(0, b, ShTable::brdf, vec3(0, 0, 1)), 3);
  EXPECT_EQ(materials.max_bands(), 3);
}

// What `bands` promises: at the nearest tabulated view, so many bands hold 95 % of this mixture's energy and
// one fewer do not. The energy of the bands that the tables lack is estimated: 1 %.
TEST_F(ShMaterialsTest, a_mixture_gets_the_bands_it_needs) {
  const Texture colours = speckled(0, 1, 8);
  MetallicRoughnessMaterial m;
  m.base_color.texture = &colours, m.metallic.texture = &colours, m.roughness.value = 0.5f;
  const ShMaterials materials(list_of(m), {.most_bands = 20});
  std::set<int> counts;
  for (float metallic : {0.0f, 0.2f, 1.0f}) {
    Bsdf b = m.at(vec2(0));
    b.diffuse = vec3(0.8f, 0.6f, 0.4f) * (1 - metallic);
    b.specular = glm::mix(vec3(0.04f), vec3(0.9f, 0.7f, 0.2f), metallic);
    const Case c{"", b, b.alpha_x};
    for (float degrees : {10.0f, 50.0f}) {
      const vec3 w_out = direction(degrees, 3);
      const BsdfContext view = prepare(b, w_out);
      const int bands = materials.bands(0, b, ShTable::brdf_cosine, w_out);
      counts.insert(bands);
      double whole = 0, held = 0, less = 0;
      SphericalGrid(w_out, c.width).integrate([&](vec3 w, double weight) {
        const glm::dvec3 f = glm::dvec3(evaluate(b, view, w)) * double(std::max(w.z, 0.0f));
        whole += glm::dot(f, f) * weight;
      });
      const Coefficients truth = by_quadrature(c, ShTable::brdf_cosine, w_out, bands, true);
      for (const auto& channel : truth) {
        for (int i = 0; i < sh_count(bands, true); ++i) {
          const double e = channel[size_t(i)] * channel[size_t(i)];
          held += e, less += i < sh_count(bands - 1, true) ? e : 0;
        }
      }
      EXPECT_GT(held, 0.94 * whole) << metallic << " " << degrees << ": " << bands;
      EXPECT_LT(less, 0.96 * whole) << metallic << " " << degrees << ": " << bands;
    }
  }
  EXPECT_GE(counts.size(), 3u);
  EXPECT_LE(*counts.begin(), 4) << "a diffuse point needs few, whatever its neighbours need";
}

// Four azimuths, looked up at one of them: no interpolation, both layouts of the frame. 7 bands' tolerance as
// above.
TEST_F(ShMaterialsTest, anisotropic_materials_follow_the_azimuth) {
  ConductorMaterial m;
  m.roughness.value = 0.6f, m.anisotropy = 0.4f;
  const ShMaterials materials(list_of(m), {.bands = 4, .azimuths = 4});
  ASSERT_FALSE(materials.mirrored(0));
  const Case c = at_point(m, vec2(0));
  for (float azimuth : {0.0f, 90.0f, 270.0f}) {
    const vec3 w_out = direction(40, azimuth);
    EXPECT_LT(relative_error(looked_up(materials, c.bsdf, ShTable::brdf_cosine, w_out, 4),
                             by_quadrature(c, ShTable::brdf_cosine, w_out, 4, false)),
              0.003)
        << azimuth;
  }
}

TEST_F(ShMaterialsTest, textured_roughness_leaves_anisotropy_out_and_says_so) {
  const Texture roughness = speckled(0.52f, 0.6f, 2);
  ConductorMaterial m;
  m.name = "brushed";
  m.roughness.texture = &roughness, m.roughness.value = 1, m.anisotropy = 0.8f;
  const ShMaterials materials(list_of(m), {.bands = 3});
  ASSERT_EQ(materials.notes().size(), 1u);
  EXPECT_NE(materials.notes()[0].find("\"brushed\""), std::string::npos);
  EXPECT_TRUE(materials.mirrored(0));
  // The isotropic surface of the same alpha_x alpha_y; levels as above.
  const Bsdf b = m.at(vec2(0.1f));
  Case mean{"", b, std::sqrt(b.alpha_x * b.alpha_y)};
  mean.bsdf.alpha_x = mean.bsdf.alpha_y = mean.width;
  const vec3 w_out = direction(35, 12);
  EXPECT_LT(relative_error(looked_up(materials, b, ShTable::brdf_cosine, w_out, 3),
                           by_quadrature(mean, ShTable::brdf_cosine, w_out, 3, true)),
            0.02);
}

TEST_F(ShMaterialsTest, black_points_and_directions_below_are_zero) {
  const ShMaterials materials(list_of(LambertMaterial{}), {.bands = 4});
  std::vector<float> rgb(30, 1.0f);
  EXPECT_EQ(materials.look_up(0, Bsdf{}, ShTable::brdf, vec3(0, 0, 1), 4, 10, rgb.data()), 0);
  EXPECT_EQ(rgb, std::vector<float>(30, 0.0f));
  rgb.assign(30, 1.0f);
  EXPECT_EQ(
      materials.look_up(0, LambertMaterial{}.at(vec2(0)), ShTable::brdf, vec3(1, 0, 0), 4, 10, rgb.data()),
      0);
  EXPECT_EQ(rgb, std::vector<float>(30, 0.0f));
}

/// A smooth lobe about the mirror direction that no model of ours has, reciprocal and mirrored.
struct MadeUpBrdf : MeasuredBrdf {
  vec3 evaluate(vec3 w_out, vec3 w_in) const override {
    if (w_out.z <= 0 || w_in.z <= 0) return vec3(0);
    const float across = w_out.x * w_in.x + w_out.y * w_in.y, along = w_out.z * w_in.z;
    return vec3(0.2f, 0.1f, 0.05f) * (1 + sqr(along - across));
  }
  vec3 sample_direction(vec3, float, vec2) const override { return vec3(0, 0, 1); }
  float pdf(vec3, vec3) const override { return 1; }
  bool isotropic() const override { return true; }
  const char* format() const override { return "made up"; }
};

// A polynomial of degree 2: three bands of F hold all that the hemisphere's edge leaves to them. Tolerances
// as above.
TEST_F(ShMaterialsTest, measured_materials_are_projected_or_read_from_their_file) {
  MeasuredMaterial m;
  m.brdf = std::make_shared<MadeUpBrdf>();
  const vec3 w_out = direction(48, 20);
  const Case c{"", m.at(vec2(0)), 1};
  const Coefficients truth = by_quadrature(c, ShTable::brdf_cosine, w_out, 5, true);
  const ShMaterials projected(list_of(m), {.bands = 5});
  EXPECT_TRUE(files().empty()) << "no file, so nothing to know it by";
  EXPECT_LT(relative_error(looked_up(projected, c.bsdf, ShTable::brdf_cosine, w_out, 5), truth), 0.003);

  const std::vector<std::byte> bytes = write_shmat(project_material(c.bsdf, {.bands = 4}), {.half = false});
  m.sh_file = (fs::path(testing::TempDir()) / (std::to_string(getpid()) + "_made_up.shmat")).string();
  std::ofstream(m.sh_file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  const ShMaterials opened(list_of(m), {.bands = 9});
  EXPECT_EQ(opened.bands(0, c.bsdf, ShTable::brdf, w_out), 4) << "as many as the file has";
  EXPECT_LT(relative_error(looked_up(opened, c.bsdf, ShTable::brdf_cosine, w_out, 4),
                           by_quadrature(c, ShTable::brdf_cosine, w_out, 4, true)),
            0.003);
  fs::remove(m.sh_file);
}

}  // namespace
}  // namespace zonal::test
