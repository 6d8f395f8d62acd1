#include "integrators/sh_direct/sh_receiver.h"

#include <algorithm>

#include "materials/zonal_lobes.h"
#include "sh/clamped_cosine.h"
#include "sh/products.h"
#include "sh/rotation.h"
#include "sh/window.h"

namespace zonal {

namespace {

constexpr float kTwoRootPi = 3.5449077018110318f;  // integral of Y_00 is 1/Y_00
constexpr int kMostCount = kMostShBands * kMostShBands;

/// World to a frame with the given axes, as sh::Rotation wants it.
sh::Mat3<float> into(vec3 x, vec3 y, vec3 z) {
  return glm::transpose(sh::Mat3<float>(x, y, z));
}

/// The view frame of a point, in world: z = normal, x towards the azimuth of w_out.
sh::Mat3<float> into_view(const Frame& f, vec3 w_out) {
  const ViewFrame view(w_out);
  return into(view.c * f.x + view.s * f.y, view.c * f.y - view.s * f.x, f.z);
}

/// Three colours side by side, coefficient after coefficient, turned; `bands` bands of L, which has stride
/// `n`.
void turned_colours(int bands, const sh::Mat3<float>& R, const float* L, size_t n, float* out) {
  float in[3 * kMostCount];
  for (int i = 0; i < sh::count(bands); ++i)
    for (int c = 0; c < 3; ++c) in[3 * i + c] = L[c * n + i];
  sh::rotate_zxzxz(bands, R, 3, in, out);
}

}  // namespace

void ShReceiverParams::visit(ParamVisitor& v) {
  v.integer_or_auto("bands", bands, {1, kMostShBands}, "bands",
                    "of the receiver's BRDF; auto: those its material keeps at that elevation");
  v.integer_or_auto("light_bands", light_bands, {1, kMostShBands}, "bands",
                    "of the lights; auto: as many as the receiver");
  v.choice(
      "product", product, {"sh", "zonal"},
      "sh: light as a whole; zonal: light by light with a diffuse part and one symmetric lobe (at pixel)");
  v.choice("shading", shading, {"table", "cosine", "general", "turned"},
           "table: BRDF with cosine; else light times cosine, then the BRDF: by Eq. 4.6, 2.48 or 4.5");
  v.integer("cosine_bands", cosine_bands, {0, kMostShBands}, "bands",
            "of the cosine (general, turned, irradiance); 0: as many as the receiver");
  v.choice("diffuse", diffuse, {"same", "irradiance"},
           "shading other than table: diffuse light from the product's mean (Eq. 4.4), or as irradiance");
  v.choice(
      "window", window, {"none", "hann", "lanczos", "hamming", "auto", "dering"},
      "softens the cut at the last band; auto: nothing is received negatively, whatever the light; dering: "
      "as little as each point's light needs for that");
  v.number("window_size", window_size, {0, 1000}, "bands",
           "of hann, lanczos, hamming; 0: the bands there are");
  v.choice("windowed", windowed, {"light", "material"}, "which side is windowed");
}

ShReceiver::ShReceiver(const ShReceiverParams& params,
                       const std::vector<std::unique_ptr<Material>>& materials, const Stop& stop)
    : params_(params) {
  const bool table = params.shading == ShReceiverParams::Shading::table;
  ShMaterialsOptions options;
  options.most_bands = kMostShBands;
  if (params.bands != kAuto) options.bands = params.bands;
  // F' times light: no more bands of either than the other has.
  if (table && params.light_bands != kAuto && params.bands != kAuto)
    options.bands = std::min(params.bands, params.light_bands);
  materials_ = ShMaterials(materials, options, stop);
  const int needed = std::min(kMostShBands, std::max(1, materials_.max_bands()));
  most_light_bands_ = params.light_bands != kAuto ? params.light_bands : needed;
  if (table) most_light_bands_ = std::min(most_light_bands_, needed);

  // The first lobe of its kind makes a table of them: a tenth of a second that belongs here.
  if (!table || params.product == ShReceiverParams::Product::zonal)
    for (const auto& material : materials) {
      const Bsdf bsdf = material->at(vec2(0.5f));
      if (has_zonal_lobe(bsdf)) zonal_brdf(bsdf, prepare(bsdf, vec3(0, 0, 1)), 1);
    }
  if (params.window == ShReceiverParams::Window::dering)
    for (int count = 1; count <= most_light_bands_; ++count) dering_.emplace_back(count);
  sh::clamped_cosine_zonal(kMostShBands, cosine_.data());
  for (int l = 0; l < kMostShBands; ++l) cosine_[l] *= std::sqrt(4 * kPi / float(2 * l + 1));
  for (int count = 1; count <= kMostShBands; ++count) window(count, windows_[count].data());
}

/// Weights of `count` bands.
void ShReceiver::window(int count, float* weights) const {
  using Window = ShReceiverParams::Window;
  if (params_.window == Window::automatic) return sh::positive_weights(count, weights);
  if (params_.window == Window::dering) return std::fill_n(weights, count, 1.0f), void();
  const double size = params_.window_size > 0 ? params_.window_size : count;
  for (int l = 0; l < count; ++l)
    weights[l] = float(sh::window_weight(static_cast<sh::Window>(params_.window), l, size));
}

int ShReceiver::bands_of(const Surface& s, const Bsdf& bsdf, vec3 w_out) const {
  if (params_.bands != kAuto) return params_.bands;
  return std::clamp(materials_.bands(s.material, bsdf, ShTable::brdf_cosine, w_out), 1, kMostShBands);
}

int ShReceiver::light_bands(const Surface& s, const Bsdf& bsdf) const {
  if (params_.light_bands != kAuto &&
      (params_.bands != kAuto || params_.shading != ShReceiverParams::Shading::table))
    return most_light_bands_;
  return std::min(most_light_bands_, bands_of(s, bsdf, s.shading.to_local(s.w_out)));
}

/// (SHD-12) each colour of the light here is windowed by the least strength that leaves none of it negative:
/// what a material with as many bands or more makes of it is the material whole times that light, and not
/// negative either.
vec3 ShReceiver::shade(const Surface& s, const Bsdf& bsdf, int bands, const float* L) const {
  if (params_.window != ShReceiverParams::Window::dering) return shade_as_is(s, bsdf, bands, L);
  float light[3 * kMostCount];
  std::copy_n(L, 3 * sh::count(bands), light);
  dering_[bands - 1].apply(light);
  return shade_as_is(s, bsdf, bands, light);
}

vec3 ShReceiver::shade_as_is(const Surface& s, const Bsdf& bsdf, int bands, const float* L) const {
  if (params_.shading == ShReceiverParams::Shading::table) return by_table(s, bsdf, bands, L);
  return by_product(s, bsdf, bands, L);
}

/// (SHD-2) Lambert's F' is zonal: no rotation. L convolved with the cosine, at the normal.
vec3 ShReceiver::by_irradiance(vec3 normal, int bands, const float* L) const {
  const size_t n = sh::count(bands);
  float Y[kMostCount];
  sh::evaluate(bands, normal, Y);
  const float* weights = windows_[bands].data();
  vec3 E(0);
  for (int l = 0; l < bands; ++l) {
    if (l > 1 && l % 2) continue;  // the clamped cosine has none of these
    vec3 sum(0);
    for (int i = l * l; i < (l + 1) * (l + 1); ++i)
      for (int c = 0; c < 3; ++c) sum[c] += L[c * n + i] * Y[i];
    E += sum * (cosine_[l] * weights[l]);
  }
  return E;
}

/// (SHD-1) the double product of light and F', in the view frame.
vec3 ShReceiver::by_table(const Surface& s, const Bsdf& bsdf, int bands, const float* L) const {
  const size_t n = sh::count(bands);
  if (bsdf.kind == BsdfKind::lambert) {
    // Fewer bands may be asked of the receiver than the light has.
    if (params_.bands != kAuto && params_.bands < bands) {
      std::vector<float> cut(3 * size_t(sh::count(params_.bands)));
      for (size_t c = 0; c < 3; ++c)
        std::copy_n(L + c * n, sh::count(params_.bands), cut.data() + c * sh::count(params_.bands));
      return bsdf.diffuse * kInvPi * by_irradiance(s.shading.z, params_.bands, cut.data());
    }
    return bsdf.diffuse * kInvPi * by_irradiance(s.shading.z, bands, L);
  }
  const vec3 w_out = s.shading.to_local(s.w_out);
  const int used = std::min(bands, bands_of(s, bsdf, w_out));
  float light[3 * kMostCount], table[3 * kMostCount];
  turned_colours(used, into_view(s.shading, w_out), L, n, light);
  const bool mirrored = materials_.mirrored(s.material);
  const int stride = sh_count(used, mirrored);
  materials_.look_up(s.material, bsdf, ShTable::brdf_cosine, w_out, used, stride, table);
  const float* weights = windows_[used].data();
  vec3 sum(0);
  for (int l = 0; l < used; ++l) {
    vec3 band(0);
    for (int m = mirrored ? 0 : -l; m <= l; ++m) {
      const int i = sh::index(l, m), j = sh_index(l, m, mirrored);
      for (int c = 0; c < 3; ++c) band[c] += light[3 * i + c] * table[c * stride + j];
    }
    sum += band * weights[l];
  }
  return sum;
}

/// (SHD-3) light times clamped cosine first; then diffuse from its mean, and the lobe.
vec3 ShReceiver::by_product(const Surface& s, const Bsdf& bsdf, int bands, const float* L) const {
  using Shading = ShReceiverParams::Shading;
  const vec3 w_out = s.shading.to_local(s.w_out);
  const int used = std::max(bands, bands_of(s, bsdf, w_out)), n = sh::count(used);
  const sh::Mat3<float> view = into_view(s.shading, w_out);
  const bool windows_light = params_.windowed == ShReceiverParams::Windowed::light;

  float light[3 * kMostCount], weighted[3 * kMostCount];
  std::fill_n(light, 3 * size_t(n), 0.0f);
  for (int c = 0; c < 3; ++c)
    for (int l = 0; l < bands; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i)
        light[3 * i + c] = L[c * size_t(sh::count(bands)) + i] * (windows_light ? windows_[bands][l] : 1.0f);

  // T of Eq. 2.48, 4.5, 4.6 in the view frame; light[3 i + c].
  if (params_.shading == Shading::cosine) {
    float local[3 * kMostCount];
    std::fill_n(local, 3 * size_t(n), 0.0f);
    sh::rotate_zxzxz(bands, view, 3, light, local);
    sh::clamped_cosine_product(used, 3, local, weighted);
  } else {
    const int cosine_bands = params_.cosine_bands > 0 ? std::min(params_.cosine_bands, used) : used;
    float one[kMostCount], product[kMostCount], turned[kMostCount], cosine[kMostCount] = {};
    float zonal[kMostShBands];
    sh::clamped_cosine_zonal(cosine_bands, zonal);
    sh::rotate_zonal(cosine_bands, s.shading.z, zonal, cosine);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < n; ++i) one[i] = light[3 * i + c];
      if (params_.shading == Shading::turned)
        sh::clamped_cosine_product_low_order(used, cosine_bands, s.shading.z, one, product);
      else
        sh::product(used, one, cosine, product);
      sh::rotate_zxzxz(used, view, product, turned);
      for (int i = 0; i < n; ++i) weighted[3 * i + c] = turned[i];
    }
  }

  vec3 E = kTwoRootPi * vec3(weighted[0], weighted[1], weighted[2]);  // (Eq. 4.4)
  if (params_.diffuse == ShReceiverParams::Diffuse::irradiance) {
    const int cut = std::min(bands, params_.cosine_bands > 0 ? params_.cosine_bands : bands);
    std::vector<float> low(3 * size_t(sh::count(cut)));
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < sh::count(cut); ++i)
        low[c * size_t(sh::count(cut)) + i] = L[c * size_t(sh::count(bands)) + i];
    E = by_irradiance(s.shading.z, cut, low.data());
  }
  if (bsdf.kind == BsdfKind::lambert) return bsdf.diffuse * kInvPi * E;

  const float* weights = windows_[used].data();
  const auto weight = [&](int l) { return windows_light ? 1.0f : weights[l]; };
  vec3 sum(0);
  if (has_zonal_lobe(bsdf)) {
    const ZonalBrdf z = zonal_brdf(bsdf, prepare(bsdf, w_out), used);
    const ViewFrame turn(w_out);
    float Y[kMostCount];
    sh::evaluate(used, turn.to_view(z.axis), Y);
    for (int l = 0; l < used; ++l) {
      vec3 band(0);
      for (int i = l * l; i < (l + 1) * (l + 1); ++i)
        band += Y[i] * vec3(weighted[3 * i], weighted[3 * i + 1], weighted[3 * i + 2]);
      sum += band * (weight(l) * z.lobe[l] * std::sqrt(4 * kPi / float(2 * l + 1)));
    }
    return z.diffuse * E + z.specular * sum;
  }
  const bool mirrored = materials_.mirrored(s.material);
  const int stride = sh_count(used, mirrored);
  std::vector<float> table(3 * size_t(stride));
  materials_.look_up(s.material, bsdf, ShTable::brdf, w_out, used, stride, table.data());
  for (int l = 0; l < used; ++l)
    for (int m = mirrored ? 0 : -l; m <= l; ++m)
      for (int c = 0; c < 3; ++c)
        sum[c] +=
            weight(l) * weighted[3 * sh::index(l, m) + c] * table[c * stride + sh_index(l, m, mirrored)];
  return sum;
}

