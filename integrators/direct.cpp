#include "integrators/direct.h"

namespace zonal {

bool has_hittable_lights(const Scene& scene) {
  for (const auto& light : scene.lights())
    if (!light->is_delta()) return true;
  return false;
}

vec3 sample_one_light(const Scene& scene, const ShadingPoint& point, Sampler& sampler, bool shadow_ray,
                      TileStats& stats) {
  const Surface& s = point.surface;
  const vec2 u = sampler.next_2d();
  const auto choice = scene.light_selector().choose(s.position, sampler.next_1d(), nullptr);
  if (!choice.light) return vec3(0);
  const LightSample light = choice.light->sample(s.position, u);
  if (!(light.pdf > 0) || !point.faces(light.w_in)) return vec3(0);

  // Value first: a shadow ray costs more than a BRDF, and half of all directions reflect nothing.
  const vec3 w_in = s.shading.to_local(light.w_in);
  vec3 f;
  float bsdf_pdf;
  evaluate_with_pdf(point.bsdf, point.view, w_in, &f, &bsdf_pdf);
  const float pdf = choice.probability * light.pdf;
  vec3 radiance = f * light.radiance * (w_in.z / pdf);
  if (is_black(radiance)) return vec3(0);
  ++stats.light_evaluations;
  if (!light.delta) radiance *= power_heuristic(pdf, bsdf_pdf);

  if (shadow_ray) {
    ++stats.shadow_rays;
    const bool blocked = std::isinf(light.distance)
                             ? scene.occluded(offset_origin(s, light.w_in), light.w_in, 0, kInfinity)
                             : scene.occluded(s, s.position + light.w_in * light.distance);
    if (blocked) return vec3(0);
  }
  return radiance;
}

vec3 emission_found(const Scene& scene, vec3 from, vec3 w_in, float pdf, const Surface* found) {
  uint32_t index;
  LightHit hit;
  if (found) {
    if (found->light == kNone) return vec3(0);
    index = found->light;
    hit = found->light_hit();
  } else {
    if (!scene.environment()) return vec3(0);
    index = scene.environment_index();
    hit.normal = w_in;
  }
  const Light& light = *scene.lights()[index];
  const vec3 emitted = light.radiance(hit, -w_in);
  if (is_black(emitted)) return vec3(0);
  const float light_pdf = scene.light_selector().probability(from, index) * light.pdf(from, hit);
  return emitted * power_heuristic(pdf, light_pdf);
}

vec3 sample_direct(const Scene& scene, const ShadingPoint& point, Sampler& sampler, int samples, TileStats& stats) {
  const Surface& s = point.surface;
  const bool hittable = has_hittable_lights(scene);
  vec3 sum(0);
  for (int i = 0; i < samples; ++i) {
    sum += sample_one_light(scene, point, sampler, true, stats);
    if (!hittable) continue;
    const vec2 u = sampler.next_2d();
    const BsdfSample ray = sample(point.bsdf, point.view, sampler.next_1d(), u);
    if (!(ray.pdf > 0)) continue;
    const vec3 w_in = s.shading.to_world(ray.w_in);
    if (!point.faces(w_in)) continue;
    ++stats.bounce_rays;
    const Hit hit = scene.intersect(offset_origin(s, w_in), w_in);
    if (hit.found()) {
      const Surface next = scene.surface(hit, w_in);
      sum += ray.weight * emission_found(scene, s.position, w_in, ray.pdf, &next);
    } else {
      sum += ray.weight * emission_found(scene, s.position, w_in, ray.pdf, nullptr);
    }
  }
  return sum / static_cast<float>(samples);
}

}  // namespace zonal
