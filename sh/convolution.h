#pragma once
/// Convolution with a kernel that is symmetric about its axis (Mézières 2022, Eq. 2.64): band l is scaled by
/// sqrt(4pi/(2l+1)) k_l, so that the value at w is the integral of f times the kernel turned from z to w. For
/// example convolving radiance with clamped_cosine_zonal gives irradiance as a function of the normal.
///
///     sh::convolve(bands, kernel, f, out);   // kernel[bands], f[count(bands)]; out may be f

#include <cmath>
#include <numbers>

#include "sh/basis.h"

namespace zonal::sh {

/// `functions` of them as structure of arrays, all with one kernel. 1 <= bands <= kMaxBands.
template <class T>
void convolve(int bands, int functions, const T* kernel, const T* in, T* out) {
  for (int l = 0; l < bands; ++l) {
    const T scale = T(std::sqrt(4 * std::numbers::pi / (2 * l + 1))) * kernel[l];
    const size_t end = size_t(l + 1) * (l + 1) * functions;
    for (size_t i = size_t(l) * l * functions; i < end; ++i) out[i] = scale * in[i];
  }
}

template <class T>
void convolve(int bands, const T* kernel, const T* in, T* out) {
  convolve(bands, 1, kernel, in, out);
}

}  // namespace zonal::sh