/// (SHD-9) each light's cap against the lobe about its axis, with the cosine of the light's middle
/// (Sec. 5.2.7).
vec3 ShReceiver::shade_zonal(const Surface& s, const Bsdf& bsdf, const ShLights& lights) const {
  const vec3 w_out = s.shading.to_local(s.w_out);
  const int bands = std::min(most_light_bands_, bands_of(s, bsdf, w_out));
  const float* weights = windows_[bands].data();
  ZonalBrdf z;
  if (bsdf.kind == BsdfKind::lambert)
    z.diffuse = bsdf.diffuse * kInvPi;
  else
    z = zonal_brdf(bsdf, prepare(bsdf, w_out), bands);
  // cosine_ is sqrt(4pi/(2l+1)) times a zonal coefficient; the lights' gains lack sqrt((2l+1)/4pi).
  float cosine[kMostShBands], lobe[kMostShBands];
  for (int l = 0; l < bands; ++l) {
    const float norm = std::sqrt(float(2 * l + 1) / (4 * kPi));
    cosine[l] = cosine_[l] * norm * norm * weights[l], lobe[l] = z.lobe[l] * norm * weights[l];
  }
  vec3 irradiance, reflected;
  lights.zonal(s.position, {s.shading.z, s.shading.to_world(z.axis), bands, cosine, lobe}, &irradiance,
               &reflected);
  std::vector<float> fixed(3 * size_t(sh::count(bands)));
  lights.fixed(bands, fixed.data());
  return z.diffuse * irradiance + z.specular * reflected + by_table(s, bsdf, bands, fixed.data());
}

}  // namespace zonal
