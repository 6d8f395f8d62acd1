#pragma once
/// Divides the flux of a light without extent into the cells of a grid, one ray each: what a reflective
/// shadow map does.
///
///     EmissionGrid grid(spot, 400);                          // 20 x 20
///     EmissionSample ray = grid.sample(cell, jitter);        // power: the flux this ray stands for
///
/// Rays are spread evenly over the plane of the grid, and a ray's flux is
///   spot (plane around the outer cone), point (six faces of a cube): intensity * cos^3 * cell area at
///   distance 1   (GRID-1) directional (square around the scene):                           irradiance * cell
///   area                        (GRID-2)
/// because a patch dA of the plane at distance 1, seen at the angle t to its axis, fills the solid angle
/// cos^3(t) dA: without that factor the light would come out stronger towards the corners.

#include "lights/light.h"

namespace zonal {

class EmissionGrid {
 public:
  /// Point, directional, and spot lights whose cone fits a plane (outer half angle up to 80 degrees).
  static bool suits(const Light& light);
  /// The rectangle nearest to `cells` in number, near square. `light` must suit and outlive the grid.
  EmissionGrid(const Light& light, double cells);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int cells() const { return faces_ * columns_ * rows_; }
  /// Uniform over the cell for uniform u. Power 0 outside a spot's cone or a directional light's disk.
  EmissionSample sample(int cell, vec2 u) const;

 private:
  const Light* light_;
  int faces_ = 1, columns_ = 1, rows_ = 1;
};

}  // namespace zonal
