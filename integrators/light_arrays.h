#pragma once
/// A set of virtual lights as arrays, in the set's order: loops over lights vectorise. Behind the last light
/// come copies of it without power, up to a multiple of `kBlockLights`, so that whole blocks may be read.

#include <vector>

#include "lights/virtual_lights.h"

namespace zonal {

struct LightArrays {
  int count = 0;
  std::vector<float> x, y, z;  ///< position, metres, world
  std::vector<float> gx, gy,
      gz;  ///< geometric normal, unit, on the lit side: the emission's cosine is with it
  std::vector<float> tx, ty, tz, bx, by, bz, nx, ny, nz;  ///< shading frame's x, y and z, world
  std::vector<float> ix, iy, iz;  ///< unit, towards where the flux came from, in the light's shading frame
  std::vector<float> power_r, power_g, power_b;  ///< incident flux, W
  std::vector<float> radius;                     ///< metres; 0 until the method's `prepare` sets it
  std::vector<vec3> target;       ///< where shadow rays end: the position moved off its surface
  std::vector<BsdfContext> view;  ///< of w_in, PathEnd::light, for `evaluate`
  std::vector<Bsdf> bsdf;

  LightArrays() = default;
  /// As many elements as `set` has lights, rounded up to a multiple of `block`.
  LightArrays(const VirtualLightSet& set, int block);

  vec3 position(int j) const { return {x[j], y[j], z[j]}; }
  vec3 normal(int j) const { return {gx[j], gy[j], gz[j]}; }
  vec3 power(int j) const { return {power_r[j], power_g[j], power_b[j]}; }
  Frame frame(int j) const {
    Frame f;
    f.x = {tx[j], ty[j], tz[j]}, f.y = {bx[j], by[j], bz[j]}, f.z = {nx[j], ny[j], nz[j]};
    return f;
  }
};

}  // namespace zonal
