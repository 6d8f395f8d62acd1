#include <utility>

#include "lights/area_sampling.h"
#include "lights/light.h"

namespace zonal {

struct MeshLight::Impl {
  struct Face {
    vec3 a, ab, ac, normal;
    float density = 0;  ///< of sampling a point of the face, m^-2; 0 for a face without area
  };
  std::vector<Face> faces;
  Discrete by_area;
  Bounds bounds;
  vec3 emission{0};
  bool two_sided = false;
  float area = 0;  ///< m^2

  /// A point of the surface; false when there is no surface.
  bool sample_point(vec2 u, vec3* position, const Face** face) const {
    if (!(area > 0)) return false;
    const uint32_t index = by_area.sample(u.x, &u.x);
    const vec2 b = uniform_triangle(u);
    *face = &faces[index];
    *position = (*face)->a + (*face)->ab * b.x + (*face)->ac * b.y;
    return true;
  }
};

MeshLight::MeshLight(std::vector<Triangle> triangles, vec3 emission, bool two_sided) {
  auto impl = std::make_shared<Impl>();
  impl->emission = emission, impl->two_sided = two_sided;
  std::vector<float> areas;
  areas.reserve(triangles.size()), impl->faces.reserve(triangles.size());
  double total = 0;
  for (const Triangle& t : triangles) {
    // In double the cross product of float edges is nearly exact: slivers get their true area, flat ones
    // exactly 0.
    const glm::dvec3 ab = glm::dvec3(t.b) - glm::dvec3(t.a), ac = glm::dvec3(t.c) - glm::dvec3(t.a);
    const glm::dvec3 cross = glm::cross(ab, ac);
    const double twice = glm::length(cross);
    const float area = static_cast<float>(0.5 * twice);
    const bool usable = area > 0 && std::isfinite(area);
    impl->faces.push_back({t.a, vec3(ab), vec3(ac), usable ? vec3(cross / twice) : vec3(0, 0, 1), 0.0f});
    areas.push_back(usable ? area : 0.0f);
    if (!usable) continue;
    total += area;
    impl->bounds.grow(t.a), impl->bounds.grow(t.b), impl->bounds.grow(t.c);
  }
  impl->area = static_cast<float>(total);
  impl->by_area = Discrete(areas);
  for (uint32_t i = 0; i < areas.size(); ++i)
    if (areas[i] > 0) impl->faces[i].density = impl->by_area.probability(i) / areas[i];
  impl_ = std::move(impl);
}

float MeshLight::area() const {
  return impl_->area;
}

vec3 MeshLight::power() const {
  return impl_->emission * (kPi * impl_->area * (impl_->two_sided ? 2.0f : 1.0f));
}

LightSample MeshLight::sample(vec3 x, vec2 u) const {
  LightSample s;
  vec3 position;
  const Impl::Face* face = nullptr;
  if (!impl_->sample_point(u, &position, &face)) return s;
  const vec3 to_light = position - x;
  const float distance2 = glm::dot(to_light, to_light);
  if (!(distance2 > 0)) return s;
  const float distance = std::sqrt(distance2);
  const vec3 w_in = to_light / distance;
  const float pdf = solid_angle_density(face->density, face->normal, w_in, distance2, impl_->two_sided);
  if (!(pdf > 0)) return s;
  s.w_in = w_in;
  s.distance = distance;
  s.radiance = impl_->emission;
  s.pdf = pdf;
  return s;
}

vec3 MeshLight::radiance(const LightHit& hit, vec3 w) const {
  return impl_->two_sided || glm::dot(hit.normal, w) > 0 ? impl_->emission : vec3(0);
}

float MeshLight::pdf(vec3 x, const LightHit& hit) const {
  if (!(impl_->area > 0)) return 0;
  const float density =
      hit.primitive < impl_->faces.size() ? impl_->faces[hit.primitive].density : 1.0f / impl_->area;
  const vec3 to_light = hit.position - x;
  const float distance2 = glm::dot(to_light, to_light);
  if (!(distance2 > 0)) return 0;
  return solid_angle_density(density, hit.normal, to_light / std::sqrt(distance2), distance2,
                             impl_->two_sided);
}

EmissionSample MeshLight::sample_emission(vec2 u_position, vec2 u_direction) const {
  EmissionSample s;
  const Impl::Face* face = nullptr;
  if (!impl_->sample_point(u_position, &s.origin, &face)) return s;
  // Faces are drawn with p_i, not exactly area_i/area: the ratio corrects the last digits.
  s.power = power() / (face->density * impl_->area);
  leave_surface(s.origin, face->normal, impl_->two_sided, u_direction, &s);
  return s;
}

float MeshLight::importance(vec3 x) const {
  if (!(impl_->area > 0)) return 0;
  // Distance to the box of the triangles: never more than to the surface. pi L is the most any surface can
  // bring.
  const vec3 gap = glm::max(glm::max(impl_->bounds.low - x, x - impl_->bounds.high), vec3(0));
  const float d2 = glm::dot(gap, gap);
  return luminance(impl_->emission) * std::fmin(kPi, impl_->area / std::fmax(d2, 1e-30f));
}

}  // namespace zonal
