/// The basis against golden vectors, quadrature, the addition theorem, finite differences and its own other
/// forms.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "core/glsl.h"
#include "sh/batch.h"
#include "tests/paths.h"

namespace zonal {
#include "sh/basis.glsl"

namespace {

using sh::Vec3;
using Json = nlohmann::json;

Json golden(const char* name) {
  std::ifstream in((test::source_dir() + "/tests/golden/") + name);
  return Json::parse(in)["cases"];
}

template <class T>
Vec3<T> vector(const Json& d) {
  return {T(d[0].get<double>()), T(d[1].get<double>()), T(d[2].get<double>())};
}

template <class T>
struct Basis {
  std::vector<T> Y;
  std::vector<Vec3<T>> gradient;
  std::vector<sh::Hessian<T>> hessian;
  Basis(int bands, const Vec3<T>& v) : Y(bands * bands), gradient(bands * bands), hessian(bands * bands) {
    sh::evaluate_hessian(bands, v, Y.data(), gradient.data(), hessian.data());
  }
};

/// Directions everywhere, half of them near the poles by powers of ten down to 1e-6, the first at the poles
/// and axes.
std::vector<Vec3<double>> directions(int n) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform;
  std::vector<Vec3<double>> d = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  while (int(d.size()) < n) {
    double theta =
        d.size() % 2 ? std::acos(2 * uniform(generator) - 1) : std::pow(10.0, -6 * uniform(generator));
    if (d.size() % 4 < 2) theta = std::numbers::pi - theta;
    const double phi = 2 * std::numbers::pi * uniform(generator);
    d.push_back({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
  }
  return d;
}

TEST(sh_basis, double_matches_golden) {
  std::vector<double> Y(sh::count(101));
  for (const Json& c : golden("sh_basis.json")) {
    sh::evaluate(101, vector<double>(c["d"]), Y.data());
    // A few roundings a band: 2e-15 is found at 21 bands and 1.5e-14 at 101.
    for (int i = 0; i < 441; ++i) ASSERT_NEAR(Y[i], c["Y"][i].get<double>(), 1e-14) << c["tag"] << " i " << i;
    for (const Json& h : c["high"]) {
      ASSERT_NEAR(Y[sh::index(h[0], h[1])], h[2].get<double>(), 1e-13) << c["tag"] << h;
    }
  }
}

TEST(sh_basis, float_matches_double_at_the_rounded_direction) {
  std::vector<float> Y(sh::count(101));
  std::vector<double> truth(Y.size());
  for (const Vec3<double>& d : directions(400)) {
    const Vec3<float> rounded(d);
    sh::evaluate(101, rounded, Y.data());
    sh::evaluate(101, Vec3<double>(rounded), truth.data());
    // Y reaches 1.8 at 20 bands: 20 roundings of 2^-24 of it. At 101 the power (x+iy)^m alone makes m
    // roundings, and Y at m = l reaches 1.3: 200 of 2^-24 of it. (The bars are 3e-6 and 3e-4.)
    for (int i = 0; i < sh::count(101); ++i) {
      ASSERT_NEAR(Y[i], truth[i], i < 400 ? 2e-6 : 2e-5) << i << " at " << d.x << " " << d.y << " " << d.z;
    }
  }
}

TEST(sh_basis, gradient_matches_golden) {
  for (const Json& c : golden("sh_gradient.json")) {
    const auto v = vector<double>(c["d"]);
    const Basis<double> basis(11, v);
    const Vec3<float> rounded(v);
    const Basis<float> single(11, rounded);
    const Basis<double> truth(11, Vec3<double>(rounded));
    const double length = glm::length(v);
    // Gradients reach 80 at l = 10: a few roundings of that. The float truth is recomputed at the rounded
    // direction.
    for (int i = 0; i < 121; ++i) {
      for (int k = 0; k < 3; ++k) {
        ASSERT_NEAR(basis.gradient[i][k] * length, c["grad"][i][k].get<double>() * length, 3e-14)
            << c["tag"] << i;
        ASSERT_NEAR(single.gradient[i][k] * length, truth.gradient[i][k] * length, 3e-5) << c["tag"] << i;
      }
    }
  }
}

TEST(sh_basis, hessian_matches_differences_of_the_gradient) {
  constexpr int kBands = 12;
  for (Vec3<double> v : directions(60)) {
    v = v * 1.3;
    const Basis<double> at(kBands, v);
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-5;
      Vec3<double> step(0);
      step[k] = h;
      const Basis<double> above(kBands, v + step), below(kBands, v - step);
      for (int i = 0; i < kBands * kBands; ++i) {
        const auto& H = at.hessian[i];
        const Vec3<double> row[3] = {{H.xx, H.xy, H.xz}, {H.xy, H.yy, H.yz}, {H.xz, H.yz, H.zz}};
        const Vec3<double> difference = (above.gradient[i] - below.gradient[i]) / (2 * h);
        // Central differences: h^2/6 of a fourth derivative of order l^4 of the Hessian's l^2, h^2 l^2.
        ASSERT_LT(glm::length(difference - row[k]), 2e-7 * (1 + glm::length(row[k]))) << i << " " << k;
      }
    }
  }
}

TEST(sh_basis, hessian_has_the_eigenvalue_of_the_laplacian_and_euler_directions) {
  for (const Vec3<double>& d : directions(80)) {
    const double length = 0.25;
    const Basis<double> basis(101, d * length);
    for (int l = 0; l < 101; ++l) {
      for (int m = -l; m <= l; ++m) {
        const int i = sh::index(l, m);
        const auto& H = basis.hessian[i];
        const double scale = 1e-13 * (1 + l * l) * (1 + l);
        ASSERT_NEAR((H.xx + H.yy + H.zz) * length * length, -l * (l + 1.0) * basis.Y[i], scale)
            << l << " " << m;
        // Y(v/|v|) is homogeneous of degree 0, its gradient of degree -1.
        ASSERT_NEAR(glm::dot(basis.gradient[i], d) * length, 0, scale);
        const Vec3<double> Hd(H.xx * d.x + H.xy * d.y + H.xz * d.z, H.xy * d.x + H.yy * d.y + H.yz * d.z,
                              H.xz * d.x + H.yz * d.y + H.zz * d.z);
        ASSERT_LT(glm::length(Hd * length + basis.gradient[i]) * length, scale);
      }
    }
  }
}

TEST(sh_basis, derivatives_at_the_poles_are_their_limits) {
  for (const double z : {1.0, -1.0}) {
    const Basis<float> pole(20, {0, 0, float(z)});
    const Basis<double> near(20, {1e-9, -1e-9, z});
    for (int i = 0; i < 400; ++i) {
      EXPECT_NEAR(pole.Y[i], near.Y[i], 2e-6);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(pole.gradient[i][k], near.gradient[i][k], 3e-5);
      EXPECT_NEAR(pole.hessian[i].xx, near.hessian[i].xx, 1e-3);  // reaches 1e4
      EXPECT_NEAR(pole.hessian[i].xy, near.hessian[i].xy, 1e-3);
      EXPECT_NEAR(pole.hessian[i].xz, near.hessian[i].xz, 1e-3);
    }
  }
}

TEST(sh_basis, is_orthonormal) {
  // Gauss-Legendre x uniform: 12 nodes are exact to degree 23, products reach 18. Nodes by Newton.
  constexpr int kBands = 10, kNodes = 12, kPhi = 24;
  std::vector<double> gram(sh::count(kBands) * sh::count(kBands)), Y(sh::count(kBands));
  for (int a = 0; a < kNodes; ++a) {
    double z = std::cos(std::numbers::pi * (a + 0.75) / (kNodes + 0.5)), slope = 0;
    for (int it = 0; it < 20; ++it) {
      double p0 = 1, p1 = z;
      for (int l = 2; l <= kNodes; ++l) {
        const double p = ((2 * l - 1) * z * p1 - (l - 1) * p0) / l;
        p0 = p1, p1 = p;
      }
      slope = kNodes * (z * p1 - p0) / (z * z - 1);
      z -= p1 / slope;
    }
    const double weight = 2 / ((1 - z * z) * slope * slope) * 2 * std::numbers::pi / kPhi,
                 r = std::sqrt(1 - z * z);
    for (int b = 0; b < kPhi; ++b) {
      const double phi = 2 * std::numbers::pi * (b + 0.25) / kPhi;
      sh::evaluate(kBands, Vec3<double>(r * std::cos(phi), r * std::sin(phi), z), Y.data());
      for (int i = 0; i < 100; ++i) {
        for (int j = 0; j < 100; ++j) gram[i * 100 + j] += weight * Y[i] * Y[j];
      }
    }
  }
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) ASSERT_NEAR(gram[i * 100 + j], i == j, 2e-14) << i << " " << j;
  }
}

