#include "integrators/sh_direct/sh_octree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace zonal {

namespace {

constexpr ShScheme kScheme{ShScheme::Interpolation::hermite, ShScheme::Mixed::hessian};
/// Corners that a split adds where none of its neighbours is split: 27 less 8.
constexpr int kCornersOfASplit = 19;
constexpr int kFirstSplits = 2;  ///< levels that every tree has

ivec3 octant(int k) {
  return {k & 1, k >> 1 & 1, k >> 2};
}

uint64_t key(ivec3 p) {
  return (uint64_t(p.x) << 42) | (uint64_t(p.y) << 21) | uint64_t(p.z);
}

}  // namespace

ShOctree::ShOctree(const Box& box, int bands, std::span<const vec3> positions)
    : low_(box.low),
      step_(max_component(box.high - box.low) / float(kSide)),
      bands_(bands),
      stride_(size_t(kCellParts) * 3 * sh::count(bands)),
      positions_(positions.begin(), positions.end()) {
  Node root;
  root.end = static_cast<int>(positions_.size());
  nodes_.push_back(root);
  for (int level = 0; level < kFirstSplits; ++level)
    for (int i = 0, count = static_cast<int>(nodes_.size()); i < count; ++i)
      if (nodes_[i].first_child < 0 && nodes_[i].end > nodes_[i].begin) split(i);
  for (Node& node : nodes_)
    if (node.first_child < 0 && node.end > node.begin) take_corners(node);
}

/// Eight children, each with its share of the positions.
void ShOctree::split(int index) {
  const int first = static_cast<int>(nodes_.size()), side = nodes_[index].side / 2;
  nodes_[index].first_child = first;
  const ivec3 at = nodes_[index].at;
  const vec3 middle = low_ + vec3(at + side) * step_;
  auto from = positions_.begin() + nodes_[index].begin;
  const auto end = positions_.begin() + nodes_[index].end;
  for (int k = 0; k < 8; ++k) {
    Node child;
    child.at = at + octant(k) * side, child.side = side;
    const auto mine = [&](vec3 p) {
      return (p.x >= middle.x) == bool(k & 1) && (p.y >= middle.y) == bool(k & 2) &&
             (p.z >= middle.z) == bool(k & 4);
    };
    child.begin = static_cast<int>(from - positions_.begin());
    from = std::partition(from, end, mine);
    child.end = static_cast<int>(from - positions_.begin());
    nodes_.push_back(child);
  }
}

void ShOctree::take_corners(Node& node) {
  for (int k = 0; k < 8; ++k) {
    const ivec3 p = node.at + octant(k) * node.side;
    const auto [place, fresh] = slots_.try_emplace(key(p), static_cast<int>(lattice_.size()));
    if (fresh) lattice_.push_back(p), cells_.push_back(float(node.side) * step_);
    node.corner[k] = place->second;
  }
}

void ShOctree::compute_new_points(const ShLights& lights, const Stop& stop) {
  const size_t straight = 9 * size_t(sh::count(bands_));
  values_.resize(lattice_.size() * stride_), straight_.resize(lattice_.size() * straight);
  tbb::parallel_for(computed_, static_cast<int>(lattice_.size()), [&](int slot) {
    if (slot % 64 == 0 && stop()) return;
    compute_grid_point(lights, kScheme, bands_, low_ + vec3(lattice_[slot]) * step_, 16 * step_, cells_[slot],
                       values_.data() + size_t(slot) * stride_, straight_.data() + size_t(slot) * straight);
  });
  computed_ = static_cast<int>(lattice_.size());
}

/// Root mean square over the four edges along an axis, those of the three axes added: in the middle of the
/// leaf they come together.
double ShOctree::error_of(const Node& node) const {
  const int n3 = 3 * sh::count(bands_);
  const float h = float(node.side) * step_;
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double squares = 0;
    for (int k = 0; k < 8; ++k) {
      if (k >> axis & 1) continue;
      const int a = node.corner[k], b = node.corner[k | 1 << axis];
      const float *slope_a = values(a) + (1 + axis) * n3, *slope_b = values(b) + (1 + axis) * n3;
      const float *curve_a = straight_.data() + (size_t(a) * 3 + axis) * n3,
                  *curve_b = straight_.data() + (size_t(b) * 3 + axis) * n3;
      float edge = 0;
      for (int i = 0; i < n3; ++i)
        edge += sqr(h / 32 * (slope_a[i] - slope_b[i]) + h * h / 64 * (curve_a[i] + curve_b[i]));
      squares += edge;
    }
    sum += std::sqrt(squares / 4);
  }
  return sum * sum;
}

/// Mean square of what the corners do not see, at a few of the leaf's positions.
double ShOctree::missed_by(const Node& node, const ShLights& lights) const {
  constexpr int kTried = 4;
  const int count = std::min(kTried, node.end - node.begin);
  double squares = 0;
  for (int i = 0; i < count; ++i)
    squares += sqr(double(
        lights.missed(bands_, positions_[node.begin + (2 * i + 1) * (node.end - node.begin) / (2 * count)],
                      float(node.side) * step_)));
  return squares / count;
}

void ShOctree::judge_new_leaves(const ShLights& lights) {
  tbb::parallel_for(size_t{0}, nodes_.size(), [&](size_t i) {
    Node& node = nodes_[i];
    if (node.first_child < 0 && node.filled() && node.error < 0)
      node.error = error_of(node) + missed_by(node, lights);
  });
}

