#pragma once
/// The mathematics of hvl.glsl for the CPU: one light against 16 shaded points, a point a SIMD lane. The
/// order of the loops is what differs: order m outside, band l inside, values meet their coefficients as they
/// are made and nothing is stored. Equations are those of README.md; tests compare with hvl.glsl and with
/// sh/.
///
/// Polynomials come from three-term recurrences without their norms, which wait in the coefficients:
///
///     p_m = 1,  p_l = 2 z p_{l-1} - B_lm p_{l-2},  B_lm = 4 ((l-1)^2 - m^2) / (4 (l-1)^2 - 1)
///
/// is the m-th derivative of the Legendre polynomial P_l times a constant near 1; two operations a value.
/// With m = 1 and z = cos a it is what the gains of a cap hang on. In float the values are within l^2
/// roundings of their maximum: 1e-5 at 20 bands.

#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

#include "integrators/hvl/hvl_bands.h"
#include "sh/zonal_lanes.h"

#define ZONAL_HVL_INLINE inline __attribute__((always_inline))
// Whole loops where the number of bands is a constant kBands; a few turns where it is not.
#ifdef __clang__
#define ZONAL_HVL_UNROLL_OUTER _Pragma("clang loop unroll_count(kBands > 0 ? 16 : 1)")
#define ZONAL_HVL_UNROLL _Pragma("clang loop unroll_count(kBands > 0 ? 16 : 2)")
#else
#define ZONAL_HVL_UNROLL_OUTER
#define ZONAL_HVL_UNROLL
#endif

// Lanes pass by value between functions that are all inlined, so what their calls would look like does not
// matter.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace zonal::hvl {

/// One register of 512 bits, or two of 256, which then hide each other's latencies.
inline constexpr int kLanes = 16;
using V = sh::Lanes<float, kLanes>;
using Mask = sh::Lanes<int, kLanes>;

ZONAL_HVL_INLINE void load(const float* p, V& v) {
  std::memcpy(&v, p, sizeof v);
}
ZONAL_HVL_INLINE void store(float* p, const V& v) {
  std::memcpy(p, &v, sizeof v);
}
ZONAL_HVL_INLINE V larger(const V& a, const V& b) {
  return a > b ? a : b;
}
ZONAL_HVL_INLINE V smaller(const V& a, const V& b) {
  return a < b ? a : b;
}
ZONAL_HVL_INLINE bool any(const Mask& mask) {
#ifdef __AVX__
  __m256 bits[2];
  std::memcpy(bits, &mask, sizeof bits);
  return _mm256_movemask_ps(_mm256_or_ps(bits[0], bits[1])) != 0;
#else
  int set = 0;
  for (int k = 0; k < kLanes; ++k) set |= mask[k];
  return set != 0;
#endif
}

/// One light as the lanes see it: (HVL-1), (HVL-3).
struct Sight {
  V x, y, z;       ///< unit, world, from the point to the light's centre; 0 on the centre itself
  V emitted;       ///< max(0, dot(light's normal, -w)) / max(d^2, r^2), 1/m^2
  V sine, cosine;  ///< of the light's half angle
};

/// Looks from the points (px, py, pz) at a light.
ZONAL_HVL_INLINE void look(const V& px, const V& py, const V& pz, const float* position, const float* normal,
                           float radius, Sight& s) {
  const V dx = position[0] - px, dy = position[1] - py, dz = position[2] - pz;
  const V d2 =
      dx * dx + dy * dy + dz * dz + 1e-36f;  // a light on the point itself: direction 0, which sends nothing
  const V inverse = 1.0f / sh::sqrt_lanes(d2);
  const V d = d2 * inverse;
  s.x = dx * inverse, s.y = dy * inverse, s.z = dz * inverse;
  // The cosine from (d - r)(d + r), which keeps its digits on the sphere's surface; inside, the hemisphere.
  const V zero = {};
  s.sine = smaller(radius * inverse, zero + 1.0f);
  s.cosine = sh::sqrt_lanes(larger(d - radius, zero) * (d + radius)) * inverse;
  const V facing = normal[0] * s.x + normal[1] * s.y + normal[2] * s.z;
  const V nearest = smaller(inverse, zero + 1.0f / radius);
  s.emitted = larger(-facing, zero) * (nearest * nearest);
}

