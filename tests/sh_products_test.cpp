// Products of functions given by coefficients: golden vectors, point by point, and the algorithms against
// each other.
#include "sh/products.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "core/glsl.h"
#include "sh/clamped_cosine.h"
#include "sh/convolution.h"
#include "sh/product_table.h"
#include "sh/rotation.h"
#include "tests/paths.h"

namespace zonal::sh {
namespace {

namespace kernel {
using namespace zonal;
#include "sh/basis.glsl"
// After the basis, for ShCoefficients.
#include "sh/clamped_cosine.glsl"
}  // namespace kernel

using Dvec = std::vector<double>;

nlohmann::json golden() {
  std::ifstream file(test::source_dir() + "/tests/golden/products.json");
  return nlohmann::json::parse(file);
}

template <class T>
std::vector<T> random_vector(size_t size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<T> v(size);
  for (T& x : v) x = T(uniform(engine));
  return v;
}

Vec3<double> random_direction(unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return glm::normalize(Vec3<double>(normal(engine), normal(engine), normal(engine)));
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

double value_at(int bands, const Dvec& f, const Vec3<double>& w) {
  Dvec Y(count(bands));
  evaluate(bands, w, Y.data());
  return dot(bands, f.data(), Y.data());
}

template <class T>
void check_golden(double tolerance) {
  const nlohmann::json file = golden();  // kept: a loop over a part of a temporary would outlive it
  for (const auto& c : file["cases"]) {
    const int n = c["bands"];
    const auto a = c["a"].get<std::vector<T>>(), b = c["b"].get<std::vector<T>>();
    const auto cut = c["product_truncated"].get<Dvec>(), full = c["product_full"].get<Dvec>();
    std::vector<T> out(cut.size()), all(full.size());
    product(n, a.data(), b.data(), out.data());
    EXPECT_LE(largest_difference(out, cut), tolerance) << n << " bands";
    product_full(n, a.data(), b.data(), all.data());
    EXPECT_LE(largest_difference(all, full), tolerance) << n << " bands, full";
    product_by_quadrature(n, n, n, a.data(), b.data(), out.data());
    EXPECT_LE(largest_difference(out, cut), tolerance) << n << " bands, quadrature";
    product_by_quadrature(n, n, 2 * n - 1, a.data(), b.data(), all.data());
    EXPECT_LE(largest_difference(all, full), tolerance) << n << " bands, full, quadrature";
    EXPECT_NEAR(dot(n, a.data(), b.data()), c["double_product"].get<double>(), tolerance);
    EXPECT_NEAR(2 * std::sqrt(std::numbers::pi) * out[0], c["double_product"].get<double>(),
                2 * tolerance);  // (4.4)
  }
}
// Table entries are sums of some 300 values of order 10 and keep 1e-14; a coefficient at 9 bands adds some
// 300 of them times numbers of order 0.3: sqrt(300) * 0.3 * 1e-14 = 5e-14. Twice that, the tolerance of
// docs/verify.md.
TEST(sh_products, golden_vectors_in_double) {
  check_golden<double>(1e-13);
}
TEST(sh_products, golden_vectors_in_float) {
  check_golden<float>(1e-5);
}

TEST(sh_products, golden_triple_entries_and_counts) {
  const nlohmann::json file = golden();
  const ProductTable<double> table(9, 9, 9);
  std::map<std::array<int, 3>, double> entries;
  table.for_each([&](int i, int j, int k, double value) { entries[{i, j, k}] = value; });
  for (const auto& e : file["triple_entries"]) {
    std::array<int, 3> key = {e[0], e[1], e[2]};
    if (key[0] > key[1]) std::swap(key[0], key[1]);
    EXPECT_NEAR(entries[key], e[3].get<double>(), 4e-15) << e;
  }
  for (int n = 1; n <= 9; ++n)
    EXPECT_EQ(ProductTable<float>(n, n, n).nonzeros(),
              file["triple_nonzero_count_by_bands"][n - 1].get<size_t>());
}

// What is dropped as zero must be far below what is kept.
TEST(sh_products, no_entry_lies_near_the_threshold_of_zero) {
  double smallest = 1;
  const ProductTable<double> table(20, 20, 20);
  table.for_each([&](int, int, int, double value) { smallest = std::min(smallest, std::abs(value)); });
  EXPECT_GE(smallest, 1e-7);
}

TEST(sh_products, full_product_is_the_pointwise_product_from_table_and_quadrature) {
  for (const int bands : {1, 2, 7, 8, 9, 20, 51, kMaxBands}) {
    const int all = 2 * bands - 1;
    const Dvec a = random_vector<double>(count(bands), 1), b = random_vector<double>(count(bands), 2);
    Dvec out(count(all));
    product_full(bands, a.data(), b.data(), out.data());
    if (all > kMaxBands) {  // too many bands to evaluate: the integral, and the first bands, must do
      Dvec cut(count(bands));
      product(bands, a.data(), b.data(), cut.data());
      out.resize(cut.size());
      EXPECT_LE(largest_difference(out, cut), 1e-11 * bands) << bands;
      EXPECT_NEAR(out[0] * 2 * std::sqrt(std::numbers::pi), dot(bands, a.data(), b.data()), 1e-10);
      continue;
    }
    for (int i = 0; i < 5; ++i) {
      const Vec3<double> w = random_direction(i);
      const double expected = value_at(bands, a, w) * value_at(bands, b, w);
      EXPECT_NEAR(value_at(all, out, w), expected, 1e-13 * count(bands)) << bands;
    }
  }
}

TEST(sh_products, table_and_quadrature_agree_for_unequal_bands) {
  const Dvec a = random_vector<double>(count(12), 3), b = random_vector<double>(count(3), 4);
  Dvec table(count(12)), quadrature(count(12));
  product(12, 3, 12, a.data(), b.data(), table.data());
  product_by_quadrature(12, 3, 12, a.data(), b.data(), quadrature.data());
  EXPECT_LE(largest_difference(table, quadrature), 2e-14);
  Dvec wide(count(20), 7.0);  // bands that the product does not reach are zero
  product(3, 3, 20, b.data(), b.data(), wide.data());
  for (int i = count(5); i < count(20); ++i) EXPECT_EQ(wide[i], 0);
}

TEST(sh_products, tables_of_20_bands_agree_with_quadrature) {
  const Dvec a = random_vector<double>(count(20), 1), b = random_vector<double>(count(20), 2);
  Dvec table(count(39)), quadrature(count(39));
  ProductTable<double>(20, 20, 39).multiply(a.data(), b.data(), table.data());
  product_by_quadrature(20, 20, 39, a.data(), b.data(), quadrature.data());
  EXPECT_LE(largest_difference(table, quadrature), 1e-12);
}

TEST(sh_products, float_holds_at_101_bands) {
  const auto a = random_vector<float>(count(kMaxBands), 5), b = random_vector<float>(count(kMaxBands), 6);
  const Dvec da(a.begin(), a.end()), db(b.begin(), b.end());
  std::vector<float> out(a.size());
  Dvec exact(a.size());
  product(kMaxBands, a.data(), b.data(), out.data());
  product(kMaxBands, da.data(), db.data(), exact.data());
  double largest = 0;
  for (const double x : exact) largest = std::max(largest, std::abs(x));
  EXPECT_LE(largest_difference(out, exact), 5e-6 * largest);
}

TEST(sh_products, triple_product_integrates_three) {
  for (const int bands : {3, 9, 30}) {
    const Dvec a = random_vector<double>(count(bands), 7), b = random_vector<double>(count(bands), 8),
               c = random_vector<double>(count(bands), 9);
    const double* all[] = {a.data(), b.data(), c.data()};
    double whole[1];
    product_of_many(bands, 3, all, 1, whole);
    EXPECT_NEAR(triple_product(bands, a.data(), b.data(), c.data()),
                whole[0] * 2 * std::sqrt(std::numbers::pi), 1e-11);
  }
}

TEST(sh_products, many_functions_multiply_point_by_point) {
  const int bands = 4, M = 5, all = M * (bands - 1) + 1;
  Dvec f[M];
  const double* pointers[M];
  for (int i = 0; i < M; ++i) f[i] = random_vector<double>(count(bands), 20 + i), pointers[i] = f[i].data();
  Dvec out(count(all));
  product_of_many(bands, M, pointers, all, out.data());
  const Vec3<double> w = random_direction(30);
  double expected = 1;
  for (int i = 0; i < M; ++i) expected *= value_at(bands, f[i], w);
  EXPECT_NEAR(value_at(all, out, w), expected, 1e-12);

  // Of two functions, the truncated product is the product.
  Dvec two(count(bands)), cut(count(bands));
  product_of_many_truncated(bands, 2, pointers, two.data());
  product(bands, f[0].data(), f[1].data(), cut.data());
  EXPECT_LE(largest_difference(two, cut), 1e-15);
}

TEST(sh_products, transfer_matrix_multiplies) {
  for (const int bands : {6, 22}) {
    const Dvec f = random_vector<double>(count(bands), 40), g = random_vector<double>(count(bands), 41);
    Dvec matrix(count(bands) * count(bands)), out(count(bands)), expected(count(bands));
    transfer_matrix(bands, f.data(), matrix.data());
    apply_transfer_matrix(bands, matrix.data(), g.data(), out.data());
    product(bands, f.data(), g.data(), expected.data());
    EXPECT_LE(largest_difference(out, expected), 1e-12);
  }
  // Straight from a function: z^2 is 1/3 of Y_0^0 and 2/3 of P_2.
  const int bands = 5;
  Dvec matrix(count(bands) * count(bands)), out(count(bands)), expected(count(bands)),
      g = random_vector<double>(25, 42);
  transfer_matrix<double>(
      bands, 2, [](const Vec3<double>& w) { return w.z * w.z; }, matrix.data());
  apply_transfer_matrix(bands, matrix.data(), g.data(), out.data());
  Dvec square(count(bands));
  square[0] = 2 * std::sqrt(std::numbers::pi) / 3,
  square[index(2, 0)] = 4.0 / 3 * std::sqrt(std::numbers::pi / 5);
  product(bands, g.data(), square.data(), expected.data());
  EXPECT_LE(largest_difference(out, expected), 1e-14);
}

TEST(sh_products, golden_clamped_cosine_matrix) {
  const nlohmann::json file = golden();
  const ClampedCosine<double> matrix(9);
  for (const auto& row : file["clamped_cosine"]) {
    const int l1 = row[0], l2 = row[1], m = row[2];
    EXPECT_NEAR(matrix.element(l1, l2, m), row[3].get<double>(), 1e-15) << row;
    EXPECT_NEAR(matrix.element(l2, l1, -m), row[3].get<double>(), 1e-15) << row;
  }
  for (int n = 1; n <= 9; ++n)
    EXPECT_EQ(ClampedCosine<float>(n).nonzeros(),
              file["clamped_cosine_nonzero_count_by_bands"][n - 1].get<int>());
  EXPECT_EQ(ClampedCosine<double>(9).nonzeros(), 377);
}

/// f max(0, z) integrated against Y_i: midpoints in z, exact in azimuth.
Dvec cosine_product_by_midpoints(int bands, const Dvec& f) {
  constexpr int kFine = 4000;
  const int columns = 2 * bands;
  Dvec out(count(bands)), Y(count(bands));
  for (int j = 0; j < kFine; ++j) {
    const double z = (j + 0.5) / kFine, s = std::sqrt(1 - z * z);
    for (int k = 0; k < columns; ++k) {
      const double phi = 2 * std::numbers::pi * k / columns;
      evaluate(bands, Vec3<double>(s * std::cos(phi), s * std::sin(phi), z), Y.data());
      const double value =
          dot(bands, f.data(), Y.data()) * z * 2 * std::numbers::pi / (columns * double(kFine));
      for (int i = 0; i < count(bands); ++i) out[i] += value * Y[i];
    }
  }
  return out;
}

TEST(sh_products, clamped_cosine_product_is_the_integral) {
  const int bands = 6;
  const Dvec f = random_vector<double>(count(bands), 50), expected = cosine_product_by_midpoints(bands, f);
  Dvec out(count(bands));
  clamped_cosine_product(bands, f.data(), out.data());
  EXPECT_LE(largest_difference(out, expected), 1e-5);  // midpoints: l^2 / (24 * 4000^2) of values near 10
}

TEST(sh_products, clamped_cosine_of_one_is_its_projection) {
  Dvec one(count(kMaxBands)), out(count(kMaxBands)), zonal(kMaxBands);
  one[0] = 2 * std::sqrt(std::numbers::pi);
  clamped_cosine_product(kMaxBands, one.data(), out.data());
  clamped_cosine_zonal(kMaxBands, zonal.data());
  for (int l = 0; l < kMaxBands; ++l) {
    EXPECT_NEAR(out[index(l, 0)], zonal[l], 1e-14) << l;
    for (int m = 1; m <= l; ++m) EXPECT_EQ(out[index(l, m)], 0);
  }
}

TEST(sh_products, clamped_cosine_in_world_turns_with_the_normal) {
  const int bands = 9;
  const Dvec f = random_vector<double>(count(bands), 51);
  for (const Vec3<double>& n :
       {random_direction(52), Vec3<double>(0, 0, 1), Vec3<double>(0, 0, -1), Vec3<double>(1, 0, 0)}) {
    const Rotation<double> R = Rotation<double>::from_z_to(bands, n);
    Dvec local(f.size()), product(f.size()), expected(f.size()), out(f.size());
    R.apply_inverse(f.data(), local.data());
    clamped_cosine_product(bands, local.data(), product.data());
    R.apply(product.data(), expected.data());
    clamped_cosine_product_in_world(bands, n, f.data(), out.data());
    EXPECT_LE(largest_difference(out, expected), 1e-13);

    // Eq. 4.5 with as many bands of the cosine as can matter (2N-1) is exact too.
    clamped_cosine_product_low_order(bands, 2 * bands - 1, n, f.data(), out.data());
    EXPECT_LE(largest_difference(out, expected), 1e-13);
    // With 3 bands its irradiance is the one of Ramamoorthi and Hanrahan, for f of 3 bands exactly the same.
    Dvec low(f.begin(), f.begin() + 9), a(9), b(9);
    clamped_cosine_product_low_order(3, 3, n, low.data(), a.data());
    clamped_cosine_product_in_world(3, n, low.data(), b.data());
    EXPECT_NEAR(a[0], b[0], 1e-14);
  }
}

TEST(sh_products, shader_kernel_of_the_clamped_cosine_is_the_same_at_every_size) {
  for (int bands = 1; bands <= 10; ++bands) {
    const std::vector<float> f = random_vector<float>(count(bands), 53);
    std::vector<float> expected(f.size());
    clamped_cosine_product(bands, f.data(), expected.data());
    kernel::ShCoefficients light{}, product;
    std::copy(f.begin(), f.end(), light.c);
    kernel::sh_clamped_cosine_product(bands, light, product);
    for (int l = 0; l < bands; ++l)
      for (int m = -l; m <= l; ++m) {
        float sum = 0;
        for (int l2 = std::abs(m); l2 < bands; ++l2)
          sum += kernel::sh_clamped_cosine(l, l2, std::abs(m)) * f[index(l2, m)];
        EXPECT_NEAR(sum, expected[index(l, m)], 1e-6) << bands << " " << l << " " << m;
        EXPECT_NEAR(product.c[index(l, m)], sum, 1e-6);
      }
  }
}

TEST(sh_products, convolution_with_the_cosine_is_irradiance) {
  const int bands = 9;
  const Dvec f = random_vector<double>(count(bands), 54);
  Dvec zonal(bands), irradiance(f.size()), weighted(f.size());
  clamped_cosine_zonal(bands, zonal.data());
  convolve(bands, zonal.data(), f.data(), irradiance.data());
  for (unsigned i = 0; i < 4; ++i) {
    const Vec3<double> n = random_direction(60 + i);
    clamped_cosine_product_in_world(bands, n, f.data(), weighted.data());
    EXPECT_NEAR(value_at(bands, irradiance, n), 2 * std::sqrt(std::numbers::pi) * weighted[0],
                1e-13);  // (4.4)
  }
}

template <class T>
void check_batches(int bands, double tolerance) {
  const int functions = 37, size = count(bands), full = count(2 * bands - 1);
  const auto a = random_vector<T>(size_t(size) * functions, 70),
             b = random_vector<T>(size_t(size) * functions, 71);
  std::vector<T> cut(a.size()), all(size_t(full) * functions), cosine(a.size()), dots(functions),
      triples(functions), smooth(a.size()), matrix(size_t(size) * size), moved(a.size());
  const auto zonal = random_vector<T>(bands, 72), f0 = random_vector<T>(size, 73);
  transfer_matrix(bands, f0.data(), matrix.data());
  product(bands, functions, a.data(), b.data(), cut.data());
  product_full(bands, functions, a.data(), b.data(), all.data());
  clamped_cosine_product(bands, functions, a.data(), cosine.data());
  dot(bands, functions, a.data(), b.data(), dots.data());
  triple_product(bands, functions, a.data(), b.data(), a.data(), triples.data());
  convolve(bands, functions, zonal.data(), a.data(), smooth.data());
  apply_transfer_matrix(bands, functions, matrix.data(), a.data(), moved.data());
  for (int f = 0; f < functions; ++f) {
    std::vector<T> one(size), two(size), out(full);
    for (int i = 0; i < size; ++i)
      one[i] = a[size_t(i) * functions + f], two[i] = b[size_t(i) * functions + f];
    const auto same = [&](int n, const std::vector<T>& batch, const char* what) {
      for (int i = 0; i < n; ++i) ASSERT_NEAR(batch[size_t(i) * functions + f], out[i], tolerance) << what;
    };
    product(bands, one.data(), two.data(), out.data()), same(size, cut, "product");
    product_full(bands, one.data(), two.data(), out.data()), same(full, all, "full");
    clamped_cosine_product(bands, one.data(), out.data()), same(size, cosine, "cosine");
    convolve(bands, zonal.data(), one.data(), out.data()), same(size, smooth, "convolution");
    apply_transfer_matrix(bands, matrix.data(), one.data(), out.data()), same(size, moved, "transfer");
    EXPECT_NEAR(dots[f], dot(bands, one.data(), two.data()), tolerance);
    EXPECT_NEAR(triples[f], triple_product(bands, one.data(), two.data(), one.data()), 10 * tolerance);
  }
}
TEST(sh_products, batches_equal_single_vectors) {
  check_batches<double>(9, 1e-13);
  check_batches<float>(9, 3e-5);
  check_batches<double>(21, 1e-11);
}

}  // namespace
}  // namespace zonal::sh
