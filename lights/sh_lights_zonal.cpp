/// The zonal product (Mézières 2022, Sec. 5.2.7): each light meets a symmetric lobe in one sum over bands.

#include <algorithm>

#include "lights/sh_lights.h"
#include "sh/seen_lanes.h"
#include "sh/simple_light_batch.h"

namespace zonal {

namespace {

constexpr int kWidth = sh::lane_count<float>;
using V = sh::Lanes<float, kWidth>;

/// Sums over bands of weights[l] gain[l] P_l(c).
V legendre_sum(int bands, const float* weights, const V* gain, V c) {
  V before = c * 0 + 1.0f, p = c, sum = weights[0] * gain[0];
  if (bands > 1) sum += weights[1] * gain[1] * c;
  for (int l = 2; l < bands; ++l) {
    const V next = (float(2 * l - 1) * c * p - float(l - 1) * before) * (1.0f / float(l));
    before = p, p = next;
    sum += weights[l] * gain[l] * p;
  }
  return sum;
}

struct Sums {
  V diffuse[3]{}, specular[3]{};

  /// A block of lights in the directions (x, y, z) with gains, of these colours.
  void add(const ShZonalLobe& lobe, V x, V y, V z, const V* gain, const V* colour) {
    const V cosine = x * lobe.normal.x + y * lobe.normal.y + z * lobe.normal.z;
    const V along = x * lobe.axis.x + y * lobe.axis.y + z * lobe.axis.z;
    const V irradiance = legendre_sum(lobe.bands, lobe.cosine, gain, cosine);
    const V reflected = legendre_sum(lobe.bands, lobe.lobe, gain, along) * (cosine > 0 ? cosine : cosine * 0);
    for (int c = 0; c < 3; ++c) diffuse[c] += colour[c] * irradiance, specular[c] += colour[c] * reflected;
  }
};

}  // namespace

void ShLights::zonal(vec3 x, const ShZonalLobe& lobe, vec3* diffuse, vec3* specular) const {
  Sums sums;
  const auto colours = [](const float* const* from, int first, int filled, V* out) {
    for (int c = 0; c < 3; ++c) out[c] = sh::load_lanes<float, kWidth>(from[c] + first, filled);
  };
  const auto caps = [&](const sh::LightArrays<float>& lights) {
    for (int first = 0; first < lights.count; first += kWidth) {
      const int filled = std::min(kWidth, lights.count - first);
      const sh::SeenLanes<float, kWidth> seen(options_.shape, x, lights, first, filled);
      V gain[sh::kMaxBands], colour[3];
      seen.gains(lobe.bands, seen.x * 0 + 1.0f, gain, nullptr);
      colours(lights.radiance, first, filled, colour);
      sums.add(lobe, seen.x, seen.y, seen.z, gain, colour);
    }
  };
  const auto diracs = [&](sh::detail::DiracKind kind, const sh::DiracArrays<float>& lights) {
    for (int first = 0; first < lights.count; first += kWidth) {
      const int filled = std::min(kWidth, lights.count - first);
      const sh::detail::DiracLanes<float, kWidth> seen(kind, x, lights, first, filled);
      V gain[sh::kMaxBands], colour[3];
      std::fill_n(gain, lobe.bands, seen.weight);
      colours(lights.intensity, first, filled, colour);
      sums.add(lobe, seen.x, seen.y, seen.z, gain, colour);
    }
  };
  caps(spheres_.caps());
  if (triangles_.spheres.count() > 0) {
    std::vector<float> weighted(6 * triangles_.spheres.x.size());
    caps(facing_spheres(x, weighted.data()));
  }
  diracs(sh::detail::DiracKind::point, points_.diracs());
  diracs(sh::detail::DiracKind::spot, spots_.diracs());
  for (int c = 0; c < 3; ++c) {
    float d = 0, s = 0;
    for (int lane = 0; lane < kWidth; ++lane) d += sums.diffuse[c][lane], s += sums.specular[c][lane];
    (*diffuse)[c] = d, (*specular)[c] = s;
  }
}

void ShLights::fixed(int bands, float* L) const {
  const size_t n = sh::count(bands), stored = sh::count(options_.bands);
  for (size_t c = 0; c < 3; ++c) std::copy_n(fixed_.data() + c * stored, n, L + c * n);
}

}  // namespace zonal
