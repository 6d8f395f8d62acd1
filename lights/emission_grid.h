#pragma once
/// Divides the flux of a light without extent into the cells of a grid, and each cell into a block of texels
/// with one ray each: what a reflective shadow map does.
///
///     EmissionGrid grid(spot, 400);                          // 20 x 20
///     EmissionSample ray = grid.sample(texel, jitter);       // power: the whole flux of that texel
///
/// The texels divide a plane evenly: around a spot's outer cone, a face of the cube around a point light, a
/// square around the scene for a directional light. A texel's flux is, exactly,
///   spot, point:    intensity * integral of falloff * cos^3 over the texel at distance 1   (GRID-1)
///   directional:    irradiance * area of the texel within the scene's disk                 (GRID-2)
/// because a patch dA of the plane at distance 1, seen at the angle t to its axis, fills the solid angle
/// cos^3(t) dA: without that factor the light would come out stronger towards the corners. Rays are drawn
/// with the density of that flux, so that each stands for its texel without bias.

#include "lights/light.h"

namespace zonal {

class EmissionGrid {
 public:
  /// Point, directional, and spot lights whose cone fits a plane (outer half angle up to 80 degrees).
  static bool suits(const Light& light);
  /// The rectangle nearest to `cells` in number, near square. `light` must suit and outlive the grid.
  EmissionGrid(const Light& light, double cells, int block_texels = 1);

  int faces() const { return faces_; }  ///< 6 for a point light, else 1
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int cells() const { return faces_ * columns_ * rows_; }
  int block_texels() const { return block_; }
  int texels() const { return cells() * block_ * block_; }
  /// Full width of the map in radians; 0 for directional lights.
  float fov() const;
  /// Texel `i` of a cell's block, row by row.
  int texel(int cell, int i) const;

  /// Solid angle weighted by the falloff, sr; for directional lights lit area, m^2. 0: the texel carries
  /// nothing.
  float weight(int texel) const;
  /// W: of a weight.
  vec3 flux(float weight) const;
  /// A ray through the texel that carries all of its flux, drawn with the density of the flux: uniform over
  /// the texel for uniform u, but where the falloff refuses that point, another one hashed from it. Power 0
  /// outside a spot's cone or a directional light's disk.
  EmissionSample sample(int texel, vec2 u) const;
  /// The ray through the texel's middle, likewise; where nothing leaves there, through its brightest point.
  EmissionSample center(int texel) const;

 private:
  struct Rectangle {
    vec2 low, high;  ///< on the plane at distance 1; directional: metres around the axis
    int face;
  };
  Rectangle rectangle(int texel) const;
  float density(vec2 q) const;  ///< flux an area at q of the plane sends, relative to the axis
  EmissionSample through(const Rectangle& r, vec2 q) const;

  const Light* light_;
  int faces_ = 1, columns_ = 1, rows_ = 1, block_ = 1;
  float half_width_ = 1;  ///< of the plane's square: tan of the half angle; directional: metres
};

}  // namespace zonal
