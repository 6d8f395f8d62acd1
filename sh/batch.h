#pragma once
/// The basis for many directions: the lanes of a SIMD register are directions. Structure of arrays in, blocks
/// out, or no output at all: what consumes the values (a dot product, a weighted sum) can be fused, which
/// from 10 bands on is what keeps memory out of it.
///
///     sh::evaluate_blocks<float>(9, x, y, z, count, [&](int first, int lanes, const float* Y) {
///       ... Y[i * sh::kLanes<float> + k] is Y_i at direction first + k, k < lanes
///     });
///     sh::reconstruct(9, coefficients, x, y, z, count, value);          // value[k] = sum_i coefficients[i]
///     Y_i(d_k) sh::project(9, x, y, z, weighted_value, count, coefficients);     // coefficients[i] += sum_k
///     weighted_value[k] Y_i(d_k)
///
/// Directions are unit to rounding; Y(d/|d|) is evaluated, as by the functions of basis.h. With the number of
/// bands as a template argument the loops unroll: `evaluate_blocks<float, 5>(...)`; to be used up to 10
/// bands.

#include <algorithm>

#include "sh/batch_kernel.h"

namespace zonal::sh {

/// Calls consumer(first, lanes, Y) for each block of kLanes<T> directions, the last of which may have fewer
/// in use (the rest repeat its last direction). Y[count(bands) * kLanes<T>] lies in a cache line's alignment
/// and lives during the call.
template <class T, int kBands = 0, class Consumer>
void evaluate_blocks(int bands, const T* x, const T* y, const T* z, int count, Consumer&& consumer) {
  batch::Scratch<T> scratch(1, bands);
  const Tables<T>& table = tables<T>();
  for (int first = 0; first < count; first += kLanes<T>) {
    const int lanes = std::min(kLanes<T>, count - first);
    const auto d = batch::load(x + first, y + first, z + first, lanes);
    batch::values<kBands>(table, bands, d, batch::Store<T>{scratch.array(0), kLanes<T>});
    consumer(first, lanes, static_cast<const T*>(scratch.array(0)));
  }
}

/// Also the gradient of Y(v/|v|) at unit v, as consumer(first, lanes, Y, gradient_x, gradient_y, gradient_z).
template <class T, int kBands = 0, class Consumer>
void evaluate_gradient_blocks(int bands, const T* x, const T* y, const T* z, int count, Consumer&& consumer) {
  batch::Scratch<T> scratch(4, bands);
  T* const out[4] = {scratch.array(0), scratch.array(1), scratch.array(2), scratch.array(3)};
  const Tables<T>& table = tables<T>();
  for (int first = 0; first < count; first += kLanes<T>) {
    const int lanes = std::min(kLanes<T>, count - first);
    const auto d = batch::load(x + first, y + first, z + first, lanes);
    batch::gradients<kBands>(table, bands, d,
                             batch::StoreGradient<T>{{out[0], out[1], out[2], out[3]}, kLanes<T>});
    consumer(first, lanes, static_cast<const T*>(out[0]), static_cast<const T*>(out[1]),
             static_cast<const T*>(out[2]), static_cast<const T*>(out[3]));
  }
}

/// Y of all directions, kept. Blocked: Y[(block * count(bands) + i) * kLanes<T> + lane], with room for whole
/// blocks, which is blocks(count) * count(bands) * kLanes<T> numbers: each block is one stream of stores.
template <class T, int kBands = 0>
void evaluate_blocked(int bands, const T* x, const T* y, const T* z, int count, T* Y) {
  const int size = (kBands > 0 ? kBands * kBands : sh::count(bands)) * kLanes<T>;
  const Tables<T>& table = tables<T>();
  for (int first = 0; first < count; first += kLanes<T>, Y += size) {
    const auto d = batch::load(x + first, y + first, z + first, std::min(kLanes<T>, count - first));
    batch::values<kBands>(table, bands, d, batch::Store<T>{Y, kLanes<T>});
  }
}

/// With gradients, four arrays of that form.
template <class T, int kBands = 0>
void evaluate_gradient_blocked(int bands, const T* x, const T* y, const T* z, int count, T* Y, T* gradient_x,
                               T* gradient_y, T* gradient_z) {
  const int size = (kBands > 0 ? kBands * kBands : sh::count(bands)) * kLanes<T>;
  const Tables<T>& table = tables<T>();
  for (int first = 0, o = 0; first < count; first += kLanes<T>, o += size) {
    const auto d = batch::load(x + first, y + first, z + first, std::min(kLanes<T>, count - first));
    batch::gradients<kBands>(
        table, bands, d,
        batch::StoreGradient<T>{{Y + o, gradient_x + o, gradient_y + o, gradient_z + o}, kLanes<T>});
  }
}

/// How many blocks hold `count` directions.
template <class T>
constexpr int blocks(int count) {
  return (count + kLanes<T> - 1) / kLanes<T>;
}

// Compiled once, for float and double; up to 10 bands unrolled.

/// Y[i * stride + k], stride >= count: one row a function.
template <class T>
void evaluate_batch(int bands, const T* x, const T* y, const T* z, int count, T* Y, int stride);

/// With the gradient of Y(v/|v|) for any non-zero v, as evaluate_gradient gives it, in rows like Y.
template <class T>
void evaluate_gradient_batch(int bands, const T* x, const T* y, const T* z, int count, T* Y, T* gradient_x,
                             T* gradient_y, T* gradient_z, int stride);

/// With Hessians, rows too: hessian[0..5] are xx, xy, xz, yy, yz, zz.
template <class T>
void evaluate_hessian_batch(int bands, const T* x, const T* y, const T* z, int count, T* Y,
                            T* const gradient[3], T* const hessian[6], int stride);

/// value[k] = sum_i coefficients[i] Y_i(d_k).
template <class T>
void reconstruct(int bands, const T* coefficients, const T* x, const T* y, const T* z, int count, T* value);

/// coefficients[i] += sum_k weight[k] Y_i(d_k). Sums run in T within 64 blocks and in double beyond.
template <class T>
void project(int bands, const T* x, const T* y, const T* z, const T* weight, int count, T* coefficients);

}  // namespace zonal::sh
