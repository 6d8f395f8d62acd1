#include "integrators/debug/debug.h"

namespace zonal {

void DebugIntegrator::shade(const Tile& tile, vec3* radiance, Sampler*, const Stop&, TileStats&) const {
  for (int i = 0; i < tile.count; ++i) {
    radiance[i] = vec3(0);
    if (!tile.found(i)) continue;
    switch (quantity_) {
      case DebugQuantity::normal:  // [-1,1] shown as [0,1]
        radiance[i] = 0.5f * tile.surfaces[i].shading.z + 0.5f;
        break;
      case DebugQuantity::albedo:
        radiance[i] = albedo(tile.bsdfs[i]);
        break;
      case DebugQuantity::depth:  // nearest surface white, a scene's diameter away black
        radiance[i] = vec3(std::exp(-tile.hits[i].t / radius_));
        break;
    }
  }
}

}  // namespace zonal
