// GGX lobes, attenuation and lights without size against the golden vectors and finite differences.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "sh/ggx_lobe.h"
#include "sh/simple_lights.h"

namespace zonal::sh {
namespace {

using nlohmann::json;
using dvec3 = Vec3<double>;
constexpr double kPi = 3.14159265358979323846;

json golden(const std::string& name) {
  std::ifstream file(std::string(ZONAL_SOURCE_DIR) + "/tests/golden/" + name + ".json");
  EXPECT_TRUE(file) << name;
  return json::parse(file);
}

template <class T = double>
Vec3<T> vec(const json& j) {
  return Vec3<T>(T(j[0].get<double>()), T(j[1].get<double>()), T(j[2].get<double>()));
}

template <class A, class B>
double worst_of_largest(const A& got, const B& truth, int n) {
  double largest = 0, worst = 0;
  for (int i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(double(truth[i])));
    worst = std::max(worst, std::abs(double(got[i]) - double(truth[i])));
    if (!std::isfinite(double(got[i]))) return INFINITY;
  }
  return largest > 0 ? worst / largest : worst;
}

TEST(ShLobesAndPoints, ggx_lobes_match_golden) {
  const json file = golden("ggx_zh");
  for (const json& c : file["cases"]) {
    for (const auto& [name, lobe] :
         {std::pair{"ndf", GgxLobe::ndf}, std::pair{"ndf_cos", GgxLobe::ndf_cos},
          std::pair{"reflect_normal_incidence", GgxLobe::reflect_normal_incidence}}) {
      double z[30];
      ggx_zonal(30, lobe, c["alpha"].get<double>(), z);
      EXPECT_LT(worst_of_largest(z, c[name].get<std::vector<double>>(), 30), 1e-13) << c["alpha"] << name;
    }
  }
}

// z_0 of D cos is 1/sqrt(4pi) for every alpha. Derivatives: central differences, error h^2/alpha^2.
TEST(ShLobesAndPoints, sharp_ggx_lobes_keep_their_energy_and_derivative) {
  for (const double alpha : {1e-6, 1e-3, 0.02, 0.3, 1.0}) {
    double z[101], dz[101], a[101], b[101];
    ggx_zonal(101, GgxLobe::ndf_cos, alpha, z, dz);
    EXPECT_NEAR(z[0], 0.5 / std::sqrt(kPi), 1e-13) << alpha;
    for (const GgxLobe lobe : {GgxLobe::ndf, GgxLobe::ndf_cos, GgxLobe::reflect_normal_incidence}) {
      const double h = 1e-4 * alpha;
      ggx_zonal(101, lobe, alpha, z, dz);
      ggx_zonal(101, lobe, alpha + h, a), ggx_zonal(101, lobe, alpha - h, b);
      for (int l = 0; l < 101; ++l)
        EXPECT_NEAR((a[l] - b[l]) / (2 * h) * alpha, dz[l] * alpha, 1e-6) << alpha << " " << l;
    }
  }
}

TEST(ShLobesAndPoints, attenuation_matches_golden) {
  const json cases = golden("yuksel")["cases"];
  ASSERT_FALSE(cases.empty());
  for (const json& c : cases) {
    const dvec3 w = vec(c["y"]) - vec(c["x"]);
    const Attenuation<double> s = inverse_square(w), q = yuksel(w, c["r"].get<double>());
    EXPECT_NEAR(q.value / c["attenuation"].get<double>(), 1, 1e-14);
    EXPECT_NEAR(s.value / c["inv_sq"].get<double>(), 1, 2e-13);  // y - x rounds
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(q.gradient[k] / c["grad_x"][k].get<double>(), 1, 2e-13);
      EXPECT_NEAR(s.gradient[k] / c["grad_x_inv_sq"][k].get<double>(), 1, 4e-13);
    }
  }
}

TEST(ShLobesAndPoints, simple_lights_have_the_gradients_they_claim) {
  const dvec3 x(0.2, -0.4, 0.1), y(0.9, 0.5, 1.2);
  const double h = 1e-5;
  SpotCone<double> cone{glm::normalize(dvec3(-0.5, -0.6, -1)), 0.999, 0.7};
  for (int kind = 0; kind < 3; ++kind) {
    const auto at = [&](dvec3 p, double* L, dvec3* G) {
      if (kind == 0) point_light(8, p, y, 2.0, L, G);
      if (kind == 1) point_light_yuksel(8, p, y, 2.0, 0.3, L, G);
      if (kind == 2) spot_light(8, p, y, 2.0, cone, L, G);
    };
    double L[64], a[64], b[64];
    dvec3 G[64];
    at(x, L, G);
    EXPECT_GT(L[0], 0.1);
    for (int k = 0; k < 3; ++k) {
      dvec3 e(0);
      e[k] = h;
      at(x + e, a, nullptr), at(x - e, b, nullptr);
      for (int i = 0; i < 64; ++i) EXPECT_NEAR((a[i] - b[i]) / (2 * h), G[i][k], 1e-7) << kind;
    }
  }
}

TEST(ShLobesAndPoints, directional_light_is_the_basis_against_its_travel) {
  double L[16], Y[16];
  const dvec3 d = glm::normalize(dvec3(1, 2, -3));
  directional_light(4, d, 3.0, L);
  evaluate(4, -d, Y);
  for (int i = 0; i < 16; ++i) EXPECT_DOUBLE_EQ(L[i], 3 * Y[i]);
}

TEST(ShLobesAndPoints, attenuation_batches_equal_single_ones) {
  const float x[3] = {1, 0, -2}, y[3] = {0.5f, 0, 1}, z[3] = {2, 0, 0}, r[3] = {0.1f, 0.2f, 3};
  float a[3], gx[3], gy[3], gz[3];
  inverse_square_batch(3, x, y, z, a, gx, gy, gz);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(gx[i], inverse_square(Vec3<float>(x[i], y[i], z[i])).gradient.x, 1e-6);
  yuksel_batch(3, x, y, z, r, a, gx, gy, gz);
  for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(a[i], yuksel(Vec3<float>(x[i], y[i], z[i]), r[i]).value);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(gy[i], yuksel(Vec3<float>(x[i], y[i], z[i]), r[i]).gradient.y, 1e-6);
}

}  // namespace
}  // namespace zonal::sh
