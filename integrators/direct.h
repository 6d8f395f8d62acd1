#pragma once
/// Direct light at one surface point, by next-event estimation and BRDF sampling combined with the power heuristic
/// (Veach and Guibas 1995). `path` uses the two halves at every vertex, the virtual-light methods at the camera's.
///
///     radiance += sample_one_light(scene, point, sampler, true, stats);   // half one
///     BsdfSample s = ...; Hit hit = ...;                                   // half two: a ray the BRDF chose
///     radiance += s.weight * emission_found(scene, point, s, hit, next);

#include "core/integrator.h"

namespace zonal {

/// A surface with its reflection made ready for evaluation.
struct ShadingPoint {
  const Surface& surface;
  const Bsdf& bsdf;
  BsdfContext view;

  ShadingPoint(const Surface& s, const Bsdf& b) : surface(s), bsdf(b), view(prepare(b, s.shading.to_local(s.w_out))) {}
  /// Light passes only on the side of the geometric surface that is looked at.
  bool faces(vec3 w) const { return dot(surface.normal, w) > 0; }
};

/// Whether any light can be met by a ray; if none can, the second half is always zero.
bool has_hittable_lights(const Scene& scene);

/// The light-sampling half: one light, one shadow ray (none with `shadow_ray` false: light passes through everything).
vec3 sample_one_light(const Scene& scene, const ShadingPoint& point, Sampler& sampler, bool shadow_ray,
                      TileStats& stats);

/// The BRDF-sampling half: the MIS-weighted emission that a ray with density `pdf` (1/sr) found at `hit`, where
/// `found` is the surface there (unused for a miss, which meets the environment). Not yet times the BRDF weight.
vec3 emission_found(const Scene& scene, vec3 from, vec3 w_in, float pdf, const Surface* found);

/// Both halves averaged over `samples` pairs: an unbiased estimate of direct light, with occlusion.
vec3 sample_direct(const Scene& scene, const ShadingPoint& point, Sampler& sampler, int samples, TileStats& stats);

}  // namespace zonal
