#include <algorithm>

#include "core/sampling.h"
#include "lights/light.h"

/// The cone's edge in terms of v = 1 - cos(angle) = 2 sin^2(angle/2), which keeps its digits for a laser's
/// thin cone where the cosine is 1 to float precision. With v_i, v_o at the inner and outer angle and t =
/// (v_o - v)/(v_o - v_i):
///   falloff = t^2 (3 - 2t)                                  (SPOT-1)
///   integral over the sphere = 2 pi (v_i + (v_o - v_i)/2)   (SPOT-2)   because t^2 (3 - 2t) integrates to
///   1/2

namespace zonal {

namespace {

float versine(float angle) {
  return 2.0f * sqr(std::sin(0.5f * angle));
}

/// 1 - cos of the angle between two unit vectors, from their difference.
float versine_between(vec3 a, vec3 b) {
  return 0.5f * glm::dot(a - b, a - b);
}

/// Inverts the cumulative 2 t^3 - t^4 of the density 2 t^2 (3 - 2t) by bisection: it has no simple inverse.
float sample_edge(float u) {
  float low = 0, high = 1;
  for (int step = 0; step < 24; ++step) {
    const float t = 0.5f * (low + high);
    (t * t * t * (2.0f - t) < u ? low : high) = t;
  }
  return 0.5f * (low + high);
}

}  // namespace

SpotCone::SpotCone(float inner_angle, float outer_angle)
    : inner(std::clamp(inner_angle, 0.0f, std::max(outer_angle, 0.0f))),
      outer(std::max(outer_angle, 0.0f)),
      v_inner(versine(inner)),
      v_outer(versine(outer)),
      v_edge(2.0f * std::sin(0.5f * (outer + inner)) * std::sin(0.5f * (outer - inner))) {}

float SpotCone::falloff(float v) const {
  if (v <= v_inner) return 1;
  if (v >= v_outer) return 0;
  const float t = std::clamp((v_outer - v) / v_edge, 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);  // (SPOT-1)
}

float SpotCone::solid_angle() const {
  return 2.0f * kPi * (v_inner + 0.5f * v_edge);  // (SPOT-2)
}

float SpotLight::falloff(float cos_angle) const {
  return falloff_versine(1.0f - cos_angle);
}

float SpotLight::falloff_versine(float one_minus_cos) const {
  return cone.falloff(one_minus_cos);
}

vec3 SpotLight::power() const {
  return intensity * cone.solid_angle();
}

LightSample SpotLight::sample(vec3 x, vec2) const {
  LightSample s;
  const vec3 to_light = position - x;
  const float distance2 = glm::dot(to_light, to_light);
  if (!(distance2 > 0)) return s;
  const float distance = std::sqrt(distance2);
  const vec3 w_in = to_light / distance;
  const vec3 irradiance = intensity * (cone.falloff(versine_between(-w_in, direction)) / distance2);
  if (is_black(irradiance) || !is_finite(irradiance)) return s;
  s.distance = distance;
  s.w_in = w_in;
  s.radiance = irradiance;
  s.pdf = 1;
  s.delta = true;
  return s;
}

EmissionSample SpotLight::sample_emission(vec2, vec2 u) const {
  // Density proportional to the falloff: every ray carries the same flux. First the full cone or its edge ...
  const float full = cone.v_inner, edge = 0.5f * cone.v_edge;
  const float split = full + edge > 0 ? full / (full + edge) : 1.0f;
  const float v = u.x < split ? full * (u.x / split)
                              : cone.v_outer - cone.v_edge * sample_edge((u.x - split) / (1.0f - split));
  // ... then the azimuth.
  const float sine = safe_sqrt(v * (2.0f - v)), phi = 2.0f * kPi * u.y;
  const vec3 local(sine * std::cos(phi), sine * std::sin(phi), 1.0f - v);
  return {position, Frame(direction).to_world(local), power()};
}

float SpotLight::importance(vec3 x) const {
  const vec3 from_light = x - position;
  const float distance2 = glm::dot(from_light, from_light);
  // At the tip itself the direction is undefined: take the axis.
  const float share = distance2 > 0
                          ? cone.falloff(versine_between(from_light / std::sqrt(distance2), direction))
                          : 1.0f;
  return std::fmin(luminance(intensity) * share / std::fmax(distance2, 1e-12f), 1e30f);
}

}  // namespace zonal
