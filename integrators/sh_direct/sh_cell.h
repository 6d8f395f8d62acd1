#pragma once
/// Interpolation inside one box whose eight corners hold SH coefficients and their derivatives. Whatever the
/// scheme, the result is a weighted sum of what the corners hold: only the weights differ.
///
///     const CellWeights w = cell_weights(scheme, t, size);
///     combine(scheme, w, corners, 25, 25, L);
///
/// Corner k = a + 2 b + 4 c lies at t = (a, b, c). It holds scheme.parts() parts of three colours each: the
/// values, then the derivatives for x, y, z, then the mixed ones xy, xz, yz: part p of colour c starts at
/// (p * 3 + c) * n.

#include <array>

#include "core/vec.h"

namespace zonal {

struct ShScheme {
  enum class Interpolation { hermite, taylor, linear };
  /// Mixed derivatives, which tricubic Hermite wants: estimated from the gradients of neighbouring corners,
  /// from the lights' Hessian, or taken as zero.
  enum class Mixed { differences, hessian, zero };

  Interpolation interpolation = Interpolation::hermite;
  Mixed mixed = Mixed::differences;

  int parts() const {
    if (interpolation == Interpolation::linear) return 1;
    return interpolation == Interpolation::hermite && mixed == Mixed::hessian ? 7 : 4;
  }
};

inline constexpr int kCellParts = 7;
using CellWeights = std::array<std::array<float, kCellParts>, 8>;  ///< [corner][part]

/// `t` in [0,1]^3, `size` of the box in metres. Hermite's alone: `derivative` dx + 2 dy + 4 dz, each 0 or 1,
/// of what is interpolated, per metre.
CellWeights cell_weights(const ShScheme& scheme, vec3 t, vec3 size, int derivative = 0);
/// Which derivative each part is, as above: the value; x, y, z; xy, xz, yz.
inline constexpr int kPartDerivative[kCellParts] = {0, 1, 2, 4, 3, 5, 6};

/// L[c * count + i] of the first `count` of `n` coefficients.
void combine(const ShScheme& scheme, const CellWeights& weights, const std::array<const float*, 8>& corners,
             int n, int count, float* L);

}  // namespace zonal
