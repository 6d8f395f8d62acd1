#pragma once
/// The points of a tile that gather light, as arrays: loops over them vectorise.
///
///     TilePoints points(tile, seeds);
///     for (int k = 0; k < points.padded; ++k) d2[k] = sqr(light.x - points.x[k]) + ...;
///
/// Pixels that gather nothing (sky, black surfaces, views from below the shading horizon) are left out. The
/// order of the points is not that of the pixels: neighbours on the screen stay neighbours here, eight of
/// them make a packet of shadow rays.

#include <memory>

#include "core/integrator.h"
#include "integrators/bsdf_arrays.h"

namespace zonal {

/// What a method keeps of a tile's points for all its blocks of lights: see ManyLights::prepare_tile.
struct TileState {
  virtual ~TileState() = default;
};

struct TilePoints {
  using Floats = std::array<float, kTilePixels>;

  const Tile& tile;
  int count = 0;
  int padded = 0;  ///< count rounded up to whole vectors of 8; the points after `count` repeat the last one
  std::array<int, kTilePixels> pixel;                     ///< of the tile: tile.surfaces[pixel[k]] is point k
  std::array<uint32_t, kTilePixels> seed;                 ///< random, of the pixel and the pass
  alignas(64) Floats x, y, z;                             ///< position, metres, world
  alignas(64) Floats gx, gy, gz;                          ///< geometric normal, unit, on the camera's side
  alignas(64) Floats tx, ty, tz, bx, by, bz, nx, ny, nz;  ///< shading frame's x, y and z (the normal), world
  alignas(64) Floats ox, oy, oz;                          ///< unit, towards the camera, shading frame: oz > 0
  std::array<vec3, kTilePixels> above;                    ///< where rays to the normal's side start
  const TileState* state = nullptr;                       ///< of ManyLights::prepare_tile
  std::array<BsdfContext, kTilePixels> view;              ///< of the camera's direction, for `evaluate`

  /// `seeds` of the tile's pixels; may be null: zeros.
  explicit TilePoints(const Tile& tile, const uint32_t* seeds = nullptr);

  vec3 position(int k) const { return {x[k], y[k], z[k]}; }
  const Surface& surface(int k) const { return tile.surfaces[pixel[k]]; }
  const Bsdf& bsdf(int k) const { return tile.bsdfs[pixel[k]]; }

 private:
  void add(int i, uint32_t random);
};

/// The points' BRDFs as arrays, padding included: what vpl and vsl keep of a tile.
struct TileBrdfs : TileState {
  BsdfArrays brdfs;
  float flat = 0, peak = 0;  ///< f cos of no point exceeds flat * cosine + peak, 1/sr
  explicit TileBrdfs(const TilePoints& points);
};

}  // namespace zonal
