// From functions to coefficients: quadrature, least squares, and hemispherical harmonics.
#include "sh/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sh/checked_operations.h"
#include "sh/clamped_cosine.h"
#include "sh/hemispherical.h"
#include "sh/least_squares.h"

namespace zonal::sh {
namespace {

using Dvec = std::vector<double>;
using Method = LeastSquaresOptions::Method;
using Penalty = LeastSquaresOptions::Penalty;

template <class T>
std::vector<T> random_vector(size_t size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<T> v(size);
  for (T& x : v) x = T(uniform(engine));
  return v;
}

template <class A, class B>
double largest_difference(const A& a, const B& b) {
  double worst = a.size() == b.size() ? 0 : NAN;
  for (size_t i = 0; i < a.size(); ++i) {
    const double d = std::abs(double(a[i]) - double(b[i]));
    worst = d <= worst ? worst : d;  // a NaN becomes the worst
  }
  return worst;
}

template <class T>
std::vector<T> values_at(int bands, const std::vector<T>& f, const SphereNodes<T>& nodes) {
  std::vector<T> values(nodes.size());
  for (int k = 0; k < nodes.size(); ++k) values[k] = reconstruct(bands, f.data(), nodes.direction(k));
  return values;
}

template <class T>
void check_exact_projection(int bands, double tolerance) {
  const std::vector<T> f = random_vector<T>(count(bands), 1);
  const SphereNodes<T> nodes = gauss_nodes<T>(2 * (bands - 1));
  std::vector<T> values(nodes.size()), out(f.size());
  reconstruct(bands, f.data(), nodes.x.data(), nodes.y.data(), nodes.z.data(), nodes.size(), values.data());
  project_values(bands, nodes, values.data(), out.data());
  EXPECT_LE(largest_difference(out, f), tolerance) << bands;
}
// Each coefficient is a mean of values of size N; float directions are off by 6e-8, which l amplifies.
TEST(sh_projection, gauss_nodes_are_exact_for_band_limited_functions) {
  for (const int bands : {1, 2, 5, 10, 30, kMaxBands}) {
    check_exact_projection<double>(bands, 2e-14 * bands);
    check_exact_projection<float>(bands, 2e-6 * bands);
  }
}

TEST(sh_projection, a_degree_too_low_is_not_exact) {
  const int bands = 6;
  const Dvec f = random_vector<double>(count(bands), 2);
  const auto nodes = gauss_nodes<double>(2 * (bands - 1) - 2);
  Dvec out(f.size());
  project_values(bands, nodes, values_at(bands, f, nodes).data(), out.data());
  EXPECT_GT(largest_difference(out, f), 1e-3);
}

TEST(sh_projection, weights_are_the_whole_sphere) {
  for (const auto& nodes : {gauss_nodes<double>(17), gauss_nodes<double>(0), fibonacci_nodes<double>(1),
                            fibonacci_nodes<double>(1000)}) {
    double sum = 0;
    for (const double w : nodes.weights) sum += w;
    EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
    for (int k = 0; k < nodes.size(); ++k) EXPECT_NEAR(glm::length(nodes.direction(k)), 1, 1e-15);
  }
}

// The clamped cosine's coefficients are known; 2/3 of the energy pi... of its square is Parseval's limit.
TEST(sh_projection, projects_a_callable_to_its_closed_form) {
  const int bands = 9;
  Dvec out(count(bands)), zonal(bands);
  clamped_cosine_zonal(bands, zonal.data());
  project_function(
      bands, fibonacci_nodes<double>(30000), [](const Vec3<double>& w) { return std::max(0.0, w.z); },
      out.data());
  for (int l = 0; l < bands; ++l)
    for (int m = -l; m <= l; ++m)
      EXPECT_NEAR(out[index(l, m)], m == 0 ? zonal[l] : 0, 1e-4);  // 1/M of its kink
}

TEST(sh_projection, bands_add_up_to_the_integral_of_the_square) {
  const int bands = kMaxBands;
  Dvec zonal(bands), f(count(bands)), energy(bands);
  clamped_cosine_zonal(bands, zonal.data());
  for (int l = 0; l < bands; ++l) f[index(l, 0)] = zonal[l];
  band_energy(bands, f.data(), energy.data());
  double sum = 0;
  for (const double e : energy) sum += e;
  EXPECT_NEAR(sum, 2 * std::numbers::pi / 3,
              1e-5);  // the tail falls as l^-4: 2 pi^... of 101 bands is below 1e-6
  EXPECT_NEAR(energy[1], std::numbers::pi / 3, 1e-15);
}

TEST(sh_projection, several_functions_at_once) {
  const int bands = 7, functions = 3;
  const auto nodes = gauss_nodes<float>(2 * (bands - 1));
  const auto values = random_vector<float>(size_t(nodes.size()) * functions, 3);
  std::vector<float> all(size_t(count(bands)) * functions), one(count(bands)), energies(bands * functions),
      energy(bands);
  project_values(bands, nodes, functions, values.data(), all.data());
  band_energy(bands, functions, all.data(), energies.data());
  for (int f = 0; f < functions; ++f) {
    project_values(bands, nodes, values.data() + f * nodes.size(), one.data());
    band_energy(bands, one.data(), energy.data());
    for (int i = 0; i < count(bands); ++i) EXPECT_EQ(all[i * functions + f], one[i]);
    for (int l = 0; l < bands; ++l) EXPECT_NEAR(energies[l * functions + f], energy[l], 1e-6 * energy[l]);
  }
}

TEST(sh_least_squares, recovers_band_limited_functions_whatever_the_method) {
  for (const Method method : {Method::automatic, Method::qr, Method::svd, Method::iterative}) {
    const int bands = 12;
    const Dvec f = random_vector<double>(count(bands), 4);
    const auto nodes = fibonacci_nodes<double>(count(bands) * 3 / 2);
    Dvec out(f.size());
    LeastSquares<double>(bands, nodes, {.method = method})
        .solve(values_at(bands, f, nodes).data(), out.data());
    EXPECT_LE(largest_difference(out, f), 1e-11) << int(method);
  }
}

TEST(sh_least_squares, goes_beyond_dense_matrices) {
  const int bands = 48;
  const auto f = random_vector<float>(count(bands), 5);
  const auto nodes = fibonacci_nodes<float>(count(bands) * 2);
  std::vector<float> values(nodes.size()), out(f.size());
  reconstruct(bands, f.data(), nodes.x.data(), nodes.y.data(), nodes.z.data(), nodes.size(), values.data());
  LeastSquares<float>(bands, nodes).solve(values.data(), out.data());
  EXPECT_LE(largest_difference(out, f), 1e-4);
}

// ERRATA of the method: condition numbers on Fibonacci points at 15 bands.
TEST(sh_least_squares, condition_numbers_on_fibonacci_points) {
  const struct {
    double ratio, condition;
  } cases[] = {{1, 230}, {1.05, 13.5}, {1.2, 2.5}, {1.5, 1.35}, {2, 1.15}};
  for (const auto& c : cases) {
    const LeastSquares<double> fit(15, fibonacci_nodes<double>(int(225 * c.ratio)));
    EXPECT_NEAR(fit.condition(), c.condition, 0.06 * c.condition) << c.ratio;  // given to two digits
  }
}

// With equal weights 4 pi/M the normal equations (2.44) hold: (A^T A + lambda Gamma^2) x = A^T b.
TEST(sh_least_squares, penalties_satisfy_the_normal_equations) {
  const int bands = 6;
  const auto nodes = fibonacci_nodes<double>(80);
  const Dvec values = random_vector<double>(nodes.size(), 6);
  for (const Penalty penalty : {Penalty::tikhonov, Penalty::laplacian})
    for (const Method method : {Method::qr, Method::iterative}) {
      Dvec x(count(bands)), residual(count(bands)), misfit(nodes.size());
      LeastSquares<double>(bands, nodes, {.method = method, .penalty = penalty, .lambda = 0.01})
          .solve(values.data(), x.data());
      const Dvec fitted = values_at(bands, x, nodes);
      for (size_t k = 0; k < fitted.size(); ++k) misfit[k] = values[k] - fitted[k];
      project_values(bands, nodes, misfit.data(), residual.data());
      for (int l = 0; l < bands; ++l)
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
          const double gamma = penalty == Penalty::tikhonov ? 1 : l * (l + 1);
          EXPECT_NEAR(residual[i], 0.01 * gamma * gamma * x[i], 1e-11);
        }
    }
}

TEST(sh_least_squares, fewer_samples_than_coefficients) {
  const auto nodes = fibonacci_nodes<double>(20);
  try {
    checked::least_squares(5, nodes);
    FAIL() << "20 samples were taken for 25 coefficients";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("20 samples"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("raise the samples to 38"), std::string::npos) << e.what();
  }
  // The truncated SVD and a penalty still pass through what they are given, nearly.
  const Dvec f = random_vector<double>(9, 7), values = values_at(3, f, nodes);
  Dvec out(25);
  checked::least_squares(5, nodes, {.method = Method::svd}).solve(values.data(), out.data());
  EXPECT_LE(largest_difference(values_at(5, out, nodes), values), 1e-10);
  checked::least_squares(5, nodes, {.lambda = 1e-12}).solve(values.data(), out.data());
  EXPECT_LE(largest_difference(values_at(5, out, nodes), values), 1e-4);
}

TEST(sh_checked_operations, refuse_with_the_value_and_the_range) {
  float out[4];
  const float in[4] = {1, 2, 3, 4};
  EXPECT_THROW(checked::rotation(0, Mat3<float>(1)), std::invalid_argument);
  EXPECT_THROW(checked::rotation(102, Mat3<float>(1)), std::invalid_argument);
  EXPECT_THROW(checked::rotation(3, Mat3<float>(2)), std::invalid_argument);
  EXPECT_THROW(checked::rotation(3, Mat3<float>(-1)), std::invalid_argument);
  EXPECT_THROW(checked::rotation(3, Mat3<float>(NAN)), std::invalid_argument);
  EXPECT_THROW(checked::rotation(3, glm::quat(0, 0, 0, 0)), std::invalid_argument);
  EXPECT_THROW(checked::rotate_about_z(2, INFINITY, in, out), std::invalid_argument);
  EXPECT_THROW(checked::rotate_zonal(2, Vec3<float>(0), in, out), std::invalid_argument);
  EXPECT_THROW(checked::reconstruct(2, in, Vec3<float>(NAN, 0, 1)), std::invalid_argument);
  EXPECT_THROW(checked::fibonacci_nodes<float>(0), std::invalid_argument);
  EXPECT_THROW(checked::apply_window(2, Window::hann, -1, out), std::invalid_argument);
  EXPECT_THROW(checked::dering(2, Window::none, out), std::invalid_argument);
  EXPECT_THROW(checked::hemispherical_conversion<float>(3, 0), std::invalid_argument);
  EXPECT_THROW(checked::evaluate_hemispherical(2, Vec3<float>(0), out), std::invalid_argument);
  EXPECT_NO_THROW(checked::rotate_zonal(2, Vec3<float>(1e-30f, 0, 1e-30f), in, out));
  for (const float x : out) EXPECT_TRUE(std::isfinite(x));
}

/// Gauss nodes of the upper hemisphere after z = t^2, which makes all products of H and Y of the test smooth.
template <class Visit>
void over_hemisphere(int heights, int columns, const Visit& visit) {
  for (int j = 0; j < heights; ++j) {
    // Midpoints of a circle: Gauss-Chebyshev in t, written out here to be independent of the library's rule.
    const double a = std::numbers::pi * (j + 0.5) / heights, t = 0.5 - 0.5 * std::cos(a), z = t * t;
    double weight = 0;  // Fejer's first rule on [0, 1]
    for (int k = 1; k <= heights / 2; ++k) weight += std::cos(2 * k * a) / (4.0 * k * k - 1);
    weight = (1 - 2 * weight) / heights;
    for (int c = 0; c < columns; ++c) {
      const double phi = 2 * std::numbers::pi * c / columns, s = std::sqrt(1 - z * z);
      visit(Vec3<double>(s * std::cos(phi), s * std::sin(phi), z),
            weight * 2 * t * 2 * std::numbers::pi / columns);
    }
  }
}

TEST(sh_hemispherical, is_orthonormal_on_the_hemisphere) {
  const int bands = 9, size = count(bands);
  Dvec gram(size * size), H(size);
  over_hemisphere(60, 2 * bands, [&](const Vec3<double>& w, double weight) {
    evaluate_hemispherical(bands, w, H.data());
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) gram[i * size + j] += weight * H[i] * H[j];
  });
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) EXPECT_NEAR(gram[i * size + j], i == j, 1e-12) << i << " " << j;
}

