/// From the loader's parts to flat arrays and Embree's structure: checks, packing, bounds.

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cassert>

#include "core/bounding_ball.h"
#include "core/error.h"
#include "core/scene_impl.h"
#include "core/sphere_geometry.h"

namespace zonal {

namespace {

/// What packing a shape found: the first error stops the scene.
struct Packed {
  std::string error;
  size_t dropped = 0;
};

std::string label(const ShapeData& shape, size_t index) {
  const std::string& name = shape.name.empty() ? shape.mesh.name : shape.name;
  return name.empty() ? fmt::format("shape {}", index) : fmt::format("shape \"{}\"", name);
}

/// Thinner than coordinates of 24 bits can say: no side to be lit from.
bool has_no_area(vec3 a, vec3 b, vec3 c) {
  const glm::dvec3 ab = glm::dvec3(b) - glm::dvec3(a), ac = glm::dvec3(c) - glm::dvec3(a), bc = ac - ab;
  const double longest2 = std::fmax(glm::dot(ab, ab), std::fmax(glm::dot(ac, ac), glm::dot(bc, bc)));
  return !(glm::length(glm::cross(ab, ac)) > 1e-9 * longest2);
}

std::string check_mesh(const MeshData& mesh) {
  const size_t count = mesh.positions.size();
  if (count >= kNone) return fmt::format("{} vertices are more than an index can count", count);
  if (!mesh.normals.empty() && mesh.normals.size() != count) {
    return fmt::format("{} normals for {} vertices", mesh.normals.size(), count);
  }
  if (!mesh.uvs.empty() && mesh.uvs.size() != count) {
    return fmt::format("{} texture coordinates for {} vertices", mesh.uvs.size(), count);
  }
  for (size_t i = 0; i < count; ++i) {
    const vec3 p = mesh.positions[i];
    if (!is_finite(p)) {
      return fmt::format("vertex {} is ({}, {}, {}), expected finite coordinates", i, p.x, p.y, p.z);
    }
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t index = mesh.triangles[i][k];
      if (index < count) continue;
      return fmt::format("triangle {} uses vertex {}, but there are {} vertices", i, index, count);
    }
  }
  return {};
}

Packed pack_mesh(const MeshData& mesh, Vertices& vertices, Triangles& triangles,
                 std::vector<uint32_t>& original) {
  Packed result{check_mesh(mesh), 0};
  if (!result.error.empty()) return result;
  // Keep the triangles that have an area, and remember which those were once one is missing.
  triangles.reserve(mesh.triangles.size());
  std::vector<bool> used(mesh.positions.size(), false);
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const uvec3 t = mesh.triangles[i];
    if (has_no_area(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z])) {
      ++result.dropped;
      continue;
    }
    triangles.push_back(t);
    used[t.x] = used[t.y] = used[t.z] = true;
    original.push_back(i);
  }
  if (result.dropped == 0) original = {};
  vertices.resize(triangles.empty() ? 0 : mesh.positions.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    // A vertex no triangle uses must not count for the bounds: put it on one that does.
    const size_t from = used[i] ? i : triangles[0].x;
    Vertex& v = vertices[i];
    v.position = mesh.positions[from];
    // A normal that is no direction is replaced by the triangle's when a hit is shaded.
    if (!mesh.normals.empty()) {
      const float length = glm::length(mesh.normals[from]);
      v.normal = length > 0 && std::isfinite(length) ? mesh.normals[from] / length : vec3(0);
    }
    if (!mesh.uvs.empty()) v.uv = mesh.uvs[from];
  }
  return result;
}

bool is_anisotropic(const Material& material) {
  if (const auto* m = dynamic_cast<const ConductorMaterial*>(&material)) return m->anisotropy != 0;
  if (const auto* m = dynamic_cast<const CoatedMaterial*>(&material)) return m->anisotropy != 0;
  return false;
}

/// Whether the mask can cut anything away: an alpha channel that is 1 everywhere cannot.
bool can_cut(const Material& m) {
  return m.mask && !(m.mask_channel == 3 && !m.mask->has_alpha() && m.mask_cutoff <= 1);
}

void remember_error(void* message, RTCError, const char* text) {
  *static_cast<std::string*>(message) = text ? text : "unknown error";
}

}  // namespace

Scene::Scene(SceneParts parts) : impl_(std::make_unique<Impl>()) {
  impl_->take(std::move(parts));
  impl_->find_bounds();
  impl_->device = rtcNewDevice(nullptr);
  if (!impl_->device) throw SceneError("Embree could not start on this machine");
  impl_->scene = impl_->build(false);
  // Coated materials make their albedo tables when first asked: that is loading, not the first pass.
  for (const auto& material : impl_->materials) material->at(vec2(0));
  std::vector<const Light*> lights;
  for (const auto& light : impl_->lights) {
    light->set_scene_bounds(impl_->bounds);
    lights.push_back(light.get());
  }
  impl_->selector = LightSelector(std::move(lights));
}

Scene::Impl::~Impl() {
  if (collector) rtcReleaseScene(collector);
  if (scene) rtcReleaseScene(scene);
  if (device) rtcReleaseDevice(device);
}

