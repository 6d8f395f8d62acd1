#include "integrators/sh_direct/sh_occlusion.h"

#include <algorithm>
#include <optional>

#include "integrators/direct.h"
#include "lights/shaped_lights.h"

namespace zonal {

vec3 shadow_ratio(const Scene& scene, const LightSelector& selector, const Surface& s, const Bsdf& bsdf,
                  int rays, Sampler& sampler, TileStats& stats) {
  const ShadingPoint point(s, bsdf);
  vec3 all(0), lit(0);
  for (int i = 0; i < rays; ++i) {
    const vec2 u = sampler.next_2d();
    const auto choice = selector.choose(s.position, (float(i) + sampler.next_1d()) / float(rays), nullptr);
    if (!choice.light) continue;
    const LightSample light = choice.light->sample(s.position, u);
    if (!(light.pdf > 0) || !point.faces(light.w_in)) continue;
    const vec3 w_in = s.shading.to_local(light.w_in);
    const vec3 reflected = evaluate(bsdf, point.view, w_in) * light.radiance *
                           (std::max(w_in.z, 0.0f) / (choice.probability * light.pdf));
    if (is_black(reflected) || !is_finite(reflected)) continue;
    all += reflected;
    ++stats.shadow_rays;
    const bool blocked = std::isinf(light.distance)
                             ? scene.occluded(offset_origin(s, light.w_in), light.w_in, 0, kInfinity)
                             : scene.occluded(s, s.position + light.w_in * light.distance);
    if (!blocked) lit += reflected;
  }
  vec3 ratio(1);
  for (int c = 0; c < 3; ++c)
    if (all[c] > 0) ratio[c] = lit[c] / all[c];
  return ratio;
}

float ambient_openness(const Scene& scene, const Surface& s, int rays, float reach, Sampler& sampler,
                       TileStats& stats) {
  int open = 0;
  for (int i = 0; i < rays; ++i) {
    const vec3 w = s.shading.to_world(cosine_hemisphere(sampler.next_2d()));
    // What lies below the true surface is not in the way, but not open either.
    if (!(glm::dot(w, s.normal) > 0)) continue;
    ++stats.shadow_rays;
    open += !scene.occluded(offset_origin(s, w), w, 0, reach);
  }
  return float(open) / float(rays);
}

namespace {

std::optional<vec3> place_of(const Light* light) {
  if (const auto* sphere = dynamic_cast<const SphereLight*>(light)) return sphere->center;
  if (const auto* point = dynamic_cast<const PointLight*>(light)) return point->position;
  if (const auto* spot = dynamic_cast<const SpotLight*>(light)) return spot->position;
  if (const auto* picture = dynamic_cast<const TexturedLight*>(light))
    return picture->corner + 0.5f * (picture->u + picture->v);
  const auto* mesh = dynamic_cast<const TriangleLight*>(light);
  if (!mesh || mesh->triangles.empty()) return {};
  vec3 sum(0);
  for (const auto& t : mesh->triangles) sum += (t.a + t.b + t.c) / 3.0f;
  return sum / float(mesh->triangles.size());
}

struct Group {
  std::vector<std::pair<vec3, const Light*>> lights;
  int axis = 0;
  float extent = 0;
  explicit Group(std::vector<std::pair<vec3, const Light*>> some) : lights(std::move(some)) {
    vec3 low(kInfinity), high(-kInfinity);
    for (const auto& [place, light] : lights) low = glm::min(low, place), high = glm::max(high, place);
    for (int k = 0; k < 3; ++k)
      if (high[k] - low[k] > extent) extent = high[k] - low[k], axis = k;
  }
};

}  // namespace

std::vector<std::vector<const Light*>> light_groups(const std::vector<std::unique_ptr<Light>>& lights,
                                                    int count) {
  std::vector<std::vector<const Light*>> result;
  std::vector<std::pair<vec3, const Light*>> placed;
  std::vector<const Light*> everywhere;
  for (const auto& light : lights) {
    const auto place = place_of(light.get());
    if (place)
      placed.emplace_back(*place, light.get());
    else
      everywhere.push_back(light.get());
  }
  if (count <= 1) {
    std::vector<const Light*> all;
    for (const auto& light : lights) all.push_back(light.get());
    return {all};
  }
  std::vector<Group> groups;
  if (!placed.empty()) groups.emplace_back(std::move(placed));
  const size_t most = size_t(count) - (everywhere.empty() ? 0 : 1);
  while (groups.size() < most) {
    const auto largest = std::max_element(groups.begin(), groups.end(),
                                          [](const Group& a, const Group& b) { return a.extent < b.extent; });
    if (largest == groups.end() || !(largest->extent > 0)) break;
    const int axis = largest->axis;
    auto some = std::move(largest->lights);
    groups.erase(largest);
    std::stable_sort(some.begin(), some.end(),
                     [&](const auto& a, const auto& b) { return a.first[axis] < b.first[axis]; });
    const auto middle = some.begin() + std::ptrdiff_t(some.size() / 2);
    groups.emplace_back(std::vector(some.begin(), middle));
    groups.emplace_back(std::vector(middle, some.end()));
  }
  for (const Group& group : groups) {
    result.emplace_back();
    for (const auto& [place, light] : group.lights) result.back().push_back(light);
  }
  if (!everywhere.empty()) result.push_back(everywhere);
  return result;
}

}  // namespace zonal
