// The basis: batches against the memory and the arithmetic they need, and one direction with gradient against
// the methods of table 3.1 of Mézières 2022 and straight-line scalar code. One thread, float, medians of
// rounds that interleave everything.
//
//     build/bench_sh_basis
//
// "floor" is the larger of the stores (one register a cycle) and the operations (two a cycle) at the clock
// that a chain of dependent additions shows.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/sh_gradient_baselines.h"
#include "sh/batch.h"

namespace zonal {
namespace {

constexpr int kDirections = 992, kRounds = 31;

struct Directions {
  std::vector<float> x, y, z;
};

struct Case {
  std::string name;
  std::function<void()> run;
  std::vector<double> times = {};
  double median() {
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
  }
};

void measure(std::vector<Case>& cases) {
  for (int round = 0; round < kRounds; ++round) {
    for (Case& c : cases) {
      const auto begin = std::chrono::steady_clock::now();
      c.run();
      const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
      if (round > 0) c.times.push_back(spent.count() / kDirections);
    }
  }
}

void keep(const void* p) {
  asm volatile("" ::"r"(p) : "memory");
}

/// Nanoseconds a cycle, from integer additions that wait for each other.
double cycle() {
  constexpr int kTurns = 200000;
  double best = 1e9;
  for (int attempt = 0; attempt < 20; ++attempt) {
    unsigned a = 1;
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < kTurns; ++k) {
      for (int i = 0; i < 16; ++i) asm volatile("addl $1, %0" : "+r"(a));
    }
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
    best = std::min(best, spent.count() / (16.0 * kTurns));
  }
  return best;
}

double floor_of(int bands, bool gradient, double ns) {
#if defined(__AVX__)
  constexpr double lanes = 8;
#else
  constexpr double lanes = 4;
#endif
  const double pairs = bands * (bands + 1) / 2.0, functions = bands * bands;
  const double stores = functions * (gradient ? 4 : 1);
  const double operations = gradient ? 12 * pairs + 6 * functions : 4 * pairs + functions;
  return std::max(stores, operations) / 2 * ns / lanes;
}

/// Outputs of a batch, aligned and touched.
struct Aligned {
  explicit Aligned(std::size_t n)
      : data(static_cast<float*>(std::aligned_alloc(64, n * sizeof(float)))), bytes(n * 4) {
    std::memset(data, 0, bytes);
  }
  ~Aligned() { std::free(data); }
  Aligned(const Aligned&) = delete;
  Aligned& operator=(const Aligned&) = delete;
  float* data;
  std::size_t bytes;
};

template <int kBands, bool kFixed>
void batches(const Directions& d, double ns) {
  constexpr int n = kBands * kBands, K = kFixed ? kBands : 0;
  const float *x = d.x.data(), *y = d.y.data(), *z = d.z.data();
  Aligned Y(std::size_t(n) * kDirections), gx(Y.bytes / 4), gy(Y.bytes / 4), gz(Y.bytes / 4);
  std::vector<float> coefficients(n, 1.0f), sums(n), value(kDirections);
  std::vector<Case> cases;
  cases.push_back({"memset", [&] { std::memset(Y.data, 1, Y.bytes), keep(Y.data); }});
  cases.push_back({"blocked", [&] { sh::evaluate_blocked<float, K>(kBands, x, y, z, kDirections, Y.data); }});
  cases.push_back({"L1", [&] {
                     sh::evaluate_blocks<float, K>(kBands, x, y, z, kDirections,
                                                   [](int, int, const float* p) { keep(p); });
                   }});
  cases.push_back(
      {"dot", [&] { sh::reconstruct(kBands, coefficients.data(), x, y, z, kDirections, value.data()); }});
  cases.push_back({"sum", [&] { sh::project(kBands, x, y, z, x, kDirections, sums.data()); }});
  cases.push_back({"memset4", [&] {
                     for (Aligned* a : {&Y, &gx, &gy, &gz}) std::memset(a->data, 1, a->bytes), keep(a->data);
                   }});
  cases.push_back({"gradient blocked", [&] {
                     sh::evaluate_gradient_blocked<float, K>(kBands, x, y, z, kDirections, Y.data, gx.data,
                                                             gy.data, gz.data);
                   }});
  cases.push_back({"gradient L1", [&] {
                     sh::evaluate_gradient_blocks<float, K>(
                         kBands, x, y, z, kDirections,
                         [](int, int, const float* a, const float* b, const float* c, const float* e) {
                           keep(a), keep(b), keep(c), keep(e);
                         });
                   }});
  measure(cases);
  double t[8];
  for (int k = 0; k < 8; ++k) t[k] = cases[k].median();
  const double f = floor_of(kBands, false, ns), g = floor_of(kBands, true, ns);
  std::printf("%5d | %7.2f %7.2f %7.2f %7.2f %7.2f %7.2f %6.2f %6.2f | %7.2f %8.2f %7.2f %7.2f %6.2f %6.2f\n",
              kBands, t[0], t[1], t[2], t[3], t[4], f, t[1] / t[0], t[2] / f, t[5], t[6], t[7], g,
              t[6] / t[5], t[7] / g);
}

template <int N>
void one_direction(const Directions& d) {
  constexpr int n = N * N;
  std::vector<float> Y(n), gx(n), gy(n), gz(n), value(n);
  const baseline::Output o{Y.data(), gx.data(), gy.data(), gz.data()};
  auto each = [&](auto&& f) {
    return [&d, &o, f] {
      for (int k = 0; k < kDirections; ++k)
        f(d.x[k], d.y[k], d.z[k]), keep(o.Y), keep(o.x), keep(o.y), keep(o.z);
    };
  };
  std::vector<Case> cases;
  cases.push_back(
      {"polynomial", each([&](float x, float y, float z) { baseline::polynomial<N>(x, y, z, o); })});
  cases.push_back({"direct", each([&](float x, float y, float z) { baseline::direct<N>(x, y, z, o); })});
  cases.push_back(
      {"Sloan's like", each([&](float x, float y, float z) { baseline::sloan_like<N>(x, y, z, o); })});
  cases.push_back(
      {"generated", each([&](float x, float y, float z) { baseline::generated<N>(x, y, z, o); })});
  cases.push_back({"zonal", each([&](float x, float y, float z) {
                     sh::evaluate_gradient(N, sh::Vec3<float>(x, y, z), o.Y, o.x, o.y, o.z);
                   })});
  cases.push_back({"value alone",
                   each([&](float x, float y, float z) { sh::evaluate(N, sh::Vec3<float>(x, y, z), o.Y); })});
  std::vector<float> truth[4];
  double worst = 0;
  // The baselines must compute the same, or their times mean nothing.
  for (auto& t : truth) t.resize(n);
  const int k = 5;
  sh::evaluate_gradient(N, sh::Vec3<float>(d.x[k], d.y[k], d.z[k]), truth[0].data(), truth[1].data(),
                        truth[2].data(), truth[3].data());
  auto check = [&](auto&& f) {
    f(d.x[k], d.y[k], d.z[k], o);
    const float* out[4] = {o.Y, o.x, o.y, o.z};
    for (int c = 0; c < 4; ++c) {
      for (int i = 0; i < n; ++i) worst = std::max<double>(worst, std::abs(out[c][i] - truth[c][i]));
    }
  };
  check(baseline::polynomial<N>), check(baseline::direct<N>), check(baseline::sloan_like<N>),
      check(baseline::generated<N>);
  measure(cases);
  std::printf("%5d |", N);
  for (Case& c : cases) std::printf(" %10.1f", c.median());
  std::printf(" | %6.2f %6.2f | %.1e\n", cases[3].median() / cases[4].median(),
              cases[2].median() / cases[4].median(), worst);
}

}  // namespace
}  // namespace zonal

