#pragma once
/// The scene as every method sees it: immutable after loading, Embree inside.
///
///     Scene scene = load_scene("scenes/cornell/cornell.json");       // core/scene_loader.h
///     Hit hit = scene.intersect(origin, direction);
///     if (hit.found()) { Surface s = scene.surface(hit, direction); Bsdf f = scene.bsdf(s); }
///
/// World: right-handed, y up, metres.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "lights/light.h"
#include "materials/material.h"

namespace zonal {

/// Pinhole. Pixel (0,0) is the top left; a point of the film is in pixels, pixel centres at +0.5.
struct Camera {
  vec3 position{0}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< orthonormal
  float vertical_fov = 0.9f;                                          ///< radians, full angle
  int width = 640, height = 360;                                      ///< pixels
  float exposure = 1;  ///< linear factor applied before the display transform

  /// Unit direction through the film point.
  vec3 direction(vec2 film) const;
};

struct Hit {
  float t = kInfinity;  ///< metres along the ray
  uint32_t shape = kNone, primitive = kNone;
  float u = 0, v = 0;  ///< barycentrics of the triangle's second and third vertex; a sphere's normal, octahedral
  bool found() const { return shape != kNone; }
};

/// Everything known of a hit point but its textures' values.
struct Surface {
  vec3 position{0};
  vec3 normal{0, 0, 1};  ///< geometric, unit, on the side the ray came from
  Frame shading;         ///< shading frame after normal mapping, on the same side
  vec3 w_out{0, 0, 1};   ///< unit, towards where the ray came from, world
  vec2 uv{0};
  float error = 0;  ///< metres: how far rounding may put the point, or the next hit of its triangle, off the surface
  uint32_t shape = kNone, primitive = kNone, material = kNone;  ///< primitive: as the loader numbered it
  uint32_t light = kNone;  ///< index into Scene::lights() when the surface glows
  bool front = true;       ///< the ray met the side the winding (counter-clockwise) or the sphere's outside shows

  LightHit light_hit() const { return {position, front ? normal : -normal, uv, primitive}; }
};

/// A mesh as the loader hands it over. Arrays are per vertex; normals and uvs may be empty.
struct MeshData {
  std::string name;
  std::vector<vec3> positions, normals;
  std::vector<vec2> uvs;
  std::vector<uvec3> triangles;
};

/// One shape: a mesh or a sphere, with its material and, when it glows, its light.
struct ShapeData {
  std::string name;
  MeshData mesh;             ///< used when radius == 0
  vec3 center{0};
  float radius = 0;          ///< > 0: a sphere
  uint32_t material = kNone;
  uint32_t light = kNone;
};

/// What the loader fills and the Scene takes over.
struct SceneParts {
  std::string name;
  Camera camera;
  std::vector<ShapeData> shapes;
  std::vector<std::unique_ptr<Texture>> textures;
  std::vector<std::unique_ptr<Material>> materials;
  std::vector<std::unique_ptr<Light>> lights;
  uint32_t environment = kNone;  ///< index into lights
  std::vector<std::string> notes;  ///< one line each: what the loader dropped or guessed
};

struct Shape;  // core/scene_impl.h

class Scene {
 public:
  /// Builds the acceleration structure. Zero-area triangles are dropped and counted in `notes()`; indices out of range
  /// and NaN vertices throw SceneError naming the shape.
  explicit Scene(SceneParts parts);
  ~Scene();
  Scene(Scene&&) noexcept;

  const std::string& name() const;
  const Camera& camera() const;
  const std::vector<std::unique_ptr<Light>>& lights() const;
  const LightSelector& light_selector() const;
  const std::vector<std::unique_ptr<Material>>& materials() const;
  const Light* environment() const;  ///< null when there is none
  uint32_t environment_index() const;
  BoundingSphere bounds() const;  ///< of all surfaces; radius 1 around the camera when there are none
  const std::vector<std::string>& notes() const;
  size_t triangle_count() const;
  /// The shapes as they were laid out for tracing: what a copy for another machine (a GPU) is made from.
  std::span<const Shape> shapes() const;

  /// Nearest hit in (t_min, t_max). Cut-away (masked) surfaces are passed through.
  Hit intersect(vec3 origin, vec3 direction, float t_min = 0, float t_max = kInfinity) const;
  bool occluded(vec3 origin, vec3 direction, float t_min, float t_max) const;
  /// Whether anything stands between a surface point and another point; both ends are moved off their surfaces.
  bool occluded(const Surface& from, vec3 to) const;
  /// Up to 8 shadow rays at once, all towards `to`, from origins already moved off their surfaces (offset_origin).
  /// `active` bit i: ray i is wanted. Returns the bits of the rays that are blocked.
  uint32_t occluded8(const vec3* origins, uint32_t active, vec3 to) const;
  /// The same with an end of its own for each ray.
  uint32_t occluded8(const vec3* origins, uint32_t active, const vec3* to) const;
  /// Every hit along the ray, each triangle once, nearest first: for transport without occlusion.
  void intersect_all(vec3 origin, vec3 direction, float t_min, std::vector<Hit>* hits) const;

  /// `direction` is the ray's, unit.
  Surface surface(const Hit& hit, vec3 direction) const;
  Bsdf bsdf(const Surface& s) const { return material(s.material).at(s.uv); }
  /// `surface` and `bsdf` of many hits at once, `directions` being their rays'; where nothing was hit the outputs are
  /// left as they are. Faster than one by one: each step asks the cache for what the next will read.
  void look_up(const Hit* hits, const vec3* directions, int count, Surface* surfaces, Bsdf* bsdfs) const;
  const Material& material(uint32_t index) const;
  /// Emitted radiance towards w_out; 0 where the surface does not glow.
  vec3 emitted(const Surface& s) const;

  /// The Embree scene, for benchmarks that want the raw ray rate (an RTCScene).
  void* embree() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A ray origin moved off the surface towards `w`, far enough that the surface is not met again in float. The second
/// form guesses the triangle's size from the position: prefer the first where there is a Surface.
vec3 offset_origin(const Surface& s, vec3 w);
vec3 offset_origin(vec3 position, vec3 normal, vec3 w);

}  // namespace zonal
