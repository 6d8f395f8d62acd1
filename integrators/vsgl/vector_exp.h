#pragma once
/// exp for loops over many floats: no call, no branch, so that the compiler makes vectors of it. A kernel
/// included in the same namespace takes it in place of the library's:
///
///     namespace vsgl_lanes {
///     #include "integrators/vsgl/spherical_gaussian.glsl"
///     }

#include <bit>
#include <cmath>
#include <cstdint>

namespace zonal::vsgl_lanes {

/// e^x to 2e-7 + |x| 1.2e-7 relative (the rounding of x times log2 e), for x <= 88; 0 for less than about
/// -87, where subnormal results would begin.
inline float exp(float x) {
  const float y = x * 1.44269504f;  // log2 e
  const float whole = std::floor(y + 0.5f);
  const float f = y - whole;  // [-0.5, 0.5]
  // Taylor's series of 2^f: ln2^n / n!, the next term is below 5e-9.
  float p = 1.52527338e-5f;
  p = p * f + 1.54035304e-4f;
  p = p * f + 1.33335581e-3f;
  p = p * f + 9.61812911e-3f;
  p = p * f + 5.55041087e-2f;
  p = p * f + 2.40226507e-1f;
  p = p * f + 6.93147181e-1f;
  p = p * f + 1.0f;
  // The comparison keeps NaN: it falls to the second branch and p is NaN.
  const float exponent = whole < -126.0f ? -126.0f : whole;
  const float scale = std::bit_cast<float>((static_cast<int32_t>(exponent) + 127) << 23);
  return whole < -126.0f ? 0.0f : p * scale;
}

}  // namespace zonal::vsgl_lanes
