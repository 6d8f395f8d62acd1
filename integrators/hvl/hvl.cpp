#include "integrators/hvl/hvl.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "sh/clamped_cosine.h"
#include "sh/window.h"

namespace zonal {

void HvlParams::visit(ParamVisitor& v) {
  ManyLightsParams::visit(v, {.occlusions = 3});
  v.choice("product", product, {"sh", "zonal"},
           "sh: any material by its table; zonal: a diffuse part and one symmetric lobe");
  v.integer_or_auto("bands", bands, {1, hvl::kMaxBands}, "bands",
                    "of the receiver's BRDF; auto: those its material keeps at that elevation");
  v.choice("emission", emission, {"sh", "brdf"}, "how a light evaluates its BRDF");
  v.integer_or_auto("emission_bands", emission_bands, {1, hvl::kMaxBands}, "bands",
                    "of the lights' BRDF (emission sh)");
  radius.visit(v);
  v.number("soft_edge", soft_edge, {0, 4}, "half angles", "how far the edge of a light's disk is blurred");
  v.choice("window", window, {"none", "hann", "lanczos", "hamming", "auto"},
           "softens the cut at the receiver's last band; auto: no light is received negatively");
  v.number("window_size", window_size, {0, 1000}, "bands",
           "of hann, lanczos, hamming; 0: the receiver's bands");
}

namespace {

/// What a tile's points do with light.
struct HvlTile : TileState {
  hvl::Receivers receivers;
};

/// Emission by the light's BRDF itself.
struct EmitBrdf {
  const LightArrays& lights;
  const BsdfArrays& brdfs;
  const std::vector<HvlIntegrator::Brdf>& of;
  int first;