TEST(sh_basis, addition_theorem) {
  const auto d = directions(12);
  std::vector<double> a(sh::count(101)), b(a.size());
  for (std::size_t k = 1; k < d.size(); ++k) {
    sh::evaluate(101, d[k - 1], a.data());
    sh::evaluate(101, d[k], b.data());
    const double x = glm::dot(d[k - 1], d[k]);
    double p0 = 0, p1 = 1;
    for (int l = 0; l < 101; ++l) {
      double sum = 0;
      for (int m = -l; m <= l; ++m) sum += a[sh::index(l, m)] * b[sh::index(l, m)];
      // The reference's own recurrence loses up to l^2 roundings.
      ASSERT_NEAR(sum * 4 * std::numbers::pi / (2 * l + 1), p1, 1e-15 * (10 + l * l)) << l;
      const double p = ((2 * l + 1) * x * p1 - l * p0) / (l + 1);
      p0 = p1, p1 = p;
    }
  }
}

/// evaluate and evaluate_gradient run over rows, evaluate_hessian over columns: two codes for the same
/// numbers.
template <class T>
void gradient_forms_agree(double tolerance) {
  for (const int bands : {1, 2, 3, 4, 5, 7, 8, 9, 10, 15, 16, 17, 20, 40, 101}) {
    const int n = sh::count(bands);
    for (const Vec3<double>& d : directions(14)) {
      const Vec3<T> v(d * 3.0);
      const Basis<T> basis(bands, v);
      // One number more, to see writes beyond the end.
      std::vector<T> Y(n + 1, T(7)), values(n + 1, T(7)), g[3];
      for (auto& component : g) component.assign(n + 1, T(7));
      std::vector<Vec3<T>> gradient(n + 1, Vec3<T>(7));
      sh::evaluate(bands, sh::normalized(v), values.data());
      sh::evaluate_gradient(bands, v, Y.data(), g[0].data(), g[1].data(), g[2].data());
      sh::evaluate_gradient(bands, v, Y.data(), gradient.data());
      for (int i = 0; i < n; ++i) {
        ASSERT_NEAR(values[i], basis.Y[i], tolerance * (bands + 10)) << bands << " " << i;
        ASSERT_NEAR(Y[i], basis.Y[i], tolerance * (bands + 10)) << bands << " " << i;
        for (int k = 0; k < 3; ++k) {
          ASSERT_NEAR(g[k][i], basis.gradient[i][k], tolerance * bands * (bands + 10)) << bands << " " << i;
          ASSERT_EQ(g[k][i], gradient[i][k]);
        }
      }
      ASSERT_EQ(values[n], 7);
      ASSERT_EQ(Y[n], 7);
      for (int k = 0; k < 3; ++k) ASSERT_EQ(g[k][n], 7);
      ASSERT_EQ(gradient[n].x, 7);
    }
  }
}

