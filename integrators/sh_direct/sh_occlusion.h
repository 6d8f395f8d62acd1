#pragma once
/// What blocks direct light, by a few rays: the share of it that arrives, to be applied to light computed
/// without occlusion. Where nothing blocks it is exactly 1, so noise stays in the shadows.
///
///     radiance *= shadow_ratio(scene, selector, surface, bsdf, 4, sampler, stats);

#include "core/integrator.h"

namespace zonal {

/// (SHD-10) Shadowed over unshadowed reflected light of the lights `selector` chooses from, per colour in
/// [0,1], both sums from the same `rays` samples, stratified over the lights. 1 where no sample reflects
/// anything.
vec3 shadow_ratio(const Scene& scene, const LightSelector& selector, const Surface& s, const Bsdf& bsdf,
                  int rays, Sampler& sampler, TileStats& stats);

/// (SHD-10) Ambient openness, [0,1]: the cosine-weighted share of directions free within `reach` metres.
float ambient_openness(const Scene& scene, const Surface& s, int rays, float reach, Sampler& sampler,
                       TileStats& stats);

/// Lights in at most `count` groups of neighbours, by halving the largest one's box across its longest side;
/// lights without a place are a group together.
std::vector<std::vector<const Light*>> light_groups(const std::vector<std::unique_ptr<Light>>& lights,
                                                    int count);

}  // namespace zonal
