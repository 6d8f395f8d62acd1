#include "integrators/vsl/vsl.h"

#include "core/glsl.h"
#include "core/sampling.h"
#include "materials/microfacet.h"

namespace zonal {
#include "integrators/vsl/vsl.glsl"

namespace {

using Floats = TilePoints::Floats;

/// Radiance beyond which a product of two narrow lobes is cut off, so that sums stay finite.
constexpr float kMost = 1e30f;

/// Directions drawn from the points' BRDFs, the same for all lights: lights that do not overlap then share
/// their noise.
struct BrdfDirections {
  alignas(64) Floats x, y, z;  ///< unit, world
  alignas(64) Floats r, g, b;  ///< f cos, 1/sr; 0 where no direction was found
  alignas(64) Floats pdf;      ///< 1/sr
};

struct VslTile : TileBrdfs {
  std::vector<BrdfDirections> directions;
  uint64_t matt = 0;                          ///< bits of the points whose BRDF is one number
  alignas(64) Floats mr, mg, mb;              ///< that number, 1/sr
  alignas(64) Floats side_x, side_y, side_z;  ///< fixes the turn about the cone's axis: view and normal

  explicit VslTile(const TilePoints& points) : TileBrdfs(points) {
    for (int k = 0; k < points.padded; ++k) {
      const Surface& s = points.surface(k);
      const vec3 side = s.w_out + 0.618f * s.shading.z;
      side_x[k] = side.x, side_y[k] = side.y, side_z[k] = side.z;
      vec3 f(0);
      if (brdfs.constant(k, &f)) matt |= uint64_t{1} << k;
      mr[k] = f.x, mg[k] = f.y, mb[k] = f.z;
    }
  }
};

/// The frame the BRDF of a point is sampled in. Where the shading frame's azimuth means nothing, it is the
/// view's, so that samples turn with the scene.
Frame sampling_frame(const Surface& s, const Bsdf& bsdf) {
  const bool isotropic = bsdf.kind != BsdfKind::measured && bsdf.alpha_x == bsdf.alpha_y;
  return isotropic ? Frame(s.shading.z, s.w_out) : s.shading;
}

/// One light against all points: where its cone is and how wide.
struct Cones {
  alignas(64) Floats wx, wy, wz;              ///< axis: unit, point to light, world
  alignas(64) Floats xx, xy, xz, yx, yy, yz;  ///< the axis' frame
  alignas(64) Floats one_minus_cos;           ///< of the half angle
  alignas(64) Floats scale;                   ///< 2 (1 - cos)/r^2: the cone's solid angle over pi r^2
  alignas(64) Floats lit;                     ///< 1 where both horizons leave some of the cone, else 0
  alignas(64) Floats turn_c, turn_s, shift;   ///< of the pair's lattice
};

/// Directions of one sample for all points, and what comes before the BRDFs.
struct Rays {
  alignas(64) Floats x, y, z;     ///< towards the light, the point's shading frame
  alignas(64) Floats ex, ey, ez;  ///< from the light, its shading frame
  alignas(64) Floats cosines;     ///< of receiver and light; 0 below either horizon
};

/// Points [begin, end), multiples of 8.
struct Run {
  int begin, end;
};

/// A light's numbers in registers.
struct Sphere {
  vec3 position, normal;
  Frame frame;
  float radius;
  uint32_t index;
};

bool see(const TilePoints& points, const VslTile& tile, const Sphere& light, Cones& out) {
  const vec3 p = light.position, n = light.normal;
  const float radius = light.radius;
  float any = 0;
#pragma omp simd reduction(+ : any)
  for (int k = 0; k < points.padded; ++k) {
    const vec3 to_light(p.x - points.x[k], p.y - points.y[k], p.z - points.z[k]);
    const float d2 = dot(to_light, to_light);
    float per_radius2;
    const float one_minus_cos = vsl_cone(d2, radius, per_radius2);
    // At the light itself every direction is as good: its normal reversed.
    const float inverse = 1.0f / sqrt(max(d2, 1e-30f));
    const float here = d2 > 1e-30f ? 0.0f : 1.0f;
    const vec3 w = to_light * inverse - n * here;
    // A vector of the scene's own that is hardly ever along w.
    const vec3 side(tile.side_x[k], tile.side_y[k], tile.side_z[k]);
    vec3 x, y;
    vsl_frame(w, side, x, y);
    out.wx[k] = w.x, out.wy[k] = w.y, out.wz[k] = w.z;
    out.xx[k] = x.x, out.xy[k] = x.y, out.xz[k] = x.z;
    out.yx[k] = y.x, out.yy[k] = y.y, out.yz[k] = y.z;
    out.one_minus_cos[k] = one_minus_cos;
    out.scale[k] = 2.0f * per_radius2;

    // Some of the cone is above a horizon when its axis is less than its half angle below it.
    const float sine = min(radius * inverse, 1.0f);
    const float above_light = -dot(n, w);
    const float above_point = w.x * points.nx[k] + w.y * points.ny[k] + w.z * points.nz[k];
    const float above_plane = w.x * points.gx[k] + w.y * points.gy[k] + w.z * points.gz[k];
    const float lit = above_light > -sine && above_point > -sine && above_plane > -sine ? 1.0f : 0.0f;
    out.lit[k] = lit;
    any += lit;

    uint32_t h = points.seed[k] ^ (light.index * 0x9e3779b9u);
    h ^= h >> 16, h *= 0x7feb352du, h ^= h >> 15, h *= 0x846ca68bu, h ^= h >> 16;
    float c, s;
    vsl_turn(static_cast<float>(static_cast<int>(h)) * 0x1p-32f, c, s);
    out.turn_c[k] = c, out.turn_s[k] = s;
    h *= 0x9e3779b9u, h ^= h >> 16;
    out.shift[k] = static_cast<float>(static_cast<int>(h >> 8)) * 0x1p-24f;
  }
  return any > 0;
}

/// Writes down the direction `w` of point k.
inline void aim(const TilePoints& points, const Sphere& light, int k, vec3 w, float lit, bool frozen,
                vec3 center, Rays& out) {
  const float receiver = w.x * points.nx[k] + w.y * points.ny[k] + w.z * points.nz[k];
  const float side = w.x * points.gx[k] + w.y * points.gy[k] + w.z * points.gz[k];
  const vec3 from = frozen ? center : w;
  const float emitter = -dot(light.normal, from);
  const float both = max(receiver, 0.0f) * max(emitter, 0.0f);
  // A light reflects nothing below its shading horizon, which Lambert's constant value does not say.
  const float above = -dot(from, light.frame.z);
  out.cosines[k] = side > 0.0f && above > kMinCosine ? both * lit : 0.0f;
  out.x[k] = w.x * points.tx[k] + w.y * points.ty[k] + w.z * points.tz[k];
  out.y[k] = w.x * points.bx[k] + w.y * points.by[k] + w.z * points.bz[k];
  out.z[k] = receiver;
  out.ex[k] = -dot(from, light.frame.x), out.ey[k] = -dot(from, light.frame.y);
  out.ez[k] = above;
}

/// A direction of point k's cone. (VSL-3)
[[gnu::always_inline]] inline vec3 in_cone(const Cones& cones, int k, float u, float c, float s) {
  const float shifted = u + cones.shift[k];
  const float inside = shifted >= 1.0f ? shifted - 1.0f : shifted;
  const float tc = cones.turn_c[k] * c - cones.turn_s[k] * s, ts = cones.turn_s[k] * c + cones.turn_c[k] * s;
  return vsl_direction(vec3(cones.wx[k], cones.wy[k], cones.wz[k]),
                       vec3(cones.xx[k], cones.xy[k], cones.xz[k]),
                       vec3(cones.yx[k], cones.yy[k], cones.yz[k]), cones.one_minus_cos[k], inside, tc, ts);
}

/// Adds the cosines of one sample of every point's cone: all that matters between matt surfaces.
template <bool kFrozen>
void add_cosines(const TilePoints& points, Run run, const Sphere& light, const Cones& cones, float u, float c,
                 float s, float* sum) {
#pragma omp simd
  for (int k = run.begin; k < run.end; ++k) {
    const vec3 w = in_cone(cones, k, u, c, s);
    const vec3 from = kFrozen ? vec3(cones.wx[k], cones.wy[k], cones.wz[k]) : w;
    const float receiver = w.x * points.nx[k] + w.y * points.ny[k] + w.z * points.nz[k];
    const float side = w.x * points.gx[k] + w.y * points.gy[k] + w.z * points.gz[k];
    const float both = max(receiver, 0.0f) * max(-dot(light.normal, from), 0.0f);
    sum[k] += side > 0.0f && -dot(from, light.frame.z) > kMinCosine ? both : 0.0f;
  }
}

/// Sample `i` of the lattice in every point's cone.
template <bool kFrozen>
void aim_in_cone(const TilePoints& points, Run run, const Sphere& light, const Cones& cones, float u, float c,
                 float s, Rays& out) {
#pragma omp simd
  for (int k = run.begin; k < run.end; ++k) {
    const vec3 axis(cones.wx[k], cones.wy[k], cones.wz[k]), w = in_cone(cones, k, u, c, s);
    aim(points, light, k, w, cones.lit[k], kFrozen, axis, out);
  }
}

/// The points' own directions, where they lie in the cone. Returns whether any does.
template <bool kFrozen>
bool aim_by_brdf(const TilePoints& points, Run run, const Sphere& light, const Cones& cones,
                 const BrdfDirections& d, Rays& out) {
  float any = 0;
#pragma omp simd reduction(+ : any)
  for (int k = run.begin; k < run.end; ++k) {
    const vec3 axis(cones.wx[k], cones.wy[k], cones.wz[k]), w(d.x[k], d.y[k], d.z[k]);
    const vec3 off = w - axis;
    // 1 - cos between unit vectors, from their difference.
    const float inside = 0.5f * dot(off, off) <= cones.one_minus_cos[k] ? 1.0f : 0.0f;
    const float wanted = inside * cones.lit[k];
    aim(points, light, k, w, wanted, kFrozen, axis, out);
    any += wanted;
  }
  return any > 0;
}

}  // namespace

VslIntegrator::VslIntegrator(const VslParams& params) : ManyLights(params), params_(params) {
  // A rank-1 lattice: one coordinate even, the other by the golden ratio.
  const int n = cone_samples();
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * 3.14159265358979 * std::fmod(i * 0.6180339887498949, 1.0);
    lattice_u_.push_back((static_cast<float>(i) + 0.5f) / static_cast<float>(n));
    lattice_c_.push_back(static_cast<float>(std::cos(angle)));
    lattice_s_.push_back(static_cast<float>(std::sin(angle)));
  }
}

