#pragma once
/// The sum of many lights with its loops in the order that Mézières 2022, section 3.3.3, calls reverse: over
/// m outside, over lights inside, so that the coefficients of one m are all that is held at a time, in
/// registers. light_batch.cpp has the other order, over blocks of lights outside and all coefficients inside.
/// On a CPU reverse is faster for coefficients alone (`bench_sh_direct orders`: 0.6 to 0.8 of the time),
/// forward for gradients, whose twelve sums a coefficient fit no registers; that variant is here to be
/// measured.

#include <algorithm>
#include <utility>
#include <vector>

#include "sh/seen_lanes.h"

namespace zonal::sh {

template <class T, int N>
struct ReversedBlock {
  using V = Lanes<T, lane_count<T>>;
  V x, y, z, u, sign, inverse_d;
  V gain[N], growth[N], c[N], s[N], colour[3];
};

/// Coefficients (l, +-M) of all blocks.
template <class T, int N, int M, bool kGradient>
void reversed_column(const std::vector<ReversedBlock<T, N>>& blocks, T* sum, T* gradient) {
  using V = typename ReversedBlock<T, N>::V;
  constexpr int kSums = kGradient ? 12 : 3, kSides = M > 0 ? 2 : 1;
  V lanes[N - M][kSides][kSums] = {};
  const Step<T>*step = tables<T>().column(M) - M, *next = tables<T>().column(M + 1) - (M + 1);
  for (const auto& b : blocks) {
    const V zero = b.x * 0;
    V p = zero + T(1), e = zero, q = zero + T(1), f = zero;  // columns M and M + 1
    const V c1 = M > 0 ? T(M) * b.sign * b.c[M > 0 ? M - 1 : 0] : zero,
            s1 = M > 0 ? T(M) * b.sign * b.s[M > 0 ? M - 1 : 0] : zero;
#pragma GCC unroll 16
    for (int l = M; l < N; ++l) {
      if (l > M) e = step[l].fall * e - step[l].rise * p, p += b.u * e;
      if (kGradient && l > M + 1) f = next[l].fall * f - next[l].rise * q, q += b.u * f;
      const V X = step[l].norm * p, g = b.gain[l] * X;
      const auto add = [&](V* to, V value, V gx, V gy, V gz) {
        for (int k = 0; k < 3; ++k) {
          to[k] += b.colour[k] * value;
          if constexpr (kGradient)
            to[3 + 3 * k] += b.colour[k] * gx, to[4 + 3 * k] += b.colour[k] * gy,
                to[5 + 3 * k] += b.colour[k] * gz;
        }
      };
      if constexpr (!kGradient) {
        add(lanes[l - M][0], g * b.c[M], g, g, g);
        if constexpr (M > 0) add(lanes[l - M][1], g * b.s[M], g, g, g);
      } else {
        const V dX = l > M ? step[l].slope * (b.sign * q) : zero;
        const V turn = -b.inverse_d * b.gain[l], flat = turn * X, up = turn * dX;
        const V along = -(b.growth[l] * X) - (up * b.z + T(M) * flat);
        V k = along * b.c[M];
        add(lanes[l - M][0], g * b.c[M], flat * c1 + b.x * k, b.y * k - flat * s1, up * b.c[M] + b.z * k);
        if constexpr (M > 0) {
          k = along * b.s[M];
          add(lanes[l - M][1], g * b.s[M], flat * s1 + b.x * k, flat * c1 + b.y * k, up * b.s[M] + b.z * k);
        }
      }
    }
  }
  for (int l = M; l < N; ++l)
    for (int side = 0; side < kSides; ++side)
      for (int k = 0; k < kSums; ++k) {
        T total = 0;
        for (int lane = 0; lane < lane_count<T>; ++lane) total += lanes[l - M][side][k][lane];
        const int i = index(l, side ? -M : M);
        (k < 3 ? sum[k * N * N + i] : gradient[(k - 3) * N * N + i]) += total;
      }
}

/// As accumulate_lights and accumulate_lights_gradient, of N bands.
template <class T, int N, bool kGradient>
void accumulate_reversed(LightShape shape, const Vec3<T>& x, const LightArrays<T>& lights, T* sum,
                         T* gradient) {
  constexpr int kWidth = lane_count<T>;
  thread_local std::vector<ReversedBlock<T, N>> blocks;
  blocks.clear();
  for (int first = 0; first < lights.count; first += kWidth) {
    const int filled = std::min(kWidth, lights.count - first);
    const SeenLanes<T, kWidth> seen(shape, x, lights, first, filled);
    const auto d = seen.direction();
    ReversedBlock<T, N>& b = blocks.emplace_back();
    b.x = d.x, b.y = d.y, b.z = d.z, b.u = d.u, b.sign = d.sign, b.inverse_d = seen.inverse_d;
    seen.gains(N, d.sign, b.gain, kGradient ? b.growth : nullptr);
    b.c[0] = d.x * 0 + T(1), b.s[0] = d.x * 0;
    for (int m = 1; m < N; ++m)
      b.c[m] = d.sign * (d.x * b.c[m - 1] - d.y * b.s[m - 1]),
      b.s[m] = d.sign * (d.x * b.s[m - 1] + d.y * b.c[m - 1]);
    for (int k = 0; k < 3; ++k) b.colour[k] = load_lanes<T, kWidth>(lights.radiance[k] + first, filled);
  }
  [&]<int... M>(std::integer_sequence<int, M...>) {
    (reversed_column<T, N, M, kGradient>(blocks, sum, gradient), ...);
  }(std::make_integer_sequence<int, N>{});
}

}  // namespace zonal::sh
