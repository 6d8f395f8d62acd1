#include "integrators/hvl/hvl_kernels.h"

namespace zonal::hvl {

void Receivers::set_sh(int k, int bands, bool mirrored, int stride, const float* source,
                       const float* window) {
  const Bands& table = Bands::table();
  Group& g = groups[k / kLanes];
  for_each_coefficient(g.bands, g.mirrored, [&](int place, int l, int m, int) {
    if (l >= bands || (mirrored && m < 0)) return;
    const int i = mirrored ? l * (l + 1) / 2 + m : l * (l + 1) + m;
    const float constant = window[l] * table.cap(l) * table.norm(l, m < 0 ? -m : m);
    for (int c = 0; c < 3; ++c)
      g.values[(size_t(place) * 3 + c) * kLanes + k % kLanes] = constant * source[c * stride + i];
  });
}

void Receivers::set_zonal(int k, int bands, const float* lobe, const float* window) {
  const Bands& table = Bands::table();
  Group& g = groups[k / kLanes];
  for (int l = 0; l < bands && l < g.bands; ++l) {
    // sqrt((2l+1)/4pi) turns gains into zonal coefficients (sh/zonal.h).
    const float root = 0.282094792f * std::sqrt(2.0f * float(l) + 1.0f);
    g.values[size_t(l) * kLanes + k % kLanes] = window[l] * table.cap(l) * table.legendre(l) * root * lobe[l];
  }
}

}  // namespace zonal::hvl