TEST(sh_hemispherical, is_finite_at_the_pole_on_the_horizon_and_below) {
  float H[count(kMaxBands)];
  for (const Vec3<float> w :
       {Vec3<float>(0, 0, 1), Vec3<float>(1, 0, 0), Vec3<float>(1, 0, 1e-30f), Vec3<float>(0, 0, -1)}) {
    evaluate_hemispherical(kMaxBands, w, H);
    for (const float h : H) EXPECT_TRUE(std::isfinite(h));
  }
  for (const float h : H) EXPECT_EQ(h, 0);
  evaluate_hemispherical(2, Vec3<float>(0, 0, 1), H);
  EXPECT_NEAR(H[2], std::sqrt(3 / (2 * std::numbers::pi)), 1e-6);  // K_1^0 P_1(1)
}

TEST(sh_hemispherical, conversion_is_the_integral_of_both) {
  const int bands = 7, size = count(bands);
  const HemisphericalConversion<double> conversion(bands, bands);
  Dvec M(size * size), H(size), Y(size);
  over_hemisphere(80, 2 * bands, [&](const Vec3<double>& w, double weight) {
    evaluate_hemispherical(bands, w, H.data());
    evaluate(bands, w, Y.data());
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) M[i * size + j] += weight * H[i] * Y[j];
  });
  const Dvec f = random_vector<double>(size, 8);
  Dvec hsh(size), sh(size), expected_h(size), expected_y(size);
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j)
      expected_h[i] += M[i * size + j] * f[j], expected_y[j] += M[i * size + j] * f[i];
  conversion.to_hemispherical(f.data(), hsh.data());
  conversion.to_spherical(f.data(), sh.data());
  EXPECT_LE(largest_difference(hsh, expected_h), 1e-12);
  EXPECT_LE(largest_difference(sh, expected_y), 1e-12);
}

