#pragma once
/// The virtual point lights that vpl, vsl, hvl and vsgl all start from: where the light of the primary lights
/// lands (Keller 1997, "Instant Radiosity"; Dachsbacher and Stamminger 2005, "Reflective Shadow Maps").
///
///     VirtualLightSet set = make_virtual_lights(scene, {.lights = 400, .seed = pass.seed, .pass = 0}, stop);
///     // A light at y, seen from x along the unit vector w (from y to x, distance d), brings to a surface at
///     x
///     //   radiance = power * f_y(w_in, w) * max(0, dot(normal, w)) * f_x * cos_x / d^2 (VL-1)
///
/// Summed over a set, (VL-1) estimates the light of 1 to `bounces` reflections without bias, whatever the
/// number of lights; the mean over passes converges. Same scene, options and seed: same set, on any number of
/// threads.

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene.h"
#include "core/stop.h"

namespace zonal {

struct VirtualLight {
  vec3 position{0};
  vec3 normal{0, 0,
              1};  ///< geometric, unit, on the lit side: the cosine of (VL-1), and where shadow rays start
  Frame frame;     ///< shading frame, on the same side: the directions of `bsdf` are in it
  vec3 w_in{0, 0, 1};  ///< unit, world, towards where the flux came from
  /// Incident flux, W. Where the shading normal n_s departs from the geometric n_g it holds the factor
  /// dot(n_s, w_in)/dot(n_g, w_in), which makes light paths and camera paths agree (Veach 1997, section 5.3).
  vec3 power{0};
  Bsdf bsdf;
  uint32_t bounce = 1;         ///< 1: lit by a primary light
  uint32_t primary = 0;        ///< index into Scene::lights() of the light the path began at
  float primary_distance = 0;  ///< metres from where it began to the path's first surface
};

struct VirtualLightOptions {
  /// grid: one ray through each cell of a grid over the light, for point, spot and directional lights (other
  /// lights, and those whose share is too small for a grid, take paths); paths: low-discrepancy light paths
  /// from every light.
  enum Distribution { grid, paths };

  /// Lights stored, all bounces together. The number of paths that leaves about as many is found by a pilot; a grid
  /// takes the nearest rectangle.
  int lights = 400;
  int bounces = 1;  ///< generations
  Distribution distribution = grid;
  uint64_t seed = 0;
  uint32_t pass = 0;
};

struct VirtualLightSet {
  std::vector<VirtualLight> lights;   ///< surfaces that reflect nothing are left out
  uint64_t rays = 0;                  ///< traced
  std::vector<std::string> warnings;  ///< one line each, for the user
  int columns = 0,
      rows = 0;           ///< of the strongest light's grid (of one cube face for a point light); 0: no grid
  vec3 emitted_power{0};  ///< W, all primary lights together, whether or not it met a surface
};

/// Returns early, with part of the set and without warnings, when `stop` says so.
VirtualLightSet make_virtual_lights(const Scene& scene, const VirtualLightOptions& options, const Stop& stop);

}  // namespace zonal
