#include "lights/virtual_light_radius.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace zonal {

namespace {

constexpr int kNearest = 10;
constexpr float kSmallest = 1e-6f;  ///< of the scene's radius

/// A balanced tree over points, halved along the longer side of each part's box.
class PointTree {
 public:
  explicit PointTree(const std::vector<vec3>& points) : points_(points), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(points.size() / 2 + 1);
    if (!points.empty()) build(0, static_cast<uint32_t>(points.size()));
  }

  /// Squared distance to the k-th nearest point other than `self`.
  float kth_squared(uint32_t self, int k) const {
    Nearest nearest{points_[self], self, k, {}};
    nearest.heap.reserve(static_cast<size_t>(k));
    visit(0, nearest);
    return nearest.heap.empty() ? 0.0f : nearest.heap.front();
  }

 private:
  static constexpr uint32_t kLeaf = 8;
  struct Node {
    uint32_t first, end;  ///< in order_
    uint32_t second = 0;  ///< node of the upper half; 0: a leaf. The lower half follows the node itself
    int axis = 0;
    float split = 0;
  };
  struct Nearest {
    vec3 from;
    uint32_t self;
    int k;
    std::vector<float> heap;  ///< the k smallest so far, largest first
    float limit() const { return static_cast<int>(heap.size()) < k ? kInfinity : heap.front(); }
    void offer(float d2) {
      if (d2 >= limit()) return;
      if (static_cast<int>(heap.size()) == k) {
        std::pop_heap(heap.begin(), heap.end());
        heap.pop_back();
      }
      heap.push_back(d2);
      std::push_heap(heap.begin(), heap.end());
    }
  };

  uint32_t build(uint32_t first, uint32_t end) {
    const auto number = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({first, end});
    if (end - first <= kLeaf) return number;
    Bounds box;
    for (uint32_t i = first; i < end; ++i) box.grow(points_[order_[i]]);
    const vec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = (first + end) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                     [&](uint32_t a, uint32_t b) { return points_[a][axis] < points_[b][axis]; });
    nodes_[number].axis = axis, nodes_[number].split = points_[order_[middle]][axis];
    build(first, middle);
    const uint32_t second = build(middle, end);
    nodes_[number].second = second;
    return number;
  }

  void visit(uint32_t number, Nearest& nearest) const {
    const Node& node = nodes_[number];
    if (node.second == 0) {
      for (uint32_t i = node.first; i < node.end; ++i) {
        const vec3 d = points_[order_[i]] - nearest.from;
        if (order_[i] != nearest.self) nearest.offer(glm::dot(d, d));
      }
      return;
    }
    const float side = nearest.from[node.axis] - node.split;
    visit(side < 0 ? number + 1 : node.second, nearest);
    if (sqr(side) < nearest.limit()) visit(side < 0 ? node.second : number + 1, nearest);
  }

  const std::vector<vec3>& points_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

/// (RADIUS-1)
float by_field_of_view(const VirtualLight& v, const VirtualLightGrid& grid) {
  const float cells = static_cast<float>(grid.columns) * static_cast<float>(grid.rows);
  const float g = std::sqrt(2.0f / cells) * grid.fov;
  return v.primary_distance * (g + g * g * g / 3.0f);
}

/// (RADIUS-3); 0 for a light without neighbours.
float by_neighbours(const VirtualLightSet& set, uint32_t light) {
  const VirtualLight& v = set.lights[light];
  const auto neighbours = set.neighbours(light);
  float nearest = kInfinity;
  for (const uint32_t n : neighbours)
    if (n != kNone) nearest = std::min(nearest, glm::distance(v.position, set.lights[n].position));
  if (!(nearest < kInfinity)) return 0;
  float sum = 0, weights = 0;
  for (const uint32_t n : neighbours) {
    if (n == kNone) continue;
    const VirtualLight& other = set.lights[n];
    const float depth = std::fabs(v.primary_distance - other.primary_distance) + 0.5f * nearest;
    const float weight = depth > 0 ? nearest / depth : 2.0f;
    sum += weight * glm::distance(v.position, other.position), weights += weight;
  }
  return sum / weights;
}

}  // namespace

void RadiusParams::visit(ParamVisitor& v) {
  v.choice_or_number("radius", rule, metres, {"auto", "field_of_view", "density", "neighbours"},
                     {0, 1e30, true}, "m",
                     "of a virtual light's sphere; auto: field_of_view on spot grids, else density");
  v.number("radius_factor", factor, {0, 1e6, true}, "", "multiplies the radius that a rule gives");
}

std::vector<float> nearest_distances(const std::vector<vec3>& points, int k) {
  const PointTree tree(points);
  std::vector<float> distances(points.size());
  tbb::parallel_for(size_t{0}, points.size(), [&](size_t i) {
    distances[i] = std::sqrt(tree.kth_squared(static_cast<uint32_t>(i), k));
  });
  return distances;
}

std::vector<float> virtual_light_radii(const VirtualLightSet& set, const RadiusParams& params,
                                       float scene_radius) {
  const size_t count = set.lights.size() - set.parts;
  std::vector<float> radii(set.lights.size(), 0.0f);
  const auto finish = [&](float factor) {
    // A texel's is its block's in the proportion of their widths.
    for (size_t i = count; i < radii.size(); ++i) {
      const VirtualLight& part = set.lights[i];
      const uint32_t whole = set.grids[part.grid].at[part.cell];
      radii[i] = radii[whole] * std::sqrt(part.footprint / set.lights[whole].footprint);
    }
    for (float& r : radii) {
      r *= factor;
      r = std::isfinite(r) ? std::clamp(r, kSmallest * scene_radius, scene_radius) : scene_radius;
    }
  };
  if (params.rule == RadiusRule::metres) {
    std::fill(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(count), params.metres);
    finish(1);
    return radii;
  }

  bool all = true;
  for (size_t i = 0; i < count; ++i) {
    const VirtualLight& v = set.lights[i];
    if (v.grid != kNone) {
      const VirtualLightGrid& grid = set.grids[v.grid];
      const bool view =
          params.rule == RadiusRule::field_of_view || (params.rule == RadiusRule::automatic && grid.spot);
      if (view && grid.fov > 0) radii[i] = by_field_of_view(v, grid);
      if (params.rule == RadiusRule::neighbours) radii[i] = by_neighbours(set, static_cast<uint32_t>(i));
    }
    all = all && radii[i] > 0;
  }

  // (RADIUS-2) for those the rule says nothing of.
  if (!all) {
    std::vector<vec3> positions;
    for (size_t i = 0; i < count; ++i) positions.push_back(set.lights[i].position);
    const int k = std::min(kNearest, static_cast<int>(count) - 1);
    const auto distances = k > 0 ? nearest_distances(positions, k) : std::vector<float>(count, 0.0f);
    for (size_t i = 0; i < count; ++i) {
      if (radii[i] > 0) continue;
      radii[i] = k > 0 ? distances[i] * std::sqrt(2 * kPi / static_cast<float>(k))
                       : 0.5f * set.lights[i].primary_distance;
    }
  }
  finish(params.factor);
  return radii;
}

}  // namespace zonal
