#include "sh/light_batch.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sh/few_bands.h"
#include "sh/light_batch_reversed.h"
#include "sh/seen_lanes.h"

namespace zonal::sh {
namespace {

template <class T, int W>
void project_block(int bands, LightShape shape, const Vec3<T>& p, const LightArrays<T>& lights, int first,
                   T* L) {
  using V = Lanes<T, W>;
  const int filled = std::min(W, lights.count - first);
  const SeenLanes<T, W> seen(shape, p, lights, first, filled);
  const DirectionLanes<T, V> d = seen.direction();
  V gain[kMaxBands];
  seen.gains(bands, d.sign, gain, nullptr);
  const size_t stride = lights.count;
  T* out = L + first;
  basis_lanes<T, W, false>(bands, d, [&](int l, int m, V X, V, V c, V s, V, V) {
    const V g = gain[l] * X;
    store_lanes<T, W>(out + index(l, m) * stride, g * c, filled);
    if (m > 0) store_lanes<T, W>(out + index(l, -m) * stride, g * s, filled);
  });
}

/// Whether a comparison holds in every filled lane.
template <class M>
inline bool all_lanes(M holds, int filled) {
  constexpr int kWidth = static_cast<int>(sizeof(M) / sizeof(holds[0]));
#if __has_builtin(__builtin_reduce_and)
  if (filled >= kWidth) return __builtin_reduce_and(holds) != 0;
#endif
  bool all = true;
  for (int k = 0; k < kWidth && k < filled; ++k) all &= holds[k] != 0;
  return all;
}

/// Lights of up to kFewBands bands, one a lane, in T alone.
template <class T, int W>
struct FewLanes {
  using V = Lanes<T, W>;
  V x, y, z, s2;  ///< axis, x^2 + y^2
  V sine2, cosine;
  bool fits;  ///< false: a light is too near for float, or of extreme size, and nothing here holds

