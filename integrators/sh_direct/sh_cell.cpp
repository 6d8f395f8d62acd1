#include "integrators/sh_direct/sh_cell.h"

namespace zonal {

namespace {

/// Weights of the derivative d = dx + 2 dy + 4 dz, each 0 or 1, of each corner.
using AllWeights = std::array<std::array<float, 8>, 8>;

/// Tensor product of cubic Hermite polynomials: value and slope at both ends, each axis.
AllWeights tricubic(vec3 t, vec3 size, int derivative) {
  float basis[3][2][2];  // [axis][end][slope]
  for (int axis = 0; axis < 3; ++axis) {
    const float u = t[axis], v = 1 - u, s = size[axis];
    if (derivative >> axis & 1) {
      basis[axis][0][0] = -6 * u * v / s, basis[axis][0][1] = v * (v - 2 * u);
      basis[axis][1][0] = 6 * u * v / s, basis[axis][1][1] = u * (u - 2 * v);
    } else {
      basis[axis][0][0] = v * v * (1 + 2 * u), basis[axis][0][1] = s * u * v * v;
      basis[axis][1][0] = u * u * (1 + 2 * v), basis[axis][1][1] = -s * u * u * v;
    }
  }
  AllWeights w;
  for (int k = 0; k < 8; ++k)
    for (int d = 0; d < 8; ++d)
      w[k][d] = basis[0][k & 1][d & 1] * basis[1][k >> 1 & 1][d >> 1 & 1] * basis[2][k >> 2][d >> 2];
  return w;
}

/// Replaces the derivative `d` at every corner by differences of those of one order less along each of its
/// axes, averaged: first order in the box's size, and on a face of it a function of that face's corners
/// alone, so that neighbouring boxes agree.
void estimate(int d, vec3 size, AllWeights& w) {
  const int axes = (d & 1) + (d >> 1 & 1) + (d >> 2);
  for (int k = 0; k < 8; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      if (!(d >> axis & 1)) continue;
      const int low = k & ~(1 << axis), high = k | 1 << axis, rest = d & ~(1 << axis);
      const float share = w[k][d] / (float(axes) * size[axis]);
      w[high][rest] += share, w[low][rest] -= share;
    }
}

}  // namespace

CellWeights cell_weights(const ShScheme& scheme, vec3 t, vec3 size, int derivative) {
  CellWeights result{};
  if (scheme.interpolation != ShScheme::Interpolation::hermite) {
    for (int k = 0; k < 8; ++k) {
      const vec3 corner(float(k & 1), float(k >> 1 & 1), float(k >> 2));
      float w = 1;
      for (int axis = 0; axis < 3; ++axis) w *= corner[axis] > 0 ? t[axis] : 1 - t[axis];
      result[k][0] = w;
      if (scheme.interpolation == ShScheme::Interpolation::linear) continue;
      for (int axis = 0; axis < 3; ++axis) result[k][1 + axis] = w * (t[axis] - corner[axis]) * size[axis];
    }
    return result;
  }
  AllWeights w = tricubic(t, size, derivative);
  if (scheme.mixed != ShScheme::Mixed::zero) {
    estimate(7, size, w);
    if (scheme.mixed == ShScheme::Mixed::differences)
      for (const int d : {3, 5, 6}) estimate(d, size, w);
  }
  for (int k = 0; k < 8; ++k)
    for (int part = 0; part < scheme.parts(); ++part) result[k][part] = w[k][kPartDerivative[part]];
  return result;
}

void combine(const ShScheme& scheme, const CellWeights& weights, const std::array<const float*, 8>& corners,
             int n, int count, float* L) {
  const int parts = scheme.parts();
  for (int c = 0; c < 3; ++c) {
    float* out = L + c * count;
    for (int i = 0; i < count; ++i) out[i] = 0;
    for (int k = 0; k < 8; ++k)
      for (int part = 0; part < parts; ++part) {
        const float w = weights[k][part];
        const float* in = corners[k] + (part * 3 + c) * n;
        for (int i = 0; i < count; ++i) out[i] += w * in[i];
      }
  }
}

}  // namespace zonal
