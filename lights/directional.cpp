#include "core/sampling.h"
#include "lights/light.h"

namespace zonal {

vec3 DirectionalLight::power() const {
  return irradiance * (kPi * sqr(bounds.radius));
}

LightSample DirectionalLight::sample(vec3, vec2) const {
  LightSample s;
  s.w_in = -direction;
  s.distance = kInfinity;
  s.radiance = irradiance;
  s.pdf = 1;
  s.delta = true;
  return s;
}

EmissionSample DirectionalLight::sample_emission(vec2 u_position, vec2) const {
  // A disk as wide as the scene, a hair outside it: a surface may touch the bounding sphere.
  const vec2 p = concentric_disk(u_position) * bounds.radius;
  const Frame frame(-direction);
  const vec3 origin = bounds.center + frame.x * p.x + frame.y * p.y + frame.z * (1.001f * bounds.radius);
  return {origin, direction, power()};
}

float DirectionalLight::importance(vec3) const {
  return std::fmin(luminance(irradiance), 1e30f);
}

}  // namespace zonal
