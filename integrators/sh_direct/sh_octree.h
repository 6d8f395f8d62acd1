#pragma once
/// Coefficients and derivatives at the corners of an octree that is fine where the light changes fast and
/// something is shaded. Between corners: tricubic Hermite with mixed derivatives from the lights' Hessian
/// (sh_cell.h).
///
///     ShOctree tree(box, 5, positions);
///     tree.build(lights, 4000, [&] { return error_at_probes(tree) < 0.01; }, stop);
///     if (!tree.interpolate(x, 5, L)) lights.coefficients(5, x, L);
///
/// A leaf's error is judged by its corners' Hessians: along an edge of length h, the cubic that the values
/// and slopes make misses the quintic that the second derivatives make, in the middle, by h/32 (f0' - f1') +
/// h^2/64 (f0'' + f1''). A corner that lies on a larger leaf's face or edge is given what that leaf
/// interpolates there, so that there are no cracks (after Iwasaki and Dobashi 2025, who refine by the Hessian
/// too).

#include <array>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "integrators/sh_direct/sh_grid.h"

namespace zonal {

class ShOctree {
 public:
  ShOctree() = default;
  /// `positions`: what will be shaded; leaves without any hold nothing.
  ShOctree(const Box& box, int bands, std::span<const vec3> positions);

  /// Splits leaves, those with the largest errors times positions first, round after round, until there are
  /// `most_points` corners or `good_enough` says so.
  void build(const ShLights& lights, int most_points, const std::function<bool()>& good_enough,
             const Stop& stop);
  /// L[c * sh::count(bands) + i] at x; false, and nothing written, where there is nothing.
  bool interpolate(vec3 x, int bands, float* L) const;

  int points() const { return static_cast<int>(lattice_.size()); }
  int leaves() const;
  /// The leaf around x; false where there is none with corners.
  bool leaf(vec3 x, Box* box) const;

 private:
  /// The root's side in lattice steps; no leaf is smaller than one.
  static constexpr int kSide = 1 << 14;
  struct Node {
    ivec3 at{0};       ///< low corner, lattice
    int side = kSide;  ///< lattice steps
    int first_child = -1;
    int begin = 0, end = 0;  ///< its positions
    std::array<int, 8> corner{-1, -1, -1, -1, -1, -1, -1, -1};
    double error = -1;  ///< squared, of a leaf; < 0: not judged yet
    bool filled() const { return corner[0] >= 0; }
  };

  void split(int node);
  void take_corners(Node& node);
  void compute_new_points(const ShLights& lights, const Stop& stop);
  void judge_new_leaves(const ShLights& lights);
  double error_of(const Node& node) const;
  double missed_by(const Node& node, const ShLights& lights) const;
  int descend(ivec3 lattice2) const;
  const Node* find(vec3 x, vec3* place) const;
  void close_cracks();
  const float* values(int slot) const { return values_.data() + size_t(slot) * stride_; }

  vec3 low_{0};
  float step_ = 1;  ///< metres a lattice step
  int bands_ = 1;
  size_t stride_ = 0;
  std::vector<Node> nodes_;
  std::vector<vec3> positions_;
  std::vector<ivec3> lattice_;  ///< of each slot
  std::vector<float> cells_;    ///< of each slot: side of the leaf it was made for, metres
  std::unordered_map<uint64_t, int> slots_;
  std::vector<float> values_, straight_;  ///< of each slot: parts; xx, yy, zz
  int computed_ = 0;                      ///< slots that have values
};

}  // namespace zonal
