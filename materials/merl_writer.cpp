#include "materials/merl_writer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstring>

#include "core/atomic_file.h"
#include "core/error.h"
#include "materials/merl_grid.h"

namespace zonal {
namespace {

/// Cosine just above the horizon: 89.94 degrees.
constexpr double kGrazing = 1e-3;

/// theta_d, in cells, at which a cell is sampled; negative where it is wholly below the horizon.
double sampled_theta_d(int h, int d, int p) {
  const double center = d + 0.5;
  if (center < merl_horizon(h + 0.5, p + 0.5)) return center;
  // The horizon falls with theta_h and rises towards phi_d = 90 degrees: a cell reaches highest at one of two
  // corners.
  if (d >= std::max(merl_horizon(h, p), merl_horizon(h, p + 1))) return -1;
  return merl_horizon(h + 0.5, p + 0.5, kGrazing);
}

}  // namespace

MerlFunction merl_function(const Bsdf& bsdf) {
  return [bsdf](const glm::dvec3& w_out, const glm::dvec3& w_in) {
    return glm::dvec3(evaluate(bsdf, prepare(bsdf, glm::normalize(vec3(w_out))), glm::normalize(vec3(w_in))));
  };
}

std::vector<float> tabulate_merl(const MerlFunction& brdf, const std::string& what) {
  std::vector<float> cells(3 * kMerlCells);
  std::atomic<size_t> wrong{kMerlCells};  // the first cell without a value, whichever thread finds it
  tbb::parallel_for(0, kMerlThetaH * kMerlThetaD, [&](int row) {
    const int h = row / kMerlThetaD, d = row % kMerlThetaD;
    for (int p = 0; p < kMerlPhiD; ++p) {
      const size_t index = merl_index(h, d, p);
      const double theta_d = sampled_theta_d(h, d, p);
      glm::dvec3 f(-1.0);
      if (theta_d >= 0) {
        const MerlDirections w = merl_directions(h + 0.5, theta_d, p + 0.5);
        f = brdf(w.out, w.in);
        // Also false for NaN.
        const auto fine = [](double x) { return x >= 0 && x < 1e12; };
        if (!fine(f.x) || !fine(f.y) || !fine(f.z)) {
          for (size_t seen = wrong; index < seen && !wrong.compare_exchange_weak(seen, index);) {
          }
        }
      }
      for (int c = 0; c < 3; ++c) cells[3 * index + size_t(c)] = float(f[c]);
    }
  });
  if (wrong < kMerlCells) {
    const size_t index = wrong;
    const float* c = &cells[3 * index];
    throw SceneError(
        fmt::format("{}: BRDF at theta_h cell {}, theta_d cell {}, phi_d cell {}: found ({}, {}, {}), "
                    "expected numbers from 0 to 1e12",
                    what, index / (kMerlPhiD * kMerlThetaD), index / kMerlPhiD % kMerlThetaD,
                    index % kMerlPhiD, c[0], c[1], c[2]));
  }
  return cells;
}

void write_merl(const std::string& file, const MerlFunction& brdf) {
  check_can_write(file);
  const std::vector<float> cells = tabulate_merl(brdf, file);
  constexpr size_t kHeader = 3 * sizeof(int32_t);
  std::vector<char> bytes(kHeader + 3 * kMerlCells * sizeof(double));
  const int32_t dims[3] = {kMerlThetaH, kMerlThetaD, kMerlPhiD};
  std::memcpy(bytes.data(), dims, kHeader);
  for (size_t c = 0; c < 3; ++c) {
    char* plane = bytes.data() + kHeader + c * kMerlCells * sizeof(double);
    tbb::parallel_for(0, kMerlThetaH, [&](int h) {
      for (size_t i = merl_index(h, 0, 0); i < merl_index(h + 1, 0, 0); ++i) {
        // -1 below the horizon is a mark, not a reflectance: it stays as it is.
        const double value = cells[3 * i + c], stored = value < 0 ? value : value / kMerlScale[c];
        std::memcpy(plane + i * sizeof(double), &stored, sizeof stored);
      }
    });
  }
  write_atomically(file, bytes.data(), bytes.size());
}

}  // namespace zonal