void Scene::Impl::take(SceneParts parts) {
  name = std::move(parts.name), camera = parts.camera, environment = parts.environment;
  textures = std::move(parts.textures), materials = std::move(parts.materials);
  lights = std::move(parts.lights), notes = std::move(parts.notes);
  const size_t count = parts.shapes.size();
  shapes.resize(count), vertices.resize(count), triangles.resize(count), original.resize(count);
  std::vector<Packed> packed(count);
  tbb::parallel_for(size_t(0), count, [&](size_t i) {
    ShapeData& data = parts.shapes[i];
    Shape& shape = shapes[i];
    assert(data.material == kNone || data.material < materials.size());
    assert(data.light == kNone || data.light < lights.size());
    shape.index = uint32_t(i), shape.material_index = data.material, shape.light = data.light;
    shape.center = data.center, shape.radius = data.radius;
    if (data.radius != 0) {
      if (!is_finite(data.center) || !(data.radius > 0) || !std::isfinite(data.radius)) {
        packed[i].error =
            fmt::format("a sphere of radius {} at ({}, {}, {}), expected finite numbers and a radius > 0",
                        data.radius, data.center.x, data.center.y, data.center.z);
      }
    } else {
      packed[i] = pack_mesh(data.mesh, vertices[i], triangles[i], original[i]);
      shape.has_normals = !data.mesh.normals.empty(), shape.has_uvs = !data.mesh.uvs.empty();
      shape.vertices = vertices[i].data(), shape.vertex_count = uint32_t(vertices[i].size());
      shape.triangles = triangles[i].data(), shape.triangle_count = uint32_t(triangles[i].size());
      shape.original = original[i].empty() ? nullptr : original[i].data();
      data.mesh = {};
    }
    if (data.material == kNone) return;
    const Material& material = *materials[data.material];
    shape.material = &material;
    shape.normal_map = material.normal_map, shape.normal_scale = material.normal_scale;
    shape.first_texture = shape.material->first_texture();
    shape.has_tangents = material.normal_map || is_anisotropic(material);
    shape.has_mask = can_cut(material);
  });

  size_t dropped = 0, shapes_with_dropped = 0, first = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!packed[i].error.empty()) throw SceneError(label(parts.shapes[i], i) + ": " + packed[i].error);
    triangle_count += shapes[i].triangle_count;
    if (packed[i].dropped == 0) continue;
    if (shapes_with_dropped++ == 0) first = i;
    dropped += packed[i].dropped;
  }
  if (dropped == 0) return;
  notes.push_back(
      fmt::format("{} zero-area triangle{} dropped from {}{}", dropped, dropped == 1 ? "" : "s",
                  label(parts.shapes[first], first),
                  shapes_with_dropped == 1 ? "" : fmt::format(" and {} more", shapes_with_dropped - 1)));
}

void Scene::Impl::find_bounds() {
  std::vector<const Shape*> visible;
  for (const Shape& s : shapes) {
    if (s.radius > 0 || s.triangle_count > 0) visible.push_back(&s);
  }
  bounds = {camera.position, 1};
  if (visible.empty()) return;
  std::vector<BoundingSphere> best(visible.size());
  bounds = enclosing_ball([&](vec3 center) {
    tbb::parallel_for(size_t(0), visible.size(), [&](size_t i) {
      const Shape& s = *visible[i];
      best[i] = {s.center, s.radius};
      float most = -1;
      for (uint32_t k = 0; k < s.vertex_count; ++k) {
        const vec3 d = s.vertices[k].position - center;
        if (const float d2 = glm::dot(d, d); d2 > most) most = d2, best[i].center = s.vertices[k].position;
      }
    });
    // The first of equals, so that the answer does not depend on the threads.
    size_t farthest = 0;
    float most = -1;
    for (size_t i = 0; i < best.size(); ++i) {
      const float reach = glm::length(best[i].center - center) + best[i].radius;
      if (reach > most) most = reach, farthest = i;
    }
    return best[farthest];
  });
}

RTCScene Scene::Impl::build(bool collecting) const {
  std::string error;
  rtcSetDeviceErrorFunction(device, remember_error, &error);
  RTCScene built = rtcNewScene(device);
  // Robust: without it rays slip through shared edges, and a closed room leaks light.
  rtcSetSceneFlags(built, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(built, collecting ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH);
  for (const Shape& shape : shapes) {
    if (shape.radius > 0) attach_sphere(device, built, shape, collecting);
    if (shape.triangle_count == 0) continue;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, shape.vertices, 0,
                               sizeof(Vertex), shape.vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, shape.triangles, 0,
                               sizeof(uvec3), shape.triangle_count);
    rtcSetGeometryUserData(geometry, const_cast<Shape*>(&shape));
    if (collecting) {
      rtcSetGeometryIntersectFilterFunction(geometry, collect_hits);
    } else if (shape.has_mask) {
      rtcSetGeometryIntersectFilterFunction(geometry, skip_masked);
      rtcSetGeometryOccludedFilterFunction(geometry, skip_masked);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(built, geometry, shape.index);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(built);
  rtcSetDeviceErrorFunction(device, nullptr, nullptr);
  if (error.empty()) return built;
  rtcReleaseScene(built);
  throw SceneError("Embree could not build the scene: " + error);
}

RTCScene Scene::Impl::collecting_scene() const {
  // Isolated: while it waits for Embree this thread must not start another tile, which would wait for itself
  // here.
  std::call_once(collector_built, [&] { tbb::this_task_arena::isolate([&] { collector = build(true); }); });
  return collector;
}

}  // namespace zonal
