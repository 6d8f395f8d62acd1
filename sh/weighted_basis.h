#pragma once
/// Sums over directions of weights times the basis or its derivative, eight directions at a time, in double:
/// the inner loop of polygonal lights.
///
///     WeightedBasis result;
///     result.start(bands, with_gradient);
///     BoundarySum sum(result);
///     sum.add(direction, slope_weight, vector_weight);   // ... any number
///     sum.finish();                                      // result.value(i), result.gradient(i)

#include <vector>

#include "sh/zonal_lanes.h"

namespace zonal::sh {

inline constexpr int kNodeLanes = 8;
using NodeLanes = Lanes<double, kNodeLanes>;
using HalfLanes = Lanes<double, kNodeLanes / 2>;

/// The result: one number and, if wanted, one vector a coefficient.
class WeightedBasis {
 public:
  void start(int bands, bool with_gradient) {
    bands_ = bands, planes_ = with_gradient ? 4 : 1;
    lanes_.assign(static_cast<size_t>(planes_) * count(bands), HalfLanes{});
    sums_.resize(lanes_.size());
  }
  int bands() const { return bands_; }
  bool with_gradient() const { return planes_ == 4; }
  HalfLanes* lanes(int i) { return &lanes_[static_cast<size_t>(i) * planes_]; }

  /// Adds up the lanes.
  void finish() {
    for (size_t i = 0; i < lanes_.size(); ++i)
      sums_[i] = (lanes_[i][0] + lanes_[i][1]) + (lanes_[i][2] + lanes_[i][3]);
  }
  void multiply(double factor) {
    if (factor == 1) return;
    for (double& s : sums_) s *= factor;
  }
  double& value(int i) { return sums_[static_cast<size_t>(i) * planes_]; }
  Vec3<double> gradient(int i) const {
    const double* s = &sums_[static_cast<size_t>(i) * planes_];
    return {s[1], s[2], s[3]};
  }

 private:
  int bands_ = 0, planes_ = 1;
  std::vector<HalfLanes> lanes_;
  std::vector<double> sums_;
};

inline void add_lanes(HalfLanes& sum, const NodeLanes& v) {
  HalfLanes low, high;
  __builtin_memcpy(&low, &v, sizeof low);
  __builtin_memcpy(&high, reinterpret_cast<const char*>(&v) + sizeof low, sizeof high);
  sum += low + high;
}

/// Directions with `kWeights` weights each, buffered until the lanes are full.
template <int kWeights>
struct NodeBuffer {
  NodeLanes x{}, y{}, z{}, weight[kWeights]{};
  int filled = 0;

  void put(const Vec3<double>& d, const double* weights) {
    x[filled] = d.x, y[filled] = d.y, z[filled] = d.z;
    for (int k = 0; k < kWeights; ++k) weight[k][filled] = weights[k];
    ++filled;
  }
  /// Empty lanes weigh nothing and look along z.
  void clear() {
    x = y = NodeLanes{}, z = NodeLanes{} + 1.0;
    for (NodeLanes& w : weight) w = NodeLanes{};
    filled = 0;
  }
};

/// Boundary integrals: value += s.grad Y, gradient += v Y. s is perpendicular to the direction.
class BoundarySum {
 public:
  explicit BoundarySum(WeightedBasis& result) : result_(result) { nodes_.clear(); }

  void add(const Vec3<double>& d, const Vec3<double>& s, const Vec3<double>& v) {
    const double weights[6] = {s.x, s.y, s.z, v.x, v.y, v.z};
    nodes_.put(d, weights);
    if (nodes_.filled == kNodeLanes) flush();
  }
  void finish() {
    if (nodes_.filled > 0) flush();
    result_.finish();
  }

 private:
  void flush() {
    result_.with_gradient() ? sum<true>() : sum<false>();
    nodes_.clear();
  }

  template <bool kGradient>
  void sum() {
    const DirectionLanes<double, NodeLanes> d(nodes_.x, nodes_.y, nodes_.z);
    const NodeLanes* w = nodes_.weight;
    const NodeLanes parity[2] = {d.sign * d.sign, d.sign};
    basis_lanes<double, kNodeLanes, true>(
        result_.bands(), d,
        [&](int l, int m, NodeLanes X, NodeLanes dX, NodeLanes c, NodeLanes s, NodeLanes c1, NodeLanes s1) {
          X *= parity[l & 1], dX *= parity[l & 1];
          const NodeLanes up = w[2] * dX;
          put<kGradient>(index(l, m), up * c + X * (w[0] * c1 - w[1] * s1), X * c, w);
          if (m == 0) return;
          put<kGradient>(index(l, -m), up * s + X * (w[0] * s1 + w[1] * c1), X * s, w);
        });
  }

  template <bool kGradient>
  void put(int i, const NodeLanes& value, const NodeLanes& Y, const NodeLanes* w) {
    HalfLanes* sums = result_.lanes(i);
    add_lanes(sums[0], value);
    if constexpr (kGradient) {
      for (int k = 0; k < 3; ++k) add_lanes(sums[1 + k], Y * w[3 + k]);
    }
  }

  WeightedBasis& result_;
  NodeBuffer<6> nodes_;
};

/// Area integrals: value += b Y, gradient += v Y + c times the tangential gradient of Y.
class AreaSum {
 public:
  explicit AreaSum(WeightedBasis& result) : result_(result) { nodes_.clear(); }

  void add(const Vec3<double>& d, double b, const Vec3<double>& v, double c) {
    const double weights[5] = {b, v.x, v.y, v.z, c};
    nodes_.put(d, weights);
    if (nodes_.filled == kNodeLanes) flush();
  }
  void finish() {
    if (nodes_.filled > 0) flush();
    result_.finish();
  }

 private:
  void flush() {
    result_.with_gradient() ? sum<true>() : sum<false>();
    nodes_.clear();
  }

  template <bool kGradient>
  void sum() {
    const DirectionLanes<double, NodeLanes> d(nodes_.x, nodes_.y, nodes_.z);
    const NodeLanes* w = nodes_.weight;
    const NodeLanes parity[2] = {d.sign * d.sign, d.sign};
    basis_lanes<double, kNodeLanes, kGradient>(
        result_.bands(), d,
        [&](int l, int m, NodeLanes X, NodeLanes dX, NodeLanes c, NodeLanes s, NodeLanes c1, NodeLanes s1) {
          X *= parity[l & 1], dX *= parity[l & 1];
          put<kGradient>(index(l, m), X * c, X * c1, X * -s1, dX * c, d, w);
          if (m > 0) put<kGradient>(index(l, -m), X * s, X * s1, X * c1, dX * s, d, w);
        });
  }

  template <bool kGradient>
  void put(int i, const NodeLanes& Y, const NodeLanes& gx, const NodeLanes& gy, const NodeLanes& gz,
           const DirectionLanes<double, NodeLanes>& d, const NodeLanes* w) {
    HalfLanes* sums = result_.lanes(i);
    add_lanes(sums[0], Y * w[0]);
    if constexpr (kGradient) {
      const NodeLanes radial = d.x * gx + d.y * gy + d.z * gz;
      add_lanes(sums[1], Y * w[1] + w[4] * (gx - d.x * radial));
      add_lanes(sums[2], Y * w[2] + w[4] * (gy - d.y * radial));
      add_lanes(sums[3], Y * w[3] + w[4] * (gz - d.z * radial));
    }
  }

  WeightedBasis& result_;
  NodeBuffer<5> nodes_;
};

}  // namespace zonal::sh
