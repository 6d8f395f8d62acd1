#pragma once
/// Inside of Scene: what the builder lays out and the ray queries read. Not for methods.

#include <mutex>
#include <vector>

#include "core/embree.h"
#include "core/huge_pages.h"
#include "core/scene.h"

namespace zonal {

/// A mesh vertex as Embree and `surface` share it: half a cache line.
struct alignas(32) Vertex {
  vec3 position{0};
  vec3 normal{0};  ///< zero: use the triangle's
  vec2 uv{0};
};

using Vertices = std::vector<Vertex, HugePages<Vertex>>;
using Triangles = std::vector<uvec3, HugePages<uvec3>>;

/// One shape, flat: no virtual calls and few indirections between a hit and its surface.
struct Shape {
  const Vertex* vertices = nullptr;
  const uvec3* triangles = nullptr;
  const uint32_t* original =
      nullptr;  ///< triangle numbers before zero-area ones were dropped; null: none were
  const Material* material = nullptr;
  const Texture* normal_map = nullptr;
  const Texture* first_texture = nullptr;  ///< what the material will read
  float normal_scale = 1;
  vec3 center{0};
  float radius = 0;  ///< > 0: a sphere
  uint32_t index = 0, material_index = kNone, light = kNone;
  uint32_t vertex_count = 0, triangle_count = 0;
  bool has_normals = false, has_uvs = false;
  bool has_tangents = false;  ///< something needs the direction of u: a normal map or an anisotropic material
  bool has_mask = false;

  vec2 uv(uint32_t primitive, float u, float v) const {
    const uvec3 t = triangles[primitive];
    return (1 - u - v) * vertices[t.x].uv + u * vertices[t.y].uv + v * vertices[t.z].uv;
  }
};

/// A context that also carries where `intersect_all` puts its hits.
struct CollectingContext {
  embree::Context context;  ///< first: Embree hands back a pointer to it
  std::vector<Hit>* hits = nullptr;
};

struct Scene::Impl {
  std::string name;
  Camera camera;
  std::vector<Shape> shapes;
  std::vector<Vertices> vertices;               ///< by shape
  std::vector<Triangles> triangles;             ///< by shape
  std::vector<std::vector<uint32_t>> original;  ///< by shape; mostly empty
  std::vector<std::unique_ptr<Texture>> textures;
  std::vector<std::unique_ptr<Material>> materials;
  std::vector<std::unique_ptr<Light>> lights;
  LightSelector selector;
  BoundingSphere bounds;
  uint32_t environment = kNone;
  std::vector<std::string> notes;
  size_t triangle_count = 0;

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  /// The same surfaces with filters that collect every hit. Built when first asked for; kept apart so that
  /// other rays run without filters, and without spatial splits, so that a triangle is met once.
  mutable std::once_flag collector_built;
  mutable RTCScene collector = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  void take(SceneParts parts);  ///< checks and packs the shapes
  void find_bounds();
  RTCScene build(bool collecting) const;
  RTCScene collecting_scene() const;
};

/// What a masked triangle geometry asks for each hit; in scene_filters.cpp.
void skip_masked(const RTCFilterFunctionNArguments* arguments);
void collect_hits(const RTCFilterFunctionNArguments* arguments);

}  // namespace zonal
