// From nodes to coefficients: the associated Legendre functions by their three-term recurrence in l, all
// nodes of a block at once, three channels in one pass. Order m starts from Re and Im of (x + iy)^m, so no
// angle is ever formed.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "materials/sh_material.h"
#include "materials/sh_projector_quadrature.h"

namespace zonal {
namespace {

constexpr int kBands = 101;
constexpr int kBlock = 128;  ///< eight arrays of doubles stay in the L1 cache

/// X_l = rise z X_{l-1} - fall X_{l-2} at fixed m.
struct Recurrence {
  double rise, fall;
};

struct LegendreTables {
  std::vector<Recurrence> step;  ///< [m * kBands + l]
  double start[kBands];          ///< X_m^m / s^m, with the sqrt2 of m > 0 and the Condon-Shortley sign
  std::vector<double> cosine;    ///< A_l^m of times_cosine, [m * kBands + l]

  LegendreTables() : step(kBands * kBands), cosine(kBands * kBands) {
    double diagonal = 0.5 * std::numbers::inv_sqrtpi;  // Y_0^0
    for (int m = 0; m < kBands; ++m) {
      if (m > 0) diagonal *= -std::sqrt((2 * m + 1) / (2.0 * m));
      start[m] = m > 0 ? std::numbers::sqrt2 * diagonal : diagonal;
      for (int l = m; l < kBands; ++l) {
        const double l2 = double(l) * l, m2 = double(m) * m, before = (l - 1.0) * (l - 1.0);
        cosine[m * kBands + l] = std::sqrt((l2 - m2) / (4 * l2 - 1));
        if (l == m) continue;
        const double rise = std::sqrt((4 * l2 - 1) / (l2 - m2));
        step[m * kBands + l] = {rise, l > m + 1 ? rise * std::sqrt((before - m2) / (4 * before - 1)) : 0};
      }
    }
  }
  static const LegendreTables& get() {
    static const LegendreTables tables;
    return tables;
  }
};

struct alignas(64) Block {
  double x[kBlock], y[kBlock], z[kBlock], r[kBlock], g[kBlock], b[kBlock];
  double re[kBlock], im[kBlock];
  double p[2][kBlock];
};

struct Sums {
  double r = 0, g = 0, b = 0;
};

/// All l >= m of one order, starting from `first`[k] = Re or Im of (x + iy)^m; sums[l] are added to.
void accumulate(Block& block, const double* first, int m, int bands, Sums* sums) {
  const LegendreTables& tables = LegendreTables::get();
  const Recurrence* step = tables.step.data() + m * kBands;
  double *before = block.p[0], *now = block.p[1];
  {
    const double start = tables.start[m];
    double r = 0, g = 0, b = 0;
#pragma omp simd reduction(+ : r, g, b)
    for (int k = 0; k < kBlock; ++k) {
      const double p = start * first[k];
      before[k] = 0, now[k] = p;
      r += p * block.r[k], g += p * block.g[k], b += p * block.b[k];
    }
    sums[m].r += r, sums[m].g += g, sums[m].b += b;
  }
  int l = m + 1;
  for (; l + 1 < bands; l += 2) {  // two at a time: half the loads
    const Recurrence s = step[l], t = step[l + 1];
    double r0 = 0, g0 = 0, b0 = 0, r1 = 0, g1 = 0, b1 = 0;
#pragma omp simd reduction(+ : r0, g0, b0, r1, g1, b1)
    for (int k = 0; k < kBlock; ++k) {
      const double z = block.z[k], p = s.rise * z * now[k] - s.fall * before[k];
      const double q = t.rise * z * p - t.fall * now[k];
      before[k] = p, now[k] = q;
      r0 += p * block.r[k], g0 += p * block.g[k], b0 += p * block.b[k];
      r1 += q * block.r[k], g1 += q * block.g[k], b1 += q * block.b[k];
    }
    sums[l].r += r0, sums[l].g += g0, sums[l].b += b0;
    sums[l + 1].r += r1, sums[l + 1].g += g1, sums[l + 1].b += b1;
  }
  if (l < bands) {
    const Recurrence s = step[l];
    double r = 0, g = 0, b = 0;
#pragma omp simd reduction(+ : r, g, b)
    for (int k = 0; k < kBlock; ++k) {
      const double p = s.rise * block.z[k] * now[k] - s.fall * before[k];
      r += p * block.r[k], g += p * block.g[k], b += p * block.b[k];
    }
    sums[l].r += r, sums[l].g += g, sums[l].b += b;
  }
}

}  // namespace

void project_nodes(const HemisphereNodes& nodes, int bands, bool mirrored, ShBasis basis, double* out) {
  const int count = sh_count(bands, mirrored);
  std::vector<Sums> sums(size_t(bands) * (2 * size_t(bands) - 1));  // [(m + bands - 1) * bands + l]
  const auto order = [&](int m) { return sums.data() + size_t(m + bands - 1) * size_t(bands); };
  Block block;
  for (int first = 0; first < nodes.size(); first += kBlock) {
    const int used = std::min(kBlock, nodes.size() - first);
    for (int k = 0; k < kBlock; ++k) {
      const int i = first + std::min(k, used - 1);
      const double mask = k < used ? 1 : 0, z = nodes.z[i];
      // Hemispherical harmonics are sqrt2 Y at height 2z - 1 (sh/hemispherical.h): the sine grows by 2
      // sqrt(z/(1+z)).
      const bool squeezed = basis == ShBasis::hemispherical;
      const double turn = squeezed ? 2 * std::sqrt(z / (1 + z)) : 1,
                   scale = squeezed ? std::numbers::sqrt2 * mask : mask;
      block.x[k] = turn * nodes.x[i], block.y[k] = turn * nodes.y[i], block.z[k] = squeezed ? 2 * z - 1 : z;
      block.r[k] = scale * nodes.f[0][i], block.g[k] = scale * nodes.f[1][i],
      block.b[k] = scale * nodes.f[2][i];
      block.re[k] = 1, block.im[k] = 0;
    }
    for (int m = 0; m < bands; ++m) {
      if (m > 0) {
        for (int k = 0; k < kBlock; ++k) {
          const double re = block.re[k], im = block.im[k];
          block.re[k] = re * block.x[k] - im * block.y[k], block.im[k] = re * block.y[k] + im * block.x[k];
        }
      }
      accumulate(block, block.re, m, bands, order(m));
      if (!mirrored && m > 0) accumulate(block, block.im, m, bands, order(-m));
    }
  }
  for (int l = 0; l < bands; ++l) {
    for (int m = mirrored ? 0 : -l; m <= l; ++m) {
      const Sums& s = order(m)[l];
      const int i = sh_index(l, m, mirrored);
      out[i] = s.r, out[count + i] = s.g, out[2 * count + i] = s.b;
    }
  }
}

void times_cosine(int bands, bool mirrored, ShBasis basis, const double* in, double* out) {
  const auto A = [&](int l, int m) { return LegendreTables::get().cosine[std::abs(m) * kBands + l]; };
  for (int l = 0; l < bands; ++l) {
    for (int m = mirrored ? 0 : -l; m <= l; ++m) {
      double value = A(l + 1, m) * in[sh_index(l + 1, m, mirrored)];
      if (l > std::abs(m)) value += A(l, m) * in[sh_index(l - 1, m, mirrored)];
      // The hemispherical basis lives at height z' = 2z - 1: z = (1 + z')/2.
      if (basis == ShBasis::hemispherical) value = 0.5 * (value + in[sh_index(l, m, mirrored)]);
      out[sh_index(l, m, mirrored)] = value;
    }
  }
}

}  // namespace zonal