std::vector<vec3> VslIntegrator::lattice() const {
  std::vector<vec3> points;
  for (size_t i = 0; i < lattice_u_.size(); ++i) points.emplace_back(lattice_u_[i], lattice_c_[i], lattice_s_[i]);
  return points;
}

int VslIntegrator::cone_samples() const {
  switch (params_.sampling) {
    case VslParams::Sampling::cone:
      return params_.samples;
    case VslParams::Sampling::brdf:
      return 0;
    case VslParams::Sampling::mis:
      break;
  }
  return (params_.samples + 1) / 2;
}

void VslIntegrator::prepare(const Pass& pass, const VirtualLightSet& set, LightArrays& arrays, const Stop&,
                            PassStats&) {
  const auto radii = virtual_light_radii(set, params_.radius, pass.scene.bounds().radius);
  std::copy(radii.begin(), radii.end(), arrays.radius.begin());
  emitters_ = BsdfArrays(static_cast<int>(set.lights.size()));
  for (int j = 0; j < emitters_.count(); ++j) emitters_.set(j, arrays.bsdf[j], arrays.view[j]);
  emitters_.finish();
  largest_.clear();
  if (shared().skip > 0)
    for (int j = 0; j < emitters_.count(); ++j)
      largest_.push_back(largest_reflection(arrays.bsdf[j], arrays.view[j]));
}

