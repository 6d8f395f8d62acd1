#include "core/sampling.h"
#include "lights/light.h"

namespace zonal {

vec3 PointLight::power() const {
  return 4.0f * kPi * intensity;
}

LightSample PointLight::sample(vec3 x, vec2) const {
  LightSample s;
  const vec3 to_light = position - x;
  const float distance2 = glm::dot(to_light, to_light);
  // On the light itself there is no direction, and no finite irradiance; too far away, none is left.
  const vec3 irradiance = intensity / distance2;
  if (!(distance2 > 0) || is_black(irradiance) || !is_finite(irradiance)) return s;
  s.distance = std::sqrt(distance2);
  s.w_in = to_light / s.distance;
  s.radiance = irradiance;
  s.pdf = 1;
  s.delta = true;
  return s;
}

EmissionSample PointLight::sample_emission(vec2, vec2 u_direction) const {
  return {position, uniform_sphere(u_direction), power()};
}

float PointLight::importance(vec3 x) const {
  const vec3 to_light = position - x;
  // The floor keeps sums of importances finite; a micrometre is nearer than any surface is placed.
  return std::fmin(luminance(intensity) / std::fmax(glm::dot(to_light, to_light), 1e-12f), 1e30f);
}

}  // namespace zonal
