#include "integrators/path/path.h"

#include <algorithm>

#include "integrators/direct.h"

namespace zonal {

/// The paths of a tile, one a pixel, all at the same bounce: rays are traced together, then surfaces are looked up
/// together, so that the memory's latency is paid once a tile rather than once a path. Paths that ended are dropped.
struct PathIntegrator::Wave {
  int count = 0;
  std::array<int, kTilePixels> pixel;
  std::array<vec3, kTilePixels> beta;  ///< product of f cos / pdf so far
  std::array<Surface, kTilePixels> surface;
  std::array<Bsdf, kTilePixels> bsdf;
  // The rays that leave the surfaces; filled by `scatter`.
  std::array<vec3, kTilePixels> direction;
  std::array<float, kTilePixels> pdf;
  std::array<Hit, kTilePixels> hit;

  void add(int i, const vec3& b, const Surface& s, const Bsdf& f) {
    pixel[count] = i, beta[count] = b, surface[count] = s, bsdf[count] = f;
    ++count;
  }
};

void PathIntegrator::begin_pass(const Pass& pass, const Stop&, PassStats&) {
  scene_ = &pass.scene;
  hittable_lights_ = has_hittable_lights(pass.scene);
}

vec3 PathIntegrator::seen_directly(const Tile& tile, int i) const {
  if (params_.min_bounces > 0) return vec3(0);
  if (tile.found(i)) return scene_->emitted(tile.surfaces[i]);
  const Light* sky = scene_->environment();
  return sky ? sky->radiance({.normal = tile.directions[i]}, -tile.directions[i]) : vec3(0);
}

void PathIntegrator::shade(const Tile& tile, vec3* radiance, Sampler* samplers, const Stop& stop,
                           TileStats& stats) const {
  const bool ordinary = params_.occlusion == PathParams::Occlusion::full &&
                        params_.direct_occlusion == PathParams::Occlusion::full;
  Wave wave;
  for (int i = 0; i < tile.count; ++i) {
    radiance[i] = seen_directly(tile, i);
    if (!tile.found(i) || tile.bsdfs[i].kind == BsdfKind::black) continue;
    if (ordinary) {
      wave.add(i, vec3(1), tile.surfaces[i], tile.bsdfs[i]);
    } else {
      if (stop()) return;
      radiance[i] += first_segment_unoccluded(tile.surfaces[i], tile.bsdfs[i], samplers[i], stats, &wave, i);
    }
  }
  follow(wave, ordinary ? 0 : 1, radiance, samplers, stop, stats);
}

/// (PATH-1) Adds all light that reaches the wave's surfaces and goes on to the camera, from bounce number `bounce` on.
void PathIntegrator::follow(Wave& wave, int bounce, vec3* radiance, Sampler* samplers, const Stop& stop,
                            TileStats& stats) const {
  for (; wave.count > 0 && !stop(); ++bounce) {
    const bool counts = bounce >= params_.min_bounces, last = bounce >= params_.max_bounces;
    wave.count = scatter(wave, bounce, radiance, samplers, stats);
    if (last && !(counts && hittable_lights_)) return;

    // The ray of the BRDF serves twice: the other half of this bounce's direct light, and the next bounce.
    std::array<vec3, kTilePixels> from;
    stats.bounce_rays += wave.count;
    for (int k = 0; k < wave.count; ++k) {
      const Surface& s = wave.surface[k];
      from[k] = s.position;
      wave.hit[k] = scene_->intersect(offset_origin(s, wave.direction[k]), wave.direction[k]);
    }
    scene_->look_up(wave.hit.data(), wave.direction.data(), wave.count, wave.surface.data(), wave.bsdf.data());

    int kept = 0;
    for (int k = 0; k < wave.count; ++k) {
      const bool found = wave.hit[k].found();
      const int i = wave.pixel[k];
      if (counts)
        radiance[i] += wave.beta[k] * emission_found(*scene_, from[k], wave.direction[k], wave.pdf[k],
                                                     found ? &wave.surface[k] : nullptr);
      if (last || !found || wave.bsdf[k].kind == BsdfKind::black) continue;
      vec3 beta = wave.beta[k];
      // Account for paths that end here by those that go on.
      if (bounce >= params_.roulette_after) {
        const float survival = std::fmin(0.95f, max_component(beta));
        if (samplers[i].next_1d() >= survival) continue;
        beta /= survival;
      }
      wave.pixel[kept] = i, wave.beta[kept] = beta;
      if (kept != k) wave.surface[kept] = wave.surface[k], wave.bsdf[kept] = wave.bsdf[k];
      ++kept;
    }
    wave.count = kept;
  }
}

/// At each surface of the wave: direct light by one shadow ray, then the direction of the path's next ray. Returns how
/// many paths go on, moved to the front.
int PathIntegrator::scatter(Wave& wave, int bounce, vec3* radiance, Sampler* samplers, TileStats& stats) const {
  int kept = 0;
  for (int k = 0; k < wave.count; ++k) {
    const int i = wave.pixel[k];
    const Surface& s = wave.surface[k];
    const ShadingPoint point(s, wave.bsdf[k]);
    if (bounce >= params_.min_bounces)
      radiance[i] += wave.beta[k] * sample_one_light(*scene_, point, samplers[i], true, stats);
    const vec2 u = samplers[i].next_2d();
    const BsdfSample ray = sample(wave.bsdf[k], point.view, samplers[i].next_1d(), u);
    if (!(ray.pdf > 0)) continue;
    const vec3 w_in = s.shading.to_world(ray.w_in);
    if (!point.faces(w_in)) continue;
    wave.beta[kept] = wave.beta[k] * ray.weight;
    wave.direction[kept] = w_in, wave.pdf[kept] = ray.pdf, wave.pixel[kept] = i;
    if (kept != k) wave.surface[kept] = wave.surface[k];
    ++kept;
  }
  return kept;
}

/// (PATH-2) Transport in which nothing blocks the segment that arrives at the camera's surface: one ray chosen by the
/// BRDF collects what every surface along it sends back, each with its own shadow rays; from there paths are ordinary.
/// Returns the direct light and adds the path that stands for the indirect to the wave.
vec3 PathIntegrator::first_segment_unoccluded(const Surface& surface, const Bsdf& bsdf, Sampler& sampler,
                                              TileStats& stats, Wave* wave, int pixel) const {
  const Scene& scene = *scene_;
  const ShadingPoint point(surface, bsdf);
  const bool direct_blocked = params_.direct_occlusion == PathParams::Occlusion::full;
  const bool indirect_blocked = params_.occlusion == PathParams::Occlusion::full;
  const bool direct_counts = params_.min_bounces == 0;
  vec3 radiance(0);
  if (direct_counts) radiance += sample_one_light(scene, point, sampler, direct_blocked, stats);

  const vec2 u = sampler.next_2d();
  const BsdfSample ray = sample(bsdf, point.view, sampler.next_1d(), u);
  if (!(ray.pdf > 0)) return radiance;
  const vec3 w_in = surface.shading.to_world(ray.w_in);
  if (!point.faces(w_in)) return radiance;
  ++stats.bounce_rays;
  thread_local std::vector<Hit> hits;
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
  const size_t chosen = std::min(candidates - 1, static_cast<size_t>(sampler.next_1d() * candidates));
  const Surface next = scene.surface(hits[chosen], w_in);
  const Bsdf next_bsdf = scene.bsdf(next);
  if (next_bsdf.kind != BsdfKind::black)
    wave->add(pixel, ray.weight * static_cast<float>(candidates), next, next_bsdf);
  return radiance;
}

}  // namespace zonal