TEST(sh_hemispherical, keeps_a_polynomial_of_the_upper_hemisphere) {
  // z restricted to the hemisphere has two HSH bands; through 101 bands of SH and back it returns but for the
  // tail.
  const double h0 = std::sqrt(2 * std::numbers::pi) / 2, h1 = std::sqrt(2 * std::numbers::pi / 3) / 2;
  const HemisphericalConversion<double> conversion(2, kMaxBands);
  const Dvec hsh = {h0, 0, h1, 0};
  Dvec sh(count(kMaxBands)), back(4), zonal(kMaxBands);
  conversion.to_spherical(hsh.data(), sh.data());
  clamped_cosine_zonal(kMaxBands, zonal.data());
  for (int l = 0; l < kMaxBands; ++l) EXPECT_NEAR(sh[index(l, 0)], zonal[l], 1e-13) << l;
  conversion.to_hemispherical(sh.data(), back.data());
  EXPECT_LE(largest_difference(back, hsh), 1e-3);
}

TEST(sh_hemispherical, batches_equal_single_vectors) {
  const int functions = 5, size_h = count(6), size_y = count(9);
  const HemisphericalConversion<float> conversion(6, 9);
  const auto y = random_vector<float>(size_t(size_y) * functions, 9);
  std::vector<float> h(size_t(size_h) * functions), y2(y.size()), one_y(size_y), one_h(size_h),
      one_y2(size_y);
  conversion.to_hemispherical(functions, y.data(), h.data());
  conversion.to_spherical(functions, h.data(), y2.data());
  for (int f = 0; f < functions; ++f) {
    for (int i = 0; i < size_y; ++i) one_y[i] = y[i * functions + f];
    conversion.to_hemispherical(one_y.data(), one_h.data());
    conversion.to_spherical(one_h.data(), one_y2.data());
    for (int i = 0; i < size_h; ++i) EXPECT_NEAR(h[i * functions + f], one_h[i], 1e-6);
    for (int i = 0; i < size_y; ++i) EXPECT_NEAR(y2[i * functions + f], one_y2[i], 1e-6);
  }
}

}  // namespace
}  // namespace zonal::sh
