// How exact projections are: against plain dense quadrature in double, for models and for measured files.

#include "materials/sh_projector.h"

#include <gtest/gtest.h>

#include "bsdf_cases.h"
#include "bsdf_quadrature.h"
#include "dense_projection.h"
#include "materials/measured_brdf.h"
#include "materials/sh_projector_quadrature.h"
#include "measured_files.h"
#include "sh/basis.h"
#include "sh/hemispherical.h"
#include "sh/quadrature.h"

namespace zonal {
namespace {

using test::kPiD;

vec3 out_direction(double theta) {
  return vec3(float(std::sin(theta)), 0, float(std::cos(theta)));
}

/// Coefficients in double, [channel][index], of F and F': rings of uniform azimuths, Gauss nodes of polar
/// angles in panels of 1.5 degrees, thinner towards the horizon; dense enough for lobes of width 0.05. For
/// BRDFs even in phi.
struct Direct {
  std::vector<double> c[2][3];
  double energy[2] = {};
};
Direct project_directly(const Bsdf& bsdf, double theta, int bands) {
  std::vector<double> phi, phi_weights;
  for (int i = 0; i < 28; ++i) {
    const double low = i < 16 ? i / 16.0 : 1 - std::exp2(15 - i) / 16;
    const double high = i < 15 ? (i + 1) / 16.0 : i < 27 ? 1 - std::exp2(14 - i) / 16 : 1;
    const sh::GaussLegendre rule = sh::gauss_legendre(8, kPiD * low, kPiD * high);
    phi.insert(phi.end(), rule.nodes.begin(), rule.nodes.end());
    phi_weights.insert(phi_weights.end(), rule.weights.begin(), rule.weights.end());
  }
  Direct direct;
  for (auto& table : direct.c)
    for (auto& channel : table) channel.assign(size_t(sh::count(bands)), 0.0);
  const BsdfContext view = prepare(bsdf, out_direction(theta));
  const size_t n = size_t(bands);
  std::vector<double> cosines(phi.size() * n), X(size_t(sh::legendre_count(bands)));
  for (size_t j = 0; j < phi.size(); ++j)
    for (size_t m = 0; m < n; ++m) cosines[j * n + m] = std::cos(double(m) * phi[j]);
  std::vector<double> edges;
  for (int i = 0; i < 60; ++i) edges.push_back(kPiD / 2 * i / 60);
  for (int i = 1; i < 8; ++i) edges.push_back(kPiD / 2 * (1 - std::exp2(-i) / 60));
  edges.push_back(kPiD / 2);
  for (size_t panel = 0; panel + 1 < edges.size(); ++panel) {
    const sh::GaussLegendre rule = sh::gauss_legendre(8, edges[panel], edges[panel + 1]);
    for (size_t k = 0; k < 8; ++k) {
      const double s = std::sin(rule.nodes[k]), z = std::cos(rule.nodes[k]);
      std::vector<glm::dvec3> sums(size_t(bands), glm::dvec3(0));
      double squares = 0;
      for (size_t j = 0; j < phi.size(); ++j) {
        const vec3 w(float(s * std::cos(phi[j])), float(s * std::sin(phi[j])), float(z));
        const glm::dvec3 f(evaluate(bsdf, view, w));
        squares += phi_weights[j] * glm::dot(f, f);
        for (size_t m = 0; m < n; ++m) sums[m] += phi_weights[j] * cosines[j * n + m] * f;
      }
      const double weight = 2 * rule.weights[k] * s;  // both halves
      direct.energy[0] += weight * squares, direct.energy[1] += weight * squares * z * z;
      sh::normalized_legendre(bands, z, s, X.data());
      for (int m = 0; m < bands; ++m)
        for (int l = m; l < bands; ++l)
          for (int c = 0; c < 3; ++c) {
            const double value = weight * (m > 0 ? std::sqrt(2.0) : 1) *
                                 X[size_t(sh::legendre_index(bands, l, m))] * sums[size_t(m)][c];
            direct.c[0][c][size_t(sh::index(l, m))] += value,
                direct.c[1][c][size_t(sh::index(l, m))] += z * value;
          }
    }
  }
  return direct;
}

// Tables at the tabulated elevations against double-precision projection on a grid refined at the mirror
// direction: issue's bar of 1e-4 of the peak at 20 bands, F' exactly and F too; energies to 1 %.
TEST(ProjectorAccuracy, agrees_with_direct_projection_and_another_quadratures_energy) {
  constexpr int kBands = 20;
  const test::Case cases[] = {test::conductor("gold", 0.25f), test::coated(vec3(0.8f, 0.5f, 0.2f), 0.4f),
                              test::blinn_phong(vec3(0.3f), vec3(0.5f), 200)};
  for (const test::Case& c : cases) {
    const ShProjection p = project_material(c.bsdf, {.bands = kBands});
    EXPECT_TRUE(p.mirrored);
    for (const int elevation : {0, 20, 55, 80, 90}) {
      const Direct direct = project_directly(c.bsdf, ShMaterial::degrees(elevation) * kPiD / 180, kBands);
      for (int table = 0; table < 2; ++table) {
        const ShRow& row = p.rows[table][size_t(elevation)];
        for (int channel = 0; channel < 3; channel += 2)
          EXPECT_LT(test::difference(kBands, true, row.coefficients.data() + channel * sh_count(kBands, true),
                                     direct.c[table][channel]),
                    1e-4)
              << c.name << " " << elevation << " table " << table;
        EXPECT_NEAR(row.energy / direct.energy[table], 1, 0.01)
            << c.name << " " << elevation << " table " << table;
      }
    }
  }
}

// The same for measured files, all channels: the bar holds for the worst of them, and grazing is the hardest.
// Nodes are those of project_material at 20 bands. The grid's own error is 6e-5 at worst (half as many steps
// as bench_materials takes, one file at 89.5 degrees) and mostly below 1e-5.
TEST(ProjectorAccuracy, measured_files_agree_with_a_dense_grid) {
  const std::vector<std::string> files = test::published_rgl_files();
  if (files.empty()) GTEST_SKIP() << test::kNoPublishedFiles;
  constexpr int kBands = 20, kCount = sh_count(kBands + 1, true);
  for (const std::string& file : files) {
    const std::unique_ptr<MeasuredBrdf> brdf = load_measured(file);
    const Bsdf b{.kind = BsdfKind::measured, .measured = brdf.get()};
    for (const int elevation : {0, 80, 90}) {
      const double theta = ShMaterial::degrees(elevation) * kPiD / 180;
      const HemisphereNodes nodes = hemisphere_nodes(b, 0, theta, {.half = true, .average = true});
      std::vector<double> f(3 * size_t(kCount)), fc(size_t(sh_count(kBands, true)));
      project_nodes(nodes, kBands + 1, true, ShBasis::spherical, f.data());
      const test::DenseProjection dense = test::dense_projection(*brdf, theta, kBands, 1000);
      for (int c = 0; c < 3; ++c) {
        times_cosine(kBands, true, ShBasis::spherical, f.data() + c * kCount, fc.data());
        const std::vector<float> row(fc.begin(), fc.end());
        EXPECT_LT(test::difference(kBands, true, row.data(), dense.c[c]), 1e-4)
            << file << " " << elevation << " " << c;
      }
      EXPECT_NEAR(nodes.energy_cosine / dense.energy_cosine, 1, 0.01) << file << " " << elevation;
    }
  }
}

TEST(ProjectorAccuracy, anisotropic_rows_agree_with_direct_projection) {
  constexpr int kBands = 8;
  const test::Case c = test::conductor("copper", 0.5f, 0.7f);
  ASSERT_FALSE(is_isotropic(c.bsdf));
  const double theta = 50 * kPiD / 180, azimuth = 2 * kPiD * 2 / 7;
  const HemisphereNodes nodes = hemisphere_nodes(c.bsdf, azimuth, theta, {});
  std::vector<double> f(3 * size_t(sh::count(kBands)));
  project_nodes(nodes, kBands, false, ShBasis::spherical, f.data());
  // The same in the shading frame, then turned: rotating the integrand's directions instead of coefficients.
  const vec3 w_out(float(std::sin(theta) * std::cos(azimuth)), float(std::sin(theta) * std::sin(azimuth)),
                   float(std::cos(theta)));
  const BsdfContext view = prepare(c.bsdf, w_out);
  const ViewFrame frame(w_out);
  std::vector<double> truth(size_t(sh::count(kBands))), Y(truth.size());
  test::SphericalGrid(w_out, 0.1 * double(c.width)).integrate([&](vec3 w, double weight) {
    sh::evaluate(kBands, glm::dvec3(frame.to_view(w)), Y.data());
    const double value = weight * evaluate(c.bsdf, view, w).y;
    for (size_t i = 0; i < Y.size(); ++i) truth[i] += value * Y[i];
  });
  std::vector<float> row(f.begin() + sh::count(kBands), f.begin() + 2 * sh::count(kBands));
  EXPECT_LT(test::difference(kBands, false, row.data(), truth), 1e-4);
  EXPECT_GT(std::abs(truth[size_t(sh::index(2, -1))]), 1e-3);  // both halves matter
}

// The study's hemispherical coefficients against those of sh/hemispherical.h, by Gauss nodes in sqrt z, which
// these functions are smooth in.
TEST(ProjectorAccuracy, hemispherical_coefficients_follow_their_definition) {
  const test::Case c = test::conductor("gold", 0.6f);
  constexpr int kBands = 6;
  const double theta = 0.7;
  const HemisphereNodes nodes = hemisphere_nodes(c.bsdf, 0, theta, {.half = true, .hemispherical = true});
  std::vector<double> f(3 * size_t(sh_count(kBands + 1, true))), fc(size_t(sh_count(kBands, true)));
  project_nodes(nodes, kBands + 1, true, ShBasis::hemispherical, f.data());
  times_cosine(kBands, true, ShBasis::hemispherical, f.data(), fc.data());
  std::vector<double> H(size_t(sh::count(kBands))), truth(H.size()), truth_cosine(H.size());
  const BsdfContext view = prepare(c.bsdf, out_direction(theta));
  const sh::GaussLegendre rule = sh::gauss_legendre(200);
  for (size_t i = 0; i < 200; ++i) {
    const double q = 0.5 + 0.5 * rule.nodes[i], z = q * q, s = std::sqrt(1 - z * z);
    for (int j = 0; j < 400; ++j) {
      const double phi = (j + 0.5) * kPiD / 200, weight = 0.5 * rule.weights[i] * 2 * q * kPiD / 200;
      const glm::dvec3 w(s * std::cos(phi), s * std::sin(phi), z);
      sh::evaluate_hemispherical(kBands, w, H.data());
      const double value = weight * evaluate(c.bsdf, view, vec3(w)).x;
      for (size_t k = 0; k < H.size(); ++k) truth[k] += value * H[k], truth_cosine[k] += value * z * H[k];
    }
  }
  for (int l = 0; l < kBands; ++l)
    for (int m = 0; m <= l; ++m) {
      EXPECT_NEAR(f[size_t(sh_index(l, m, true))], truth[size_t(sh::index(l, m))], 1e-5 * truth[0]) << l << m;
      EXPECT_NEAR(fc[size_t(sh_index(l, m, true))], truth_cosine[size_t(sh::index(l, m))], 1e-5 * truth[0]);
    }
}

}  // namespace
}  // namespace zonal
