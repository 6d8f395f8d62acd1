#include "integrators/vpl/vpl.h"

#include "core/glsl.h"

namespace zonal {
#include "integrators/vpl/vpl.glsl"

namespace {

/// What of a light reaches the points, before their BRDFs: (VPL-1).
struct Transfer {
  alignas(64) TilePoints::Floats geometry;    ///< cos cos / d^2 as used
  alignas(64) TilePoints::Floats wx, wy, wz;  ///< unit, point to light, world
};

void transfer(const TilePoints& points, vec3 p, vec3 n, bool yuksel, float shortest, Transfer* out) {
#pragma omp simd
  for (int k = 0; k < points.padded; ++k) {
    const vec3 to_light(p.x - points.x[k], p.y - points.y[k], p.z - points.z[k]);
    const float d2 = dot(to_light, to_light);
    const float attenuation = yuksel ? vpl_yuksel(d2, shortest) : vpl_inverse_square(d2, shortest);
    vec3 w;
    const float g = vpl_geometry(to_light, vec3(points.nx[k], points.ny[k], points.nz[k]), n, attenuation, w);
    // Light must arrive on the side of the true surface that the camera sees, whatever the shading normal
    // says.
    const bool faces = w.x * points.gx[k] + w.y * points.gy[k] + w.z * points.gz[k] > 0.0f;
    out->geometry[k] = faces && d2 > 0.0f ? g : 0.0f;
    out->wx[k] = w.x, out->wy[k] = w.y, out->wz[k] = w.z;
  }
}

}  // namespace

void VplIntegrator::prepare(const Pass& pass, const VirtualLightSet&, LightArrays&, const Stop&, PassStats&) {
  shortest_ = params_.clamp * pass.scene.bounds().radius;
}

void VplIntegrator::gather(const TilePoints& points, int first, int count, Contributions& out) const {
  const bool yuksel = params_.attenuation == VplParams::Attenuation::yuksel;
  const Lobes lobes = params_.emission == VplParams::Emission::brdf ? Lobes::all : Lobes::diffuse;
  const LightArrays& lights = this->lights();
  Transfer t;
  for (int j = 0; j < count; ++j) {
    const int l = first + j;
    transfer(points, lights.position(l), lights.normal(l), yuksel, shortest_, &t);
    const Frame frame = lights.frame(l);
    for (int k = 0; k < points.padded; ++k) {
      vec3 sent(0);
      if (t.geometry[k] > 0) {
        const vec3 w(t.wx[k], t.wy[k], t.wz[k]);
        // (VPL-4) flux, times both BRDFs, times the geometry. BRDFs are symmetric, so w_in serves as the
        // light's view.
        sent = lights.power(l) * evaluate(lights.bsdf[l], lights.view[l], frame.to_local(-w), lobes) *
               evaluate(points.bsdf(k), points.view[k], points.surface(k).shading.to_local(w)) *
               t.geometry[k];
      }
      const int i = out.at(j, k);
      out.r[i] = sent.x, out.g[i] = sent.y, out.b[i] = sent.z;
    }
  }
}

/// What the clamp took of the light that arrives: its share is counted in luminance.
void VplIntegrator::account(const TilePoints& points, int first, int count, const Contributions& visible,
                            TileStats& stats) const {
  const bool yuksel = params_.attenuation == VplParams::Attenuation::yuksel;
  for (int j = 0; j < count; ++j) {
    for (int k = 0; k < points.count; ++k) {
      const int i = visible.at(j, k);
      const double used = luminance({visible.r[i], visible.g[i], visible.b[i]});
      if (!(used > 0)) continue;
      const vec3 to_light = lights().position(first + j) - points.position(k);
      const float d2 = dot(to_light, to_light);
      const double attenuation = yuksel ? vpl_yuksel(d2, shortest_) : vpl_inverse_square(d2, shortest_);
      const double whole = used / (attenuation * d2);
      stats.total_energy += whole;
      stats.clamped_energy += whole - used;
    }
  }
}

}  // namespace zonal
