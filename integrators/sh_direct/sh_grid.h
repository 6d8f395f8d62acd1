#pragma once
/// Coefficients, and where the scheme wants them their derivatives, at the points of a uniform grid; between
/// them they are interpolated. Only points next to what will be shaded are computed.
///
///     ShGrid grid({low, high}, ivec3(8), scheme, 5);
///     grid.need(positions);
///     grid.build(lights, stop);                        // in parallel over points
///     if (!grid.interpolate(x, 5, L)) lights.coefficients(5, x, L);

#include <span>
#include <vector>

#include "core/stop.h"
#include "integrators/sh_direct/sh_cell.h"
#include "lights/sh_lights.h"

namespace zonal {

using glm::ivec3;

struct Box {
  vec3 low{0}, high{0};
  /// Of the positions, a hair larger; sides without extent get some.
  static Box around(std::span<const vec3> positions);
  bool contains(vec3 x) const {
    return x.x >= low.x && x.y >= low.y && x.z >= low.z && x.x <= high.x && x.y <= high.y && x.z <= high.z;
  }
};

/// What a grid holds of one point, from the lights: scheme.parts() * 3 * n numbers, as sh_cell.h has them.
/// `step`: metres, of the differences where a Hessian has no closed form. `cell`: metres, over which
/// derivatives beside spheres are bounded; 0: nowhere. `straight`, where it is not null and the scheme takes
/// the Hessian: xx, yy, zz, at (axis * 3 + c) * n.
void compute_grid_point(const ShLights& lights, const ShScheme& scheme, int bands, vec3 x, float step,
                        float cell, float* out, float* straight = nullptr);

class ShGrid {
 public:
  ShGrid() = default;
  /// `points` >= 2 along each axis, ends included.
  ShGrid(const Box& box, ivec3 points, const ShScheme& scheme, int bands);
  /// Bytes of such a grid when every point is needed.
  static double bytes(double points_a_side, const ShScheme& scheme, int bands);

  /// The cells around these positions will be asked for.
  void need(std::span<const vec3> positions);
  void build(const ShLights& lights, const Stop& stop);
  /// L[c * sh::count(bands) + i] at x; false, and nothing written, where x lies in a cell nobody needed.
  /// `bands` at most the grid's.
  bool interpolate(vec3 x, int bands, float* L) const;

  int built_points() const { return static_cast<int>(wanted_.size()); }
  vec3 cell_size() const { return size_; }
  /// Where things are, for a copy elsewhere (a GPU): the first corner, points along each axis, the place of
  /// each slot's values, and each point's slot, x fastest, -1 where nobody needs it.
  vec3 low() const { return box_.low; }
  ivec3 points() const { return points_; }
  vec3 place(int slot) const { return box_.low + vec3(wanted_[slot]) * size_; }
  const std::vector<int>& slots() const { return slots_; }

 private:
  bool locate(vec3 x, ivec3* cell, vec3* t) const;
  size_t index(ivec3 p) const { return (size_t(p.z) * points_.y + p.y) * points_.x + p.x; }

  Box box_;
  ivec3 points_{2};
  vec3 size_{1};
  ShScheme scheme_;
  int bands_ = 1;
  std::vector<int> slots_;     ///< of each point: where its values are; -1: nobody needs it
  std::vector<ivec3> wanted_;  ///< the points of the slots
  std::vector<float> values_;
};

}  // namespace zonal
