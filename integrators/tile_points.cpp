#include "integrators/tile_points.h"

#include "integrators/tile_bounds.h"
#include "materials/microfacet.h"

namespace zonal {

namespace {

/// Every second bit of a Morton code: 8 points in a row of codes are a block of 4 x 2 pixels.
int morton_x(int code) {
  return (code & 1) | (code >> 1 & 2) | (code >> 2 & 4);
}

/// Lambert counts as a kind of Schlick's (bsdf_arrays.h); black gathers nothing.
int group_of(BsdfKind kind) {
  switch (kind) {
    case BsdfKind::lambert:
    case BsdfKind::metallic_roughness:
      return 0;
    case BsdfKind::coated:
      return 1;
    case BsdfKind::conductor:
      return 2;
    case BsdfKind::blinn_phong:
    case BsdfKind::measured:
      return 3;
    case BsdfKind::black:
      break;
  }
  return -1;
}

}  // namespace

TilePoints::TilePoints(const Tile& t, const uint32_t* seeds) : tile(t) {
  std::array<int8_t, kTilePixels> at;  // of the 8x8 block the tile lies in
  at.fill(-1);
  for (int i = 0; i < tile.count; ++i)
    at[(tile.pixels[i].y & 7) * 8 + (tile.pixels[i].x & 7)] = static_cast<int8_t>(i);

  // By groups of kinds that are evaluated alike, inside a group in Morton order.
  for (int group = 0; group < 4; ++group) {
    for (int code = 0; code < kTilePixels; ++code) {
      const int i = at[morton_x(code >> 1) * 8 + morton_x(code)];
      if (i >= 0 && tile.found(i) && group_of(tile.bsdfs[i].kind) == group) add(i, seeds ? seeds[i] : 0);
    }
  }

  padded = (count + 7) / 8 * 8;
  for (int k = count; k < padded; ++k) {
    const int last = count - 1;
    pixel[k] = pixel[last], seed[k] = seed[last], view[k] = view[last];
    for (Floats* a : {&x, &y, &z, &gx, &gy, &gz, &tx, &ty, &tz, &bx, &by, &bz, &nx, &ny, &nz, &ox, &oy, &oz})
      (*a)[k] = (*a)[last];
  }
}

void TilePoints::add(int i, uint32_t random) {
  const Surface& s = tile.surfaces[i];
  const vec3 out = s.shading.to_local(s.w_out);
  if (!(out.z > kMinCosine)) return;
  const int k = count++;
  pixel[k] = i;
  seed[k] = random;
  x[k] = s.position.x, y[k] = s.position.y, z[k] = s.position.z;
  gx[k] = s.normal.x, gy[k] = s.normal.y, gz[k] = s.normal.z;
  tx[k] = s.shading.x.x, ty[k] = s.shading.x.y, tz[k] = s.shading.x.z;
  bx[k] = s.shading.y.x, by[k] = s.shading.y.y, bz[k] = s.shading.y.z;
  nx[k] = s.shading.z.x, ny[k] = s.shading.z.y, nz[k] = s.shading.z.z;
  ox[k] = out.x, oy[k] = out.y, oz[k] = out.z;
  above[k] = offset_origin(s, s.normal);
  view[k] = prepare(tile.bsdfs[i], out);
}

TileBrdfs::TileBrdfs(const TilePoints& points) : brdfs(points.padded) {
  for (int k = 0; k < points.padded; ++k) brdfs.set(k, points.bsdf(k), points.view[k]);
  brdfs.finish();
  for (int k = 0; k < points.count; ++k) {
    const Reflection most = largest_reflection(points.bsdf(k), points.view[k]);
    flat = std::max(flat, most.flat), peak = std::max(peak, most.peak);
  }
}

}  // namespace zonal
