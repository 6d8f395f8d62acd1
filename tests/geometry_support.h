#pragma once
/// Small shapes, reproducible random numbers and slow, plain ray tests in double: what the geometry tests
/// compare with.

#include <vector>

#include "core/sampling.h"
#include "core/scene.h"

namespace zonal::test {

class HashRandom {
 public:
  explicit HashRandom(uint32_t seed) : seed_(seed) {}
  uint32_t bits() { return hash32(seed_, count_++); }
  float number() { return unit_float(bits()); }
  vec3 vector() { return {number(), number(), number()}; }  ///< in the unit cube
  vec3 direction() { return glm::normalize(uniform_sphere({number(), number()})); }

 private:
  uint32_t seed_, count_ = 0;
};

inline ShapeData sphere(vec3 center, float radius) {
  ShapeData s;
  s.name = "sphere";
  s.center = center, s.radius = radius;
  return s;
}

/// Normal u x v; uv runs from 0 to 1 along u and v.
inline ShapeData quad(vec3 corner, vec3 u, vec3 v) {
  ShapeData s;
  s.name = "quad";
  s.mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  s.mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  s.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return s;
}

inline ShapeData box(vec3 low, vec3 high) {
  ShapeData s;
  s.name = "box";
  for (int i = 0; i < 8; ++i) {
    s.mesh.positions.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  }
  s.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return s;
}

/// Triangles of about half a metre in and around the unit cube.
inline ShapeData triangle_soup(int count, HashRandom& random) {
  ShapeData s;
  s.name = "soup";
  for (uint32_t i = 0; i < uint32_t(count); ++i) {
    const vec3 middle = random.vector();
    for (int k = 0; k < 3; ++k) s.mesh.positions.push_back(middle + 0.5f * (random.vector() - 0.5f));
    s.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return s;
}

inline SceneParts one_shape(ShapeData shape) {
  SceneParts parts;
  parts.shapes.push_back(std::move(shape));
  return parts;
}
inline SceneParts sphere_scene(vec3 center, float radius) {
  return one_shape(sphere(center, radius));
}

/// Distances > 0 at which the ray meets the triangles, each solved as a 3 x 3 system by Cramer's rule.
inline std::vector<double> brute_force(const MeshData& mesh, vec3 origin, vec3 direction) {
  std::vector<double> found;
  for (const uvec3 t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), e1 = glm::dvec3(mesh.positions[t.y]) - a,
                                             e2 = glm::dvec3(mesh.positions[t.z]) - a, d(direction),
                                             o = glm::dvec3(origin) - a;
    const double det = glm::dot(glm::cross(e1, e2), d);
    const double distance = -glm::dot(glm::cross(e1, e2), o) / det;
    const double u = glm::dot(glm::cross(o, e2), d) / det, v = glm::dot(glm::cross(e1, o), d) / det;
    if (distance > 0 && u >= 0 && v >= 0 && u + v <= 1) found.push_back(distance);
  }
  return found;
}

/// Both distances, where > 0, from the quadratic formula.
inline std::vector<double> sphere_roots(glm::dvec3 center, double radius, vec3 origin, vec3 direction) {
  const glm::dvec3 oc = glm::dvec3(origin) - center, d(direction);
  const double a = glm::dot(d, d), b = glm::dot(oc, d), c = glm::dot(oc, oc) - radius * radius;
  std::vector<double> found;
  if (b * b - a * c <= 0) return found;
  for (const double sign : {-1.0, 1.0}) {
    const double t = (-b + sign * std::sqrt(b * b - a * c)) / a;
    if (t > 0) found.push_back(t);
  }
  return found;
}

}  // namespace zonal::test
