#pragma once
/// Where a ray of flux lands, and what a cell of a reflective shadow map leaves there: the steps that
/// make_virtual_lights is built of.
///
///     if (auto light = land(scene, ray, hit_count)) ...            // one ray, one virtual light
///     if (auto light = light_of_cell(scene, grid, job, ...)) ...   // a block of rays, one virtual light

#include <optional>

#include "lights/emission_grid.h"
#include "lights/virtual_lights.h"

namespace zonal {

/// A virtual light of bounce 1 where the ray meets a surface that reflects; none where it meets nothing or
/// black.
std::optional<VirtualLight> land(const Scene& scene, const EmissionSample& ray, uint64_t* rays);

/// Which cell of whose map, and the randomness of its rays.
struct CellJob {
  int cell = 0;
  uint32_t primary = 0;  ///< index into Scene::lights()
  uint64_t seed = 0;
  uint32_t pass = 0;
  VirtualLightOptions::Placement placement = VirtualLightOptions::sampled;
};

/// The light of one cell: it stands at one of the block's texels and holds the flux of all those whose rays
/// meet a surface that reflects. `texels`, when given, receives those. `cell` and `grid` are left to the
/// caller.
std::optional<VirtualLight> light_of_cell(const Scene& scene, const EmissionGrid& grid, const CellJob& job,
                                          std::vector<VirtualLight>* texels, uint64_t* rays);

}  // namespace zonal