int main() {
  using namespace zonal;
  std::mt19937 generator(3);
  std::normal_distribution<float> normal;
  Directions d;
  for (int k = 0; k < kDirections; ++k) {
    const auto v = sh::normalized(sh::Vec3<float>(normal(generator), normal(generator), normal(generator)));
    d.x.push_back(v.x), d.y.push_back(v.y), d.z.push_back(v.z);
  }
  const double ns = cycle();
  std::printf("Batches of %d, ns a direction (%.2f ns a cycle)\n", kDirections, ns);
  std::printf("      | values                                                         | with gradient\n");
  std::printf(
      "bands |  memset blocked   in L1     dot     sum   floor /memset L1/floor |  memset  blocked   in L1   "
      "floor /memset L1/floor\n");
  batches<3, true>(d, ns);
  batches<5, true>(d, ns);
  batches<6, true>(d, ns);
  batches<8, true>(d, ns);
  batches<10, true>(d, ns);
  batches<15, false>(d, ns);
  batches<20, false>(d, ns);
  std::printf(
      "\nOne direction with gradient, ns (Mézières 2022, table 3.1 remade); ratios of generated and Sloan's "
      "like to ours\n");
  std::printf(
      "bands | polynomial     direct Sloan-like  generated       ours  (no grad) | gen/ours sloan/ours | "
      "worst difference\n");
  one_direction<3>(d);
  one_direction<4>(d);
  one_direction<5>(d);
  one_direction<6>(d);
  one_direction<8>(d);
  one_direction<10>(d);
}
