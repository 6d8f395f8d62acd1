#pragma once
/// Draws directions for a tabulated isotropic BRDF: a mixture of a cosine lobe and of half vectors from a
/// table.
///
///     MerlSampler sampler(brdf);                      // some milliseconds
///     vec3 w_in = sampler.sample(w_out, u_lobe, u);   // z <= 0: none found
///     float density = sampler.pdf(w_out, w_in, half_difference(w_out, w_in));
///
/// For each of 32 elevations of w_out the BRDF is split into a constant floor, which the cosine lobe draws,
/// and the rest, which is tabulated over the half vector: MERL's 90 rings of theta_h by 16 sectors of azimuth
/// around w_out, with f cos(theta_in) 4 (w_out . h), the quantity whose integral over half vectors is the
/// light reflected. Were the cells infinitely small, f cos / pdf would be the albedo everywhere.

#include <functional>
#include <vector>

#include "core/sampling.h"
#include "materials/merl_grid.h"

namespace zonal {

class MerlSampler {
 public:
  MerlSampler() = default;
  explicit MerlSampler(const std::function<vec3(vec3 w_out, vec3 w_in)>& brdf);

  vec3 sample(vec3 w_out, float u_lobe, vec2 u) const;
  /// 1/sr. `a` is that of the two directions; both are above the horizon.
  float pdf(vec3 w_out, vec3 w_in, const HalfDifference& a) const;

  static constexpr int kElevations = 32, kSectors = 16;

 private:
  struct Elevation {
    float cosine_share = 1;  ///< probability of the cosine lobe, [0.1, 1]
    Piecewise2D half;        ///< x: azimuth of h from that of w_out over 2 pi; y: ring / 90
  };
  std::vector<Elevation> elevations_;

  const Elevation& elevation(vec3 w_out) const;
};

}  // namespace zonal