void ShOctree::build(const ShLights& lights, int most_points, const std::function<bool()>& good_enough,
                     const Stop& stop) {
  for (;;) {
    compute_new_points(lights, stop);
    if (stop()) return;
    judge_new_leaves(lights);
    const int left = (most_points - points()) / kCornersOfASplit;
    if (left < 1 || good_enough()) break;

    std::vector<std::pair<double, int>> worth;
    double total = 0;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (node.first_child >= 0 || !node.filled() || node.side == 1) continue;
      worth.emplace_back(node.error * (node.end - node.begin), static_cast<int>(i));
      total += worth.back().first;
    }
    std::sort(worth.begin(), worth.end(),
              [](auto a, auto b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
    // Half of the error at a time: what comes after may look otherwise then.
    double taken = 0;
    int splits = 0;
    for (const auto& [error, index] : worth) {
      if (!(error > 0) || splits >= left || taken > 0.5 * total) break;
      taken += error, ++splits;
      split(index);
      const int first = nodes_[index].first_child;
      for (int k = 0; k < 8; ++k)
        if (nodes_[first + k].end > nodes_[first + k].begin) take_corners(nodes_[first + k]);
    }
    if (splits == 0) break;
  }
  close_cracks();
}

/// The leaf around a point given in half lattice steps, odd numbers.
int ShOctree::descend(ivec3 lattice2) const {
  int index = 0;
  while (nodes_[index].first_child >= 0) {
    const ivec3 middle2 = 2 * nodes_[index].at + nodes_[index].side;
    index = nodes_[index].first_child + (lattice2.x > middle2.x) + 2 * (lattice2.y > middle2.y) +
            4 * (lattice2.z > middle2.z);
  }
  return index;
}

/// From the largest leaves down: a corner on the boundary of a leaf that has it not as a corner takes that
/// leaf's value and derivatives there. A bicubic on a face is what its corners' values, slopes and mixed
/// slope say, so the small face then is a part of the large one.
void ShOctree::close_cracks() {
  struct Bound {
    int side, slot, leaf;
  };
  std::vector<Bound> bounds;
  for (int slot = 0; slot < points(); ++slot) {
    const ivec3 p = lattice_[slot];
    Bound bound{0, slot, -1};
    for (int k = 0; k < 8; ++k) {
      const ivec3 near2 = 2 * p + 2 * octant(k) - 1;
      if (glm::any(glm::lessThan(near2, ivec3(0))) || glm::any(glm::greaterThan(near2, ivec3(2 * kSide))))
        continue;
      const int leaf = descend(near2);
      const Node& node = nodes_[leaf];
      if (!node.filled() || node.side <= bound.side) continue;
      if (std::find(node.corner.begin(), node.corner.end(), slot) != node.corner.end()) continue;
      bound.side = node.side, bound.leaf = leaf;
    }
    if (bound.leaf >= 0) bounds.push_back(bound);
  }
  std::stable_sort(bounds.begin(), bounds.end(),
                   [](const Bound& a, const Bound& b) { return a.side > b.side; });
  const int n = sh::count(bands_);
  std::vector<float> parts(stride_);
  for (const Bound& bound : bounds) {
    const Node& leaf = nodes_[bound.leaf];
    const vec3 t = vec3(lattice_[bound.slot] - leaf.at) / float(leaf.side);
    std::array<const float*, 8> corners;
    for (int k = 0; k < 8; ++k) corners[k] = values(leaf.corner[k]);
    for (int part = 0; part < kCellParts; ++part)
      combine(kScheme, cell_weights(kScheme, t, vec3(float(leaf.side) * step_), kPartDerivative[part]),
              corners, n, n, parts.data() + size_t(part) * 3 * n);
    std::copy(parts.begin(), parts.end(), values_.begin() + std::ptrdiff_t(size_t(bound.slot) * stride_));
  }
}

int ShOctree::leaves() const {
  return static_cast<int>(std::count_if(
      nodes_.begin(), nodes_.end(), [](const Node& node) { return node.first_child < 0 && node.filled(); }));
}

/// The leaf around x, with corners or without; null outside. `place`: x in lattice steps.
const ShOctree::Node* ShOctree::find(vec3 x, vec3* place) const {
  *place = (x - low_) / step_;
  for (int k = 0; k < 3; ++k)
    if (nodes_.empty() || !((*place)[k] >= 0 && (*place)[k] <= float(kSide))) return nullptr;
  const Node* node = nodes_.data();
  while (node->first_child >= 0) {
    const vec3 middle = vec3(node->at + node->side / 2);
    node = &nodes_[node->first_child + (place->x >= middle.x) + 2 * (place->y >= middle.y) +
                   4 * (place->z >= middle.z)];
  }
  return node;
}

bool ShOctree::leaf(vec3 x, Box* box) const {
  vec3 place;
  const Node* node = find(x, &place);
  if (!node || !node->filled()) return false;
  *box = {low_ + vec3(node->at) * step_, low_ + vec3(node->at + node->side) * step_};
  return true;
}

bool ShOctree::interpolate(vec3 x, int bands, float* L) const {
  vec3 place;
  const Node* node = find(x, &place);
  if (!node || !node->filled()) return false;
  std::array<const float*, 8> corners;
  for (int k = 0; k < 8; ++k) corners[k] = values(node->corner[k]);
  const vec3 t = glm::clamp((place - vec3(node->at)) / float(node->side), 0.0f, 1.0f);
  combine(kScheme, cell_weights(kScheme, t, vec3(float(node->side) * step_)), corners, sh::count(bands_),
          sh::count(bands), L);
  return true;
}

}  // namespace zonal
