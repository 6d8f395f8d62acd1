#pragma once
/// What the tests of many-light methods share: scenes of one floor, lights made by hand, a turned and scaled
/// copy of a scene with its lights, a room that all of them agree on.

#include <glm/gtc/matrix_transform.hpp>

#include "integrators/many_lights.h"

namespace zonal::test {

/// p -> scale * turn * p + shift
struct Similarity {
  mat3 turn{1};
  float scale = 1;
  vec3 shift{0};
  vec3 point(vec3 p) const { return scale * (turn * p) + shift; }
};

/// The lights of the scene after the similarity: as bright, from as far in proportion.
inline VirtualLightSet transformed(VirtualLightSet set, const Similarity& s) {
  const auto transform = [&](VirtualLight& v) {
    v.position = s.point(v.position), v.shadow_point = s.point(v.shadow_point);
    v.normal = s.turn * v.normal, v.w_in = s.turn * v.w_in;
    v.frame.x = s.turn * v.frame.x, v.frame.y = s.turn * v.frame.y, v.frame.z = s.turn * v.frame.z;
    v.power *= sqr(s.scale), v.primary_distance *= s.scale, v.footprint *= sqr(s.scale);
  };
  for (VirtualLight& v : set.lights) transform(v);
  for (VirtualLight& v : set.texels) transform(v);
  return set;
}

/// A quadrilateral corner, corner + u, corner + u + v, corner + v of material number `material`.
struct Patch {
  vec3 corner, u, v;
  uint32_t material = 0;
};

/// Patches seen by `camera`, both moved by the similarity.
inline Scene scene_of(const std::vector<Patch>& patches, std::vector<std::unique_ptr<Material>> materials,
                      Camera camera, const Similarity& s = {}) {
  SceneParts parts;
  parts.materials = std::move(materials);
  for (const Patch& p : patches) {
    ShapeData shape;
    for (const vec3 corner : {p.corner, p.corner + p.u, p.corner + p.u + p.v, p.corner + p.v})
      shape.mesh.positions.push_back(s.point(corner));
    shape.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    shape.material = p.material;
    parts.shapes.push_back(std::move(shape));
  }
  camera.position = s.point(camera.position);
  camera.right = s.turn * camera.right, camera.up = s.turn * camera.up,
  camera.forward = s.turn * camera.forward;
  parts.camera = camera;
  return Scene(std::move(parts));
}

inline Camera camera_at(vec3 position, vec3 target, int size, float fov) {
  Camera camera;
  camera.position = position;
  camera.forward = glm::normalize(target - position);
  camera.right = glm::normalize(glm::cross(camera.forward, vec3(0, 1, 0.01f)));
  camera.up = glm::cross(camera.right, camera.forward);
  camera.vertical_fov = fov, camera.width = size, camera.height = size;
  return camera;
}

/// One light of the material's BRDF at `position`, lit from `w_in`.
inline VirtualLight light_at(vec3 position, vec3 normal, vec3 w_in, vec3 power, const Material& material) {
  VirtualLight v;
  v.position = position, v.normal = glm::normalize(normal), v.frame = Frame(v.normal);
  v.w_in = glm::normalize(w_in), v.power = power, v.bsdf = material.at({});
  v.shadow_point = offset_origin(v.position, v.normal, v.normal);
  v.primary_distance = 1;
  return v;
}

/// What the method makes of the scene at pixel centres, one pass for each seed.
inline Image image_of(const Scene& scene, ManyLights& method, int size, uint64_t seed = 0, int threads = 2) {
  Film film(size, size);
  render(scene, method, film, {.passes = 1}, {.seed = seed, .threads = threads});
  return film.radiance();
}

/// A box with a blocker, seen so that no pixel lies within half a metre of a corner, where 1/d^2 has no
/// finite variance.
inline std::string room(const std::string& material, const std::string& lights) {
  return R"({
    "camera": {"position": [0, 1, 1.9], "look_at": [0, 0.9, -2], "vertical_fov": 24, "resolution": [4, 4]},
    "materials": [{"name": "wall", )" +
         material + R"(}, {"name": "grey", "type": "lambert", "albedo": 0.5}],
    "objects": [{"name": "room", "type": "box", "low": [-1, 0, -2], "high": [1, 2, 2], "material": "wall"},
                {"name": "blocker", "type": "box", "low": [-0.6, 0, -1], "high": [-0.2, 0.5, -0.6], "material": "grey"}],
    "lights": [)" +
         lights + "]}";
}
inline const char* const kDiffuse = R"("type": "lambert", "albedo": 0.6)";
inline const char* const kGlossy = R"("type": "coated", "albedo": 0.4, "roughness": 0.7)";
inline const char* const kSphere =
    R"({"type": "sphere", "center": [0.3, 1.5, 0], "radius": 0.1, "radiance": 50})";
inline const char* const kSpot =
    R"({"type": "spot", "position": [0.3, 1.2, 1], "look_at": [0.9, 0.4, 0], "intensity": 9, "inner": 25, "outer": 40})";
inline const char* const kPoint = R"({"type": "point", "position": [0.3, 1.5, 0], "intensity": 2})";

}  // namespace zonal::test
