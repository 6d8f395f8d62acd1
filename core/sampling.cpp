#include "core/sampling.h"

#include <algorithm>
#include <bit>

namespace zonal {

namespace {
constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;  // the largest float below 1

/// Column or row of a coordinate in [0,1], the upper end included.
int cell_of(float x, int count) {
  return std::clamp(static_cast<int>(x * static_cast<float>(count)), 0, count - 1);
}
}  // namespace

vec2 concentric_disk(vec2 u) {
  // Shirley and Chiu 1997: squares map to circles, so neighbours stay neighbours.
  const vec2 p = 2.0f * u - vec2(1.0f);
  if (p.x == 0 && p.y == 0) return vec2(0);
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const float r = wide ? p.x : p.y;
  const float phi = wide ? kPi / 4 * (p.y / p.x) : kPi / 2 - kPi / 4 * (p.x / p.y);
  return r * vec2(std::cos(phi), std::sin(phi));
}

vec3 cosine_hemisphere(vec2 u) {
  // Malley's method: a uniform disk lifted to the hemisphere.
  const vec2 p = concentric_disk(u);
  return {p.x, p.y, safe_sqrt(1.0f - glm::dot(p, p))};
}

vec3 uniform_sphere(vec2 u) {
  const float r = 2.0f * safe_sqrt(u.x * (1.0f - u.x));
  const float phi = 2.0f * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), 1.0f - 2.0f * u.x};
}

vec3 uniform_cone(vec2 u, float one_minus_cos) {
  // sin^2 = (1 - cos)(1 + cos) keeps its digits where 1 - cos^2 has none.
  const float v = u.x * one_minus_cos;
  const float sine = safe_sqrt(v * (2.0f - v));
  const float phi = 2.0f * kPi * u.y;
  return {sine * std::cos(phi), sine * std::sin(phi), 1.0f - v};
}

vec2 uniform_triangle(vec2 u) {
  // Heitz 2019, "A Low-Distortion Map Between Triangle and Square": halves of the square fold onto the
  // triangle.
  if (u.y > u.x) {
    u.x *= 0.5f;
    u.y -= u.x;
  } else {
    u.y *= 0.5f;
    u.x -= u.y;
  }
  return u;
}

Discrete::Discrete(std::span<const float> weights) {
  const auto positive = [](float w) { return w > 0 && std::isfinite(w); };
  size_t count = 0;
  for (const float w : weights)
    if (positive(w)) total_ += w, ++count;

  // With more indices than that some would share the few cells unevenly: finer cells, found with made-up low
  // bits.
  if (weights.size() > (1u << 22)) bits_ = 31;
  const bool uniform = count == 0;
  const double sum = uniform ? static_cast<double>(weights.size()) : total_;
  if (uniform) count = weights.size();

  // One cell for every positive weight, the others shared in proportion.
  const double shared = std::ldexp(1.0, static_cast<int>(bits_)) - static_cast<double>(count);
  first_.reserve(weights.size() + 1);
  first_.push_back(0);
  double cumulative = 0;
  uint32_t kept = 0;
  for (const float w : weights) {
    if (uniform || positive(w)) cumulative += uniform ? 1.0 : w, ++kept;
    const double share = std::min(cumulative / sum, 1.0);
    first_.push_back(kept == count ? 1u << bits_ : kept + static_cast<uint32_t>(share * shared));
  }
}

uint32_t Discrete::sample(float u, float* u_out) const {
  if (first_.size() < 2) {
    if (u_out) *u_out = u;
    return 0;
  }
  // u has 24 bits; a hash of it makes up the digits below, which a choice among many would otherwise use up.
  const uint32_t below = hash32(std::bit_cast<uint32_t>(u));
  const double scaled = std::ldexp(static_cast<double>(u) + std::ldexp(below, -56), static_cast<int>(bits_));
  const uint32_t cell = std::min(static_cast<uint32_t>(std::max(scaled, 0.0)), (1u << bits_) - 1);
  const auto after = std::upper_bound(first_.begin() + 1, first_.end() - 1, cell);
  const auto index = static_cast<uint32_t>(after - first_.begin()) - 1;
  if (u_out) {
    const double width = static_cast<double>(first_[index + 1]) - first_[index];
    *u_out = std::clamp(static_cast<float>((scaled - first_[index]) / width), 0.0f, kOneMinusEpsilon);
  }
  return index;
}

float Discrete::probability(uint32_t index) const {
  if (index >= size()) return 0;
  return std::ldexp(static_cast<float>(first_[index + 1] - first_[index]), -static_cast<int>(bits_));
}

Piecewise2D::Piecewise2D(std::span<const float> weights, int width, int height)
    : width_(width), height_(height) {
  std::vector<float> sums;
  sums.reserve(static_cast<size_t>(height));
  columns_.reserve(static_cast<size_t>(height));
  for (int y = 0; y < height; ++y) {
    columns_.emplace_back(weights.subspan(static_cast<size_t>(y) * width, static_cast<size_t>(width)));
    sums.push_back(static_cast<float>(columns_.back().total()));
  }
  rows_ = Discrete(sums);
}

vec2 Piecewise2D::sample(vec2 u, float* pdf_out) const {
  vec2 inside;
  const uint32_t row = rows_.sample(u.y, &inside.y);
  const uint32_t column = columns_[row].sample(u.x, &inside.x);
  vec2 p((static_cast<float>(column) + inside.x) / static_cast<float>(width_),
         (static_cast<float>(row) + inside.y) / static_cast<float>(height_));
  p = glm::min(p, vec2(kOneMinusEpsilon));
  // Rounding can push p into the next cell: the density is that of the cell p says it is in.
  if (pdf_out) *pdf_out = pdf(p);
  return p;
}

float Piecewise2D::pdf(vec2 p) const {
  const auto row = static_cast<uint32_t>(cell_of(p.y, height_)),
             column = static_cast<uint32_t>(cell_of(p.x, width_));
  return rows_.probability(row) * columns_[row].probability(column) * static_cast<float>(width_) *
         static_cast<float>(height_);
}

}  // namespace zonal