float VslIntegrator::most(const TilePoints& points, const TileBounds& bounds, int light) const {
  const float radius = lights().radius[light];
  const auto reach = bounds.reach(lights().position(light), lights().normal(light), radius);
  float per_radius2;
  vsl_cone(reach.distance * reach.distance, radius, per_radius2);
  const auto& tile = static_cast<const VslTile&>(*points.state);
  const Reflection receiver{tile.flat, tile.peak};
  return luminance(lights().power(light)) * largest_[light].most(reach.cos_light) *
         receiver.most(reach.cos_point) * 2.0f * per_radius2;
}

std::unique_ptr<TileState> VslIntegrator::prepare_tile(const TilePoints& points) const {
  auto tile = std::make_unique<VslTile>(points);
  const int n = brdf_samples();
  tile->directions.resize(static_cast<size_t>(n));
  for (int k = 0; k < points.padded; ++k) {
    const Surface& surface = points.surface(k);
    const Frame frame = sampling_frame(surface, points.bsdf(k));
    const BsdfContext view = zonal::prepare(points.bsdf(k), frame.to_local(surface.w_out));
    const auto shift = [&](uint32_t which) { return unit_float(hash32(points.seed[k], which, 0x76736cu)); };
    const float shift_u = shift(0), shift_v = shift(1), shift_lobe = shift(2);
    for (int i = 0; i < n; ++i) {
      // The same lattice with a third coordinate for the choice of the lobe.
      const auto wrap = [](float x) { return std::fmin(x - std::floor(x), 0x1.fffffep-1f); };
      const vec2 u(wrap(shift_u + (static_cast<float>(i) + 0.5f) / static_cast<float>(n)),
                   wrap(shift_v + static_cast<float>(i) * 0.75487767f));
      const BsdfSample s =
          sample(points.bsdf(k), view, wrap(shift_lobe + static_cast<float>(i) * 0.56984029f), u);
      BrdfDirections& d = tile->directions[i];
      const bool found = s.pdf > 0;
      const vec3 w = found ? frame.to_world(s.w_in) : -frame.z;
      const vec3 f = found ? s.weight * s.pdf : vec3(0);  // f cos
      d.x[k] = w.x, d.y[k] = w.y, d.z[k] = w.z;
      d.r[k] = f.x, d.g[k] = f.y, d.b[k] = f.z;
      d.pdf[k] = found ? s.pdf : 1.0f;
    }
  }
  return tile;
}

