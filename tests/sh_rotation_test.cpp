// Rotation of coefficients: golden vectors, the definition g(R^T w), composition, and the algorithms against
// each other.
#include "sh/rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "core/glsl.h"
#include "sh/zonal_factorization.h"
#include "tests/paths.h"

namespace zonal::sh {
namespace {

namespace kernel {
using namespace zonal;
#include "sh/rotation.glsl"
}  // namespace kernel

using Dvec = std::vector<double>;

nlohmann::json golden(const char* name) {
  std::ifstream file((test::source_dir() + "/tests/golden/") + name);
  return nlohmann::json::parse(file);
}

template <class T>
std::vector<T> random_vector(int size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<T> v(size);
  for (T& x : v) x = T(uniform(engine));
  return v;
}

template <class T>
double largest_difference(const std::vector<T>& a, const std::vector<T>& b) {
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double d = std::abs(double(a[i]) - double(b[i]));
    worst = d <= worst ? worst : d;  // a NaN becomes the worst
  }
  return worst;
}

Mat3<double> random_rotation(unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const glm::dquat q =
      glm::normalize(glm::dquat(normal(engine), normal(engine), normal(engine), normal(engine)));
  return glm::mat3_cast(q);
}

Mat3<double> about_z(double a) {
  return {{std::cos(a), std::sin(a), 0}, {-std::sin(a), std::cos(a), 0}, {0, 0, 1}};
}
Mat3<double> half_turn_x() {
  return {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
}

template <class T>
std::vector<T> rotated(int bands, const Mat3<T>& R, const std::vector<T>& g) {
  std::vector<T> out(g.size());
  Rotation<T>(bands, R).apply(g.data(), out.data());
  return out;
}

template <class T>
void check_golden(double tolerance) {
  const nlohmann::json file = golden("rotation.json");
  const int bands = file["bands"];
  for (const auto& c : file["cases"]) {
    const auto coeffs = c["coeffs"].get<std::vector<T>>();
    const auto expected = c["rotated"].get<std::vector<T>>();
    const auto q = c["quat_wxyz"].get<std::vector<T>>();
    const glm::qua<T> quaternion(q[0], q[1], q[2], q[3]);
    std::vector<T> out(coeffs.size());
    const Rotation<T> rotation(bands, quaternion);
    rotation.apply(coeffs.data(), out.data());
    EXPECT_LE(largest_difference(out, expected), tolerance) << c["tag"];

    Mat3<T> R;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) R[j][i] = c["R"][i][j].template get<T>();
    rotate_zxzxz(bands, R, coeffs.data(), out.data());
    EXPECT_LE(largest_difference(out, expected), tolerance) << "zxzxz " << c["tag"];

    ZonalFactorization<T>(bands).rotate(R, coeffs.data(), out.data());
    EXPECT_LE(largest_difference(out, expected), 4 * tolerance) << "factorisation " << c["tag"];

    const auto a = c["zonal_axis"].get<std::vector<T>>();
    const std::vector<T> ones(bands, T(1));
    rotate_zonal(bands, Vec3<T>(a[0], a[1], a[2]), ones.data(), out.data());
    EXPECT_LE(largest_difference(out, c["zonal_rotated_of_unit"].get<std::vector<T>>()), tolerance)
        << c["tag"];
  }
}

// Coefficients are of order 1, and a row of the matrix adds 19 of them: a few tens of epsilon. In float the
// input R is itself rounded by 6e-8, which band l = 9 amplifies by l.
TEST(sh_rotation, golden_vectors_in_double) {
  check_golden<double>(2e-14);
}
TEST(sh_rotation, golden_vectors_in_float) {
  check_golden<float>(4e-6);
}

// g_hat(w) = g(R^T w), the definition, at 101 bands. Values are sums of 10201 products of order 1, about 100
// in size.
TEST(sh_rotation, rotating_the_coefficients_rotates_the_function) {
  const int bands = kMaxBands;
  const Mat3<double> R = random_rotation(1);
  const Dvec g = random_vector<double>(count(bands), 2), h = rotated(bands, R, g);
  Dvec Y(count(bands));
  for (int i = 0; i < 20; ++i) {
    const Dvec d = random_vector<double>(3, 100 + i);
    const Vec3<double> w = glm::normalize(Vec3<double>(d[0], d[1], d[2]));
    double expected = 0, found = 0;
    evaluate(bands, glm::transpose(R) * w, Y.data());
    for (size_t k = 0; k < g.size(); ++k) expected += g[k] * Y[k];
    evaluate(bands, w, Y.data());
    for (size_t k = 0; k < g.size(); ++k) found += h[k] * Y[k];
    EXPECT_NEAR(found, expected, 1e-10);
  }
}

// The error bound of each algorithm at every size: a drift of the recurrences would show at 101 bands.
TEST(sh_rotation, algorithms_agree_up_to_101_bands) {
  for (const int bands : {1, 2, 3, 6, 7, 12, 13, 25, 50, kMaxBands}) {
    for (const Mat3<double>& R :
         {random_rotation(bands), Mat3<double>(1), half_turn_x(), about_z(0.3), about_z(0.3) * half_turn_x(),
          Mat3<double>(glm::dmat3({0, 1, 0}, {0, 0, 1}, {1, 0, 0}))}) {
      const Dvec g = random_vector<double>(count(bands), 5), exact = rotated(bands, R, g);
      Dvec other(g.size());
      rotate_zxzxz(bands, R, g.data(), other.data());
      EXPECT_LE(largest_difference(exact, other), 4e-14 * bands) << bands;
    }
  }
}

TEST(sh_rotation, matrices_are_orthogonal_and_their_inverse_is_the_transpose) {
  const Rotation<double> rotation(kMaxBands, random_rotation(3));
  const Dvec g = random_vector<double>(count(kMaxBands), 4);
  Dvec turned(g.size()), back(g.size());
  rotation.apply(g.data(), turned.data());
  rotation.apply_inverse(turned.data(), back.data());
  EXPECT_LE(largest_difference(g, back), 1e-12);
}

TEST(sh_rotation, composition_follows_the_matrices) {
  const int bands = 40;
  const Mat3<double> A = random_rotation(7), B = random_rotation(8);
  const Dvec g = random_vector<double>(count(bands), 9);
  EXPECT_LE(largest_difference(rotated(bands, A, rotated(bands, B, g)), rotated(bands, A * B, g)), 1e-12);
}

TEST(sh_rotation, about_z_is_the_general_rotation_in_place_or_not) {
  const int bands = 30;
  for (const double angle : {0.0, 1e-9, 0.3, 3.14159265358979, -2.0, 100.0}) {
    const Dvec g = random_vector<double>(count(bands), 10);
    Dvec out(g.size()), in_place = g;
    rotate_about_z(bands, angle, g.data(), out.data());
    rotate_about_z(bands, angle, in_place.data(), in_place.data());
    EXPECT_EQ(out, in_place);
    EXPECT_LE(largest_difference(out, rotated(bands, about_z(angle), g)), 1e-12) << angle;
  }
}

TEST(sh_rotation, the_shader_kernel_about_z_is_the_same) {
  const int bands = 10;
  const std::vector<float> g = random_vector<float>(count(bands), 11);
  std::vector<float> expected(g.size()), found = g;
  rotate_about_z(bands, 0.7f, g.data(), expected.data());
  vec2 multiple(1, 0);
  for (int m = 1; m < bands; ++m) {
    multiple = kernel::sh_next_multiple(multiple, std::cos(0.7f), std::sin(0.7f));
    for (int l = m; l < bands; ++l) kernel::sh_rotate_pair(multiple, found[index(l, m)], found[index(l, -m)]);
  }
  EXPECT_LE(largest_difference(expected, found), 2e-6);  // 9 products, each within 1.2e-7
}

TEST(sh_rotation, z_goes_to_the_axis_from_every_side) {
  const int bands = 12;
  Dvec zonal = random_vector<double>(bands, 12), g(count(bands)), expected(count(bands)), found(count(bands));
  for (int l = 0; l < bands; ++l) g[index(l, 0)] = zonal[l];
  for (const Vec3<double> v :
       {Vec3<double>(0, 0, 1), Vec3<double>(0, 0, -1), Vec3<double>(1e-9, 0, -1),
        Vec3<double>(1e-200, 1e-200, -1), Vec3<double>(1, 2, 3), Vec3<double>(0, 1, 0)}) {
    const Vec3<double> axis = glm::normalize(v);
    rotate_zonal(bands, axis, zonal.data(), expected.data());
    Rotation<double>::from_z_to(bands, axis).apply(g.data(), found.data());
    EXPECT_LE(largest_difference(expected, found), 1e-13) << v.x << " " << v.y << " " << v.z;
  }
}

TEST(sh_rotation, quaternions_of_any_length_will_do) {
  const Rotation<float> tiny(5, glm::quat(1e-30f, 2e-30f, -1e-30f, 3e-30f)),
      large(5, glm::quat(1e30f, 2e30f, -1e30f, 3e30f));
  for (int m = -4; m <= 4; ++m)
    for (int n = -4; n <= 4; ++n) EXPECT_NEAR(tiny.element(4, m, n), large.element(4, m, n), 1e-6);
}

/// Every batch form against the single form, at a number of functions that is no multiple of anything.
template <class T>
void check_batches(double tolerance) {
  const int bands = 20, functions = 45;
  const Mat3<T> R(random_rotation(13));
  const std::vector<T> g = random_vector<T>(count(bands) * functions, 14);
  std::vector<T> one(count(bands)), expected(one.size());
  const Rotation<T> rotation(bands, R);
  const ZonalFactorization<T> factors(bands);
  std::vector<T> out[5];
  for (auto& o : out) o.resize(g.size());
  rotation.apply(functions, g.data(), out[0].data());
  rotation.apply_inverse(functions, g.data(), out[1].data());
  rotate_about_z(bands, T(0.4), functions, g.data(), out[2].data());
  rotate_zxzxz(bands, R, functions, g.data(), out[3].data());
  factors.rotate(R, functions, g.data(), out[4].data());
  for (int f = 0; f < functions; ++f) {
    for (int i = 0; i < count(bands); ++i) one[i] = g[i * functions + f];
    for (int k = 0; k < 5; ++k) {
      if (k == 0) rotation.apply(one.data(), expected.data());
      if (k == 1) rotation.apply_inverse(one.data(), expected.data());
      if (k == 2) rotate_about_z(bands, T(0.4), one.data(), expected.data());
      if (k == 3) rotate_zxzxz(bands, R, one.data(), expected.data());
      if (k == 4) factors.rotate(R, one.data(), expected.data());
      for (int i = 0; i < count(bands); ++i)
        ASSERT_NEAR(out[k][i * functions + f], expected[i], tolerance) << "form " << k << ", function " << f;
    }
  }
}
TEST(sh_rotation, batches_equal_single_vectors) {
  check_batches<double>(1e-13);
  check_batches<float>(1e-4);
}

// Float matrices are made in double, so only the application rounds: sqrt(201) sums of eps/2 times 1.
TEST(sh_rotation, float_keeps_its_digits_at_101_bands) {
  const Mat3<float> R(random_rotation(15));
  const std::vector<float> g = random_vector<float>(count(kMaxBands), 16);
  const Dvec exact = rotated(kMaxBands, orthonormalized(R), Dvec(g.begin(), g.end()));
  const std::vector<float> found = rotated(kMaxBands, R, g);
  EXPECT_LE(largest_difference(exact, Dvec(found.begin(), found.end())), 5e-6);
  std::vector<float> other(g.size());
  rotate_zxzxz(kMaxBands, R, g.data(), other.data());
  EXPECT_LE(largest_difference(exact, Dvec(other.begin(), other.end())), 1e-5);
}

}  // namespace
}  // namespace zonal::sh
