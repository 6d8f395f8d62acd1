#include "integrators/sh_direct/sh_seen.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/render.h"

namespace zonal {

ShSeen look_around(const Scene& scene, const Camera& camera, const Stop& stop) {
  const int columns = (camera.width + 7) / 8, rows = (camera.height + 7) / 8, tiles = columns * rows;
  constexpr int kProbes = 2048;
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

void ShSeen::thin(int count, std::span<const ShLights* const> lights) {
  std::vector<double> share(probes.size());
  tbb::parallel_for(size_t{0}, probes.size(), [&](size_t i) {
    double light = 0;
    for (const ShLights* some : lights) {
      float L[3];
      some->coefficients(1, probes[i].surface.position, L);
      light += double(L[0]) + L[1] + L[2];
    }
    share[i] = light * light;
  });
  double total = 0;
  for (const double s : share) total += s;
  std::vector<Probe> kept;
  double before = 0;
  for (size_t i = 0; i < probes.size(); ++i) {
    const double even = 1 / double(probes.size()),
                 wanted = count * (total > 0 ? 0.5 * (even + share[i] / total) : even);
    // As many copies as steps of 1 lie in its part of the sum.
    const double copies = std::floor(before + wanted + 0.5) - std::floor(before + 0.5);
    before += wanted;
    if (!(copies > 0)) continue;
    kept.push_back(probes[i]);
    kept.back().weight = copies / wanted;
  }
  probes = std::move(kept);
}

}  // namespace zonal
