#include "integrators/sh_direct/sh_seen.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/render.h"

namespace zonal {

ShSeen look_around(const Scene& scene, const Camera& camera, const Stop& stop) {
  const int columns = (camera.width + 7) / 8, rows = (camera.height + 7) / 8, tiles = columns * rows;
  constexpr int kProbes = 256;
  std::vector<ShSeen> of_tile(tiles);
  tbb::parallel_for(0, tiles, [&](int index) {
    if (stop()) return;
    Tile tile;
    std::array<Sampler, kTilePixels> samplers;
    trace_tile(scene, camera, ivec2(index % columns, index / columns) * 8, 0, 0, false, &tile,
               samplers.data());
    ShSeen& mine = of_tile[index];
    // Of many tiles every so manieth gives a probe, of few tiles each gives several.
    const int probes = (index + 1) * kProbes / tiles - index * kProbes / tiles;
    for (int i = 0; i < tile.count; ++i)
      if (tile.found(i) && tile.bsdfs[i].kind != BsdfKind::black)
        mine.positions.push_back(tile.surfaces[i].position);
    for (int p = 0; p < probes; ++p) {
      const int i = (2 * p + 1) * tile.count / (2 * probes);
      if (tile.found(i) && tile.bsdfs[i].kind != BsdfKind::black)
        mine.probes.push_back({tile.surfaces[i], tile.bsdfs[i]});
    }
  });
  ShSeen all;
  for (const ShSeen& mine : of_tile) {
    all.positions.insert(all.positions.end(), mine.positions.begin(), mine.positions.end());
    all.probes.insert(all.probes.end(), mine.probes.begin(), mine.probes.end());
  }
  return all;
}

}  // namespace zonal
