#include "integrators/path/path.h"

#include "integrators/direct.h"

namespace zonal {

struct PathIntegrator::Work {
  const Scene& scene;
  Sampler& sampler;
  TileStats& stats;
};

void PathIntegrator::begin_pass(const Pass& pass, const Stop&, PassStats&) {
  scene_ = &pass.scene;
  hittable_lights_ = has_hittable_lights(pass.scene);
}

void PathIntegrator::shade(const Tile& tile, vec3* radiance, Sampler* samplers, const Stop& stop,
                           TileStats& stats) const {
  for (int i = 0; i < tile.count && !stop(); ++i) {
    const Work work{*scene_, samplers[i], stats};
    radiance[i] = camera_radiance(work, tile, i);
  }
}

vec3 PathIntegrator::camera_radiance(const Work& work, const Tile& tile, int i) const {
  const Scene& scene = work.scene;
  if (!tile.found(i)) {
    const Light* sky = params_.min_bounces == 0 ? scene.environment() : nullptr;
    return sky ? sky->radiance({.normal = tile.directions[i]}, -tile.directions[i]) : vec3(0);
  }
  const vec3 seen = params_.min_bounces == 0 ? scene.emitted(tile.surfaces[i]) : vec3(0);
  const bool ordinary = params_.occlusion == PathParams::Occlusion::full &&
                        params_.direct_occlusion == PathParams::Occlusion::full;
  return seen + (ordinary ? follow(work, tile.surfaces[i], tile.bsdfs[i], vec3(1), 0)
                          : first_segment_unoccluded(work, tile.surfaces[i], tile.bsdfs[i]));
}

/// (PATH-1) All light that reaches `surface` and leaves towards its w_out, from bounce number `bounce` on.
vec3 PathIntegrator::follow(const Work& work, Surface surface, Bsdf bsdf, vec3 beta, int bounce) const {
  const Scene& scene = work.scene;
  vec3 radiance(0);
  for (;; ++bounce) {
    if (bsdf.kind == BsdfKind::black) break;
    const ShadingPoint point(surface, bsdf);
    const bool counts = bounce >= params_.min_bounces;
    if (counts) radiance += beta * sample_one_light(scene, point, work.sampler, true, work.stats);

    // The ray of the BRDF serves twice: the other half of this bounce's direct light, and the next bounce.
    const bool last = bounce >= params_.max_bounces;
    if (last && !(counts && hittable_lights_)) break;
    const vec2 u = work.sampler.next_2d();
    const BsdfSample ray = sample(bsdf, point.view, work.sampler.next_1d(), u);
    if (!(ray.pdf > 0)) break;
    const vec3 w_in = surface.shading.to_world(ray.w_in);
    if (!point.faces(w_in)) break;
    beta *= ray.weight;

    ++work.stats.bounce_rays;
    const Hit hit = scene.intersect(offset_origin(surface, w_in), w_in);
    if (!hit.found()) {
      if (counts) radiance += beta * emission_found(scene, surface.position, w_in, ray.pdf, nullptr);
      break;
    }
    const Surface next = scene.surface(hit, w_in);
    if (counts && next.light != kNone)
      radiance += beta * emission_found(scene, surface.position, w_in, ray.pdf, &next);
    if (last) break;

    // Account for paths that end here by those that go on.
    if (bounce >= params_.roulette_after) {
      const float survival = std::fmin(0.95f, max_component(beta));
      if (work.sampler.next_1d() >= survival) break;
      beta /= survival;
    }
    surface = next;
    bsdf = scene.bsdf(surface);
  }
  return radiance;
}

/// (PATH-2) Transport in which nothing blocks the segment that arrives at the camera's surface: one ray chosen by the
/// BRDF collects what every surface along it sends back, each with its own shadow rays; from there paths are ordinary.
vec3 PathIntegrator::first_segment_unoccluded(const Work& work, const Surface& surface, const Bsdf& bsdf) const {
  if (bsdf.kind == BsdfKind::black) return vec3(0);
  const Scene& scene = work.scene;
  const ShadingPoint point(surface, bsdf);
  const bool direct_blocked = params_.direct_occlusion == PathParams::Occlusion::full;
  const bool indirect_blocked = params_.occlusion == PathParams::Occlusion::full;
  const bool direct_counts = params_.min_bounces == 0;
  vec3 radiance(0);
  if (direct_counts) radiance += sample_one_light(scene, point, work.sampler, direct_blocked, work.stats);

  const vec2 u = work.sampler.next_2d();
  const BsdfSample ray = sample(bsdf, point.view, work.sampler.next_1d(), u);
  if (!(ray.pdf > 0)) return radiance;
  const vec3 w_in = surface.shading.to_world(ray.w_in);
  if (!point.faces(w_in)) return radiance;
  ++work.stats.bounce_rays;
  thread_local std::vector<Hit> hits;
  hits.clear();
  scene.intersect_all(offset_origin(surface, w_in), w_in, 0, &hits);

  // Emitters met by the ray: the first only, or all of them and the sky behind.
  if (direct_counts) {
    for (size_t i = 0; i < hits.size() && (i == 0 || !direct_blocked); ++i) {
      const Surface next = scene.surface(hits[i], w_in);
      radiance += ray.weight * emission_found(scene, surface.position, w_in, ray.pdf, &next);
    }
    if (hits.empty() || !direct_blocked)
      radiance += ray.weight * emission_found(scene, surface.position, w_in, ray.pdf, nullptr);
  }
  if (params_.max_bounces == 0 || hits.empty()) return radiance;

  // Virtual lights stand on every surface along the ray. One of them, drawn at random, stands for all.
  const size_t candidates = indirect_blocked ? 1 : hits.size();
  const size_t chosen = std::min(candidates - 1, static_cast<size_t>(work.sampler.next_1d() * candidates));
  const Surface next = scene.surface(hits[chosen], w_in);
  return radiance + follow(work, next, scene.bsdf(next), ray.weight * static_cast<float>(candidates), 1);
}

}  // namespace zonal