  void operator()(int i, const hvl::V& x, const hvl::V& y, const hvl::V& z, hvl::V* out) const {
    const int j = first + i;
    if (of[j].at < 0) {
      const hvl::V up = -(lights.nx[j] * x + lights.ny[j] * y + lights.nz[j] * z), zero = {};
      for (int c = 0; c < 3; ++c) out[c] = up > 0.0f ? zero + of[j].flat[c] : zero;
      return;
    }
    alignas(64) float w[3][hvl::kLanes], f[3][hvl::kLanes];
    hvl::store(w[0], -(lights.tx[j] * x + lights.ty[j] * y + lights.tz[j] * z));
    hvl::store(w[1], -(lights.bx[j] * x + lights.by[j] * y + lights.bz[j] * z));
    hvl::store(w[2], -(lights.nx[j] * x + lights.ny[j] * y + lights.nz[j] * z));
    brdfs.evaluate_one(of[j].at, hvl::kLanes, w[0], w[1], w[2], f[0], f[1], f[2]);
    for (int c = 0; c < 3; ++c) hvl::load(f[c], out[c]);
  }
};

}  // namespace

HvlIntegrator::HvlIntegrator(const HvlParams& params, const std::string& where)
    : ManyLights(params), params_(params), where_(where) {}

void HvlIntegrator::window(int count, float* weights) const {
  const double size = params_.window_size > 0 ? params_.window_size : count;
  using Window = HvlParams::Window;
  if (params_.window == Window::automatic) {
    sh::positive_weights(count, weights);
    return;
  }
  for (int l = 0; l < count; ++l)
    weights[l] = float(sh::window_weight(static_cast<sh::Window>(params_.window), l, size));
}

void HvlIntegrator::load(const Scene& scene, const Stop& stop, PassStats& stats) {
  loaded_ = &scene;
  if (params_.product == HvlParams::Product::zonal) {
    refuse_lobeless(scene);
    // The first lobe of its kind makes a table of them: a tenth of a second that belongs here.
    for (const auto& material : scene.materials()) {
      const Bsdf bsdf = material->at(vec2(0.5f));
      zonal_brdf(bsdf, zonal::prepare(bsdf, vec3(0, 0, 1)), 1);
    }
  }
  const bool receiver = params_.product == HvlParams::Product::sh;
  const bool light = params_.emission == HvlParams::Emission::sh;
  if (!receiver && !light) return;
  ShMaterialsOptions options;
  const bool automatic = (receiver && params_.bands == kAuto) || (light && params_.emission_bands == kAuto);
  if (!automatic) options.bands = std::max(receiver ? params_.bands : 1, light ? params_.emission_bands : 1);
  const auto start = std::chrono::steady_clock::now();
  materials_ = ShMaterials(scene.materials(), options, stop);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  stats.numbers["material_projection_seconds"] = spent.count();
}

void HvlIntegrator::refuse_lobeless(const Scene& scene) const {
  for (const auto& material : scene.materials()) {
    const std::string reason = zonal_lobe_refusal(material->at(vec2(0.5f)));
    if (!reason.empty())
      throw SceneError(where_ + ": /product: found \"zonal\", but the material \"" + material->name + "\" " +
                       reason);
  }
}

/// (HVL-2) for every light: coefficients of the even extension, scaled so that the light sends what it
/// reflects.
void HvlIntegrator::prepare_emission(const VirtualLightSet& set, const Stop& stop) {
  const int count = static_cast<int>(set.lights.size());
  emission_mirrored_ = true;
  emission_bands_ = 1;
  std::vector<int> bands(set.lights.size());
  for (int j = 0; j < count; ++j) {
    const VirtualLight& light = set.lights[j];
    const vec3 w_in = light.frame.to_local(light.w_in);
    emission_mirrored_ = emission_mirrored_ && materials_.mirrored(light.material);
    bands[j] = params_.emission_bands != kAuto
                   ? params_.emission_bands
                   : materials_.bands(light.material, light.bsdf, ShTable::brdf, w_in);
    bands[j] = std::clamp(bands[j], 1, hvl::kMaxBands);
    emission_bands_ = std::max(emission_bands_, bands[j]);
  }

  const int stored = hvl::even_count(emission_bands_, emission_mirrored_);
  emission_.assign(size_t(count) * stored * 3, 0.0f);
  emitters_.resize(set.lights.size());
  std::vector<float> cosine(emission_bands_);
  sh::clamped_cosine_zonal(emission_bands_, cosine.data());
  tbb::parallel_for(0, count, [&](int j) {
    if (j % 1024 == 0 && stop()) return;
    const VirtualLight& light = set.lights[j];
    const vec3 w_in = light.frame.to_local(light.w_in);
    const ViewFrame view(w_in);
    float* out = emission_.data() + size_t(j) * stored * 3;
    emitters_[j] = {view.c * light.frame.x + view.s * light.frame.y,
                    view.c * light.frame.y - view.s * light.frame.x, light.frame.z, out,
                    light.bsdf.kind == BsdfKind::lambert};
    const bool mirrored = materials_.mirrored(light.material);
    const int stride = sh_count(bands[j], mirrored);
    std::vector<float> F(size_t(stride) * 3);
    materials_.look_up(light.material, light.bsdf, ShTable::brdf, w_in, bands[j], stride, F.data());

    // What the light should send a unit flux, from band 0 of F', and what the bands at hand send.
    float whole[3];
    materials_.look_up(light.material, light.bsdf, ShTable::brdf_cosine, w_in, 1, 1, whole);
    float scale[3];
    for (int c = 0; c < 3; ++c) {
      double sent = 0;
      for (int l = 0; l < bands[j]; l += 2) {
        const int i = mirrored ? l * (l + 1) / 2 : l * (l + 1);
        sent += 2.0 * F[size_t(c) * stride + i] * cosine[l];
      }
      const double reflected = 3.5449077018110318 * whole[c];  // sqrt(4 pi)
      // Too few bands of a narrow lobe may send next to nothing: then nothing is known to scale.
      scale[c] = sent > 0.05 * reflected ? float(std::max(reflected, 0.0) / sent) : 1.0f;
    }

    const hvl::Bands& table = hvl::Bands::table();
    hvl::for_each_even_coefficient(emission_bands_, emission_mirrored_, [&](int place, int l, int m, int) {
      if (l >= bands[j] || (mirrored && m < 0)) return;
      const int i = mirrored ? l * (l + 1) / 2 + m : l * (l + 1) + m;
      for (int c = 0; c < 3; ++c)
        out[3 * place + c] = 2.0f * scale[c] * table.norm(l, std::abs(m)) * F[size_t(c) * stride + i];
    });
  });
}

void HvlIntegrator::prepare(const Pass& pass, const VirtualLightSet& set, LightArrays& arrays,
                            const Stop& stop, PassStats& stats) {
  if (loaded_ != &pass.scene) load(pass.scene, stop, stats);
  const int count = static_cast<int>(set.lights.size());
  records_.resize(set.lights.size());
  const std::vector<float> radii = virtual_light_radii(set, params_.radius, pass.scene.bounds().radius);
  for (int j = 0; j < count; ++j) {
    const VirtualLight& light = set.lights[j];
    arrays.radius[j] = radii[j];
    records_[j] = {light.position, light.normal, arrays.radius[j], light.power};
  }
  if (params_.emission == HvlParams::Emission::sh) {
    prepare_emission(set, stop);
    return;
  }
  // Matt lights are one number.
  int glossy = 0;
  brdf_of_.assign(set.lights.size(), {});
  for (int j = 0; j < count; ++j) {
    const Bsdf& b = arrays.bsdf[j];
    if (b.kind == BsdfKind::lambert)
      brdf_of_[j].flat = b.diffuse * kInvPi;
    else
      brdf_of_[j].at = glossy++;
  }
  brdfs_ = BsdfArrays(glossy);
  for (int j = 0; j < count; ++j)
    if (brdf_of_[j].at >= 0) brdfs_.set(brdf_of_[j].at, arrays.bsdf[j], arrays.view[j]);
  brdfs_.finish();
}

void HvlIntegrator::receive_sh(const TilePoints& points, hvl::Receivers& r) const {
  std::array<int, kTilePixels> bands;
  std::array<uint32_t, kTilePixels> material;
  for (int g = 0; g * hvl::kLanes < points.count; ++g) {
    const int end = std::min(points.count, (g + 1) * hvl::kLanes);
    const bool automatic = params_.bands == kAuto;
    const auto is_matt = [&](int k) { return points.bsdf(k).kind == BsdfKind::lambert; };
    int most = 1, matt = 0;
    bool mirrored = true;
    for (int k = g * hvl::kLanes; k < end; ++k) {
      const vec3 w_out(points.ox[k], points.oy[k], points.oz[k]);
      material[k] = points.surface(k).material;
      if (automatic && is_matt(k)) ++matt;
      bands[k] = !automatic ? params_.bands
                            : materials_.bands(material[k], points.bsdf(k), ShTable::brdf_cosine, w_out);
      bands[k] = std::clamp(bands[k], 1, hvl::kMaxBands);
      most = std::max(most, bands[k]);
      mirrored = mirrored && materials_.mirrored(material[k]);
    }
    if (matt == end - g * hvl::kLanes) {
      // All their bands, in closed form.
      r.open_matt(g);
      for (int k = g * hvl::kLanes; k < end; ++k)
        for (int c = 0; c < 3; ++c) r.diffuse[c][k] = points.bsdf(k).diffuse[c] * kInvPi;
      continue;
    }
    r.open(g, most, mirrored);
    std::vector<float> table(3 * size_t(sh_count(most, false)));
    std::array<float, hvl::kMaxBands> weights;
    int weighted = 0;
    for (int k = g * hvl::kLanes; k < end; ++k) {
      const vec3 w_out(points.ox[k], points.oy[k], points.oz[k]);
      if (automatic && is_matt(k)) bands[k] = most;  // they cost the same as its neighbours'
      const bool half = materials_.mirrored(material[k]);
      const int stride = sh_count(bands[k], half);
      materials_.look_up(material[k], points.bsdf(k), ShTable::brdf_cosine, w_out, bands[k], stride,
                         table.data());
      if (weighted != bands[k]) window(weighted = bands[k], weights.data());
      r.set_sh(k, bands[k], half, stride, table.data(), weights.data());
      const ViewFrame view(w_out);
      r.ax[k] = view.c * points.tx[k] + view.s * points.bx[k],
      r.bx[k] = view.c * points.bx[k] - view.s * points.tx[k];
      r.ay[k] = view.c * points.ty[k] + view.s * points.by[k],
      r.by[k] = view.c * points.by[k] - view.s * points.ty[k];
      r.az[k] = view.c * points.tz[k] + view.s * points.bz[k],
      r.bz[k] = view.c * points.bz[k] - view.s * points.tz[k];
    }
  }
}

void HvlIntegrator::receive_zonal(const TilePoints& points, hvl::Receivers& r) const {
  const int bands = params_.bands == kAuto ? 20 : params_.bands;
  std::array<float, hvl::kMaxBands> weights;
  window(bands, weights.data());
  for (int g = 0; g * hvl::kLanes < points.count; ++g) r.open_matt(g);
  for (int k = 0; k < points.count; ++k) {
    if (points.bsdf(k).kind == BsdfKind::lambert) {
      for (int c = 0; c < 3; ++c) r.diffuse[c][k] = points.bsdf(k).diffuse[c] * kInvPi;
      continue;
    }
    const ZonalBrdf z = zonal_brdf(points.bsdf(k), points.view[k], bands);
    const int group = k / hvl::kLanes;
    if (!r.groups[group].lobe) r.open(group, bands, true), r.groups[group].lobe = true;
    r.set_zonal(k, bands, z.lobe.data(), weights.data());
    r.ax[k] = points.tx[k] * z.axis.x + points.bx[k] * z.axis.y + points.nx[k] * z.axis.z;
    r.ay[k] = points.ty[k] * z.axis.x + points.by[k] * z.axis.y + points.ny[k] * z.axis.z;
    r.az[k] = points.tz[k] * z.axis.x + points.bz[k] * z.axis.y + points.nz[k] * z.axis.z;
    for (int c = 0; c < 3; ++c) r.diffuse[c][k] = z.diffuse[c], r.specular[c][k] = z.specular[c];
  }
}

std::unique_ptr<TileState> HvlIntegrator::prepare_tile(const TilePoints& points) const {
  auto tile = std::make_unique<HvlTile>();
  hvl::Receivers& r = tile->receivers;
  std::copy_n(points.x.begin(), points.count, r.x.begin()),
      std::copy_n(points.y.begin(), points.count, r.y.begin());
  std::copy_n(points.z.begin(), points.count, r.z.begin());
  std::copy_n(points.gx.begin(), points.count, r.gx.begin()),
      std::copy_n(points.gy.begin(), points.count, r.gy.begin());
  std::copy_n(points.gz.begin(), points.count, r.gz.begin());
  std::copy_n(points.nx.begin(), points.count, r.nx.begin()),
      std::copy_n(points.ny.begin(), points.count, r.ny.begin());
  std::copy_n(points.nz.begin(), points.count, r.nz.begin());
  if (params_.product == HvlParams::Product::sh) {
    r.product = hvl::Product::sh;
    receive_sh(points, r);
  } else {
    r.product = hvl::Product::zonal;
    receive_zonal(points, r);
  }
  return tile;
}

/// Calls f with the function that `hvl::gather` emits by, for lights from `first` on.
template <class F>
void HvlIntegrator::with_emission(int first, F&& f) const {
  if (params_.emission == HvlParams::Emission::brdf) return f(EmitBrdf{lights(), brdfs_, brdf_of_, first});
  const Emitter* emitters = emitters_.data() + first;
  const auto by_sh = [&](auto bands, auto mirrored) {
    f([emitters, count = emission_bands_](int j, const hvl::V& x, const hvl::V& y, const hvl::V& z,
                                          hvl::V* sent) {
      constexpr int kBands = decltype(bands)::value;
      const Emitter& e = emitters[j];
      const hvl::V up = -(e.z.x * x + e.z.y * y + e.z.z * z), zero = {};
      if (e.flat) {
        for (int c = 0; c < 3; ++c) sent[c] = up > 0.0f ? zero + e.coefficients[c] : zero;
        return;
      }
      hvl::emission<kBands, decltype(mirrored)::value>(hvl::Bands::table(), count, e.coefficients,
                                                       -(e.x.x * x + e.x.y * y + e.x.z * z),
                                                       -(e.y.x * x + e.y.y * y + e.y.z * z), up, sent);
      for (int c = 0; c < 3; ++c) sent[c] = up > 0.0f ? sent[c] : zero;
    });
  };
  if (emission_mirrored_ && emission_bands_ == 3)
    by_sh(std::integral_constant<int, 3>{}, std::true_type{});
  else if (emission_mirrored_)
    by_sh(std::integral_constant<int, 0>{}, std::true_type{});
  else
    by_sh(std::integral_constant<int, 0>{}, std::false_type{});
}

HvlIntegrator::ShEmission HvlIntegrator::sh_emission(int j) const {
  const Emitter& e = emitters_[j];
  ShEmission result{e.x, e.y, e.z, std::vector<vec3>(size_t(emission_bands_) * (emission_bands_ + 1) / 2)};
  hvl::for_each_even_coefficient(emission_bands_, emission_mirrored_, [&](int place, int l, int m, int) {
    // The lanes' own factors come off again.
    const float scale = 0.5f / hvl::Bands::table().norm(l, std::abs(m));
    const float* c = e.coefficients + 3 * place;
    result.coefficients[size_t(l) * (l + 1) / 2 + (m + l) / 2] = scale * vec3(c[0], c[1], c[2]);
  });
  return result;
}

vec3 HvlIntegrator::emission(int j, vec3 w) const {
  vec3 result;
  with_emission(j, [&](const auto& emit) {
    const hvl::V zero = {};
    hvl::V sent[3];
    emit(0, zero - w.x, zero - w.y, zero - w.z, sent);
    result = {sent[0][0], sent[1][0], sent[2][0]};
  });
  return result;
}

void HvlIntegrator::gather(const TilePoints& points, int first, int count, Contributions& out) const {
  const hvl::Receivers& r = static_cast<const HvlTile*>(points.state)->receivers;
  const hvl::Out to{out.r.data(), out.g.data(), out.b.data()};
  out.order = Contributions::Order::by_light;
  with_emission(first, [&](const auto& emit) {
    hvl::gather(r, records_.data() + first, count, params_.soft_edge, emit, to);
  });
}

void HvlIntegrator::gather_sums(const TilePoints& points, int first, int count, PointSums& sums) const {
  const hvl::Receivers& r = static_cast<const HvlTile*>(points.state)->receivers;
  const hvl::Sums to{sums.r.data(), sums.g.data(), sums.b.data()};
  with_emission(first, [&](const auto& emit) {
    hvl::gather(r, records_.data() + first, count, params_.soft_edge, emit, to);
  });
}

}  // namespace zonal
