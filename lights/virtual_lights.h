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

#include <array>
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
  uint32_t material = kNone;   ///< index into Scene::materials()
  vec3 shadow_point{0};        ///< the position moved off its surface to the lit side: where shadow rays end
  /// Square metres of surface whose light it carries: the solid angle of its cells of the map, times squared
  /// distance, over the cosine (directional: area over cosine). 0 where no map says (paths, later bounces).
  float footprint = 0;
  uint32_t grid = kNone;  ///< index into VirtualLightSet::grids; kNone: it came by a path or after a bounce
  uint32_t cell = 0;      ///< row * columns + column of that grid
  uint32_t first_texel = 0, texel_count = 0;  ///< in VirtualLightSet::texels
};

/// The map of one primary light, or one face of a point light's cube.
struct VirtualLightGrid {
  uint32_t primary = 0;  ///< index into Scene::lights()
  int columns = 0, rows = 0;
  /// Radians, the map's full width: a spot's whole outer cone, pi/2 for a cube's face, 0 for a directional
  /// light.
  float fov = 0;
  bool spot = false;         ///< the primary is a spot light
  std::vector<uint32_t> at;  ///< of each cell the index of its light, kNone where it holds none
};

struct VirtualLightOptions {
  /// grid: one ray through each cell of a grid over the light, for point, spot and directional lights (other
  /// lights, and those whose share is too small for a grid, take paths); paths: low-discrepancy light paths
  /// from every light.
  enum Distribution { grid, paths };

  /// Lights stored, all bounces together. The number of paths that leaves about as many is found by a pilot;
  /// a grid takes the nearest rectangle.
  int lights = 400;
  int bounces = 1;  ///< generations
  Distribution distribution = grid;
  uint64_t seed = 0;
  uint32_t pass = 0;

  /// A cell of a grid is a block of `block_texels` x `block_texels` texels of the map, one ray each. Its one
  /// light holds the flux of all of them and stands at one: drawn by flux (`sampled`: unbiased over the
  /// passes), or the one nearest the block's centre that meets a surface, rays through the texels' centres
  /// (`center`: the same every pass).
  int block_texels = 1;
  enum Placement { sampled, center };
  Placement placement = sampled;
  bool keep_texels = false;  ///< fill VirtualLightSet::texels
};

struct VirtualLightSet {
  std::vector<VirtualLight> lights;   ///< surfaces that reflect nothing are left out
  uint64_t rays = 0;                  ///< traced
  std::vector<std::string> warnings;  ///< one line each, for the user
  int columns = 0,
      rows = 0;  ///< of the strongest light's grid (of one cube face for a point light); 0: no grid
  std::vector<VirtualLightGrid> grids;  ///< cube faces apart
  /// With `keep_texels`: the texels of each grid light's block that meet a reflecting surface, block by
  /// block. Their powers sum to the light's.
  std::vector<VirtualLight> texels;
  /// So many of the lights at the end are not lights of their own but texels of the blocks of those before
  /// them, for methods that gather either the one or the other.
  size_t parts = 0;
  vec3 emitted_power{0};  ///< W, all primary lights together, whether or not it met a surface

  /// The lights in the eight cells around a light's own, row by row; kNone where there is none.
  std::array<uint32_t, 8> neighbours(uint32_t light) const;
};

/// Returns early, with part of the set and without warnings, when `stop` says so.
VirtualLightSet make_virtual_lights(const Scene& scene, const VirtualLightOptions& options, const Stop& stop);

}  // namespace zonal
