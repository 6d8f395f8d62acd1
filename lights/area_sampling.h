#pragma once
/// What lights share whose surface is sampled by area.

#include "core/sampling.h"
#include "core/scene.h"

namespace zonal {

/// From a density by area (m^-2) to one by solid angle (1/sr), sqrt(distance2) metres away along w_in; 0
/// where the surface is edge-on or its dark side is seen.
inline float solid_angle_density(float density, vec3 normal, vec3 w_in, float distance2, bool two_sided) {
  const float facing = -glm::dot(normal, w_in);
  const float cosine = two_sided ? std::abs(facing) : facing;
  if (!(cosine > 0)) return 0;
  const float pdf = density * distance2 / cosine;
  return std::isfinite(pdf) ? pdf : 0.0f;
}

/// A cosine-weighted ray off the surface; off either side by half of `u.x`, where both shine.
inline void leave_surface(vec3 position, vec3 normal, bool two_sided, vec2 u, EmissionSample* s) {
  if (two_sided) {
    const bool back = u.x >= 0.5f;
    u.x = 2.0f * u.x - (back ? 1.0f : 0.0f);
    if (back) normal = -normal;
  }
  s->direction = Frame(normal).to_world(cosine_hemisphere(u));
  s->origin = offset_origin(position, normal, s->direction);
}

}  // namespace zonal
