#include "integrators/vpl/vpl.h"

#include <algorithm>

#include "core/glsl.h"
#include "core/render.h"
#include "integrators/direct.h"

namespace zonal {
#include "integrators/vpl/vpl.glsl"

namespace {

/// The tile's points as arrays over pixels, so that the geometry of one light against 64 points vectorises. Pixels
/// that gather nothing (sky, black surfaces) are left out.
struct TilePoints {
  int count = 0;
  std::array<int, kTilePixels> pixel;
  alignas(64) std::array<float, kTilePixels> x, y, z;         // position
  alignas(64) std::array<float, kTilePixels> nx, ny, nz;      // shading normal
  alignas(64) std::array<float, kTilePixels> gx, gy, gz;      // geometric normal
  std::array<BsdfContext, kTilePixels> view;
  bool lambert = true;  ///< of all points: their BRDF is a constant

  explicit TilePoints(const Tile& tile) {
    for (int i = 0; i < tile.count; ++i) {
      if (!tile.found(i) || tile.bsdfs[i].kind == BsdfKind::black) continue;
      const Surface& s = tile.surfaces[i];
      const int k = count++;
      pixel[k] = i;
      x[k] = s.position.x, y[k] = s.position.y, z[k] = s.position.z;
      nx[k] = s.shading.z.x, ny[k] = s.shading.z.y, nz[k] = s.shading.z.z;
      gx[k] = s.normal.x, gy[k] = s.normal.y, gz[k] = s.normal.z;
      view[k] = prepare(tile.bsdfs[i], s.shading.to_local(s.w_out));
      lambert = lambert && tile.bsdfs[i].kind == BsdfKind::lambert;
    }
  }
  vec3 position(int k) const { return {x[k], y[k], z[k]}; }
};

/// What of a light reaches the points, before their BRDFs: (VPL-1), and the share the clamp took.
struct Transfer {
  alignas(64) std::array<float, kTilePixels> geometry;   ///< cos cos / d^2 as used
  alignas(64) std::array<float, kTilePixels> unclamped;  ///< the same without the clamp
  alignas(64) std::array<float, kTilePixels> wx, wy, wz; ///< unit, point to light
};

void transfer(const TilePoints& points, const VirtualLight& light, bool yuksel, float shortest, Transfer* out) {
  const vec3 p = light.position, n = light.normal;
#pragma omp simd
  for (int k = 0; k < points.count; ++k) {
    const vec3 to_light(p.x - points.x[k], p.y - points.y[k], p.z - points.z[k]);
    const float d2 = dot(to_light, to_light);
    const float attenuation = yuksel ? vpl_yuksel(d2, shortest) : vpl_inverse_square(d2, shortest);
    vec3 w;
    const float g = vpl_geometry(to_light, vec3(points.nx[k], points.ny[k], points.nz[k]), n, attenuation, w);
    // Light must arrive on the side of the true surface that the camera sees, whatever the shading normal says.
    const bool faces = w.x * points.gx[k] + w.y * points.gy[k] + w.z * points.gz[k] > 0.0f;
    out->geometry[k] = faces && d2 > 0.0f ? g : 0.0f;
    out->unclamped[k] = out->geometry[k] / (attenuation * d2);
    out->wx[k] = w.x, out->wy[k] = w.y, out->wz[k] = w.z;
  }
}

/// Clears the contribution of points that the light does not see.
void remove_shadowed(const Scene& scene, const Tile& tile, const TilePoints& points, const VirtualLight& light,
                     const int* lit, int lit_count, const Transfer& t, std::array<vec3, kTilePixels>& contribution,
                     TileStats& stats) {
  const vec3 target = offset_origin(light.position, light.normal, light.normal);
  std::array<vec3, 8> origins;
  for (int first = 0; first < lit_count; first += 8) {
    const int n = std::min(8, lit_count - first);
    for (int j = 0; j < n; ++j) {
      const int k = lit[first + j];
      origins[j] = offset_origin(tile.surfaces[points.pixel[k]], vec3(t.wx[k], t.wy[k], t.wz[k]));
    }
    const uint32_t blocked = scene.occluded8(origins.data(), (1u << n) - 1u, target);
    for (int j = 0; j < n; ++j)
      if (blocked >> j & 1u) contribution[lit[first + j]] = vec3(0);
  }
  stats.shadow_rays += lit_count;
}

}  // namespace

void VplIntegrator::trace_lights(const Pass& pass, int count, const Stop& stop, PassStats* stats) {
  VirtualLightOptions options;
  options.lights = count;
  options.bounces = params_.bounces;
  options.distribution = params_.distribution == VplParams::Distribution::grid ? VirtualLightOptions::grid
                                                                               : VirtualLightOptions::paths;
  options.seed = pass.seed;
  options.pass = static_cast<uint32_t>(pass.index);
  set_ = make_virtual_lights(pass.scene, options, stop);
  if (!stats) return;
  stats->numbers["virtual_lights"] += static_cast<double>(set_.lights.size());
  stats->numbers["light_rays"] += static_cast<double>(set_.rays);
  if (stats->warnings.empty()) stats->warnings = set_.warnings;
}

/// A timed render whose pass would take more than a tenth of the time gathers from fewer lights a pass, but not so few
/// that gathering takes less of a pass than all the rest of it. Measured on four tiles spread over the picture, once.
int VplIntegrator::lights_that_fit(const Pass& pass, const Stop& stop) {
  trace_lights(pass, std::min(params_.lights, 64), stop, nullptr);
  if (set_.lights.empty()) return params_.lights;
  const double with_lights = seconds_a_pass(pass, stop);
  const auto count = static_cast<double>(set_.lights.size());
  set_.lights.clear();
  const double rest = seconds_a_pass(pass, stop);
  const double per_light = std::max(with_lights - rest, 1e-3 * with_lights) / count;
  const double fit = std::max(pass.budget_seconds / 10 - rest, rest) / per_light;
  return static_cast<int>(std::clamp(fit, 1.0, static_cast<double>(params_.lights)));
}

/// How long shading the whole picture from the present lights will take.
double VplIntegrator::seconds_a_pass(const Pass& pass, const Stop& stop) const {
  const Camera& camera = pass.camera;
  const auto start = Clock::now();
  Tile tile;
  std::array<Sampler, kTilePixels> samplers;
  std::array<vec3, kTilePixels> radiance;
  TileStats ignored;
  double pixels = 0;
  for (int i = 0; i < 4; ++i) {
    const ivec2 corner(camera.width * (2 * (i % 2) + 1) / 4 / 8 * 8, camera.height * (2 * (i / 2) + 1) / 4 / 8 * 8);
    trace_tile(pass.scene, camera, corner, pass.seed, 0, true, &tile, samplers.data());
    shade(tile, radiance.data(), samplers.data(), stop, ignored);
    pixels += tile.count;
  }
  return seconds_since(start) / pixels * camera.width * camera.height / pass.threads;
}

void VplIntegrator::begin_pass(const Pass& pass, const Stop& stop, PassStats& stats) {
  scene_ = &pass.scene;
  shortest_ = params_.clamp * pass.scene.bounds().radius;
  if (pass.index == 0) {
    pass_lights_ = params_.pass_lights > 0 ? std::min(params_.pass_lights, params_.lights) : params_.lights;
    if (params_.pass_lights == 0 && pass.budget_seconds > 0) pass_lights_ = lights_that_fit(pass, stop);
    stats.numbers["pass_lights"] = pass_lights_;
  }
  trace_lights(pass, pass_lights_, stop, &stats);
}

void VplIntegrator::shade(const Tile& tile, vec3* radiance, Sampler* samplers, const Stop& stop,
                          TileStats& stats) const {
  for (int i = 0; i < tile.count; ++i) {
    radiance[i] = vec3(0);
    if (params_.direct == VplParams::Direct::none) continue;
    if (!tile.found(i)) {
      if (const Light* sky = scene_->environment())
        radiance[i] = sky->radiance({.normal = tile.directions[i]}, -tile.directions[i]);
      continue;
    }
    radiance[i] = scene_->emitted(tile.surfaces[i]);
    if (tile.bsdfs[i].kind == BsdfKind::black) continue;
    const ShadingPoint point(tile.surfaces[i], tile.bsdfs[i]);
    radiance[i] += sample_direct(*scene_, point, samplers[i], params_.direct_samples, stats);
  }

  const TilePoints points(tile);
  const bool yuksel = params_.attenuation == VplParams::Attenuation::yuksel;
  const Lobes lobes = params_.emission == VplParams::Emission::brdf ? Lobes::all : Lobes::diffuse;
  Transfer t;
  std::array<vec3, kTilePixels> contribution;
  std::array<int, kTilePixels> lit;
  for (size_t j = 0; j < set_.lights.size(); ++j) {
    if (j % 64 == 0 && stop()) return;
    const VirtualLight& light = set_.lights[j];
    transfer(points, light, yuksel, shortest_, &t);
    const BsdfContext light_view = prepare(light.bsdf, light.frame.to_local(light.w_in), PathEnd::light);
    const bool constant = light.bsdf.kind == BsdfKind::lambert;
    const vec3 diffuse_flux = constant ? light.power * light.bsdf.diffuse * kInvPi : vec3(0);

    int lit_count = 0;
    for (int k = 0; k < points.count; ++k) {
      if (!(t.geometry[k] > 0)) continue;
      const vec3 w(t.wx[k], t.wy[k], t.wz[k]);
      const int i = points.pixel[k];
      // (VPL-4) flux, times both BRDFs, times the geometry. BRDFs are symmetric, so w_in serves as the light's view.
      const vec3 emitted = constant ? diffuse_flux
                                    : light.power * evaluate(light.bsdf, light_view, light.frame.to_local(-w), lobes);
      const vec3 received = points.lambert ? tile.bsdfs[i].diffuse * kInvPi
                                           : evaluate(tile.bsdfs[i], points.view[k], tile.surfaces[i].shading.to_local(w));
      contribution[k] = emitted * received * t.geometry[k];
      if (!is_black(contribution[k])) lit[lit_count++] = k;
    }
    stats.light_evaluations += points.count;
    if (params_.occlusion == VplParams::Occlusion::center)
      remove_shadowed(*scene_, tile, points, light, lit.data(), lit_count, t, contribution, stats);

    for (int m = 0; m < lit_count; ++m) {
      const int k = lit[m];
      radiance[points.pixel[k]] += contribution[k];
      if (shortest_ > 0) {
        const double used = luminance(contribution[k]);
        stats.total_energy += used * (t.unclamped[k] / t.geometry[k]);
        stats.clamped_energy += used * (t.unclamped[k] / t.geometry[k] - 1.0f);
      }
    }
  }
}

}  // namespace zonal