/// Gains of a cap over sin^2 a, without their constants (Bands::cap): gain[l], 1 <= l < bands, is the
/// polynomial of order 1 at cos a; gain[0] = 1 / (1 + cos a). With `soft` > 0 times (HVL-8).
template <int kBands>
ZONAL_HVL_INLINE void cap_gains(const Bands& table, int bands, const V& sine, const V& cosine, float soft,
                                V* gain) {
  if (kBands > 0) bands = kBands;
  gain[0] = 1.0f / (1.0f + cosine);
  if (bands > 1) gain[1] = sine * 0.0f + 1.0f;
  const V turn = 2.0f * cosine;
  if (bands > 2) gain[2] = turn;
  const float* B = table.step(1);
  for (int l = 3; l < bands; ++l) gain[l] = turn * gain[l - 1] - B[l - 1] * gain[l - 2];
  if (soft > 0.0f) {
    const V keep = 1.0f / (1.0f + soft * soft * 2.0f * sine * sine * gain[0]);
    V ratio = keep, weight = keep;
    for (int l = 1; l < bands; ++l) gain[l] *= weight, ratio *= keep, weight *= ratio;
  }
}

/// (HVL-5) over sin^2 a: sum[channel] of receiver coefficients times gains times the basis at the direction
/// (x, y, z) of the view frame. `c` holds, in the order of Bands::place, 3 channels of kLanes numbers a
/// coefficient; where the table is not mirrored each order m > 0 is followed by the same for -m.
template <int kBands, bool kMirrored>
ZONAL_HVL_INLINE void product(const Bands& table, int bands, const float* c, const V& x, const V& y,
                              const V& z, const V* gain, V* sum) {
  if (kBands > 0) bands = kBands;
  const V zero = {}, turn = 2.0f * z;
  V re = zero + 1.0f, im = zero;  // (x + iy)^m
  sum[0] = sum[1] = sum[2] = zero;
  ZONAL_HVL_UNROLL_OUTER
  for (int m = 0; m < bands; ++m) {
    const float* B = table.step(m);
    const bool both = !kMirrored && m > 0;
    V p = zero + 1.0f, before = zero;
    V a0 = zero, a1 = zero, a2 = zero, b0 = zero, b1 = zero, b2 = zero;
    const float* mirror = c + 3 * kLanes * (bands - m);
    ZONAL_HVL_UNROLL
    for (int l = m; l < bands; ++l) {
      if (l > m) {
        const V next = turn * p - B[l - m] * before;
        before = p, p = next;
      }
      const V value = gain[l] * p;
      V k0, k1, k2;
      load(c, k0), load(c + kLanes, k1), load(c + 2 * kLanes, k2);
      a0 = k0 * value + a0, a1 = k1 * value + a1, a2 = k2 * value + a2;
      c += 3 * kLanes;
      if (both) {
        load(mirror, k0), load(mirror + kLanes, k1), load(mirror + 2 * kLanes, k2);
        b0 = k0 * value + b0, b1 = k1 * value + b1, b2 = k2 * value + b2;
        mirror += 3 * kLanes;
      }
    }
    sum[0] = a0 * re + sum[0], sum[1] = a1 * re + sum[1], sum[2] = a2 * re + sum[2];
    if (both) {
      sum[0] = b0 * im + sum[0], sum[1] = b1 * im + sum[1], sum[2] = b2 * im + sum[2];
      c = mirror;
    }
    const V next = x * re - y * im;
    if (!kMirrored || m + 2 < bands) im = x * im + y * re;
    re = next;
  }
}

/// (HVL-7) without its cosine, over sin^2 a: sum over l of lobe[l] gain[l] P_l(turn / 2), the constants of
/// both inside the lobe's coefficients, lobe + l * kLanes.
template <int kBands>
ZONAL_HVL_INLINE V zonal_product(const Bands& table, int bands, const float* lobe, const V& x, const V& sine,
                                 const V& cosine, float soft) {
  if (kBands > 0) bands = kBands;
  const float *B = table.step(0), *C = table.step(1);
  const V zero = {}, one = zero + 1.0f, turn = 2.0f * x, close = 2.0f * cosine;
  V k;
  load(lobe, k);
  const V first = 1.0f / (1.0f + cosine);
  V sum = k * first;
  V p = turn, p_before = one, q = one, q_before = zero;
  V keep = one, ratio = one, weight = one;
  if (soft > 0.0f) keep = 1.0f / (1.0f + soft * soft * 2.0f * sine * sine * first), ratio = weight = keep;
  ZONAL_HVL_UNROLL
  for (int l = 1; l < bands; ++l) {
    if (l > 1) {
      const V p_next = turn * p - B[l] * p_before, q_next = close * q - C[l - 1] * q_before;
      p_before = p, p = p_next, q_before = q, q = q_next;
    }
    load(lobe + l * kLanes, k);
    if (soft > 0.0f) {
      sum = k * (p * (q * weight)) + sum;
      ratio *= keep, weight *= ratio;
    } else {
      sum = k * (p * q) + sum;
    }
  }
  return sum;
}