/// One light against a tile's points: what its samples share, and where they add up.
struct VslIntegrator::OneLight {
  const TilePoints& points;
  const VslTile& tile;
  Sphere light{};
  Cones cones;
  Rays rays;
  float *sum_r = nullptr, *sum_g = nullptr, *sum_b = nullptr;
};

void VslIntegrator::gather(const TilePoints& points, int first, int count, Contributions& out) const {
  OneLight one{.points = points, .tile = static_cast<const VslTile&>(*points.state)};
  for (int j = 0; j < count; ++j) {
    const int l = first + j, row = out.at(j, 0);
    one.sum_r = &out.r[row], one.sum_g = &out.g[row], one.sum_b = &out.b[row];
    for (int k = 0; k < points.padded; ++k) one.sum_r[k] = one.sum_g[k] = one.sum_b[k] = 0;
    one.light = {lights().position(l), lights().normal(l), lights().frame(l), lights().radius[l],
                 static_cast<uint32_t>(l)};
    if (!see(points, one.tile, one.light, one.cones)) continue;

    // Samples cost more than a shadow ray: eight points that are all hidden have none.
    uint64_t lit = 0;
    for (int k = 0; k < points.count; ++k) lit |= uint64_t{one.cones.lit[k] > 0} << k;
    lit = visible(points, l, lit, &out.shadow_rays);
    for (int k = 0; k < points.padded; ++k) one.cones.lit[k] = static_cast<float>(lit >> k & 1);
    vec3 flat;
    const uint64_t matt =
        cone_samples() == params_.samples && emitters_.constant(l, &flat) ? one.tile.matt : 0;
    const auto part = [&](int k) { return !(lit >> k & 0xff) ? 0 : (matt >> k & 0xff) != 0xff ? 1 : 2; };
    for (int begin = 0, end = 0; begin < points.padded; begin = end) {
      const int kind = part(begin);
      while (end < points.padded && part(end) == kind) end += 8;
      if (kind == 1) sum_samples(one, begin, end);
      if (kind == 2) sum_cosines(one, begin, end, flat * lights().power(l));
    }
  }
}

void VslIntegrator::sum_cosines(OneLight& one, int begin, int end, vec3 sent) const {
  alignas(64) Floats sum;
  std::fill(&sum[begin], &sum[0] + end, 0.0f);
  const auto add = params_.frozen ? add_cosines<true> : add_cosines<false>;
  for (int i = 0; i < params_.samples; ++i)
    add(one.points, {begin, end}, one.light, one.cones, lattice_u_[i], lattice_c_[i], lattice_s_[i],
        sum.data());
  const float each = 1.0f / static_cast<float>(params_.samples);
  for (int k = begin; k < end; ++k) {
    const float weight = sum[k] * each * one.cones.scale[k] * one.cones.lit[k];
    one.sum_r[k] = min(one.tile.mr[k] * weight * sent.x, kMost);
    one.sum_g[k] = min(one.tile.mg[k] * weight * sent.y, kMost);
    one.sum_b[k] = min(one.tile.mb[k] * weight * sent.z, kMost);
  }
}

