#include "lights/area_sampling.h"
#include "lights/shaped_lights.h"

namespace zonal {

TexturedLight::TexturedLight(vec3 lower_left, vec3 right, vec3 up, int columns, int rows,
                             std::vector<vec3> picture, bool both_sides)
    : corner(lower_left),
      u(right),
      v(up),
      width(columns),
      height(rows),
      texels(std::move(picture)),
      two_sided(both_sides) {
  const glm::dvec3 cross = glm::cross(glm::dvec3(u), glm::dvec3(v));
  normal_ = vec3(glm::normalize(cross)), area_ = float(glm::length(cross));
  std::vector<float> weights;
  glm::dvec3 sum(0);
  for (const vec3& radiance : texels) {
    weights.push_back(luminance(radiance)), brightest_ = std::max(brightest_, weights.back());
    sum += radiance;
  }
  mean_ = vec3(sum / double(texels.size()));
  distribution_ = Piecewise2D(weights, width, height);
}

vec3 TexturedLight::texel(vec2 p) const {
  const auto place = [](float t, int n) { return std::clamp(static_cast<int>(t * float(n)), 0, n - 1); };
  return texels[size_t(place(p.y, height)) * size_t(width) + size_t(place(p.x, width))];
}

vec3 TexturedLight::power() const {
  return mean_ * (kPi * area_ * (two_sided ? 2.0f : 1.0f));
}

LightSample TexturedLight::sample(vec3 x, vec2 random) const {
  LightSample s;
  if (!(brightest_ > 0)) return s;
  float density = 0;
  const vec2 p = distribution_.sample(random, &density);
  const vec3 to_light = corner + u * p.x + v * (1 - p.y) - x;
  const float distance2 = glm::dot(to_light, to_light);
  if (!(distance2 > 0)) return s;
  s.distance = std::sqrt(distance2);
  s.w_in = to_light / s.distance;
  s.radiance = texel(p);
  s.pdf = solid_angle_density(density / area_, normal_, s.w_in, distance2, two_sided);
  return s;
}

vec3 TexturedLight::radiance(const LightHit& hit, vec3 w) const {
  return two_sided || glm::dot(hit.normal, w) > 0 ? texel({hit.uv.x, 1 - hit.uv.y}) : vec3(0);
}

float TexturedLight::pdf(vec3 x, const LightHit& hit) const {
  const vec3 to_light = hit.position - x;
  const float distance2 = glm::dot(to_light, to_light);
  if (!(brightest_ > 0) || !(distance2 > 0)) return 0;
  const float density = distribution_.pdf(glm::clamp(vec2(hit.uv.x, 1 - hit.uv.y), 0.0f, 1.0f)) / area_;
  return solid_angle_density(density, hit.normal, to_light / std::sqrt(distance2), distance2, two_sided);
}

EmissionSample TexturedLight::sample_emission(vec2 u_position, vec2 u_direction) const {
  EmissionSample s;
  if (!(brightest_ > 0)) return s;
  float density = 0;
  const vec2 p = distribution_.sample(u_position, &density);
  s.power = texel(p) * (kPi * area_ * (two_sided ? 2.0f : 1.0f) / density);
  leave_surface(corner + u * p.x + v * (1 - p.y), normal_, two_sided, u_direction, &s);
  return s;
}

float TexturedLight::importance(vec3 x) const {
  // As that of mesh lights: a box never farther than the surface; pi L is the most any point of it can bring.
  Bounds box;
  for (const vec3 p : {corner, corner + u, corner + v, corner + u + v}) box.grow(p);
  const vec3 gap = glm::max(glm::max(box.low - x, x - box.high), vec3(0));
  return std::fmin(kPi * brightest_, luminance(mean_) * area_ / std::fmax(glm::dot(gap, gap), 1e-30f));
}

}  // namespace zonal
