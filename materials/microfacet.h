#pragma once
/// GGX microfacets: how many face a direction, how many of them are seen, and how to draw one of the seen
/// ones.
///
///     vec3 h = sample_visible_normal(w_out, ax, ay, u);
///     float f_over_fresnel = ggx_distribution(h, ax, ay) * ggx_visibility(w_out, w_in, ...);
///
/// Everything is in the shading frame (z = normal). The widths alpha_x and alpha_y are those of Walter et al.
/// 2007, not roughness, and at least kMinAlpha. The formulas take slopes from h.x and h.y, never from 1 -
/// h.z^2: that difference has no correct digit left once alpha nears 1e-4.

#include "core/vec.h"

namespace zonal {

/// Narrowest GGX width: roughness 0.01, a lobe of 0.01 degrees. Below it single-precision half vectors
/// (rounded to 6e-8) no longer resolve the lobe, so smoother surfaces are treated as this one; there is no
/// perfect mirror.
inline constexpr float kMinAlpha = 1e-4f;

/// Directions with a smaller cosine count as below the horizon. Keeps every quotient finite in float: the
/// largest BRDF value is then about 1 / (pi alpha^2) / (4 alpha cos) = 1e19.
inline constexpr float kMinCosine = 1e-8f;

/// Half vector of two directions above the horizon, and its cosine with either.
struct HalfVector {
  vec3 h;
  float cosine;  ///< [0,1]
};
inline HalfVector half_vector(vec3 a, vec3 b) {
  const vec3 sum = a + b;
  const vec3 h = sum * (1.0f / std::sqrt(glm::dot(sum, sum)));
  return {h, std::fmin(std::fmax(glm::dot(a, h), 0.0f), 1.0f)};
}

/// Anisotropic GGX distribution of normals, 1/sr (Walter et al. 2007 eq. 33, Heitz 2014 eq. 85).
inline float ggx_distribution(vec3 h, float alpha_x, float alpha_y) {
  const float s = sqr(h.x / alpha_x) + sqr(h.y / alpha_y) + sqr(h.z);
  return kInvPi / (alpha_x * alpha_y * s * s);
}

/// Length of w after the stretch that makes the surface's GGX hemisphere uniform: |(ax x, ay y, z)|. Smith's
/// Lambda(w) = (ggx_stretch / cos - 1) / 2 (Heitz 2014 eq. 86).
inline float ggx_stretch(vec3 w, float alpha_x, float alpha_y) {
  return std::sqrt(sqr(alpha_x * w.x) + sqr(alpha_y * w.y) + sqr(w.z));
}

/// Height-correlated Smith masking and shadowing over 4 cos_out cos_in (Heitz 2014 eq. 99, with the cosines
/// cancelled).
inline float ggx_visibility(float cos_out, float stretch_out, float cos_in, float stretch_in) {
  return 0.5f / (cos_out * stretch_in + cos_in * stretch_out);
}

/// Density of the reflected direction when h is drawn among the normals seen from w_out, 1/sr:
/// G1(w_out) D(h) / (4 cos_out)  (Heitz 2018 eq. 17), with the cosine of G1 cancelled.
inline float ggx_reflection_pdf(float distribution, float cos_out, float stretch_out) {
  return 0.5f * distribution / (cos_out + stretch_out);
}

/// Share of the seen microfacet's reflection that leaves towards w_in: G2 / G1, what f cos / pdf is without
/// Fresnel.
inline float ggx_sample_weight(float cos_out, float stretch_out, float cos_in, float stretch_in) {
  return cos_in * (cos_out + stretch_out) / (cos_in * stretch_out + cos_out * stretch_in);
}

/// Draws a normal among those seen from w_out (Heitz 2018), by a uniform spherical cap in stretched space
/// (Dupuy and Benyoub 2023): there the reflected directions are uniform in z.
inline vec3 sample_visible_normal(vec3 w_out, float alpha_x, float alpha_y, vec2 u) {
  const vec3 stretched(alpha_x * w_out.x, alpha_y * w_out.y, w_out.z);
  const vec3 o = stretched * (1.0f / std::sqrt(glm::dot(stretched, stretched)));
  const float phi = 2.0f * kPi * u.x;
  const float z = (1.0f - u.y) * (1.0f + o.z) - o.z;
  const float sin_theta = safe_sqrt((1.0f - z) * (1.0f + z));
  const vec3 h = vec3(sin_theta * std::cos(phi), sin_theta * std::sin(phi), z) + o;
  // Back from stretched space. The floor on z only matters where the cap's point is -o to the last bit.
  const vec3 n(alpha_x * h.x, alpha_y * h.y, std::fmax(h.z, 1e-12f));
  return n * (1.0f / std::sqrt(glm::dot(n, n)));
}

}  // namespace zonal
