#include "integrators/light_arrays.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace zonal {

LightArrays::LightArrays(const VirtualLightSet& set, int block) : count(static_cast<int>(set.lights.size())) {
  const size_t size = (set.lights.size() + block - 1) / block * block;
  for (auto* a : {&x,  &y,  &z,  &gx, &gy, &gz, &tx, &ty,      &tz,      &bx,      &by,
                  &bz, &nx, &ny, &nz, &ix, &iy, &iz, &power_r, &power_g, &power_b, &radius})
    a->resize(size);
  target.resize(size), view.resize(size), bsdf.resize(size);

  tbb::parallel_for(size_t{0}, size, [&](size_t j) {
    const VirtualLight& v = set.lights[std::min(j, set.lights.size() - 1)];
    const bool padding = j >= set.lights.size();
    x[j] = v.position.x, y[j] = v.position.y, z[j] = v.position.z;
    gx[j] = v.normal.x, gy[j] = v.normal.y, gz[j] = v.normal.z;
    tx[j] = v.frame.x.x, ty[j] = v.frame.x.y, tz[j] = v.frame.x.z;
    bx[j] = v.frame.y.x, by[j] = v.frame.y.y, bz[j] = v.frame.y.z;
    nx[j] = v.frame.z.x, ny[j] = v.frame.z.y, nz[j] = v.frame.z.z;
    const vec3 in = v.frame.to_local(v.w_in);
    ix[j] = in.x, iy[j] = in.y, iz[j] = in.z;
    const vec3 power = padding ? vec3(0) : v.power;
    power_r[j] = power.x, power_g[j] = power.y, power_b[j] = power.z;
    target[j] = v.shadow_point;
    view[j] = prepare(v.bsdf, in, PathEnd::light);
    bsdf[j] = v.bsdf;
  });
}

}  // namespace zonal
