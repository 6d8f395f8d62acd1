#include "integrators/sh_direct/sh_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace zonal {

Box Box::around(std::span<const vec3> positions) {
  Box box;
  if (positions.empty()) return {vec3(-1), vec3(1)};
  box.low = box.high = positions[0];
  for (const vec3& p : positions) box.low = glm::min(box.low, p), box.high = glm::max(box.high, p);
  const vec3 extent = box.high - box.low;
  const float margin = std::max(1e-3f * max_component(extent), 1e-4f);
  box.low -= margin, box.high += margin;
  return box;
}

void compute_grid_point(const ShLights& lights, const ShScheme& scheme, int bands, vec3 x, float step,
                        float cell, float* out, float* straight) {
  const int n = sh::count(bands);
  if (scheme.parts() == 1) return lights.coefficients(bands, x, out);
  thread_local std::vector<float> gradient, hessian;
  gradient.resize(9 * size_t(n)), hessian.resize(18 * size_t(n));
  if (scheme.parts() == kCellParts)
    lights.hessian(bands, x, step, out, gradient.data(), hessian.data(), cell);
  else
    lights.gradient(bands, x, out, gradient.data(), cell);
  constexpr int kMixed[3] = {1, 2, 4}, kStraight[3] = {0, 3, 5};  // of xx, xy, xz, yy, yz, zz
  for (int c = 0; c < 3; ++c)
    for (int axis = 0; axis < 3; ++axis) {
      std::copy_n(gradient.data() + (c * 3 + axis) * n, n, out + ((1 + axis) * 3 + c) * n);
      if (scheme.parts() < kCellParts) continue;
      std::copy_n(hessian.data() + (c * 6 + kMixed[axis]) * n, n, out + ((4 + axis) * 3 + c) * n);
      if (straight)
        std::copy_n(hessian.data() + (c * 6 + kStraight[axis]) * n, n, straight + (axis * 3 + c) * n);
    }
}

ShGrid::ShGrid(const Box& box, ivec3 points, const ShScheme& scheme, int bands)
    : box_(box),
      points_(points),
      size_((box.high - box.low) / vec3(points - 1)),
      scheme_(scheme),
      bands_(bands),
      slots_(size_t(points.x) * points.y * points.z, -1) {}

double ShGrid::bytes(double points_a_side, const ShScheme& scheme, int bands) {
  const double numbers = 3.0 * scheme.parts() * sh::count(bands) + 1;
  return points_a_side * points_a_side * points_a_side * numbers * sizeof(float);
}

bool ShGrid::locate(vec3 x, ivec3* cell, vec3* t) const {
  if (!box_.contains(x)) return false;
  const vec3 place = (x - box_.low) / size_;
  *cell = glm::min(ivec3(place), points_ - 2);
  *t = glm::clamp(place - vec3(*cell), 0.0f, 1.0f);
  return true;
}

void ShGrid::need(std::span<const vec3> positions) {
  for (const vec3& x : positions) {
    ivec3 cell;
    vec3 t;
    if (!locate(x, &cell, &t)) continue;
    for (int k = 0; k < 8; ++k) {
      const ivec3 p = cell + ivec3(k & 1, k >> 1 & 1, k >> 2);
      int& slot = slots_[index(p)];
      if (slot >= 0) continue;
      slot = static_cast<int>(wanted_.size());
      wanted_.push_back(p);
    }
  }
}

void ShGrid::build(const ShLights& lights, const Stop& stop) {
  const size_t stride = 3 * size_t(scheme_.parts()) * sh::count(bands_);
  values_.resize(wanted_.size() * stride);
  const float cell = std::min({size_.x, size_.y, size_.z});
  tbb::parallel_for(size_t{0}, wanted_.size(), [&](size_t i) {
    if (i % 64 == 0 && stop()) return;
    compute_grid_point(lights, scheme_, bands_, place(int(i)), 0.03f * cell, cell,
                       values_.data() + i * stride);
  });
}

bool ShGrid::interpolate(vec3 x, int bands, float* L) const {
  ivec3 cell;
  vec3 t;
  if (!locate(x, &cell, &t)) return false;
  const int n = sh::count(bands_);
  const size_t stride = 3 * size_t(scheme_.parts()) * n;
  std::array<const float*, 8> corners;
  for (int k = 0; k < 8; ++k) {
    const int slot = slots_[index(cell + ivec3(k & 1, k >> 1 & 1, k >> 2))];
    if (slot < 0) return false;
    corners[k] = values_.data() + size_t(slot) * stride;
  }
  combine(scheme_, cell_weights(scheme_, t, size_), corners, n, sh::count(bands), L);
  return true;
}

}  // namespace zonal
