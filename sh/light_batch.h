#pragma once
/// Many spherical lights or oriented disks at once, one a SIMD lane: coefficients of each, or their sum in
/// three colours with its gradient, which is what a probe or a shaded point wants. Any number of bands.
///
///     std::vector<float> sum(3 * sh::count(9));                      // [colour][l(l+1)+m], zeroed by the
///     caller sh::accumulate_lights(9, sh::LightShape::sphere, x, lights, sum.data());
///
/// Distances are computed in double for float lights too: close to a sphere's surface its size hangs on d^2 -
/// r^2.

#include "sh/basis.h"

namespace zonal::sh {

enum class LightShape { sphere, disk };

/// Structure of arrays, caller-owned. Radius > 0. Squares of distances must stay in double's range.
template <class T>
struct LightArrays {
  int count = 0;
  const T *x = nullptr, *y = nullptr, *z = nullptr;  ///< centres
  const T* radius = nullptr;
  const T* radiance[3] = {nullptr, nullptr, nullptr};  ///< red, green, blue; for sums alone
  /// Where radiance depends on x (a factor of it, the same for all colours): the gradient of its logarithm
  /// with respect to x, 1/m. Null: it does not. For accumulate_lights_gradient alone.
  const T* slope[3] = {nullptr, nullptr, nullptr};
  /// Metres, > 0: derivatives are for cubic Hermite interpolation over cells of this size and are bounded
  /// within one cell of a light's surface, where they grow without end but hold over a shorter way
  /// (seen_lanes.h). 0: as they are.
  T cell = 0;
};

/// L[i * lights.count + k] = coefficient i of light k of radiance 1.
template <class T>
void project_lights(int bands, LightShape shape, const Vec3<T>& x, const LightArrays<T>& lights, T* L);

/// Mézières 2022, section 3.3.3: lights outside and all coefficients inside, or one m after another and
/// lights inside (light_batch_reversed.h). The sums agree to rounding; beyond 10 bands there is forward
/// alone.
enum class LoopOrder { forward, reverse };

/// sum[c * count(bands) + i] += radiance_c times coefficient i, over all lights.
template <class T>
void accumulate_lights(int bands, LightShape shape, const Vec3<T>& x, const LightArrays<T>& lights, T* sum,
                       LoopOrder order = LoopOrder::reverse);

/// The same, and gradient[(c * 3 + axis) * count(bands) + i] += its derivative with respect to x.
template <class T>
void accumulate_lights_gradient(int bands, LightShape shape, const Vec3<T>& x, const LightArrays<T>& lights,
                                T* sum, T* gradient);

}  // namespace zonal::sh
