// GGX lobes, attenuation and lights without size against the golden vectors and finite differences.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "sh/disk_light.h"
#include "sh/ggx_lobe.h"
#include "sh/light_batch_hessian.h"
#include "sh/simple_light_batch.h"
#include "sh/simple_lights.h"
#include "sh/sphere_light.h"
#include "tests/paths.h"

namespace zonal::sh {
namespace {

using nlohmann::json;
using dvec3 = Vec3<double>;
constexpr double kPi = 3.14159265358979323846;

json golden(const std::string& name) {
  std::ifstream file(test::source_dir() + "/tests/golden/" + name + ".json");
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

// Sums of lanes against single lights in double at the same inputs; terms cancel, so the bar is of single
// lights times their number.
template <class T>
void expect_dirac_batches_match(double tolerance) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int n = 21;
  std::vector<T> v[12];
  for (int i = 0; i < n; ++i) {
    const dvec3 axis = glm::normalize(dvec3(uniform(random), uniform(random), uniform(random)));
    const double values[12] = {uniform(random),
                               uniform(random),
                               uniform(random),
                               1 + uniform(random),
                               1 + uniform(random),
                               0.5,
                               0.3,
                               axis.x,
                               axis.y,
                               axis.z,
                               0.9,
                               -0.8};
    for (int k = 0; k < 12; ++k) v[k].push_back(T(values[k]));
  }
  const Vec3<T> p(T(0.1), T(0.2), T(-1.3));
  v[0][3] = p.x, v[1][3] = p.y;                 // a pole
  v[0][4] = p.x, v[1][4] = p.y, v[2][4] = p.z;  // the light itself
  const DiracArrays<T> lights{
      n,           v[0].data(), v[1].data(), v[2].data(), {v[3].data(), v[4].data(), v[5].data()},
      nullptr,     v[7].data(), v[8].data(), v[9].data(), v[10].data(),
      v[11].data()};
  for (int kind = 0; kind < 4; ++kind) {
    for (const int bands : {1, 4, 12}) {
      const int size = count(bands);
      std::vector<T> sum(3 * size), value(3 * size), slope(9 * size);
      DiracArrays<T> of = lights;
      if (kind == 1) of.radius = v[6].data();
      if (kind == 3) of.x = v[7].data(), of.y = v[8].data(), of.z = v[9].data();
      const auto run = [&](T* out, T* gradient) {
        if (kind == 3) return accumulate_directional_lights(bands, of, out);
        kind == 2 ? accumulate_spot_lights(bands, p, of, out, gradient)
                  : accumulate_point_lights(bands, p, of, out, gradient);
      };
      run(value.data(), nullptr), run(sum.data(), slope.data());
      std::vector<double> truth(3 * size), turned(9 * size), L(size);
      std::vector<dvec3> G(size);
      for (int i = 0; i < n; ++i) {
        const dvec3 x(p), y(of.x[i], of.y[i], of.z[i]);
        const SpotCone<double> cone{dvec3(v[7][i], v[8][i], v[9][i]), double(v[10][i]), double(v[11][i])};
        if (kind == 0) point_light(bands, x, y, 1.0, L.data(), G.data());
        if (kind == 1) point_light_yuksel(bands, x, y, 1.0, double(v[6][i]), L.data(), G.data());
        if (kind == 2) spot_light(bands, x, y, 1.0, cone, L.data(), G.data());
        if (kind == 3) directional_light(bands, y, 1.0, L.data());
        for (int j = 0; j < size; ++j) {
          for (int c = 0; c < 3; ++c) {
            truth[c * size + j] += L[j] * double(v[3 + c][i]);
            for (int a = 0; a < 3; ++a) turned[(c * 3 + a) * size + j] += G[j][a] * double(v[3 + c][i]);
          }
        }
      }
      EXPECT_LT(worst_of_largest(sum, truth, 3 * size), n * tolerance) << kind << " " << bands;
      EXPECT_LT(worst_of_largest(value, truth, 3 * size), n * tolerance) << kind << " " << bands;
      if (kind < 3)
        EXPECT_LT(worst_of_largest(slope, turned, 9 * size), n * tolerance) << kind << " " << bands;
    }
  }
}
TEST(ShLobesAndPoints, batches_of_lights_without_size_match_single_ones) {
  expect_dirac_batches_match<float>(2e-6);
  expect_dirac_batches_match<double>(1e-14);
}

// Sums of lanes against single lights in double at the same inputs.
template <class T>
void expect_hessian_batch_matches(double tolerance) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int n = 11;
  std::vector<T> v[7];
  for (int i = 0; i < n; ++i) {
    for (auto& a : v) a.push_back(T(uniform(random)));
    v[2][i] += T(3), v[3][i] = T(0.5 + 0.4 * v[3][i]);
  }
  v[0][2] = v[1][2] = 0;  // a pole
  v[3][4] = T(9);         // inside
  const LightArrays<T> lights{n,           v[0].data(), v[1].data(),
                              v[2].data(), v[3].data(), {v[4].data(), v[5].data(), v[6].data()}};
  for (const LightShape shape : {LightShape::sphere, LightShape::disk}) {
    for (const int bands : {1, 2, 5, 11}) {
      const int size = count(bands);
      std::vector<T> sum(3 * size), gradient(9 * size), hessian(18 * size);
      const Vec3<T> x(0);
      accumulate_lights_hessian(bands, shape, x, lights, sum.data(), gradient.data(), hessian.data());
      std::vector<double> L(size), s(3 * size), g(9 * size), h(18 * size);
      std::vector<dvec3> G(size);
      std::vector<Hessian<double>> H(size);
      for (int i = 0; i < n; ++i) {
        const dvec3 y(v[0][i], v[1][i], v[2][i]);
        const double r = v[3][i];
        shape == LightShape::disk ? disk_light_hessian(bands, dvec3(0), y, r, L.data(), G.data(), H.data())
                                  : sphere_light_hessian(bands, dvec3(0), y, r, L.data(), G.data(), H.data());
        for (int c = 0; c < 3; ++c) {
          const double w = v[4 + c][i];
          for (int j = 0; j < size; ++j) {
            s[c * size + j] += w * L[j];
            for (int a = 0; a < 3; ++a) g[(c * 3 + a) * size + j] += w * G[j][a];
            const double six[6] = {H[j].xx, H[j].xy, H[j].xz, H[j].yy, H[j].yz, H[j].zz};
            for (int a = 0; a < 6; ++a) h[(c * 6 + a) * size + j] += w * six[a];
          }
        }
      }
      EXPECT_LT(worst_of_largest(sum, s, 3 * size), n * tolerance) << bands;
      EXPECT_LT(worst_of_largest(gradient, g, 9 * size), n * tolerance) << bands;
      EXPECT_LT(worst_of_largest(hessian, h, 18 * size), n * tolerance) << bands;
    }
  }
}
TEST(ShLobesAndPoints, batch_of_hessians_matches_single_lights) {
  expect_hessian_batch_matches<float>(2e-6);
  expect_hessian_batch_matches<double>(1e-13);
}

}  // namespace
}  // namespace zonal::sh
