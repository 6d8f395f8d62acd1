#include "gl/scene_buffers.h"

#include <fmt/format.h>

#include <map>

#include "core/error.h"
#include "core/scene_impl.h"
#include "gl/units.h"
#include "lights/shaped_lights.h"

namespace zonal::gl {

struct SceneBuffers::Staging {
  std::vector<vec4> vertices, shapes, materials, texels;
  std::vector<uint32_t> triangles, spheres, textures;
  std::map<const Texture*, int> known;

  /// Number of a texture in the table; -1 where there is none.
  float texture(const Texture* t) {
    if (!t) return -1;
    const auto [place, fresh] = known.try_emplace(t, static_cast<int>(known.size()));
    if (fresh) {
      textures.insert(textures.end(),
                      {static_cast<uint32_t>(texels.size()), static_cast<uint32_t>(t->width()),
                       static_cast<uint32_t>(t->height()), 0u});
      // A texel's centre gives the texel itself.
      for (int y = 0; y < t->height(); ++y)
        for (int x = 0; x < t->width(); ++x)
          texels.push_back(
              t->sample({(float(x) + 0.5f) / float(t->width()), 1 - (float(y) + 0.5f) / float(t->height())}));
    }
    return static_cast<float>(place->second);
  }
};

namespace {

// What gl/scene.glsl calls SHAPE_...
constexpr uint32_t kNormals = 1, kUvs = 2, kTangents = 4, kMask = 8;

/// Emission of both sides: of a shape's light towards its front and its back.
void emissions(const Scene& scene, uint32_t light, vec3* front, vec3* back) {
  *front = *back = vec3(0);
  if (light == kNone) return;
  LightHit hit;
  hit.normal = vec3(0, 0, 1);
  *front = scene.lights()[light]->radiance(hit, vec3(0, 0, 1));
  *back = scene.lights()[light]->radiance(hit, vec3(0, 0, -1));
  // The shaders know one radiance a side: a picture is shown as its mean.
  if (const auto* picture = dynamic_cast<const TexturedLight*>(scene.lights()[light].get()))
    *front = picture->mean(), *back = picture->two_sided ? *front : vec3(0);
}

}  // namespace

void SceneBuffers::add_geometry(const Scene& scene, Staging& s) {
  for (const Shape& shape : scene.shapes()) {
    const auto first_vertex = static_cast<uint32_t>(s.vertices.size() / 2);
    for (uint32_t i = 0; i < shape.vertex_count; ++i) {
      const Vertex& v = shape.vertices[i];
      s.vertices.emplace_back(v.position, v.uv.x);
      s.vertices.emplace_back(v.normal, v.uv.y);
    }
    const auto first_triangle = static_cast<uint32_t>(s.triangles.size() / 4);
    for (uint32_t i = 0; i < shape.triangle_count; ++i) {
      const uvec3 t = shape.triangles[i] + uvec3(first_vertex);
      s.triangles.insert(s.triangles.end(), {t.x, t.y, t.z, shape.index});
    }
    if (shape.radius > 0) s.spheres.push_back(shape.index);

    vec3 front, back;
    emissions(scene, shape.light, &front, &back);
    const uint32_t flags = (shape.has_normals ? kNormals : 0) | (shape.has_uvs ? kUvs : 0) |
                           (shape.has_tangents ? kTangents : 0) | (shape.has_mask ? kMask : 0);
    // A shape without a material is black: the material behind the last one.
    const uint32_t material =
        shape.material_index == kNone ? uint32_t(scene.materials().size()) : shape.material_index;
    s.shapes.emplace_back(shape.center, shape.radius);
    s.shapes.emplace_back(float(material), float(flags), float(first_triangle), 0.0f);
    s.shapes.emplace_back(front, 0.0f);
    s.shapes.emplace_back(back, 0.0f);
  }
  triangle_count_ = static_cast<int>(s.triangles.size() / 4);
  sphere_count_ = static_cast<int>(s.spheres.size());
}

/// Eight texels a material: see material_at in gl/material.glsl.
void SceneBuffers::add_material(const Material& material, Staging& s) {
  const Bsdf at_middle = material.at(vec2(0.5f));
  const float kind =
      static_cast<float>(at_middle.kind == BsdfKind::black ? BsdfKind::lambert : at_middle.kind);
  vec3 first(0), second(0), eta(1), k(0);
  float first_texture = -1, second_texture = -1, exponent = 1, aspect = 1, coat = -1;
  TexturedNumber metallic{0}, roughness{1};
  if (const auto* m = dynamic_cast<const LambertMaterial*>(&material)) {
    first = m->albedo.value, first_texture = s.texture(m->albedo.texture);
  } else if (const auto* m = dynamic_cast<const BlinnPhongMaterial*>(&material)) {
    first = m->diffuse.value, first_texture = s.texture(m->diffuse.texture);
    second = m->specular.value, second_texture = s.texture(m->specular.texture);
    exponent = at_middle.exponent;
  } else if (const auto* m = dynamic_cast<const ConductorMaterial*>(&material)) {
    first = m->tint.value, first_texture = s.texture(m->tint.texture), roughness = m->roughness;
    eta = at_middle.eta, k = at_middle.k;
  } else if (const auto* m = dynamic_cast<const CoatedMaterial*>(&material)) {
    first = m->albedo.value, first_texture = s.texture(m->albedo.texture), roughness = m->roughness;
    eta = at_middle.eta;
  } else if (const auto* m = dynamic_cast<const MetallicRoughnessMaterial*>(&material)) {
    first = m->base_color.value, first_texture = s.texture(m->base_color.texture);
    metallic = m->metallic, roughness = m->roughness;
  }
  aspect = at_middle.alpha_y / at_middle.alpha_x;
  if (at_middle.coat)
    coat = static_cast<float>(coats_.place(*at_middle.coat)), aspect = at_middle.coat->aspect();
  if (std::abs(aspect - 1) < 1e-6f) aspect = 1;

  s.materials.emplace_back(kind, exponent, aspect, coat);
  s.materials.emplace_back(first, first_texture);
  s.materials.emplace_back(second, second_texture);
  s.materials.emplace_back(metallic.value, s.texture(metallic.texture), metallic.channel,
                           material.mask_cutoff);
  s.materials.emplace_back(roughness.value, s.texture(roughness.texture), roughness.channel,
                           material.mask_channel);
  s.materials.emplace_back(eta, s.texture(material.normal_map));
  s.materials.emplace_back(k, material.normal_scale);
  s.materials.emplace_back(s.texture(material.mask), 0, 0, 0);
}

SceneBuffers::SceneBuffers(const Scene& scene) {
  Staging s;
  add_geometry(scene, s);
  for (const auto& material : scene.materials()) add_material(*material, s);
  LambertMaterial black;
  black.albedo.value = vec3(0);
  add_material(black, s);

  const size_t limit = TextureBuffer::limit();
  const size_t most = std::max({s.vertices.size(), s.triangles.size(), s.texels.size()});
  if (most > limit)
    throw SceneError(fmt::format(
        "the GPU backend: {} is too large for this GPU: found {} texels in one buffer, expected at "
        "most {} (textures are kept as floats)",
        scene.name(), most, limit));
  vertices_ = TextureBuffer(std::span<const vec4>(s.vertices));
  triangles_ = TextureBuffer(std::span<const uint32_t>(s.triangles));
  shapes_ = TextureBuffer(std::span<const vec4>(s.shapes));
  spheres_ = TextureBuffer(std::span<const uint32_t>(s.spheres));
  materials_ = TextureBuffer(std::span<const vec4>(s.materials));
  texels_ = TextureBuffer(std::span<const vec4>(s.texels));
  textures_ = TextureBuffer(std::span<const uint32_t>(s.textures));
  upload_coats();
}

void SceneBuffers::upload_coats() {
  if (uploaded_coats_ == coats_.texels().size() && uploaded_coats_ > 0) return;
  coat_texels_ = TextureBuffer(std::span<const vec4>(coats_.texels()));
  uploaded_coats_ = coats_.texels().size();
}

void SceneBuffers::bind() const {
  vertices_.bind(units::kVertices), triangles_.bind(units::kTriangles), shapes_.bind(units::kShapes);
  spheres_.bind(units::kSpheres), materials_.bind(units::kMaterials), texels_.bind(units::kTexels);
  textures_.bind(units::kTextures), coat_texels_.bind(units::kCoats);
}

}  // namespace zonal::gl
