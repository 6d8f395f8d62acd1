#pragma once
/// A lighting method: two virtual functions. Pixels, threads, passes and clocks live in core/render.
///
///     struct Flat : Integrator {
///       void shade(const Tile& tile, vec3* radiance, Sampler*, const Stop&, TileStats&) const override {
///         for (int i = 0; i < tile.count; ++i) radiance[i] = tile.found(i) ? vec3(1) : vec3(0);
///       }
///     };

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "core/sampling.h"
#include "core/scene.h"
#include "core/stop.h"

namespace zonal {

inline constexpr int kTilePixels = 64;

/// Up to 8x8 pixels whose primary rays have been traced.
struct Tile {
  int count = 0;
  std::array<ivec2, kTilePixels> pixels;
  std::array<vec3, kTilePixels> directions;  ///< unit, from the camera
  std::array<Hit, kTilePixels> hits;
  std::array<Surface, kTilePixels> surfaces;  ///< valid where hits[i].found()
  std::array<Bsdf, kTilePixels> bsdfs;        ///< likewise
  bool found(int i) const { return hits[i].found(); }
};

/// Counters of one tile; summed over tiles in no particular order, so integers only.
struct TileStats {
  uint64_t camera_rays = 0, bounce_rays = 0, shadow_rays = 0, light_evaluations = 0;
  uint64_t skipped_pairs = 0;                   ///< points times lights left out by a bound on what they bring
  double clamped_energy = 0, total_energy = 0;  ///< summed per tile, then over tiles in tile order
  double skipped_bound = 0, skipped_total = 0;  ///< at most what skipping lost; what was gathered; likewise
};

/// What a pass may know. Everything that influences pixels is in here: same Pass, same bits.
struct Pass {
  const Scene& scene;
  Camera camera;  ///< with the resolution being rendered
  int index = 0;
  uint64_t seed = 0;
  double budget_seconds = 0;  ///< of the whole render; 0 when it counts passes
  int threads = 1;
};

/// What a method reports of its preparation; printed in --stats.
struct PassStats {
  std::map<std::string, double> numbers;  ///< e.g. "virtual_lights", "grid_columns"
  std::vector<std::string> warnings;      ///< one line each, printed once
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Runs once before the first pass and off the clock: what hangs on the scene alone and counts as loading it (materials
  /// projected on spherical harmonics). May be parallel inside. Returns early when `stop` says so.
  virtual void load(const Scene&, const Stop&, PassStats&) {}
  /// Runs before each pass, timed apart; may be parallel inside. Returns early when `stop` says so.
  virtual void begin_pass(const Pass&, const Stop&, PassStats&) {}
  /// Radiance towards the camera of each of the tile's pixels, W m^-2 sr^-1, written (not added) for every pixel, the
  /// environment and emitters seen directly included. Called from many threads. When `stop` says so it may return early;
  /// the tile is then discarded.
  virtual void shade(const Tile& tile, vec3* radiance, Sampler* samplers, const Stop& stop, TileStats&) const = 0;
};

}  // namespace zonal
