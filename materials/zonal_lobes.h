#pragma once
/// Decomposable BRDFs as a diffuse part and one circularly symmetric lobe, for the fast path of Mézières
/// 2022, Sec. 5.2.7: the lobe is zonal about an axis, so it meets a spherical light in one sum over bands
/// (Eq. 5.14).
///
///     ZonalBrdf z = zonal_brdf(bsdf, view, 10);
///     // integral of f L cos over a cap with zonal coefficients cap[l] in the direction w (shading frame):
///     //   diffuse part: z.diffuse times the irradiance of the cap
///     //   specular part: z.specular * max(0, w.z) * sum over l of z.lobe[l] cap[l] P_l(dot(w, z.axis))
///
/// A lobe cut to few bands rings below 0. Clamp the sum over all lights, never each: sums stay within a few
/// per cent of the true albedo, while clamping each light of a narrow lobe adds from a quarter to several
/// times that.
///
/// The thesis takes the lobe by roughness alone, which a GGX lobe follows only at normal incidence. Ours
/// comes from a table by width and elevation: about the direction in which f cos peaks, the mean of the true
/// lobe on each circle, weighted by the cosine, so that with all bands it reflects exactly what the true lobe
/// does. docs/materials.md has its error.

#include <array>
#include <span>
#include <string>

#include "materials/bsdf.h"

namespace zonal {

inline constexpr int kMaxZonalBands = 64;

struct ZonalBrdf {
  vec3 diffuse{
      0};  ///< 1/sr: albedo / pi of the diffuse part; under a coat, what comes out of it towards w_out
  vec3 axis{0, 0, 1};  ///< unit, shading frame: where the specular lobe points
  vec3 specular{0};    ///< weight of the lobe: tint times Fresnel's mean over it; 0: no lobe
  std::array<float, kMaxZonalBands>
      lobe{};  ///< zonal coefficients F_l of the lobe as a BRDF (no cosine), 1/sr
};

/// Empty where the reflection has a symmetric lobe or none at all; else why not, to follow the material's
/// name: "is measured:
/// ...". Measured and anisotropic ones have none.
std::string zonal_lobe_refusal(const Bsdf& bsdf);
inline bool has_zonal_lobe(const Bsdf& bsdf) {
  return zonal_lobe_refusal(bsdf).empty();
}

/// 1 <= bands <= kMaxZonalBands; lobe[bands..] is 0. `view` is prepare(bsdf, w_out), either end. Where there
/// is no symmetric lobe, or w_out is below the horizon, everything is 0. The first call makes a table (0.1
/// s).
ZonalBrdf zonal_brdf(const Bsdf& bsdf, const BsdfContext& view, int bands);

/// The table behind it, of GGX or of Blinn-Phong, for a copy elsewhere (a GPU): [56 widths][64 cosines][67],
/// the last being what the lobe reflects, 1 - the cosine at which to take Fresnel, the fourth root of the
/// axis' cosine, and F_l times that cosine.
std::span<const float> zonal_lobe_table(bool ggx);

}  // namespace zonal
