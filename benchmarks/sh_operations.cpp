// Operations on coefficients: rotation, products, clamped cosine, deringing; and the data of the thesis'
// figures 4.2 and 5.16 to 5.18 (Mézières 2022) with analytic lobes in place of its probes.
//
//     build/bench_sh_operations            times, each the median of interleaved rounds, one thread
//     build/bench_sh_operations figures    tab-separated data
//
// Times are nanoseconds a function; "batch" is 256 functions as structure of arrays.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "sh/clamped_cosine.h"
#include "sh/extremum.h"
#include "sh/least_squares.h"
#include "sh/product_table.h"
#include "sh/products.h"
#include "sh/projection.h"
#include "sh/rotation.h"
#include "sh/window.h"
#include "sh/zonal_factorization.h"

namespace zonal::sh {
namespace {

constexpr int kFunctions = 256, kRounds = 7;

struct Row {
  const char* name;
  int functions;  ///< that one call treats
  std::function<void()> call;
  std::vector<double> ns = {};
};

double run(const Row& row, long calls) {
  const auto start = std::chrono::steady_clock::now();
  for (long i = 0; i < calls; ++i) row.call();
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
  return time.count() / double(calls) / row.functions;
}

/// Medians of rounds in which the rows take turns; each row runs for about a millisecond a round.
void measure(std::vector<Row>& rows) {
  std::vector<long> calls;
  for (const Row& row : rows) {
    row.call();
    calls.push_back(std::max(1L, long(1e6 / (run(row, 1) * row.functions + 1))));
  }
  for (int round = 0; round < kRounds; ++round)
    for (size_t r = 0; r < rows.size(); ++r) rows[r].ns.push_back(run(rows[r], calls[r]));
  for (Row& row : rows) std::nth_element(row.ns.begin(), row.ns.begin() + kRounds / 2, row.ns.end());
}

void times(int bands) {
  const int size = count(bands);
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<float> a(size_t(size) * kFunctions), b(a.size()),
      out(size_t(count(2 * bands - 1)) * kFunctions);
  for (float& x : a) x = uniform(engine);
  for (float& x : b) x = uniform(engine);
  const Mat3<float> R(glm::mat3_cast(glm::normalize(glm::quat(0.3f, 0.2f, 0.5f, -0.7f))));
  const Vec3<float> normal = R[2];
  const Rotation<float> rotation(bands, R);
  const ZonalFactorization<float> factors(bands);
  const ProductTable<float> table(std::min(bands, 20), std::min(bands, 20), std::min(bands, 20));
  std::vector<Row> rows = {
      {"rotation: making the matrices", 1, [&] { (void)Rotation<float>(bands, R); }},
      {"rotation: applying them", 1, [&] { rotation.apply(a.data(), out.data()); }},
      {"rotation: applying, batch", kFunctions, [&] { rotation.apply(kFunctions, a.data(), out.data()); }},
      {"rotation: zxzxz", 1, [&] { rotate_zxzxz(bands, R, a.data(), out.data()); }},
      {"rotation: zxzxz, batch", kFunctions,
       [&] { rotate_zxzxz(bands, R, kFunctions, a.data(), out.data()); }},
      {"rotation: about z", 1, [&] { rotate_about_z(bands, 0.3f, a.data(), out.data()); }},
      {"rotation: about z, batch", kFunctions,
       [&] { rotate_about_z(bands, 0.3f, kFunctions, a.data(), out.data()); }},
      {"rotation: zonal", 1, [&] { rotate_zonal(bands, normal, a.data(), out.data()); }},
      {"rotation: zonal factorisation", 1, [&] { factors.rotate(R, a.data(), out.data()); }},
      {"product", 1, [&] { product(bands, a.data(), b.data(), out.data()); }},
      {"product, batch", kFunctions, [&] { product(bands, kFunctions, a.data(), b.data(), out.data()); }},
      {"product, full", 1, [&] { product_full(bands, a.data(), b.data(), out.data()); }},
      {"product by table", 1, [&] { table.multiply(a.data(), b.data(), out.data()); }},
      {"product by table, batch", kFunctions,
       [&] { table.multiply(kFunctions, a.data(), b.data(), out.data()); }},
      {"product by quadrature", 1,
       [&] { product_by_quadrature(bands, bands, bands, a.data(), b.data(), out.data()); }},
      {"clamped cosine", 1, [&] { clamped_cosine_product(bands, a.data(), out.data()); }},
      {"clamped cosine, batch", kFunctions,
       [&] { clamped_cosine_product(bands, kFunctions, a.data(), out.data()); }},
      {"clamped cosine in world frame", 1,
       [&] { clamped_cosine_product_in_world(bands, normal, a.data(), out.data()); }},
      {"clamped cosine, 3 bands of it (4.5)", 1,
       [&] { clamped_cosine_product_low_order(bands, 3, normal, a.data(), out.data()); }},
      {"triple product", 1, [&] { out[0] = triple_product(bands, a.data(), b.data(), a.data()); }},
  };
  measure(rows);
  const auto ns = [&](const char* name) {
    for (const Row& row : rows)
      if (std::string(row.name) == name) return row.ns[kRounds / 2];
    return 0.0;
  };
  std::printf("\n%d bands, float, ns a function\n", bands);
  for (const Row& row : rows) std::printf("%12.1f  %s\n", row.ns[kRounds / 2], row.name);
  std::printf("clamped cosine against product: %.0fx faster, in batches %.0fx\n",
              ns("product") / ns("clamped cosine"), ns("product, batch") / ns("clamped cosine, batch"));
}

void dering_times() {
  for (const int bands : {3, 5, 9, 20}) {
    std::vector<double> f(count(bands)), zonal(bands), g;
    for (int l = 0; l < bands; ++l) zonal[l] = std::sqrt((2 * l + 1) / (4 * std::numbers::pi));
    rotate_zonal(bands, glm::normalize(Vec3<double>(1, 2, 3)), zonal.data(), f.data());
    const Vec3<double> axis = glm::normalize(Vec3<double>(1, 2, 3));
    const double peak = reconstruct(bands, f.data(), axis);
    Dering found;
    const Row automatic{"", 1, [&] { g = f, found = dering(bands, g.data()); }};
    const double us = run(automatic, 3) / 1000;
    std::printf("dering a delta, %2d bands: automatic, strength %.3f, peak kept %.3f, %.0f us;", bands,
                found.strength, reconstruct(bands, g.data(), axis) / peak, us);
    g = f, found = dering(bands, Window::hann, g.data());
    std::printf(" Hann window of %.3f bands, peak kept %.3f\n", found.size,
                reconstruct(bands, g.data(), axis) / peak);
  }
}

/// A lobe exp(k (w . a - 1)) on either side, unequal.
double lobes(const Vec3<double>& w, double k) {
  static const Vec3<double> a = glm::normalize(Vec3<double>(1, 2, 3)),
                            b = glm::normalize(Vec3<double>(-2, 1, 0.5));
  return std::exp(k * (glm::dot(w, a) - 1)) + 0.5 * std::exp(k * (glm::dot(w, b) - 1));
}

struct Errors {
  double coefficients[2], values[2];  ///< root mean squares of quadrature and least squares
};

Errors projection_errors(int bands, int samples, double k) {
  const auto f = [&](const Vec3<double>& w) { return lobes(w, k); };
  const auto nodes = fibonacci_nodes<double>(samples);
  const auto fine = gauss_nodes<double>(160);
  const int size = count(bands);
  std::vector<double> exact(size), found(size), values(nodes.size());
  project_function(bands, fine, f, exact.data());
  for (int i = 0; i < nodes.size(); ++i) values[i] = f(nodes.direction(i));
  Errors errors{};
  for (int method = 0; method < 2; ++method) {
    if (method == 0)
      project_values(bands, nodes, values.data(), found.data());
    else
      LeastSquares<double>(bands, nodes, {.method = LeastSquaresOptions::Method::svd, .cutoff = 0.05})
          .solve(values.data(), found.data());
    for (int i = 0; i < size; ++i)
      errors.coefficients[method] += (found[i] - exact[i]) * (found[i] - exact[i]);
    std::vector<double> there(fine.size());
    reconstruct(bands, found.data(), fine.x.data(), fine.y.data(), fine.z.data(), fine.size(), there.data());
    for (int i = 0; i < fine.size(); ++i)
      errors.values[method] +=
          fine.weights[i] / (4 * std::numbers::pi) * std::pow(there[i] - f(fine.direction(i)), 2);
    errors.coefficients[method] = std::sqrt(errors.coefficients[method] / size);
    errors.values[method] = std::sqrt(errors.values[method]);
  }
  return errors;
}

void figures() {
  std::printf(
      "# figure 4.2: numbers multiplied, by bands\nbands\tproduct\tcosine of 3 bands\tclamped cosine\n");
  for (int n = 1; n <= 10; ++n)
    std::printf("%d\t%zu\t%zu\t%d\n", n, ProductTable<float>(n, n, n).nonzeros(),
                ProductTable<float>(n, 3, n).nonzeros(), ClampedCosine<float>(n).nonzeros());

  for (const double k : {8.0, 60.0, 2000.0}) {
    std::printf("# figure %s: lobes exp(%g (cos - 1)), 15 bands, root mean square errors by samples\n",
                k < 1000 ? "5.16 a-d" : "5.17", k);
    std::printf(
        "samples\tcoefficients, quadrature\tcoefficients, least squares\tvalues, quadrature\tvalues, least "
        "squares\n");
    for (int samples = 100; samples <= 600; samples += 50) {
      const Errors e = projection_errors(15, samples, k);
      std::printf("%d\t%.3g\t%.3g\t%.3g\t%.3g\n", samples, e.coefficients[0], e.coefficients[1], e.values[0],
                  e.values[1]);
    }
  }
  for (const double k : {8.0, 60.0})
    for (const int samples : {300, 600}) {
      std::printf("# figure 5.16 e-h: lobes exp(%g (cos - 1)), %d samples, errors of values by bands\n", k,
                  samples);
      std::printf("bands\tquadrature\tleast squares\n");
      for (int bands = 3; bands <= 20; ++bands) {
        const Errors e = projection_errors(bands, samples, k);
        std::printf("%d\t%.3g\t%.3g\n", bands, e.values[0], e.values[1]);
      }
    }
  std::printf("# figure 5.18: condition number by samples and bands\nbands");
  for (int samples = 100; samples <= 600; samples += 100) std::printf("\t%d", samples);
  for (int bands = 4; bands <= 20; bands += 2) {
    std::printf("\n%d", bands);
    for (int samples = 100; samples <= 600; samples += 100)
      std::printf("\t%.3g", LeastSquares<double>(bands, fibonacci_nodes<double>(samples),
                                                 {.method = LeastSquaresOptions::Method::iterative})
                                .condition());
  }
  std::printf("\n");
}

}  // namespace
}  // namespace zonal::sh

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "figures") {
    zonal::sh::figures();
    return 0;
  }
  for (const int bands : {3, 4, 5, 6, 9, 15, 20, 40}) zonal::sh::times(bands);
  zonal::sh::dering_times();
}
