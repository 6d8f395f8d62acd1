#pragma once
/// Densities over the unit square, bilinear between the vertices of a grid, and the maps that turn uniform
/// points into points of such a density and back (Dupuy and Jakob 2018, "An Adaptive Parameterization for
/// Efficient Material Acquisition and Rendering", section 4). A grid has one slice for each elevation and
/// azimuth of the camera's side; what lies between two of them is the linear mixture of their densities,
/// which is the linear mixture of their cumulative sums too, so that the maps stay exact inverses of each
/// other.
///
///     WarpGrid grid(128, 128, std::move(samples));
///     SliceMix mix{2, {3, 4}, {0.25f, 0.75f}};
///     vec2 p = grid.sample(mix, u);            // u uniform in the unit square; p has density
///     grid.density(mix, p) vec2 same = grid.invert(mix, p);

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace zonal {

/// Up to four slices and their shares, which add up to 1.
struct SliceMix {
  int count = 1;
  std::array<uint32_t, 4> index{};
  std::array<float, 4> weight{1.0f};
};

/// Place on a grid of width x height vertices: a cell, and where in it.
struct GridCell {
  int x, y;           ///< vertex of smallest coordinates
  float along, down;  ///< [0, 1]

  GridCell(vec2 p, int width, int height) {
    const float px = p.x * static_cast<float>(width - 1), py = p.y * static_cast<float>(height - 1);
    x = std::min(std::max(static_cast<int>(px), 0), width - 2);
    y = std::min(std::max(static_cast<int>(py), 0), height - 2);
    along = px - static_cast<float>(x), down = py - static_cast<float>(y);
  }
};

class WarpGrid {
 public:
  WarpGrid() = default;
  /// `samples`: slices of height rows of width >= 2 numbers, finite and >= 0, of any scale. A slice that is 0
  /// everywhere becomes the uniform density.
  WarpGrid(int width, int height, const std::vector<float>& samples);

  /// Density of p; its integral over the square is 1.
  float density(const SliceMix& mix, vec2 p) const;
  /// The point that the uniform u goes to.
  vec2 sample(const SliceMix& mix, vec2 u) const;
  /// The uniform point that goes to p, and the density there.
  vec2 invert(const SliceMix& mix, vec2 p, float* density = nullptr) const;

  /// One slice that is this mixture: for many look-ups of one mixture.
  WarpGrid blended(const SliceMix& mix) const;
  size_t slices() const { return slices_; }
  /// Density at a vertex, counted row by row.
  float vertex_density(size_t slice, size_t vertex) const {
    return vertices_[slice * (vertices_.size() / slices_) + vertex].density * scale_;
  }
  /// True when `slice` was 0 everywhere.
  bool is_empty(size_t slice) const { return empty_[slice]; }

 private:
  // Neighbours in memory are what one look-up reads together.
  struct Vertex {
    float density;  ///< of a slice whose cells' masses add up to 1
    float before;   ///< integral of the row from its start, cells of width 1
  };
  struct Row {
    float total;   ///< integral of the row
    float before;  ///< integral of all rows before, cells of height 1
  };
  struct Corners;  ///< everything known of a cell, mixed

  int width_ = 0, height_ = 0;
  size_t slices_ = 0;
  float scale_ = 0;  ///< number of cells: from mass per cell to density
  std::vector<Vertex> vertices_;
  std::vector<Row> rows_;
  std::vector<bool> empty_;

  Corners corners(const SliceMix& mix, int x, int y) const;
};

}  // namespace zonal