TEST(sh_basis, gradient_forms_agree_in_float) {
  gradient_forms_agree<float>(1.2e-7);
}
TEST(sh_basis, gradient_forms_agree_in_double) {
  gradient_forms_agree<double>(2.3e-16);
}

TEST(sh_basis, extreme_vectors_give_numbers) {
  for (const float size : {1e-45f, 1e-38f, 1e-30f, 1e-10f, 1e10f, 1e30f, 3.4e38f}) {
    for (const Vec3<float> v :
         {Vec3<float>(0, 0, size), Vec3<float>(size, -size, size), Vec3<float>(1e-45f, 0, -size)}) {
      const Vec3<float> unit = sh::normalized(v);
      EXPECT_NEAR(glm::length(unit), 1, 2e-7) << size;
      const Basis<float> basis(101, v);
      for (int i = 0; i < sh::count(101); ++i) {
        ASSERT_TRUE(std::isfinite(basis.Y[i]));
        const auto& H = basis.hessian[i];
        for (int k = 0; k < 3; ++k) ASSERT_FALSE(std::isnan(basis.gradient[i][k])) << size << " " << i;
        for (float h : {H.xx, H.xy, H.xz, H.yy, H.yz, H.zz}) ASSERT_FALSE(std::isnan(h)) << size << " " << i;
      }
    }
  }
}

