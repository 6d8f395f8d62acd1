// The projector against closed forms and against itself; sh_projector_accuracy_test.cpp has the quadratures.

#include "materials/sh_projector.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "bsdf_cases.h"
#include "materials/sh_projector_quadrature.h"
#include "sh/basis.h"
#include "sh/clamped_cosine.h"
#include "sh/ggx_lobe.h"
#include "sh/quadrature.h"

namespace zonal {
namespace {

constexpr double kPiD = 3.14159265358979323846;

TEST(Projector, lambert_is_the_clamped_cosine_over_pi) {
  const vec3 albedo(0.8f, 0.5f, 0.2f);
  const ShProjection p = project_material(test::lambert(albedo).bsdf, {.bands = 9});
  ASSERT_TRUE(p.mirrored);
  double cosine[9];
  sh::clamped_cosine_zonal(9, cosine);
  for (int elevation : {0, 37, 90}) {
    for (int l = 0; l < 9; ++l) {
      for (int m = 0; m <= l; ++m) {
        const int i = sh_index(l, m, true);
        // The hemisphere itself: int_0^1 P_l = 1, 1/2, 0, -1/8, ... by quadrature of the definition.
        const sh::GaussLegendre rule = sh::gauss_legendre(12, 0, 1);
        double hemisphere = 0;
        std::vector<double> X(45);
        for (int k = 0; k < 12; ++k) {
          sh::normalized_legendre(9, rule.nodes[size_t(k)],
                                  std::sqrt(1 - rule.nodes[size_t(k)] * rule.nodes[size_t(k)]), X.data());
          hemisphere += 2 * kPiD * rule.weights[size_t(k)] * X[size_t(sh::legendre_index(9, l, 0))];
        }
        for (int c = 0; c < 3; ++c) {
          const double f = p.rows[0][size_t(elevation)].coefficients[size_t(c * 45 + i)];
          const double fc = p.rows[1][size_t(elevation)].coefficients[size_t(c * 45 + i)];
          // float: 6e-8 of values up to 1, and nodes' error
          EXPECT_NEAR(f, m == 0 ? albedo[c] / kPiD * hemisphere : 0, 2e-6) << l << " " << m;
          EXPECT_NEAR(fc, m == 0 ? albedo[c] / kPiD * cosine[l] : 0, 2e-6) << l << " " << m;
        }
      }
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.albedo[c], albedo[c], 1e-5);
  EXPECT_NEAR(p.rows[1][3].energy, 2.0 / 3 / kPiD * glm::dot(albedo, albedo), 1e-5);  // 2 pi int z^2 / pi^2
}

// At normal incidence without Fresnel, f cos = D(theta/2) G2 / (4 cos o) with o.z = 1: ggx_zonal's lobe times
// G2, which differs from 1 by less than alpha^2/4 tan^2 theta.
TEST(Projector, ggx_at_normal_incidence_is_the_zonal_lobe) {
  for (const float alpha : {0.03f, 0.1f}) {
    Bsdf b{.kind = BsdfKind::conductor, .specular = vec3(1), .eta = vec3(1e-4f), .k = vec3(1e4f)};  // F = 1
    b.alpha_x = b.alpha_y = alpha;
    const HemisphereNodes nodes = hemisphere_nodes(b, 0, 0, {.half = true});
    constexpr int kBands = 12;
    std::vector<double> f(3 * size_t(sh_count(kBands + 1, true))), fc(size_t(sh_count(kBands, true)));
    project_nodes(nodes, kBands + 1, true, ShBasis::spherical, f.data());
    times_cosine(kBands, true, ShBasis::spherical, f.data(), fc.data());
    double zonal[kBands];
    sh::ggx_zonal(kBands, sh::GgxLobe::reflect_normal_incidence, double(alpha), zonal);
    for (int l = 0; l < kBands; ++l)
      for (int m = 0; m <= l; ++m)
        EXPECT_NEAR(fc[size_t(sh_index(l, m, true))], m == 0 ? zonal[l] : 0,
                    m == 0 ? 2.5 * alpha * alpha : 1e-6)
            << alpha << " " << l << " " << m;
  }
}

TEST(Projector, a_sharp_highlight_is_found_at_every_elevation) {
  // Mirror-like, alpha = 1e-3: the albedo towards w_out is known from the sampler's weights.
  Bsdf b{.kind = BsdfKind::conductor,
         .specular = vec3(1),
         .eta = vec3(1e-4f),
         .k = vec3(1e4f),
         .alpha_x = 1e-3f};
  b.alpha_y = b.alpha_x;
  for (const double degrees : {0.0, 1.0, 45.0, 85.0}) {
    const HemisphereNodes nodes = hemisphere_nodes(b, 0, degrees * kPiD / 180, {.half = true});
    EXPECT_NEAR(nodes.albedo[0], 1, 2e-3)
        << degrees;  // G2 at alpha 1e-3 loses less than 1e-4; half vectors in float
  }
}

TEST(Projector, shares_grow_with_bands_and_end_at_one) {
  for (const test::Case& c : {test::conductor("gold", 0.3f), test::lambert(vec3(0.5f))}) {
    for (const double theta : {0.0, 0.6, 1.2, 1.55}) {
      const BandStudy study = study_bands(c.bsdf, theta, 60);
      for (const auto* basis : {&study.spherical, &study.hemispherical}) {
        for (int table = 0; table < 2; ++table) {
          const std::vector<double>& shares = (*basis)[table];
          ASSERT_EQ(shares.size(), 60u);
          EXPECT_GT(shares[0], 0);
          for (size_t l = 1; l < shares.size(); ++l) EXPECT_GE(shares[l], shares[l - 1]);
          EXPECT_LE(shares.back(), 1.001) << c.name << " " << theta;
          // A lobe of half vectors of width 0.09 is 0.18 wide in w_in: 60 bands hold it, unless the horizon
          // cuts it.
          if (theta < 1) {
            EXPECT_GT(shares.back(), 0.99) << c.name << " " << theta << " table " << table;
          }
        }
      }
    }
  }
  EXPECT_EQ(BandStudy::bands({0.3, 0.6, 0.96}, 0.95), 3);
  EXPECT_EQ(BandStudy::bands({0.3, 0.6, 0.94}, 0.95), 0);
}

TEST(Projector, rows_keep_no_more_bands_than_the_share_needs) {
  const test::Case c = test::conductor("gold", 0.4f);
  const ShProjection p = project_material(c.bsdf, {.share = 0.9f, .most_bands = 30});
  for (const int elevation : {0, 40, 70}) {
    const BandStudy study = study_bands(c.bsdf, ShMaterial::degrees(elevation) * kPiD / 180, 40);
    const int needed[2] = {BandStudy::bands(study.spherical[0], 0.9),
                           BandStudy::bands(study.spherical[1], 0.9)};
    for (int table = 0; table < 2; ++table) {
      const ShRow& row = p.rows[table][size_t(elevation)];
      EXPECT_EQ(row.bands, table == 0 ? std::min(needed[0], needed[1]) : needed[1]) << elevation;
      EXPECT_NEAR(row.captured, study.spherical[table][size_t(row.bands) - 1], 1e-4);
      if (table == 1) EXPECT_GE(row.captured, 0.9);
      EXPECT_EQ(row.coefficients.size(), 3 * size_t(sh_count(row.bands, true)));
      // Parseval: what is stored is what is counted.
      double sum = 0;
      for (const float x : row.coefficients) sum += double(x) * x;
      EXPECT_NEAR(sum / row.energy, row.captured, 1e-5);
    }
  }
  // Band 0 of F' is the directional albedo over 2 sqrt pi.
  for (int e = 0; e < ShMaterial::kElevations; ++e)
    for (int channel = 0; channel < 3; ++channel) {
      const ShRow& row = p.rows[1][size_t(e)];
      EXPECT_NEAR(row.coefficients[size_t(channel) * row.coefficients.size() / 3],
                  p.row_albedo[size_t(e)][channel] / (2 * std::sqrt(kPiD)), 1e-6);
    }
}

// Lambert's F is a step at the horizon: 94.9 % in four bands, 96.7 % in six. F' holds 99.2 % in three.
TEST(Projector, rows_of_F_have_no_more_bands_than_the_light_they_send_needs) {
  const ShProjection p = project_material(test::lambert(vec3(0.5f)).bsdf);
  for (const int elevation : {0, 50, 90}) {
    EXPECT_EQ(p.rows[1][size_t(elevation)].bands, 3);
    EXPECT_EQ(p.rows[0][size_t(elevation)].bands, 3);
    EXPECT_NEAR(p.rows[0][size_t(elevation)].captured, 0.875, 1e-3);  // bands 0 and 1: 1/2 and 3/8; 2: none
  }
}

TEST(Projector, rows_are_cut_at_the_most_bands) {
  const ShProjection p = project_material(test::conductor("gold", 0.1f).bsdf, {.most_bands = 10});
  EXPECT_EQ(p.rows[1][45].bands, 10);
  EXPECT_LT(p.rows[1][45].captured, 0.5);
}

TEST(Projector, anisotropic_materials_are_fans_of_few_bands) {
  const Bsdf b = test::conductor("gold", 0.3f, 0.8f).bsdf;
  const ShProjection p = project_material(b, {.azimuths = 3, .nodes = 600});
  EXPECT_FALSE(p.mirrored);
  EXPECT_EQ(p.azimuths, 3);
  ASSERT_EQ(p.rows[0].size(), 3u * ShMaterial::kElevations);
  int most = 0;
  for (const auto& table : p.rows)
    for (const ShRow& row : table) most = std::max(most, row.bands);
  EXPECT_EQ(most, kAnisotropicBands);
  EXPECT_LT(p.evaluations, 3u * 91 * 5000);
  // Turned by half a circle the surface is the same: of six azimuths, the fourth fan is the first. Highlights
  // differ in rounding alone, and where cells are halved.
  const ShProjection six = project_material(b, {.bands = 4, .azimuths = 6, .nodes = 3000});
  for (const int e : {5, 50, 80}) {
    const ShRow &first = six.rows[1][size_t(e)], &fourth = six.rows[1][size_t(3 * 91 + e)];
    const ShRow& second = six.rows[1][size_t(91 + e)];
    double other = 0;
    for (size_t i = 0; i < first.coefficients.size(); ++i) {
      EXPECT_NEAR(first.coefficients[i], fourth.coefficients[i], 1e-4);
      other = std::max(other, std::abs(double(first.coefficients[i]) - second.coefficients[i]));
    }
    EXPECT_GT(other, 0.005);
  }
}

TEST(Projector, windows_scale_bands) {
  const Bsdf b = test::conductor("gold", 0.4f).bsdf;
  const ShProjection plain = project_material(b, {.bands = 6, .nodes = 2000});
  const ShProjection hann =
      project_material(b, {.bands = 6, .window = "hann", .window_size = 8, .nodes = 2000});
  const ShProjection dered = project_material(b, {.bands = 6, .window = "auto", .nodes = 2000});
  for (int l = 0; l < 6; ++l) {
    const size_t i = size_t(sh_index(l, 0, true));
    EXPECT_NEAR(hann.rows[1][30].coefficients[i],
                plain.rows[1][30].coefficients[i] * (0.5 + 0.5 * std::cos(kPiD * l / 8)), 1e-6);
  }
  EXPECT_EQ(hann.rows[1][30].captured, plain.rows[1][30].captured);
  EXPECT_NEAR(dered.rows[1][30].coefficients[0], plain.rows[1][30].coefficients[0], 1e-6);
  const size_t last = size_t(sh_index(5, 0, true));
  EXPECT_LT(std::abs(dered.rows[1][30].coefficients[last]),
            0.9f * std::abs(plain.rows[1][30].coefficients[last]));
  EXPECT_THROW(project_material(b, {.window = "han"}), std::runtime_error);
  EXPECT_THROW(project_material(b, {.bands = 101}), std::runtime_error);
}

TEST(Projector, results_do_not_depend_on_threads_and_stopping_leaves_nothing) {
  const Bsdf b = test::coated(vec3(0.5f), 0.5f).bsdf;
  double last = 0;
  int calls = 0;
  const ShProjection first = project_material(b, {.bands = 4}, {}, [&](double done) {
    EXPECT_GT(done, last);
    last = done, ++calls;
  });
  EXPECT_EQ(calls, 91);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(write_shmat(first), write_shmat(project_material(b, {.bands = 4})));
  std::atomic<bool> asked{true};
  EXPECT_TRUE(project_material(b, {.bands = 4}, Stop(&asked, Clock::time_point::max())).empty());
}

TEST(Projector, black_is_black) {
  const ShProjection p = project_material(Bsdf{});
  EXPECT_EQ(p.rows[0][10].bands, 1);
  EXPECT_EQ(p.rows[0][10].captured, 1);
  EXPECT_EQ(p.albedo, vec3(0));
  const ShMaterial m = ShMaterial::from_bytes(write_shmat(p), "black");
  EXPECT_EQ(m.max_bands(), 1);
}

}  // namespace
}  // namespace zonal
