#include "integrators/tile_bounds.h"

#include <algorithm>

namespace zonal {

namespace {

/// Rounding of positions and products, as a share of distances: what counts as behind must be so by more than
/// that.
constexpr float kSlack = 1e-5f;

}  // namespace

TileBounds::TileBounds(const TilePoints& points) {
  Bounds box;
  vec3 sum(0);
  for (int k = 0; k < points.count; ++k) {
    box.grow(points.position(k));
    sum += vec3(points.gx[k], points.gy[k], points.gz[k]);
  }
  center = box.center();
  const float length = glm::length(sum);
  if (length > 0) axis = sum / length;
  cosine = length > 0 ? 1.0f : -1.0f;
  for (int k = 0; k < points.count; ++k) {
    radius = std::max(radius, glm::distance(center, points.position(k)));
    cosine = std::min(cosine, glm::dot(axis, vec3(points.gx[k], points.gy[k], points.gz[k])));
  }
  sine = safe_sqrt(1 - cosine * cosine);
  if (!(cosine > -1)) sine = 0;
}

float TileBounds::highest(vec3 to, float length) const {
  // To `to` itself when it lies in the cone, else turned to the cone's edge.
  const float along = glm::dot(axis, to);
  if (along >= cosine * length) return length;
  return along * cosine + safe_sqrt(length * length - along * along) * sine;
}

bool TileBounds::sees(vec3 position, vec3 normal, float light_radius) const {
  const vec3 to = position - center;
  const float d = glm::length(to), slack = radius + light_radius + kSlack * (d + radius + light_radius);
  return slack - glm::dot(normal, to) >= 0 && highest(to, d) + slack >= 0;
}

TileBounds::Reach TileBounds::reach(vec3 position, vec3 normal, float light_radius) const {
  const vec3 to = position - center;
  const float d = glm::length(to), slack = radius + light_radius + kSlack * (d + radius + light_radius);
  const float nearest = d - slack;
  const auto cosine_of = [&](float height) {
    return nearest > 0 ? std::clamp((height + slack) / nearest, 0.0f, 1.0f) : 1.0f;
  };
  return {std::max(0.0f, nearest + light_radius), cosine_of(-glm::dot(normal, to)),
          cosine_of(highest(to, d))};
}

Reflection largest_reflection(const Bsdf& b, const BsdfContext& view, Lobes lobes) {
  const bool specular = has(lobes, Lobes::specular);
  const float base = has(lobes, Lobes::diffuse) ? max_component(b.diffuse) : 0.0f;
  switch (b.kind) {
    case BsdfKind::black:
      return {};
    case BsdfKind::lambert:
      return {base * kInvPi, 0};
    case BsdfKind::blinn_phong:
      return {base * kInvPi + (specular ? max_component(b.specular) * view.normalization : 0.0f), 0};
    case BsdfKind::conductor:
    case BsdfKind::coated:
    case BsdfKind::metallic_roughness: {
      // D at its peak (at the normal; where a width exceeds 1, along it), Fresnel 1, and cos_in / (2 (cos_out
      // stretch_in + cos_in stretch_out)) < 1/(2 stretch_out).
      const float widest = std::max({1.0f, b.alpha_x, b.alpha_y});
      const float peak = kInvPi / (b.alpha_x * b.alpha_y) * sqr(sqr(widest)) * 0.5f / view.stretch_out;
      return {base * view.normalization, specular ? peak : 0.0f};
    }
    case BsdfKind::measured:
      break;
  }
  return {0, kInfinity};
}

}  // namespace zonal