  FewLanes(LightShape shape, const Vec3<T>& p, const LightArrays<T>& lights, int first, int filled) {
    const V wx = load_lanes<T, W>(lights.x + first, filled) - p.x,
            wy = load_lanes<T, W>(lights.y + first, filled) - p.y,
            wz = load_lanes<T, W>(lights.z + first, filled) - p.z;
    const V r = load_lanes<T, W>(lights.radius + first, filled);
    const V xy2 = wx * wx + wy * wy, d2 = xy2 + wz * wz;
    const V inverse = T(1) / sqrt_lanes(d2);
    x = wx * inverse, y = wy * inverse, z = wz * inverse;
    s2 = few_sine2(z, xy2 * inverse * inverse);
    if (shape == LightShape::sphere) {
      const V ratio = r * inverse;
      sine2 = ratio * ratio;
      cosine = sqrt_lanes((T(1) - sine2));
    } else {
      const V r2 = r * r, inverse_s2 = T(1) / (d2 + r2);
      sine2 = r2 * inverse_s2;
      cosine = sqrt_lanes(d2 * inverse_s2);
    }
    // False for NaN too. A disk has no trouble near it.
    const T most = shape == LightShape::sphere ? T(kFewSine2) : T(1);
    fits = all_lanes((sine2 <= most) & (d2 > T(kFewLeast)) & (d2 < T(kFewMost)), filled);
  }
};

template <class T, int W, int N>
bool project_few(LightShape shape, const Vec3<T>& p, const LightArrays<T>& lights, int first, T* L) {
  using V = Lanes<T, W>;
  const int filled = std::min(W, lights.count - first);
  const FewLanes<T, W> seen(shape, p, lights, first, filled);
  if (!seen.fits) return false;
  V gain[N];
  few_gains<N, T>(seen.sine2, seen.cosine, gain);
  const size_t stride = lights.count;
  T* out = L + first;
  few_bands<N, T>(
      seen.x, seen.y, seen.z, seen.s2, gain, [&](int i, V v) __attribute__((always_inline)) {
        store_lanes<T, W>(out + i * stride, v, filled);
      });
  return true;
}

/// N: bands at compile time, 0 for any number.
template <class T, int W, int N>
void project_some(int bands, LightShape shape, const Vec3<T>& p, const LightArrays<T>& lights, int first,
                  T* L) {
  if constexpr (N > 0) {
    if (project_few<T, W, N>(shape, p, lights, first, L)) return;
  }
  project_block<T, W>(bands, shape, p, lights, first, L);
}

template <class T, int N>
void project_all(int bands, LightShape shape, const Vec3<T>& x, const LightArrays<T>& lights, T* L) {
  constexpr int kWidth = lane_count<T>, kLine = 2 * kWidth;
  int first = 0;
  // A cache line of output at a time: with long strides between coefficients lines do not stay to be finished
  // later.
  const int lead = static_cast<int>((64 - reinterpret_cast<std::uintptr_t>(L) % 64) % 64 / sizeof(T));
  if (lead > 0 && lead + kLine <= lights.count) {
    project_some<T, kLine, N>(bands, shape, x, lights, 0, L);
    first = lead;
  }
  for (; first + kLine <= lights.count; first += kLine) {
    project_some<T, kLine, N>(bands, shape, x, lights, first, L);
  }
  for (; first < lights.count; first += kWidth) {
    project_some<T, kWidth, N>(bands, shape, x, lights, first, L);
  }
}

/// Adds a block to `lanes`: 3 or 12 lane sums a coefficient.
/// kVaries: the lights' radiance has slopes.
template <class T, int W, bool kGradient, bool kVaries>
void accumulate_block(int bands, LightShape shape, const Vec3<T>& p, const LightArrays<T>& lights, int first,
                      Lanes<T, W>* lanes) {
  using V = Lanes<T, W>;
  const int filled = std::min(W, lights.count - first);
  const SeenLanes<T, W> seen(shape, p, lights, first, filled);
  const DirectionLanes<T, V> d = seen.direction();
  V gain[kMaxBands], growth[kMaxBands], colour[3];
  seen.gains(bands, d.sign, gain, kGradient ? growth : nullptr);
  for (int k = 0; k < 3; ++k) colour[k] = load_lanes<T, W>(lights.radiance[k] + first, filled);
  V slope[3];
  if constexpr (kVaries)
    for (int k = 0; k < 3; ++k) slope[k] = load_lanes<T, W>(lights.slope[k] + first, filled);

  constexpr int kSums = kGradient ? 12 : 3;
  const auto add = [&](int i, V value, V gx, V gy, V gz) {
    V* sum = lanes + static_cast<size_t>(i) * kSums;
    if constexpr (kVaries) gx += value * slope[0], gy += value * slope[1], gz += value * slope[2];
    for (int k = 0; k < 3; ++k) {
      sum[k] += colour[k] * value;
      if constexpr (kGradient) {
        sum[3 + 3 * k] += colour[k] * gx;
        sum[4 + 3 * k] += colour[k] * gy;
        sum[5 + 3 * k] += colour[k] * gz;
      }
    }
  };
  basis_lanes<T, W, kGradient>(bands, d, [&](int l, int m, V X, V dX, V c, V s, V c1, V s1) {
    const V g = gain[l] * X;
    if constexpr (!kGradient) {
      add(index(l, m), g * c, g, g, g);
      if (m > 0) add(index(l, -m), g * s, g, g, g);
    } else {
      // grad_x = -g (grad Y - w (w.grad Y))/d - g' w Y (Eq. 3.26); w.grad of X (x+iy)^m is (z dX + m
      // X)(x+iy)^m.
      const V turn = -seen.inverse_d * gain[l], flat = turn * X, up = turn * dX;
      const V along = -(growth[l] * X) - (up * d.z + T(m) * flat);
      V k = along * c;
      add(index(l, m), g * c, flat * c1 + d.x * k, d.y * k - flat * s1, up * c + d.z * k);
      if (m == 0) return;
      k = along * s;
      add(index(l, -m), g * s, flat * s1 + d.x * k, flat * c1 + d.y * k, up * s + d.z * k);
    }
  });
}

template <class T, bool kGradient>
void accumulate(int bands, LightShape shape, const Vec3<T>& p, const LightArrays<T>& lights, T* sum,
                T* gradient) {
  constexpr int kWidth = lane_count<T>, kSums = kGradient ? 12 : 3;
  using V = Lanes<T, kWidth>;
  thread_local std::vector<V> lanes;
  const int n = count(bands);
  lanes.assign(static_cast<size_t>(n) * kSums, V{});
  for (int first = 0; first < lights.count; first += kWidth) {
    if (kGradient && lights.slope[0])
      accumulate_block<T, kWidth, kGradient, true>(bands, shape, p, lights, first, lanes.data());
    else
      accumulate_block<T, kWidth, kGradient, false>(bands, shape, p, lights, first, lanes.data());
  }
  for (int i = 0; i < n; ++i) {
    const V* v = &lanes[static_cast<size_t>(i) * kSums];
    for (int k = 0; k < kSums; ++k) {
      T total = 0;
      for (int lane = 0; lane < kWidth; ++lane) total += v[k][lane];
      (k < 3 ? sum[k * n + i] : gradient[(k - 3) * n + i]) += total;
    }
  }
}

/// False beyond 10 bands.
template <class T, int... N>
bool accumulate_few_reversed(int bands, LightShape shape, const Vec3<T>& p, const LightArrays<T>& lights,
                             T* sum, std::integer_sequence<int, N...>) {
  return ((bands == N + 1 && (accumulate_reversed<T, N + 1, false>(shape, p, lights, sum, nullptr), true)) ||
          ...);
}

}  // namespace

template <class T>
void project_lights(int bands, LightShape shape, const Vec3<T>& x, const LightArrays<T>& lights, T* L) {
  switch (bands) {
    case 1:
      return project_all<T, 1>(bands, shape, x, lights, L);
    case 2:
      return project_all<T, 2>(bands, shape, x, lights, L);
    case 3:
      return project_all<T, 3>(bands, shape, x, lights, L);
    case 4:
      return project_all<T, 4>(bands, shape, x, lights, L);
    case 5:
      return project_all<T, 5>(bands, shape, x, lights, L);
    case 6:
      return project_all<T, 6>(bands, shape, x, lights, L);
    default:
      return project_all<T, 0>(bands, shape, x, lights, L);
  }
}

template <class T>
void accumulate_lights(int bands, LightShape shape, const Vec3<T>& x, const LightArrays<T>& lights, T* sum,
                       LoopOrder order) {
  if (order == LoopOrder::reverse &&
      accumulate_few_reversed(bands, shape, x, lights, sum, std::make_integer_sequence<int, 10>{}))
    return;
  accumulate<T, false>(bands, shape, x, lights, sum, nullptr);
}

template <class T>
void accumulate_lights_gradient(int bands, LightShape shape, const Vec3<T>& x, const LightArrays<T>& lights,
                                T* sum, T* gradient) {
  accumulate<T, true>(bands, shape, x, lights, sum, gradient);
}

#define ZONAL_INSTANTIATE(T)                                                                                 \
  template void project_lights<T>(int, LightShape, const Vec3<T>&, const LightArrays<T>&, T*);               \
  template void accumulate_lights<T>(int, LightShape, const Vec3<T>&, const LightArrays<T>&, T*, LoopOrder); \
  template void accumulate_lights_gradient<T>(int, LightShape, const Vec3<T>&, const LightArrays<T>&, T*, T*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
