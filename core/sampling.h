#pragma once
/// Random numbers as values, and the maps from the unit square to where they are needed.
///
///     Sampler sampler(seed, pixel_index, pass);
///     vec3 w = cosine_hemisphere(sampler.next_2d());
///
/// A sampler draws from an Owen-scrambled Sobol (0,2)-sequence padded over dimensions (Burley 2020, "Practical
/// Hash-based Owen Scrambling"): pass number = sample index, so passes stratify each pixel. Same seed, pixel, pass and
/// call order: same numbers.

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace zonal {

/// A well-mixed 32-bit hash (Wellons' lowbias32), and of several words.
inline uint32_t hash32(uint32_t x) {
  x ^= x >> 16, x *= 0x7feb352du;
  x ^= x >> 15, x *= 0x846ca68bu;
  return x ^ (x >> 16);
}
inline uint32_t hash32(uint32_t a, uint32_t b) { return hash32(a ^ (hash32(b) + 0x9e3779b9u)); }
inline uint32_t hash32(uint32_t a, uint32_t b, uint32_t c) { return hash32(a, hash32(b, c)); }
inline uint32_t hash32(uint64_t seed, uint32_t b, uint32_t c) {
  return hash32(static_cast<uint32_t>(seed), hash32(static_cast<uint32_t>(seed >> 32), b), c);
}

/// 32 random bits to [0, 1), never 1.
inline float unit_float(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

class Sampler {
 public:
  Sampler() = default;
  Sampler(uint64_t seed, uint32_t stream, uint32_t index)
      : key_(hash32(seed, stream, 0x5eedu)), index_(index) {}

  vec2 next_2d();
  float next_1d();

 private:
  uint32_t key_ = 0, index_ = 0, dimension_ = 0;
};

namespace detail {
inline uint32_t reverse_bits(uint32_t x) {
#if defined(__clang__)
  return __builtin_bitreverse32(x);
#else
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
#endif
}
/// Laine-Karras permutation with Vegdahl's constants: each bit is flipped by the bits below it only.
inline uint32_t laine_karras(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}
inline uint32_t owen_scramble(uint32_t x, uint32_t seed) {
  return reverse_bits(laine_karras(reverse_bits(x), seed));
}
/// Second dimension of Sobol's sequence from the bit-reversed index. Its matrix is Pascal's triangle modulo 2: bit j of
/// the index reaches output digit i when C(j, i) is odd, which by Lucas means that i's bits are among j's. Summing over
/// subsets is a butterfly of five steps; on reversed bits each sends the lower half of a block into the upper one.
inline uint32_t sobol_second(uint32_t reversed) {
  uint32_t x = reversed;
  x ^= (x & 0x0000ffffu) << 16;
  x ^= (x & 0x00ff00ffu) << 8;
  x ^= (x & 0x0f0f0f0fu) << 4;
  x ^= (x & 0x33333333u) << 2;
  x ^= (x & 0x55555555u) << 1;
  return x;
}
}  // namespace detail

inline float Sampler::next_1d() {
  const uint32_t seed = hash32(key_ + dimension_++ * 0x9e3779b9u);
  // Shuffle which pass gets which point, then scramble the point: both are Owen permutations.
  const uint32_t index = detail::owen_scramble(index_, seed);
  return unit_float(detail::owen_scramble(detail::reverse_bits(index), hash32(seed)));
}

inline vec2 Sampler::next_2d() {
  const uint32_t seed = hash32(key_ + dimension_++ * 0x9e3779b9u);
  const uint32_t index = detail::owen_scramble(index_, seed);
  const uint32_t x = detail::reverse_bits(index), y = detail::sobol_second(x);
  return {unit_float(detail::owen_scramble(x, hash32(seed))),
          unit_float(detail::owen_scramble(y, hash32(seed ^ 0xa511e9b3u)))};
}

/// Uniform on the unit disk (Shirley and Chiu's concentric map).
vec2 concentric_disk(vec2 u);
/// Density cos(theta)/pi on the z > 0 hemisphere.
vec3 cosine_hemisphere(vec2 u);
/// Density 1/(4 pi).
vec3 uniform_sphere(vec2 u);
/// Uniform in the cone around +z with the given 1 - cos(half angle): exact for tiny cones.
vec3 uniform_cone(vec2 u, float one_minus_cos);
/// Barycentric coordinates, uniform over a triangle's area (Heitz 2019).
vec2 uniform_triangle(vec2 u);
inline float power_heuristic(float a, float b) { return a == 0 ? 0 : 1.0f / (1.0f + sqr(b / a)); }

/// Discrete distribution over non-negative weights; all zero makes it uniform, and a weight that is not a positive
/// finite number counts as zero. Probabilities are whole multiples of the spacing of `unit_float`, so `probability` is
/// exactly the share of u's that `sample` maps to an index, and every positive weight keeps at least one of them: no
/// light and no texel is lost to rounding, however dim it is beside the others.
class Discrete {
 public:
  Discrete() = default;
  explicit Discrete(std::span<const float> weights);
  /// Index drawn by u in [0,1); `u_out`, when given, is a fresh uniform number in [0,1).
  uint32_t sample(float u, float* u_out = nullptr) const;
  float probability(uint32_t index) const;
  uint32_t size() const { return static_cast<uint32_t>(first_.size() ? first_.size() - 1 : 0); }
  double total() const { return total_; }  ///< sum of the weights

 private:
  std::vector<uint32_t> first_;  ///< first cell of each index; the cells divide [0,1) evenly
  uint32_t bits_ = 24;           ///< 2^bits_ cells
  double total_ = 0;
};

/// Piecewise-constant density over the unit square from row-major weights.
class Piecewise2D {
 public:
  Piecewise2D() = default;
  Piecewise2D(std::span<const float> weights, int width, int height);
  vec2 sample(vec2 u, float* pdf) const;  ///< pdf over the unit square
  float pdf(vec2 p) const;

 private:
  int width_ = 0, height_ = 0;
  Discrete rows_;
  std::vector<Discrete> columns_;
};

}  // namespace zonal
