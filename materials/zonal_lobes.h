#pragma once
/// Decomposable BRDFs as a diffuse part and one circularly symmetric lobe, for the fast path of Mézières 2022, Sec.
/// 5.2.7: the lobe is zonal about an axis, so it meets a spherical light in one sum over bands (Eq. 5.14).
///
///     ZonalBrdf z = zonal_brdf(bsdf, view, 10);
///     // integral of f L cos over a cap with zonal coefficients cap[l] in the direction w:
///     //   diffuse part: z.diffuse times E(dot(n, w)) (2x2 form); specular part:
///     //   z.specular * max(0, w.z) * sum over l of z.lobe[l] cap[l] P_l(dot(w, z.axis))

#include <array>
#include <string>

#include "materials/bsdf.h"

namespace zonal {

inline constexpr int kMaxZonalBands = 64;

struct ZonalBrdf {
  vec3 diffuse{0};        ///< 1/sr: albedo / pi of the diffuse part, directional where the coat takes its share
  vec3 axis{0, 0, 1};     ///< unit, shading frame: where the specular lobe points
  vec3 specular{0};       ///< weight of the lobe: Fresnel at the half vector of view and axis, tint
  std::array<float, kMaxZonalBands> lobe{};  ///< zonal coefficients F_l of the lobe as a BRDF (no cosine), 1/sr
};

/// False where the kind has no symmetric lobe (measured); the message of the refusal names the kind.
bool has_zonal_lobe(const Bsdf& bsdf);
ZonalBrdf zonal_brdf(const Bsdf& bsdf, const BsdfContext& view, int bands);

}  // namespace zonal
