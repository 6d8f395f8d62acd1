#include "integrators/vsgl/vsgl.h"

#include <fmt/format.h>

#include <bit>

#include "core/error.h"
#include "integrators/vsgl/vector_exp.h"
#include "integrators/vsgl/vsgl_receivers.h"
#include "materials/fresnel.h"

// Loops over the kernel become vectors when every call in them is gone and `exp` is this namespace's own.
#undef KERNEL
#define KERNEL [[gnu::always_inline]] inline

namespace zonal {
namespace vsgl_lanes {
#include "integrators/vsgl/spherical_gaussian.glsl"
#include "integrators/vsgl/vsgl.glsl"
}  // namespace vsgl_lanes

namespace {

using namespace vsgl_lanes;

/// Sharpest cloud of points, as variance over squared distance: beyond it float tells nothing apart.
constexpr float kLeastShare2015 = 0x1p-28f, kLeastShare2024 = 0x1p-41f;

struct Options {
  bool second = true;  ///< generation 2024
  float least_share = 0, least_variance = 0;
};

template <bool second>
[[gnu::always_inline]] inline float specular_at(const VsglReceivers& r, int k, vec3 v, vec3 axis, float K,
                                                vec3& peak) {
  if constexpr (second) {
    const VsglFilteredReceiver f{v, vec2(r.lobe[0][k], r.lobe[1][k]),
                                 vec3(r.lobe[2][k], r.lobe[3][k], r.lobe[4][k]), r.lobe[5][k],
                                 vec3(r.lobe[6][k], r.lobe[7][k], r.lobe[8][k])};
    return vsgl_specular_2024(f, axis, K, peak);
  } else {
    const VsglAsgReceiver a{vec2(r.lobe[0][k], r.lobe[1][k]), r.lobe[2][k], r.lobe[3][k], r.lobe[4][k],
                            r.lobe[5][k]};
    return vsgl_specular_2015(a, axis, K, peak);
  }
}

/// Adds one light's radiance by way of points [begin, end) to out[0..2][k].
template <bool second, bool specular, bool exact>
void add_lobe(const TilePoints& p, const VsglReceivers& r, VsglReceivers::Run run, const VsglLobe& lobe,
              Options o, float* out_r, float* out_g, float* out_b) {
  const VsglLight light{lobe.position, lobe.variance, lobe.flux, lobe.sharpness, lobe.axis};
  const float coefficient = lobe.coefficient;
#pragma omp simd
  for (int k = run.begin; k < run.end; ++k) {
    vec3 axis;
    float scale;
    const float K = vsgl_radiance(light, coefficient, vec3(p.x[k], p.y[k], p.z[k]), o.least_share,
                                  o.least_variance, axis, scale);
    const vec3 local(p.tx[k] * axis.x + p.ty[k] * axis.y + p.tz[k] * axis.z,
                     p.bx[k] * axis.x + p.by[k] * axis.y + p.bz[k] * axis.z,
                     p.nx[k] * axis.x + p.ny[k] * axis.y + p.nz[k] * axis.z);
    float diffuse = second ? sg_cosine_2024(local.z, K) : sg_cosine_2015(local.z, K);
    float red = 0, green = 0, blue = 0;
    if constexpr (specular) {
      diffuse *=
          vsgl_coat_at(vec3(r.base[k], r.square[k], r.fifth[k]), vsgl_base_cosine(local.z, K));  // (VSGL-19)

      // (VSGL-17) Fresnel's factor at the half vector of camera and peak stands for that of the whole lobe.
      const vec3 v(p.ox[k], p.oy[k], p.oz[k]);
      vec3 peak;
      const float reflected = specular_at<second>(r, k, v, local, K, peak);
      const float cosine = vsgl_half_cosine(v, peak);
      const float schlick = schlick_weight(cosine);
      red = r.f0r[k] + r.f1r[k] * schlick;
      green = r.f0g[k] + r.f1g[k] * schlick;
      blue = r.f0b[k] + r.f1b[k] * schlick;
      if constexpr (exact) {
        red += r.tr[k] * fresnel_conductor(cosine, r.er[k], r.kr[k]);
        green += r.tg[k] * fresnel_conductor(cosine, r.eg[k], r.kg[k]);
        blue += r.tb[k] * fresnel_conductor(cosine, r.eb[k], r.kb[k]);
      }
      red *= reflected, green *= reflected, blue *= reflected;
    }
    out_r[k] += light.flux.x * scale * (r.dr[k] * diffuse + red);
    out_g[k] += light.flux.y * scale * (r.dg[k] * diffuse + green);
    out_b[k] += light.flux.z * scale * (r.db[k] * diffuse + blue);
  }
}

using AddLobe = decltype(&add_lobe<true, true, true>);

AddLobe loop_for(bool second, const VsglReceivers::Run& run) {
  if (second) {
    if (!run.specular) return add_lobe<true, false, false>;
    return run.exact ? add_lobe<true, true, true> : add_lobe<true, true, false>;
  }
  if (!run.specular) return add_lobe<false, false, false>;
  return run.exact ? add_lobe<false, true, true> : add_lobe<false, true, false>;
}

/// Bits of the points that `target` is in front of: a shadow ray cannot leave through the back of the shaded
/// surface.
uint64_t in_front(const TilePoints& p, vec3 target) {
  alignas(64) TilePoints::Floats side;
#pragma omp simd
  for (int k = 0; k < p.padded; ++k)
    side[k] = (target.x - p.x[k]) * p.gx[k] + (target.y - p.y[k]) * p.gy[k] + (target.z - p.z[k]) * p.gz[k];
  uint64_t bits = 0;
  for (int k = 0; k < p.count; ++k) bits |= uint64_t{side[k] > 0} << k;
  return bits;
}

}  // namespace

float VsglIntegrator::least_share() const {
  return params_.generation == VsglGeneration::y2024 ? kLeastShare2024 : kLeastShare2015;
}

VsglIntegrator::VsglIntegrator(const VsglParams& params) : ManyLights(params), params_(params) {
  if (params.distribution == ManyLightsParams::Distribution::paths)
    throw SceneError(
        "vsgl: found \"distribution\": \"paths\", expected \"grid\": its lights are fitted to blocks of a "
        "reflective "
        "shadow map (vpl, vsl and hvl take light paths)");
}

void VsglIntegrator::prepare(const Pass& pass, const VirtualLightSet& set, LightArrays&, const Stop&,
                             PassStats& stats) {
  for (const auto& material : pass.scene.materials())
    if (std::string(material->type()) == "measured")
      throw SceneError(
          fmt::format("vsgl: material \"{}\" is measured, expected a material with a GGX or Blinn-Phong "
                      "lobe or none: no spherical Gaussian is known for it (vpl, vsl and hvl take it)",
                      material->name));
  blocks_ = fit_blocks(set, params_.generation, pass.scene.bounds().radius);
  least_variance_ = sqr(1e-6f * pass.scene.bounds().radius);
  double lobes = 0;
  for (const VsglBlock& block : blocks_)
    for (const VsglLobe& lobe : block) lobes += is_black(lobe.flux) ? 0 : 1;
  stats.numbers["spherical_gaussians"] += lobes;
  stats.numbers["block_texels_found"] += static_cast<double>(set.texels.size());
}

std::unique_ptr<TileState> VsglIntegrator::prepare_tile(const TilePoints& points) const {
  return std::make_unique<VsglReceivers>(points, params_.generation);
}

void VsglIntegrator::gather(const TilePoints& points, int first, int count, Contributions& out) const {
  const auto& receivers = static_cast<const VsglReceivers&>(*points.state);
  const bool second = params_.generation == VsglGeneration::y2024;
  const Options options{second, least_share(), least_variance_};
  out.order = Contributions::Order::by_light;
  for (int j = 0; j < count; ++j) {
    float* r = &out.r[out.at(j, 0)];
    float* g = &out.g[out.at(j, 0)];
    float* b = &out.b[out.at(j, 0)];
    std::fill_n(r, points.padded, 0.0f), std::fill_n(g, points.padded, 0.0f),
        std::fill_n(b, points.padded, 0.0f);
    // Spherical Gaussians cost about as much as shadow rays: eight points that are all hidden get none.
    uint64_t seen = ~uint64_t{0};
    if (shared().occlusion == Occlusion::center)
      seen = visible(points, first + j, in_front(points, lights().target[first + j]), &out.shadow_rays);
    for (const VsglReceivers::Run& whole : receivers.runs) {
      const AddLobe add = loop_for(second, whole);
      VsglReceivers::Run run = whole;
      for (int at = whole.begin; at < whole.end; at = run.end) {
        run.begin = run.end = at;
        while (run.end < whole.end && (seen >> run.end & 0xff)) run.end += 8;
        for (const VsglLobe& lobe : blocks_[first + j])
          if (run.end > run.begin && !is_black(lobe.flux))
            add(points, receivers, run, lobe, options, r, g, b);
        if (run.end == run.begin) run.end += 8;
      }
    }
    for (uint64_t hidden = ~seen; hidden != 0; hidden &= hidden - 1) {
      const int k = std::countr_zero(hidden);
      r[k] = g[k] = b[k] = 0;
    }
  }
}

}  // namespace zonal
