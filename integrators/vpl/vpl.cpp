#include "integrators/vpl/vpl.h"

#include "core/glsl.h"

namespace zonal {
#include "integrators/vpl/vpl.glsl"

namespace {

/// What of a light reaches the points, before their BRDFs.
struct Transfer {
  using Floats = TilePoints::Floats;
  alignas(64) Floats geometry;    ///< (VPL-1): cos cos / d^2
  alignas(64) Floats x, y, z;     ///< unit, point to light, the point's shading frame
  alignas(64) Floats ex, ey, ez;  ///< unit, light to point, the light's shading frame
};

/// One light against all points. Returns whether any of them sees it.
template <bool kYuksel>
bool transfer(const TilePoints& points, vec3 p, vec3 n, const Frame& frame, float shortest, Transfer& out) {
  float any = 0;
#pragma omp simd reduction(+ : any)
  for (int k = 0; k < points.padded; ++k) {
    const vec3 to_light(p.x - points.x[k], p.y - points.y[k], p.z - points.z[k]);
    const float d2 = dot(to_light, to_light);
    const float attenuation = kYuksel ? vpl_yuksel(d2, shortest) : vpl_inverse_square(d2, shortest);
    vec3 w;
    const float g = vpl_geometry(to_light, vec3(points.nx[k], points.ny[k], points.nz[k]), n, attenuation, w);
    // Light must arrive on the side of the true surface that the camera sees, whatever the shading normal
    // says.
    const bool faces = w.x * points.gx[k] + w.y * points.gy[k] + w.z * points.gz[k] > 0.0f;
    const float geometry = faces ? g : 0.0f;
    out.geometry[k] = geometry;
    any += geometry;
    out.x[k] = w.x * points.tx[k] + w.y * points.ty[k] + w.z * points.tz[k];
    out.y[k] = w.x * points.bx[k] + w.y * points.by[k] + w.z * points.bz[k];
    out.z[k] = w.x * points.nx[k] + w.y * points.ny[k] + w.z * points.nz[k];
    out.ex[k] = -dot(w, frame.x), out.ey[k] = -dot(w, frame.y), out.ez[k] = -dot(w, frame.z);
  }
  return any > 0;
}

/// Radiance beyond which a product of two narrow lobes is cut off, so that sums stay finite.
constexpr float kMost = 1e30f;

}  // namespace

void VplIntegrator::prepare(const Pass& pass, const VirtualLightSet& set, LightArrays& arrays, const Stop&,
                            PassStats&) {
  shortest_ = params_.clamp * pass.scene.bounds().radius;
  const Lobes lobes = params_.emission == VplParams::Emission::brdf ? Lobes::all : Lobes::diffuse;
  emitters_ = BsdfArrays(static_cast<int>(set.lights.size()));
  for (int j = 0; j < emitters_.count(); ++j) emitters_.set(j, arrays.bsdf[j], arrays.view[j], lobes);
  emitters_.finish();
  largest_.clear();
  if (shared().skip > 0)
    for (int j = 0; j < emitters_.count(); ++j)
      largest_.push_back(largest_reflection(arrays.bsdf[j], arrays.view[j], lobes));
}

float VplIntegrator::most(const TilePoints& points, const TileBounds& bounds, int light) const {
  const auto reach = bounds.reach(lights().position(light), lights().normal(light), 0);
  const float d2 = reach.distance * reach.distance;
  const float attenuation = params_.attenuation == VplParams::Attenuation::yuksel
                                ? vpl_yuksel(d2, shortest_)
                                : vpl_inverse_square(d2, shortest_);
  const auto& tile = static_cast<const TileBrdfs&>(*points.state);
  const Reflection receiver{tile.flat, tile.peak};
  return luminance(lights().power(light)) * largest_[light].most(reach.cos_light) *
         receiver.most(reach.cos_point) * attenuation;
}

std::unique_ptr<TileState> VplIntegrator::prepare_tile(const TilePoints& points) const {
  return std::make_unique<TileBrdfs>(points);
}

void VplIntegrator::gather_one(const TilePoints& points, int l, float* r, float* g, float* b) const {
  const int n = points.padded;
  Transfer t;
  const auto one = params_.attenuation == VplParams::Attenuation::yuksel ? transfer<true> : transfer<false>;
  if (!one(points, lights().position(l), lights().normal(l), lights().frame(l), shortest_, t)) {
    for (int k = 0; k < n; ++k) r[k] = g[k] = b[k] = 0;
    return;
  }
  // (VPL-4) flux, times both BRDFs, times the geometry. BRDFs are symmetric, so w_in serves as the light's
  // view.
  const BsdfArrays& receivers = static_cast<const TileBrdfs*>(points.state)->brdfs;
  receivers.evaluate(0, n, t.x.data(), t.y.data(), t.z.data(), r, g, b);
  emitters_.multiply_by_one(l, n, t.ex.data(), t.ey.data(), t.ez.data(), t.geometry.data(), lights().power(l),
                            kMost, r, g, b);
}

void VplIntegrator::gather(const TilePoints& points, int first, int count, Contributions& out) const {
  for (int j = 0; j < count; ++j) {
    const int row = out.at(j, 0);
    gather_one(points, first + j, &out.r[row], &out.g[row], &out.b[row]);
  }
}

void VplIntegrator::gather_sums(const TilePoints& points, int first, int count, PointSums& sums) const {
  alignas(64) TilePoints::Floats r, g, b;
  for (int j = 0; j < count; ++j) {
    gather_one(points, first + j, r.data(), g.data(), b.data());
    for (int k = 0; k < points.padded; ++k) sums.r[k] += r[k], sums.g[k] += g[k], sums.b[k] += b[k];
  }
}

/// What the clamp took of the light that arrives: its share is counted in luminance.
void VplIntegrator::account(const TilePoints& points, int first, int count, const Contributions& visible,
                            TileStats& stats) const {
  const bool yuksel = params_.attenuation == VplParams::Attenuation::yuksel;
  for (int j = 0; j < count; ++j) {
    const vec3 p = lights().position(first + j);
    const int row = visible.at(j, 0);
    float sum = 0, taken = 0;
#pragma omp simd reduction(+ : sum, taken)
    for (int k = 0; k < points.count; ++k) {
      const float used = luminance({visible.r[row + k], visible.g[row + k], visible.b[row + k]});
      const float d2 = sqr(p.x - points.x[k]) + sqr(p.y - points.y[k]) + sqr(p.z - points.z[k]);
      const float attenuation = yuksel ? vpl_yuksel(d2, shortest_) : vpl_inverse_square(d2, shortest_);
      const float whole = used > 0 ? used / (attenuation * d2) : 0.0f;
      sum += whole, taken += whole - used;
    }
    stats.total_energy += sum;
    stats.clamped_energy += taken;
  }
}

}  // namespace zonal
