#include "core/sampling.h"
#include "core/scene.h"
#include "lights/light.h"

/// Seen from distance d > r the ball fills a cone with
///   sin^2(a) = (r/d)^2,  cos(a) = sqrt((d - r)(d + r))/d,  1 - cos(a) = sin^2(a)/(1 + cos(a)) (SPHERE-1)
/// which keeps all digits for a far or tiny ball, where 1 - cos(a) itself has none left. A ray at angle t to
/// the axis meets it at
///   (d - r)(d + r) / (d cos(t) + sqrt(r^2 - d^2 sin^2(t))) (SPHERE-2)
/// the smaller root of its quadratic without the cancellation.

namespace zonal {

namespace {

/// 1 - cos of the cone the ball fills, 0 when it is too small for a density to be a float; d > r.
float cone_versine(float d, float r) {
  const float sine2 = sqr(r / d), cosine = safe_sqrt((d - r) * (d + r)) / d;
  const float versine = sine2 / (1.0f + cosine);  // (SPHERE-1)
  return versine > 1e-37f ? versine : 0.0f;
}

}  // namespace

vec3 SphereLight::power() const {
  return emission *
         ((two_sided ? 2.0f : 1.0f) * 4.0f * sqr(kPi * radius));  // pi L over 4 pi r^2, and again inside
}

LightSample SphereLight::sample(vec3 x, vec2 u) const {
  LightSample s;
  const vec3 to_center = center - x;
  const float d = glm::length(to_center);

  if (d > radius) {
    const float versine = cone_versine(d, radius);
    if (versine == 0 || !std::isfinite(d)) return s;
    const vec3 local = uniform_cone(u, versine);
    const float v = u.x * versine, sine = safe_sqrt(v * (2.0f - v));
    s.w_in = Frame(to_center / d).to_world(local);
    s.distance = (d - radius) * (d + radius) /
                 (d * local.z + safe_sqrt((radius - d * sine) * (radius + d * sine)));  // (SPHERE-2)
    s.radiance = emission;
    s.pdf = 1.0f / (2.0f * kPi * versine);
    return s;
  }

  // Inside: the far wall in every direction, if it shines inwards. A point of the wall itself sees it inwards
  // only.
  if (!two_sided) return s;
  s.w_in = uniform_sphere(u);
  const float b = glm::dot(to_center, s.w_in), gap = (radius - d) * (radius + d);
  const float root = std::sqrt(b * b + gap);
  s.distance = b > 0 ? b + root : gap / (root - b);
  if (!(s.distance > 0)) return s;
  s.radiance = emission;
  s.pdf = 0.25f * kInvPi;
  return s;
}

vec3 SphereLight::radiance(const LightHit& hit, vec3 w) const {
  return two_sided || glm::dot(hit.normal, w) > 0 ? emission : vec3(0);
}

float SphereLight::pdf(vec3 x, const LightHit&) const {
  const float d = glm::length(center - x);
  if (d <= radius) return two_sided ? 0.25f * kInvPi : 0.0f;
  const float versine = cone_versine(d, radius);
  return versine > 0 && std::isfinite(d) ? 1.0f / (2.0f * kPi * versine) : 0.0f;
}

EmissionSample SphereLight::sample_emission(vec2 u_position, vec2 u_direction) const {
  vec3 normal = uniform_sphere(u_position);
  const vec3 point = center + radius * normal;
  // Half the flux of a two-sided ball goes inwards.
  if (two_sided) {
    const bool inwards = u_direction.x >= 0.5f;
    u_direction.x = 2.0f * u_direction.x - (inwards ? 1.0f : 0.0f);
    if (inwards) normal = -normal;
  }
  const vec3 direction = Frame(normal).to_world(cosine_hemisphere(u_direction));
  return {offset_origin(point, normal, direction), direction, power()};
}

float SphereLight::importance(vec3 x) const {
  const vec3 to_center = center - x;
  const float d2 = glm::dot(to_center, to_center);
  // The same test as in `sample`: dark exactly where that finds nothing.
  if (std::sqrt(d2) <= radius) return two_sided ? kPi * luminance(emission) : 0.0f;
  return kPi * luminance(emission) * std::fmin(1.0f, sqr(radius / std::sqrt(d2)));
}

}  // namespace zonal