/// (x - atan x)/x^3 by powers of x^2, x in [0, 1]: the polynomial of materials/zonal_lobes.glsl.
ZONAL_HVL_INLINE V atan_tail(const V& x2) {
  V a = 0.0200267476f - 0.00386673891f * x2;
  a = a * x2 - 0.0489143215f;
  a = a * x2 + 0.0800968172f;
  a = a * x2 - 0.108657591f;
  a = a * x2 + 0.142570449f;
  a = a * x2 - 0.199986812f;
  return a * x2 + 0.333333231f;
}

/// (HVL-6) over sin^2 a: what a cap of radiance 1 brings a diffuse surface, `up` the cosine between its axis
/// and the normal. Above the horizon pi cos; cut by it, cap_irradiance of materials/zonal_lobes.glsl.
ZONAL_HVL_INLINE void cap_irradiance(const V& up, const Sight& s, V& E) {
  const V zero = {}, one = zero + 1.0f;
  E = kPi * larger(up, zero);
  const Mask cut = (up < s.sine) & (up > -s.sine);
  if (!any(cut)) return;
  const V inverse = 1.0f / s.sine, t = up * inverse, c = larger(s.cosine, zero + 1e-18f);
  const V r2 = one - t * t, r = sh::sqrt_lanes(larger(r2, zero)), rs = r * s.sine;

  // The angle of the point (-t c, r) from the x axis.
  const V x = t * c, across = x < 0.0f ? -x : x;
  const Mask steep = r > across, wide = rs > c;
  const V low = (steep ? across : r) / ((steep ? r : across) + 1e-30f);
  V angle = low - low * low * low * atan_tail(low * low);
  angle = steep ? 1.57079633f - angle : angle;
  angle = x > 0.0f ? kPi - angle : angle;

  // (atan k - k cos^2 a)/sin^2 a, k = r tan a.
  const V k = (wide ? c : rs) / (wide ? rs : c), k2 = k * k, tail = atan_tail(k2);
  const V near = (1.57079633f - k + k * k2 * tail - rs * c) * inverse * inverse;
  const V rest = k * (one - k2 * tail * inverse * inverse);
  const V exact = up * angle + (wide ? near : rest);
  E = cut ? exact : E;
}

/// (HVL-2): out[channel] of the even extension, coefficients c[3 i + channel] of the light in the order of
/// Bands::even_place. (x, y, z) is the direction in the light's view frame.
template <int kBands, bool kMirrored>
ZONAL_HVL_INLINE void emission(const Bands& table, int bands, const float* c, const V& x, const V& y,
                               const V& z, V* out) {
  if (kBands > 0) bands = kBands;
  const V zero = {}, z2 = 4.0f * z * z;
  V re = zero + 1.0f, im = zero;
  out[0] = out[1] = out[2] = zero;
  for (int m = 0; m < bands; ++m) {
    const float *A = table.even_step(m), *B = table.even_fall(m);
    V p = zero + 1.0f, before = zero;
    V a0 = zero, a1 = zero, a2 = zero, b0 = zero, b1 = zero, b2 = zero;
    for (int l = m; l < bands; l += 2) {
      if (l > m) {
        const V next = (z2 - A[l - m]) * p - B[l - m] * before;
        before = p, p = next;
      }
      a0 = c[0] * p + a0, a1 = c[1] * p + a1, a2 = c[2] * p + a2;
      c += 3;
      if (!kMirrored && m > 0) {
        b0 = c[0] * p + b0, b1 = c[1] * p + b1, b2 = c[2] * p + b2;
        c += 3;
      }
    }
    out[0] = a0 * re + out[0], out[1] = a1 * re + out[1], out[2] = a2 * re + out[2];
    if (!kMirrored && m > 0) out[0] = b0 * im + out[0], out[1] = b1 * im + out[1], out[2] = b2 * im + out[2];
    const V next = x * re - y * im;
    im = x * im + y * re;
    re = next;
  }
}

}  // namespace zonal::hvl

#pragma GCC diagnostic pop
