// Zonal lights against the golden vectors, quadrature, finite differences and their limits.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "core/glsl.h"
#include "sh/disk_light.h"
#include "sh/light_batch.h"
#include "sh/light_batch_reversed.h"
#include "sh/simple_lights.h"
#include "sh/sphere_light.h"
#include "tests/paths.h"

namespace zonal::sh {
namespace {

// The shaders' text, in a namespace of its own: C++'s functions have the same names.
namespace shader {
#include "sh/attenuation.glsl"
#include "sh/sphere_light.glsl"
}  // namespace shader

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

std::vector<double> flat(const json& rows) {
  std::vector<double> v;
  for (const json& row : rows) {
    for (const json& x : row) v.push_back(x.get<double>());
  }
  return v;
}

// Coefficients: rounding of 30 recurrence steps. Derivatives: h = sqrt((d-r)(d+r)) is exact to rounding, so
// they are as good.
TEST(ShZonal, sphere_matches_golden_zonal_coefficients_and_derivatives) {
  const json cases = golden("zh_sphere")["cases"];
  ASSERT_FALSE(cases.empty());
  for (const json& c : cases) {
    double z[30], dz[30];
    sphere_light_zonal<double>(30, c["d"].get<double>(), c["r"].get<double>(), z, dz);
    EXPECT_LT(worst_of_largest(z, c["zh"].get<std::vector<double>>(), 30), 1e-13) << c["ratio"];
    EXPECT_LT(worst_of_largest(dz, c["dzh_dd"].get<std::vector<double>>(), 30), 1e-13) << c["ratio"];
  }
}

// Float: the truth is the double result at the rounded inputs (tested above against 50 digits).
TEST(ShZonal, float_sphere_is_accurate_from_contact_to_a_point) {
  for (const double ratio : {0.999, 0.99, 0.9, 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
    for (const float d : {0.013f, 1.0f, 777.7f}) {
      for (const int bands : {9, 30, 101}) {
        const float r = float(ratio * d);
        float z[101];
        double truth[101];
        sphere_light_zonal(bands, d, r, z);
        sphere_light_zonal(bands, double(d), double(r), truth);
        EXPECT_LT(worst_of_largest(z, truth, bands), 2e-6) << ratio << " " << d << " " << bands;
      }
    }
  }
}

TEST(ShZonal, sphere_and_disk_match_golden_sh_coefficients_and_gradients) {
  const json cases = golden("zh_sphere")["sh_cases"];
  ASSERT_FALSE(cases.empty());
  for (const json& c : cases) {
    const bool disk = c["kind"] == "disk";
    const dvec3 x = vec(c["x"]), y = vec(c["y"]);
    const double r = c["r"];
    double L[81];
    dvec3 G[81];
    disk ? disk_light_gradient(9, x, y, r, L, G) : sphere_light_gradient(9, x, y, r, L, G);
    EXPECT_LT(worst_of_largest(L, c["coeffs"].get<std::vector<double>>(), 81), 1e-13) << c["kind"] << r;
    EXPECT_LT(worst_of_largest(&G[0].x, flat(c["grad_x"]), 243), 1e-12) << c["kind"] << r;

    // Float, at the rounded inputs.
    const Vec3<float> xf(x), yf(y);
    float Lf[81];
    Vec3<float> Gf[81];
    disk ? disk_light_gradient(9, xf, yf, float(r), Lf, Gf)
         : sphere_light_gradient(9, xf, yf, float(r), Lf, Gf);
    disk ? disk_light_gradient(9, dvec3(xf), dvec3(yf), double(float(r)), L, G)
         : sphere_light_gradient(9, dvec3(xf), dvec3(yf), double(float(r)), L, G);
    EXPECT_LT(worst_of_largest(Lf, L, 81), 2e-6) << c["kind"] << r;
    EXPECT_LT(worst_of_largest(&Gf[0].x, &G[0].x, 243), 4e-6) << c["kind"] << r;
  }
}

// Central differences with step h: error h^2 f'''/6 + eps f/h, 1e-8 of the largest at h = 1e-5.
TEST(ShZonal, gradient_and_hessian_are_the_derivatives) {
  const int bands = 12, n = count(bands);
  const double h = 1e-5;
  for (const bool disk : {false, true}) {
    const dvec3 x(0.2, -0.4, 0.1), y(0.9, 0.5, -1.2);
    const auto at = [&](dvec3 p, std::vector<double>& L, std::vector<dvec3>& G,
                        std::vector<Hessian<double>>& H) {
      L.resize(n), G.resize(n), H.resize(n);
      disk ? disk_light_hessian(bands, p, y, 0.7, L.data(), G.data(), H.data())
           : sphere_light_hessian(bands, p, y, 0.7, L.data(), G.data(), H.data());
    };
    std::vector<double> L, a, b;
    std::vector<dvec3> G, ga, gb;
    std::vector<Hessian<double>> H, t;
    at(x, L, G, H);
    double worst_g = 0, worst_h = 0;
    for (int k = 0; k < 3; ++k) {
      dvec3 e(0);
      e[k] = h;
      at(x + e, a, ga, t), at(x - e, b, gb, t);
      for (int i = 0; i < n; ++i) {
        const dvec3 row = k == 0   ? dvec3(H[i].xx, H[i].xy, H[i].xz)
                          : k == 1 ? dvec3(H[i].xy, H[i].yy, H[i].yz)
                                   : dvec3(H[i].xz, H[i].yz, H[i].zz);
        worst_g = std::max(worst_g, std::abs((a[i] - b[i]) / (2 * h) - G[i][k]));
        worst_h = std::max(worst_h, glm::length((ga[i] - gb[i]) / (2 * h) - row));
      }
    }
    EXPECT_LT(worst_g, 1e-7);
    EXPECT_LT(worst_h, 1e-6);
  }
}

TEST(ShZonal, second_derivative_along_the_distance) {
  const double h = 1e-5;
  double z[20], a[20], b[20], d2[20];
  for (const bool disk : {false, true}) {
    const auto f = disk ? disk_light_zonal<double> : sphere_light_zonal<double>;
    double t[20];
    f(20, 1.3, 0.6, z, t, d2);
    f(20, 1.3 + h, 0.6, z, a, nullptr), f(20, 1.3 - h, 0.6, z, b, nullptr);
    for (int l = 0; l < 20; ++l) EXPECT_NEAR((a[l] - b[l]) / (2 * h), d2[l], 1e-6) << l;
  }
}

// Any cap, beyond the hemisphere too, against Simpson's rule on Eq. 3.4: error (l h)^4 z/180, 5e-10 at l
// = 15.
TEST(ShZonal, cap_of_any_half_angle_matches_quadrature) {
  for (const double a : {0.01, 0.7, kPi / 2, 2.0, 3.0, kPi}) {
    double z[16];
    cap_zonal(16, cap_from_half_angle(a), z);
    for (int l = 0; l < 16; ++l) {
      const int n = 2000;
      double sum = 0;
      for (int i = 0; i <= n; ++i) {
        const double theta = a * i / n;
        sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * std::legendre(l, std::cos(theta)) * std::sin(theta);
      }
      const double truth = 2 * kPi * std::sqrt((2 * l + 1) / (4 * kPi)) * sum * a / n / 3;
      EXPECT_NEAR(z[l], truth, 1e-9) << a << " " << l;
    }
  }
}

TEST(ShZonal, cap_by_solid_angle_is_cap_by_half_angle) {
  double a[12], b[12];
  cap_zonal(12, cap_from_half_angle(1.1), a);
  cap_zonal(12, cap_from_solid_angle(2 * kPi * (1 - std::cos(1.1))), b);
  EXPECT_LT(worst_of_largest(a, b, 12), 1e-14);
}

TEST(ShZonal, batch_equals_single) {
  const int n = 13, bands = 20;
  std::vector<float> t(n), s2(n), z(bands * n), x(n), y(n), w(n), f(count(bands) * n);
  for (int i = 0; i < n; ++i) {
    const Cap<float> cap = cap_from_half_angle(0.24f * float(i) + 0.001f);
    t[i] = cap.versine, s2[i] = cap.sine2;
    const Vec3<float> axis = glm::normalize(Vec3<float>(i - 6.0f, 0.3f * i, 5.0f - i));
    x[i] = axis.x, y[i] = axis.y, w[i] = axis.z;
  }
  cap_zonal_batch(bands, n, t.data(), s2.data(), z.data());
  rotate_zonal_batch(bands, n, z.data(), x.data(), y.data(), w.data(), f.data());
  for (int i = 0; i < n; ++i) {
    float one[20], turned[400], column[400];
    cap_zonal(bands, Cap<float>{t[i], s2[i]}, one);
    rotate_zonal(bands, one, Vec3<float>(x[i], y[i], w[i]), turned);
    for (int l = 0; l < bands; ++l) EXPECT_NEAR(one[l], z[l * n + i], 1e-5) << l << " " << i;
    for (int k = 0; k < count(bands); ++k) column[k] = f[k * n + i];
    EXPECT_LT(worst_of_largest(column, turned, count(bands)), 5e-6) << i;
  }
}

// Batches against one light at a time, in double from the same inputs; float within the bar of single lights,
// times the number of lights for sums (whose terms cancel).
template <class T>
void expect_batches_match(double tolerance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int n = 21;
  std::vector<T> x(n), y(n), z(n), r(n), rgb[3] = {std::vector<T>(n), std::vector<T>(n), std::vector<T>(n)};
  const Vec3<T> p(T(0.1), T(0.2), T(-0.3));
  for (int i = 0; i < n; ++i) {
    x[i] = T(uniform(random)), y[i] = T(uniform(random)), z[i] = T(uniform(random));
    const double d = glm::length(dvec3(x[i], y[i], z[i]) - dvec3(p));
    r[i] = T(d * (i == 0   ? 0.999
                  : i == 1 ? 2.0
                  : i == 2 ? 1e-8
                           : std::pow(10.0, -2 * std::abs(uniform(random)))));
    for (auto& c : rgb) c[i] = T(1 + uniform(random));
  }
  x[3] = p.x, y[3] = p.y;  // a pole
  const LightArrays<T> lights{n,        x.data(), y.data(),
                              z.data(), r.data(), {rgb[0].data(), rgb[1].data(), rgb[2].data()}};
  for (const int bands : {1, 3, 6, 10, 17}) {
    for (const LightShape shape : {LightShape::sphere, LightShape::disk}) {
      const int size = count(bands);
      std::vector<T> each(size * n), sum(3 * size), forward(3 * size), sum2(3 * size), gradient(9 * size);
      project_lights(bands, shape, p, lights, each.data());
      accumulate_lights(bands, shape, p, lights, sum.data());
      accumulate_lights(bands, shape, p, lights, forward.data(), LoopOrder::forward);
      accumulate_lights_gradient(bands, shape, p, lights, sum2.data(), gradient.data());
      std::vector<double> truth(3 * size), slope(9 * size), L(size), column(size);
      std::vector<dvec3> G(size);
      double scale = 0;
      for (int k = 0; k < n; ++k) {
        const dvec3 at(x[k], y[k], z[k]);
        shape == LightShape::disk
            ? disk_light_gradient(bands, dvec3(p), at, double(r[k]), L.data(), G.data())
            : sphere_light_gradient(bands, dvec3(p), at, double(r[k]), L.data(), G.data());
        for (int i = 0; i < size; ++i) {
          column[i] = each[i * n + k];
          for (int c = 0; c < 3; ++c) {
            truth[c * size + i] += L[i] * rgb[c][k];
            for (int a = 0; a < 3; ++a) slope[(c * 3 + a) * size + i] += G[i][a] * rgb[c][k];
          }
          scale = std::max(scale, glm::length(G[i]));
        }
        EXPECT_LT(worst_of_largest(column, L, size), bands > 10 ? 3 * tolerance : tolerance)
            << bands << " " << k;
      }
      EXPECT_LT(worst_of_largest(sum, truth, 3 * size), n * tolerance) << bands;
      EXPECT_LT(worst_of_largest(forward, truth, 3 * size), n * tolerance) << bands;
      EXPECT_LT(worst_of_largest(sum2, truth, 3 * size), n * tolerance) << bands;
      EXPECT_LT(worst_of_largest(gradient, slope, 9 * size), n * tolerance) << bands;
      if (bands != 6) continue;
      std::vector<T> sum3(3 * size), reversed(9 * size);
      accumulate_reversed<T, 6, true>(shape, p, lights, sum3.data(), reversed.data());
      EXPECT_LT(worst_of_largest(sum3, truth, 3 * size), n * tolerance);
      EXPECT_LT(worst_of_largest(reversed, slope, 9 * size), n * tolerance);
    }
  }
}
TEST(ShZonal, batches_of_lights_match_single_lights) {
  expect_batches_match<float>(2e-6);
  expect_batches_match<double>(1e-12);
}

// A sphere that shrinks becomes a point light of intensity pi r^2: z_l -> pi r^2/d^2 Y_l0, relative error (l
// r/d)^2.
TEST(ShZonal, small_sphere_is_a_point_light_and_small_disk_too) {
  const dvec3 x(0.1, 0.2, 0.3), y(2, -1, 1.5);
  const double r = 1e-6;
  double sphere[100], disk[100], point[100];
  sphere_light(10, x, y, r, sphere), disk_light(10, x, y, r, disk), point_light(10, x, y, kPi * r * r, point);
  EXPECT_LT(worst_of_largest(sphere, point, 100), 1e-9);
  EXPECT_LT(worst_of_largest(disk, point, 100), 1e-9);
}

TEST(ShZonal, inside_the_sphere_is_the_hemisphere_with_a_still_size) {
  const dvec3 x(0.1, 0, 0), y(0.5, 0, 0);
  double z[9], dz[9], d2z[9], hemisphere[9];
  for (const double d : {1.0, 0.5, 1e-30}) {
    sphere_light_zonal(9, d, 1.0, z, dz, d2z);
    cap_zonal(9, cap_from_half_angle(kPi / 2), hemisphere);
    for (int l = 0; l < 9; ++l) {
      EXPECT_NEAR(z[l], hemisphere[l], 1e-14);
      EXPECT_EQ(dz[l], 0);
      EXPECT_EQ(d2z[l], 0);
    }
  }
  double L[81];
  dvec3 G[81];
  Hessian<double> H[81];
  for (const dvec3 p : {x, y}) {
    sphere_light_hessian(9, p, y, 1.0, L, G, H);
    for (int i = 0; i < 81; ++i)
      EXPECT_TRUE(std::isfinite(L[i] + G[i].x + G[i].y + G[i].z + H[i].xx + H[i].yz));
  }
  EXPECT_NEAR(L[0], std::sqrt(kPi), 1e-15);
}

template <class T>
void expect_finite_at_extremes() {
  for (const double size : {1e-30, 1e-10, 1.0, 1e10, 1e30}) {
    for (const double ratio : {1e-30, 1e-8, 0.5, 1 - 1e-7, 1.0, 3.0, 1e20}) {
      const Vec3<T> x(0), y(T(0.6 * size), T(-0.64 * size), T(0.48 * size));
      const T r = T(std::min(ratio * size, 1e37));
      if (!(r > 0)) continue;
      T L[100];
      Vec3<T> G[100];
      for (const bool disk : {false, true}) {
        disk ? disk_light_gradient(10, x, y, r, L, G) : sphere_light_gradient(10, x, y, r, L, G);
        for (int i = 0; i < 100; ++i) {
          EXPECT_FALSE(std::isnan(L[i] + G[i].x + G[i].y + G[i].z)) << size << " " << ratio << " " << disk;
        }
      }
      point_light(10, x, y, T(1), L, G);
      for (int i = 0; i < 100; ++i) EXPECT_FALSE(std::isnan(L[i] + G[i].x)) << size;
    }
  }
}
TEST(ShZonal, extreme_inputs_never_give_nan) {
  expect_finite_at_extremes<float>();
  expect_finite_at_extremes<double>();
}

TEST(ShZonal, shader_kernels_equal_the_library) {
  for (const float ratio : {1e-6f, 0.01f, 0.3f, 0.9f, 1.5f}) {
    const float d = 2.5f, r = ratio * d;
    for (const bool disk : {false, true}) {
      const SeenCap<double> seen = disk ? see_disk(double(d), double(r)) : see_sphere(double(d), double(r));
      double g[20], slope[20];
      cap_gains(20, seen.cap, g, slope);
      const shader::ZonalCap cap = disk ? shader::disk_cap(d * d, r) : shader::sphere_cap(d * d, r);
      EXPECT_NEAR(cap.dt, seen.dt, 2e-6 * std::abs(seen.dt)) << ratio;
      shader::CapBand band = shader::cap_first(cap);
      for (int l = 0; l < 20; ++l) {
        if (l > 0) band = shader::cap_next(cap, band, l);
        EXPECT_NEAR(band.gain, g[l], 2e-6 * g[0]) << ratio << " " << l;
        EXPECT_NEAR(band.slope, slope[l], 2e-5) << ratio << " " << l;
      }
    }
  }
  const vec3 w(0.3f, -0.4f, 1.2f);
  vec3 gradient;
  EXPECT_FLOAT_EQ(shader::inverse_square_attenuation(w, gradient), inverse_square(w).value);
  EXPECT_NEAR(gradient.z, inverse_square(w).gradient.z, 1e-6);
  EXPECT_FLOAT_EQ(shader::yuksel_attenuation(w, 0.2f, gradient), yuksel(w, 0.2f).value);
  EXPECT_NEAR(gradient.y, yuksel(w, 0.2f).gradient.y, 1e-6);
}

// Coefficients alone, where float takes a path of its own; the truth is double at the same float inputs.
TEST(ShZonal, float_coefficients_hold_their_bar_at_any_size_and_place) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (const double ratio : {0.999, 0.9, 0.3, 1e-2, 1e-4, 1e-8}) {
    for (int k = 0; k < 200; ++k) {
      const Vec3<float> x(uniform(random), uniform(random), uniform(random));
      Vec3<float> y(uniform(random), uniform(random), uniform(random));
      if (k % 4 == 0) y.x = x.x + 1e-6f * uniform(random), y.y = x.y;  // near a pole
      const float r = float(ratio * glm::length(dvec3(y) - dvec3(x)));
      for (const int bands : {3, 6, 9, 10}) {
        float L[100];
        double truth[100];
        sphere_light(bands, x, y, r, L);
        sphere_light(bands, dvec3(x), dvec3(y), double(r), truth);
        EXPECT_LT(worst_of_largest(L, truth, count(bands)), 2e-6) << ratio << " " << bands << " " << k;
      }
    }
  }
}

}  // namespace
}  // namespace zonal::sh