void VslIntegrator::sum_samples(OneLight& one, int begin, int end) const {
  const Run run{begin, end};
  const Sphere& light = one.light;
  const int l = static_cast<int>(light.index), n = end - begin;
  const int cone = cone_samples(), brdf = brdf_samples();
  const auto cones_drawn = static_cast<float>(cone), brdfs_drawn = static_cast<float>(brdf);
  const Cones& cones = one.cones;
  Rays& rays = one.rays;
  alignas(64) Floats r, g, b, er, eg, eb, pdf;

  // Emission for the directions in `rays`; a constant one stays as it is, a frozen one after the first.
  vec3 flat(0);
  const bool constant = emitters_.constant(l, &flat);
  const auto emit = [&](bool again) {
    if (constant || again) return;
    emitters_.evaluate_one(l, n, &rays.ex[begin], &rays.ey[begin], &rays.ez[begin], &er[begin], &eg[begin],
                           &eb[begin]);
  };
  if (constant) er.fill(flat.x), eg.fill(flat.y), eb.fill(flat.z);
  if (brdf == 0) pdf.fill(0);

  // (VSL-4) from the cone, with (VSL-6) where the BRDF is sampled too.
  const auto aim_all = params_.frozen ? aim_in_cone<true> : aim_in_cone<false>;
  for (int i = 0; i < cone; ++i) {
    aim_all(one.points, run, light, cones, lattice_u_[i], lattice_c_[i], lattice_s_[i], rays);
    emit(params_.frozen && i > 0);
    if (brdf == 0)
      one.tile.brdfs.evaluate(begin, end, &rays.x[begin], &rays.y[begin], &rays.z[begin], &r[begin],
                              &g[begin], &b[begin]);
    else
      one.tile.brdfs.evaluate_with_pdf(begin, end, &rays.x[begin], &rays.y[begin], &rays.z[begin], &r[begin],
                                       &g[begin], &b[begin], &pdf[begin]);
    for (int k = begin; k < end; ++k) {
      const float solid_angle = 2.0f * kPi * cones.one_minus_cos[k];
      const float weight =
          rays.cosines[k] * cones.scale[k] / (cones_drawn + brdfs_drawn * pdf[k] * solid_angle);
      one.sum_r[k] += min(r[k] * weight * er[k], kMost);
      one.sum_g[k] += min(g[k] * weight * eg[k], kMost);
      one.sum_b[k] += min(b[k] * weight * eb[k], kMost);
    }
  }
  // (VSL-5) from the points' BRDFs.
  const auto aim_own = params_.frozen ? aim_by_brdf<true> : aim_by_brdf<false>;
  for (int i = 0; i < brdf; ++i) {
    const BrdfDirections& d = one.tile.directions[i];
    if (!aim_own(one.points, run, light, cones, d, rays)) continue;
    emit(false);
    for (int k = begin; k < end; ++k) {
      const float solid_angle = 2.0f * kPi * cones.one_minus_cos[k];
      const float drawn = max(cones_drawn + brdfs_drawn * d.pdf[k] * solid_angle, 1e-18f);
      // f cos of the point is in d.
      const float emitter = rays.z[k] > 0.0f ? rays.cosines[k] / rays.z[k] : 0.0f;
      const float weight = min(emitter * cones.scale[k] / drawn, 1e18f);
      one.sum_r[k] += min(d.r[k] * weight * er[k], kMost);
      one.sum_g[k] += min(d.g[k] * weight * eg[k], kMost);
      one.sum_b[k] += min(d.b[k] * weight * eb[k], kMost);
    }
  }
  const vec3 power = lights().power(l);
  for (int k = begin; k < end; ++k) {
    one.sum_r[k] = min(one.sum_r[k] * power.x, kMost), one.sum_g[k] = min(one.sum_g[k] * power.y, kMost);
    one.sum_b[k] = min(one.sum_b[k] * power.z, kMost);
  }
}

}  // namespace zonal
