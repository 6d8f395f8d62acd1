/// What methods ask a Scene. How it is built: scene_build.cpp; how a hit becomes a Surface: surface.cpp.

#include "core/scene.h"

#include <algorithm>
#include <cassert>

#include "core/ray_recorder.h"
#include "core/scene_impl.h"

namespace zonal {

constinit thread_local std::vector<RayRecord>* ray_recorder = nullptr;

namespace {

/// What a shape without a material is made of: it reflects nothing (a lamp's own surface).
struct BlackMaterial : Material {
  Bsdf at(vec2) const override { return {}; }
  const char* type() const override { return "black"; }
};

/// Share of a shadow ray's length that is left out at its far end, where the light's own surface lies.
constexpr float kFarSlack = 1e-4f;

/// Where on the way from `origin` (t = 0) to `to` (t = 1) a shadow ray ends. Negative: there is nothing to
/// trace.
float shadow_end(vec3 origin, vec3 to) {
  // 64 roundings of the larger coordinates; what a hit near `to` may be wrong by when the light is a few
  // metres wide.
  const vec3 size = glm::max(glm::abs(origin), glm::abs(to));
  const float slack = 64 * 0x1p-24f * max_component(size);
  return 1 - std::fmax(kFarSlack, slack / glm::length(to - origin));
}

void fill(RTCRay& ray, vec3 origin, vec3 direction, float t_min, float t_max) {
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
  ray.tnear = t_min, ray.tfar = t_max;
  ray.time = 0, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
}

}  // namespace

vec3 Camera::direction(vec2 film) const {
  const float half = std::tan(0.5f * vertical_fov);
  const float x = (2 * film.x - float(width)) / float(height) * half;
  const float y = (1 - 2 * film.y / float(height)) * half;
  return glm::normalize(forward + x * right + y * up);
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;

const std::string& Scene::name() const {
  return impl_->name;
}
const Camera& Scene::camera() const {
  return impl_->camera;
}
const std::vector<std::unique_ptr<Light>>& Scene::lights() const {
  return impl_->lights;
}
const LightSelector& Scene::light_selector() const {
  return impl_->selector;
}
const std::vector<std::unique_ptr<Material>>& Scene::materials() const {
  return impl_->materials;
}
uint32_t Scene::environment_index() const {
  return impl_->environment;
}
BoundingSphere Scene::bounds() const {
  return impl_->bounds;
}
const std::vector<std::string>& Scene::notes() const {
  return impl_->notes;
}
std::span<const Shape> Scene::shapes() const {
  return impl_->shapes;
}

size_t Scene::triangle_count() const {
  return impl_->triangle_count;
}
void* Scene::embree() const {
  return impl_->scene;
}

const Light* Scene::environment() const {
  return impl_->environment == kNone ? nullptr : impl_->lights[impl_->environment].get();
}

const Material& Scene::material(uint32_t index) const {
  static const BlackMaterial black;
  if (index == kNone) return black;
  return *impl_->materials[index];
}

vec3 Scene::emitted(const Surface& s) const {
  return s.light == kNone ? vec3(0) : impl_->lights[s.light]->radiance(s.light_hit(), s.w_out);
}

Hit Scene::intersect(vec3 origin, vec3 direction, float t_min, float t_max) const {
  RTCRayHit query;
  if (ray_recorder) [[unlikely]] ray_recorder->push_back({origin, t_min, direction, t_max, false});
  fill(query.ray, origin, direction, t_min, t_max);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  embree::Context context = embree::context();
  embree::intersect1(impl_->scene, context, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {query.ray.tfar, query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v};
}

bool Scene::occluded(vec3 origin, vec3 direction, float t_min, float t_max) const {
  RTCRay ray;
  if (ray_recorder) [[unlikely]] ray_recorder->push_back({origin, t_min, direction, t_max, true});
  fill(ray, origin, direction, t_min, t_max);
  embree::Context context = embree::context();
  embree::occluded1(impl_->scene, context, ray);
  return ray.tfar < 0;
}

bool Scene::occluded(const Surface& from, vec3 to) const {
  const vec3 origin = offset_origin(from, to - from.position);
  const float end = shadow_end(origin, to);
  return end > 0 && occluded(origin, to - origin, 0, end);
}

uint32_t Scene::occluded8(const vec3* origins, uint32_t active, vec3 to) const {
  const vec3 ends[8] = {to, to, to, to, to, to, to, to};
  return occluded8(origins, active, ends);
}

uint32_t Scene::occluded8(const vec3* origins, uint32_t active, const vec3* to) const {
  alignas(32) int valid[8];
  RTCRay8 rays;
  for (int i = 0; i < 8; ++i) {
    const bool wanted = (active >> i) & 1u;
    const vec3 origin = wanted ? origins[i] : vec3(0), target = wanted ? to[i] : vec3(0);
    const vec3 direction = target - origin;
    const float end = wanted ? shadow_end(origin, target) : -1;
    if (wanted && ray_recorder) [[unlikely]] ray_recorder->push_back({origin, 0, direction, end, true});
    valid[i] = end > 0 ? -1 : 0;
    rays.org_x[i] = origin.x, rays.org_y[i] = origin.y, rays.org_z[i] = origin.z;
    rays.dir_x[i] = direction.x, rays.dir_y[i] = direction.y, rays.dir_z[i] = direction.z;
    rays.tnear[i] = 0, rays.tfar[i] = end;
    rays.time[i] = 0, rays.mask[i] = ~0u, rays.id[i] = 0, rays.flags[i] = 0;
  }
  embree::Context context = embree::context();
  embree::occluded8_coherent(valid, impl_->scene, context, rays);
  uint32_t blocked = 0;
  for (int i = 0; i < 8; ++i) blocked |= uint32_t(valid[i] && rays.tfar[i] < 0) << i;
  return blocked;
}

void Scene::intersect_all(vec3 origin, vec3 direction, float t_min, std::vector<Hit>* hits) const {
  hits->clear();
  CollectingContext context{embree::context(), hits};
  RTCRayHit query;
  fill(query.ray, origin, direction, t_min, kInfinity);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  embree::intersect1(impl_->collecting_scene(), context.context, query);
  // Order by distance; ties by number, so that the order is the same on every machine.
  std::sort(hits->begin(), hits->end(), [](const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    return a.shape != b.shape ? a.shape < b.shape : a.primitive < b.primitive;
  });
  const auto same = [](const Hit& a, const Hit& b) {
    return a.t == b.t && a.shape == b.shape && a.primitive == b.primitive;
  };
  hits->erase(std::unique(hits->begin(), hits->end(), same), hits->end());
}

}  // namespace zonal