TEST(sh_batch, extreme_vectors_give_numbers) {
  const float size[] = {1e-45f, 1e-38f, 1e-30f, 1, 1e30f, 3.4e38f};
  std::vector<float> Y(6 * 25), x(Y), y(Y), z(Y);
  sh::evaluate_gradient_batch(5, size, size, size, 6, Y.data(), x.data(), y.data(), z.data(), 6);
  for (int i = 0; i < 25 * 6; ++i) {
    ASSERT_NEAR(Y[i], Y[i / 6 * 6 + 3], 1e-6) << i;
    ASSERT_FALSE(std::isnan(x[i]) || std::isnan(y[i]) || std::isnan(z[i])) << i;
  }
}

template <class T>
void batch_equals_single(int bands, int number) {
  std::vector<T> x, y, z;
  for (const auto& d : directions(number)) x.push_back(T(d.x)), y.push_back(T(d.y)), z.push_back(T(d.z));
  const int n = sh::count(bands);
  std::vector<std::vector<T>> out(10, std::vector<T>(n * number));
  T* const g[3] = {out[1].data(), out[2].data(), out[3].data()};
  T* const h[6] = {out[4].data(), out[5].data(), out[6].data(), out[7].data(), out[8].data(), out[9].data()};
  const T eps = std::numeric_limits<T>::epsilon() * (bands + 10);
  const double l = bands;  // Y grows as sqrt(l), each derivative by l at most
  auto compare = [&](const Basis<T>& one, int k, bool gradient, bool hessian) {
    for (int i = 0; i < n; ++i) {
      auto near = [&](int row, T expected, double scale) {
        ASSERT_NEAR(out[row][i * number + k], expected, scale * eps)
            << "bands " << bands << " row " << row << " i " << i;
      };
      near(0, one.Y[i], 1);
      for (int c = 0; gradient && c < 3; ++c) near(1 + c, one.gradient[i][c], l);
      const auto& H = one.hessian[i];
      const T entries[6] = {H.xx, H.xy, H.xz, H.yy, H.yz, H.zz};
      for (int c = 0; hessian && c < 6; ++c) near(4 + c, entries[c], l * l);
    }
  };
  sh::evaluate_batch(bands, x.data(), y.data(), z.data(), number, out[0].data(), number);
  for (int k = 0; k < number; ++k) compare(Basis<T>(bands, {x[k], y[k], z[k]}), k, false, false);
  sh::evaluate_gradient_batch(bands, x.data(), y.data(), z.data(), number, out[0].data(), g[0], g[1], g[2],
                              number);
  for (int k = 0; k < number; ++k) compare(Basis<T>(bands, {x[k], y[k], z[k]}), k, true, false);
  sh::evaluate_hessian_batch(bands, x.data(), y.data(), z.data(), number, out[0].data(), g, h, number);
  for (int k = 0; k < number; ++k) compare(Basis<T>(bands, {x[k], y[k], z[k]}), k, true, true);

  // The fused forms against sums of the stored values.
  std::vector<T> coefficients(n), value(number), sums(n, T(0));
  for (int i = 0; i < n; ++i) coefficients[i] = T(std::sin(i + 1.0));
  sh::reconstruct(bands, coefficients.data(), x.data(), y.data(), z.data(), number, value.data());
  sh::project(bands, x.data(), y.data(), z.data(), x.data(), number, sums.data());
  std::vector<double> expected(n);
  for (int k = 0; k < number; ++k) {
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double Y = out[0][i * number + k];
      sum += coefficients[i] * Y;
      expected[i] += x[k] * Y;
    }
    ASSERT_NEAR(value[k], sum, eps * bands * 10) << bands;
  }
  for (int i = 0; i < n; ++i) ASSERT_NEAR(sums[i], expected[i], eps * number) << bands;
}

