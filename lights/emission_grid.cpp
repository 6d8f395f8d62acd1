#include "lights/emission_grid.h"

#include <algorithm>
#include <cassert>

namespace zonal {

namespace {

constexpr float kWidestCone = 80 * kPi / 180;  ///< half angle; the plane's corners carry cos^3 = 0.2 % there

/// The frame whose z looks through face 0..5 of a cube.
Frame cube_face(int face) {
  vec3 axis(0);
  axis[face / 2] = face % 2 ? -1.0f : 1.0f;
  return Frame(axis);
}

}  // namespace

bool EmissionGrid::suits(const Light& light) {
  if (const auto* spot = dynamic_cast<const SpotLight*>(&light)) return spot->cone.outer <= kWidestCone;
  return dynamic_cast<const PointLight*>(&light) || dynamic_cast<const DirectionalLight*>(&light);
}

EmissionGrid::EmissionGrid(const Light& light, double cells) : light_(&light) {
  assert(suits(light));
  if (dynamic_cast<const PointLight*>(&light)) faces_ = 6;
  const double per_face = std::clamp(cells / faces_, 1.0, 1e8);
  columns_ = std::max(1, static_cast<int>(std::lround(std::sqrt(per_face))));
  rows_ = std::max(1, static_cast<int>(std::lround(per_face / columns_)));
}

EmissionSample EmissionGrid::sample(int cell, vec2 u) const {
  const int face = cell / (columns_ * rows_), row = cell / columns_ % rows_, column = cell % columns_;
  // The point of the square [-1,1]^2, and the cell's share of its area of 4.
  const vec2 p(2.0f * (static_cast<float>(column) + u.x) / static_cast<float>(columns_) - 1.0f,
               2.0f * (static_cast<float>(row) + u.y) / static_cast<float>(rows_) - 1.0f);
  const float area = 4.0f / (static_cast<float>(columns_) * static_cast<float>(rows_));
  const auto through = [](const Frame& frame, vec2 q) {
    return glm::normalize(frame.to_world({q.x, q.y, 1.0f}));
  };

  EmissionSample s;
  if (const auto* sun = dynamic_cast<const DirectionalLight*>(light_)) {
    const float radius = sun->bounds.radius;
    const Frame frame(-sun->direction);
    s.direction = sun->direction;
    s.origin = sun->bounds.center + radius * (frame.x * p.x + frame.y * p.y + frame.z * 1.001f);
    // Rays outside the disk pass the scene by.
    if (glm::dot(p, p) <= 1.0f) s.power = sun->irradiance * (area * sqr(radius));  // (GRID-2)
    return s;
  }

  if (const auto* point = dynamic_cast<const PointLight*>(light_)) {
    s.origin = point->position;
    s.direction = through(cube_face(face), p);
    s.power = point->intensity * (area / std::pow(1.0f + glm::dot(p, p), 1.5f));  // (GRID-1)
    return s;
  }

  const auto& spot = static_cast<const SpotLight&>(*light_);
  const float width = std::tan(spot.cone.outer);
  const vec2 q = width * p;
  const float q2 = glm::dot(q, q), secant = std::sqrt(1.0f + q2);
  s.origin = spot.position;
  s.direction = through(Frame(spot.direction), q);
  // 1 - cos without cancellation: (secant - 1)/secant = q^2 / (secant (secant + 1)).
  const float versine = q2 / (secant * (secant + 1.0f));
  s.power = spot.intensity *
            (spot.falloff_versine(versine) * area * sqr(width) / (secant * secant * secant));  // (GRID-1)
  return s;
}

}  // namespace zonal
