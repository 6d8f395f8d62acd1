#include "materials/merl.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "materials/microfacet.h"

namespace zonal {
namespace {

static_assert(std::endian::native == std::endian::little,
              "MERL files are little-endian, and are read as they lie");

constexpr const char* kColours[3] = {"red", "green", "blue"};
/// A lobe that fits into MERL's first ring, 0.01 degrees, reaches 1e7 / sr. What is far above is a damaged
/// file.
constexpr double kLargest = 1e12;

/// Three floats and whatever follows them.
using Float4 = float __attribute__((vector_size(16)));
inline Float4 load4(const float* p) {
  Float4 v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

bool above_horizon(vec3 w) {
  return w.z > kMinCosine;
}

/// Cell below a sample position and the weight of the one above it. NaN becomes 0.
struct Neighbours {
  int low;
  float weight;
};
inline Neighbours clamped(float cells, int count) {
  const float c = cells - 0.5f;
  const float inside = c > 0.0f ? std::fmin(c, float(count - 1)) : 0.0f;
  const int low = std::min(int(inside), count - 2);
  return {low, inside - float(low)};
}
inline Neighbours periodic(float cells, int count) {
  float c = cells - 0.5f;
  if (c < 0.0f) c += float(count);
  if (!(c >= 0.0f && c < float(count))) c = 0.0f;
  const int low = int(c);
  return {low, c - float(low)};
}

}  // namespace

MerlBrdf::MerlBrdf(std::vector<float> cells) : cells_(std::move(cells)) {
  cells_.resize(3 * kMerlCells + 1);
  repair();
  sampler_ = MerlSampler([this](vec3 w_out, vec3 w_in) { return evaluate(w_out, w_in); });
  estimate_albedo();

  // Directional albedo by the sampler itself, whose weights vary little.
  constexpr uint32_t kSamples = 512;
  for (uint32_t e = 0; e < MerlSampler::kElevations; ++e) {
    const float theta = (float(e) + 0.5f) / MerlSampler::kElevations * 0.5f * kPi;
    const vec3 w_out(std::sin(theta), 0, std::cos(theta));
    vec3 sum(0.0f);
    for (uint32_t i = 0; i < kSamples; ++i) {
      Sampler sampler(0, e, i);
      const float u_lobe = sampler.next_1d();
      const vec3 w_in = sample_direction(w_out, u_lobe, sampler.next_2d());
      if (!above_horizon(w_in)) continue;
      vec3 f;
      float density;
      evaluate_with_pdf(w_out, w_in, &f, &density);
      if (density > 0.0f) sum += f * (w_in.z / density);
    }
    sum /= float(kSamples);
    if (max_component(sum) > max_component(largest_albedo)) {
      largest_albedo = sum, largest_albedo_degrees = theta * 180.0f / kPi;
    }
  }
  if (negative_samples > 0) {
    notes.push_back(
        fmt::format("{} of {} samples are negative and read as 0", negative_samples, 3 * kMerlCells));
  }
  // What the estimate errs by is not worth a note.
  if (max_component(largest_albedo) > 1.01f) {
    notes.push_back(
        fmt::format("reflects {:.2f} of the light from {:.0f} degrees: more than arrives, and kept as it is",
                    max_component(largest_albedo), largest_albedo_degrees));
  }
}

void MerlBrdf::repair() {
  for (int h = 0; h < kMerlThetaH; ++h) {
    for (int p = 0; p < kMerlPhiD; ++p) {
      const double horizon = merl_horizon(h + 0.5, p + 0.5);
      for (int d = 0; d < kMerlThetaD; ++d) {
        float* c = &cells_[3 * merl_index(h, d, p)];
        // Nothing was measured below the horizon, but interpolation near it reads those cells: they continue
        // what lies above them in theta_d. theta_d = 0 is above the horizon for every half vector.
        if (d + 0.5 > horizon && d > 0 && c[0] <= 0 && c[1] <= 0 && c[2] <= 0) {
          std::copy_n(&cells_[3 * merl_index(h, d - 1, p)], 3, c);
          ++cells_below_horizon;
          continue;
        }
        for (int i = 0; i < 3; ++i) {
          if (c[i] < 0) c[i] = 0, ++negative_samples;
        }
      }
    }
  }
}

vec3 MerlBrdf::interpolate(MerlPoint point) const {
  const Neighbours h = clamped(point.h, kMerlThetaH), d = clamped(point.d, kMerlThetaD);
  const Neighbours p = periodic(point.p, kMerlPhiD);
  const ptrdiff_t next_h = 3 * ptrdiff_t(kMerlThetaD) * kMerlPhiD, next_d = 3 * ptrdiff_t(kMerlPhiD);
  const ptrdiff_t next_p = p.low + 1 < kMerlPhiD ? 3 : -3 * ptrdiff_t(kMerlPhiD - 1);
  const float* c = &cells_[3 * merl_index(h.low, d.low, p.low)];

  // a + w (b - a) could fall below zero by rounding; the weighted sum of non-negative numbers cannot.
  const auto along_p = [&](const float* q) {
    return load4(q) * (1.0f - p.weight) + load4(q + next_p) * p.weight;
  };
  const auto along_d = [&](const float* q) {
    return along_p(q) * (1.0f - d.weight) + along_p(q + next_d) * d.weight;
  };
  const Float4 f = along_d(c) * (1.0f - h.weight) + along_d(c + next_h) * h.weight;
  return {f[0], f[1], f[2]};
}

vec3 MerlBrdf::evaluate(vec3 w_out, vec3 w_in) const {
  if (!above_horizon(w_out) || !above_horizon(w_in)) return vec3(0.0f);
  return interpolate(merl_point(half_difference(w_out, w_in)));
}

void MerlBrdf::evaluate_many(vec3 w_out, int n, const vec3* w_in, vec3* f) const {
  // Angles for a block at a time, in a loop without branches that vectorises; then the look-ups.
  constexpr int kBlock = 64;
  float h[kBlock], d[kBlock], p[kBlock];
  for (int first = 0; first < n; first += kBlock) {
    const int count = std::min(kBlock, n - first);
    const vec3* w = w_in + first;
    for (int i = 0; i < count; ++i) {
      const MerlPoint point = merl_point(half_difference(w_out, w[i]));
      h[i] = point.h, d[i] = point.d, p[i] = point.p;
    }
    for (int i = 0; i < count; ++i) {
      const bool visible = above_horizon(w_out) && above_horizon(w[i]);
      f[first + i] = visible ? interpolate({h[i], d[i], p[i]}) : vec3(0.0f);
    }
  }
}

void MerlBrdf::evaluate_with_pdf(vec3 w_out, vec3 w_in, vec3* f, float* density) const {
  *f = vec3(0.0f), *density = 0.0f;
  if (!above_horizon(w_out) || !above_horizon(w_in)) return;
  const HalfDifference a = half_difference(w_out, w_in);
  *f = interpolate(merl_point(a));
  *density = sampler_.pdf(w_out, w_in, a);
}

vec3 MerlBrdf::sample_direction(vec3 w_out, float u_lobe, vec2 u) const {
  return above_horizon(w_out) ? sampler_.sample(w_out, u_lobe, u) : vec3(0.0f);
}

float MerlBrdf::pdf(vec3 w_out, vec3 w_in) const {
  if (!above_horizon(w_out) || !above_horizon(w_in)) return 0.0f;
  return sampler_.pdf(w_out, w_in, half_difference(w_out, w_in));
}

vec3 MerlBrdf::nearest(vec3 w_out, vec3 w_in) const {
  if (!above_horizon(w_out) || !above_horizon(w_in)) return vec3(0.0f);
  const MerlPoint point = merl_point(half_difference(w_out, w_in));
  return cell(std::min(int(point.h), kMerlThetaH - 1), std::min(int(point.d), kMerlThetaD - 1),
              int(point.p) % kMerlPhiD);
}

vec3 MerlBrdf::cell(int h, int d, int p) const {
  const float* c = &cells_[3 * merl_index(h, d, p)];
  return {c[0], c[1], c[2]};
}

std::unique_ptr<MeasuredBrdf> load_merl(const std::string& file) {
  constexpr uintmax_t kHeader = 12, kSize = kHeader + 3 * kMerlCells * sizeof(double);
  const auto fail = [&](const std::string& what) { throw SceneError(file + ": " + what); };
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(file, error);
  if (!regular && std::filesystem::exists(file, error)) fail("not a file");
  std::ifstream in(file, std::ios::binary);
  if (!in) fail("cannot be opened");
  const uintmax_t size = std::filesystem::file_size(file, error);

  int32_t dims[3] = {};
  if (error || size < kHeader || !in.read(reinterpret_cast<char*>(dims), kHeader)) {
    fail(
        fmt::format("dimensions: the file has {} bytes, expected {} (a MERL file)", error ? 0 : size, kSize));
  }
  if (dims[0] != kMerlThetaH || dims[1] != kMerlThetaD || dims[2] != kMerlPhiD) {
    fail(fmt::format(
        "dimensions: found {} x {} x {}, expected {} x {} x {} (theta_h, theta_d, phi_d of a MERL file)",
        dims[0], dims[1], dims[2], kMerlThetaH, kMerlThetaD, kMerlPhiD));
  }
  if (size != kSize) {
    fail(fmt::format("size: found {} bytes, expected {} ({})", size, kSize,
                     size < kSize ? "truncated" : "too long"));
  }

  std::vector<float> cells(3 * kMerlCells);
  std::vector<double> row(size_t(kMerlThetaD) * kMerlPhiD);
  for (int c = 0; c < 3; ++c) {
    for (int h = 0; h < kMerlThetaH; ++h) {
      if (!in.read(reinterpret_cast<char*>(row.data()), std::streamsize(row.size() * sizeof(double)))) {
        fail(fmt::format("samples: cannot be read beyond {}, theta_h {}", kColours[c], h));
      }
      float* cell = &cells[3 * merl_index(h, 0, 0) + size_t(c)];
      for (size_t i = 0; i < row.size(); ++i) {
        const double value = row[i] * kMerlScale[size_t(c)];
        if (!(std::abs(value) < kLargest)) {
          fail(fmt::format(
              "sample {}, theta_h {}, theta_d {}, phi_d {}: found {}, expected a finite number below {:g}",
              kColours[c], h, i / kMerlPhiD, i % kMerlPhiD, row[i], kLargest / kMerlScale[size_t(c)]));
        }
        cell[3 * i] = float(value);
      }
    }
  }
  auto brdf = std::make_unique<MerlBrdf>(std::move(cells));
  brdf->file = file;
  return brdf;
}

}  // namespace zonal