TEST(sh_batch, equals_single_directions) {
  for (const int bands : {1, 2, 3, 5, 10, 11, 20, 101}) {
    batch_equals_single<float>(bands, 37);
    batch_equals_single<double>(bands, 19);
  }
}

TEST(sh_batch, blocks_and_unrolled_loops_equal_rows) {
  constexpr int kNumber = 40, kBands = 6, n = kBands * kBands, kW = sh::kLanes<float>;
  std::vector<float> x, y, z, rows(n * kNumber), g[3];
  for (const auto& d : directions(kNumber))
    x.push_back(float(d.x)), y.push_back(float(d.y)), z.push_back(float(d.z));
  for (auto& c : g) c.resize(rows.size());
  sh::evaluate_gradient_batch(kBands, x.data(), y.data(), z.data(), kNumber, rows.data(), g[0].data(),
                              g[1].data(), g[2].data(), kNumber);
  std::vector<float> blocked(sh::blocks<float>(kNumber) * n * kW);
  sh::evaluate_blocked<float, kBands>(kBands, x.data(), y.data(), z.data(), kNumber, blocked.data());
  int seen = 0;
  sh::evaluate_gradient_blocks<float, kBands>(
      kBands, x.data(), y.data(), z.data(), kNumber,
      [&](int first, int lanes, const float* Y, const float* gx, const float* gy, const float* gz) {
        for (int k = 0; k < lanes; ++k, ++seen) {
          for (int i = 0; i < n; ++i) {
            const int row = i * kNumber + first + k;
            ASSERT_NEAR(Y[i * kW + k], rows[row], 1e-6);
            ASSERT_NEAR(blocked[(first / kW * n + i) * kW + k], rows[row], 1e-6);
            ASSERT_NEAR(gx[i * kW + k], g[0][row], 1e-5);
            ASSERT_NEAR(gy[i * kW + k], g[1][row], 1e-5);
            ASSERT_NEAR(gz[i * kW + k], g[2][row], 1e-5);
          }
        }
      });
  EXPECT_EQ(seen, kNumber);
}

TEST(sh_glsl, equals_the_basis) {
  for (const Vec3<double>& v : directions(200)) {
    const Vec3<float> d(v);
    ShCoefficients Y, plain;
    ShGradient g;
    sh_evaluate_gradient(10, d, Y, g);
    sh_evaluate(10, d, plain);
    const Basis<double> basis(10, Vec3<double>(sh::normalized(Vec3<double>(d))));
    double sum = 0;
    for (int i = 0; i < 100; ++i) {
      ASSERT_NEAR(plain.c[i], basis.Y[i], 2e-6);
      ASSERT_NEAR(Y.c[i], basis.Y[i], 2e-6);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(g.g[i][k], basis.gradient[i][k], 4e-5) << i << " " << k;
      sum += basis.Y[i] * basis.Y[i];
    }
    ASSERT_NEAR(sh_dot(10, Y, plain), sum, 3e-5);  // 100/4pi
  }
}

}  // namespace
}  // namespace zonal
