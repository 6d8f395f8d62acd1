#pragma once
/// The lobe (n.h)^exponent of Blinn 1977: its normalisation, and how to draw its half vector.

#include "core/vec.h"

namespace zonal {

/// Factor that makes the lobe reflect everything at normal incidence, and less elsewhere (Giesen 2009,
/// "Phong and Blinn-Phong Normalization Factors"): (n+2)(n+4) / (8 pi (2^(-n/2) + n)).
inline float blinn_phong_normalization(float exponent) {
  return (exponent + 2.0f) * (exponent + 4.0f) / (8.0f * kPi * (std::exp2(-0.5f * exponent) + exponent));
}

/// h.z^exponent. Near the normal h.z has lost the digits that a large exponent needs, so they come from h.x
/// and h.y.
inline float blinn_phong_lobe(vec3 h, float exponent) {
  const float sin2 = h.x * h.x + h.y * h.y;
  const float log_cosine = sin2 < 0.5f ? 0.5f * std::log1p(-sin2) : std::log(std::fmax(h.z, 1e-30f));
  return std::exp(exponent * log_cosine);
}

/// Draws h with density (n+1)/(2 pi) h.z^n.
inline vec3 sample_blinn_phong(float exponent, vec2 u) {
  // cos = (1-u)^(1/(n+1)); sin^2 = 1 - cos^2 through expm1, which stays exact for large n.
  const float log_cosine = std::log1p(-u.y) / (exponent + 1.0f);
  const float sin_theta = safe_sqrt(-std::expm1(2.0f * log_cosine));
  const float phi = 2.0f * kPi * u.x;
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), std::exp(log_cosine)};
}
/// Density of the direction reflected about such an h, 1/sr; `lobe` is h.z^n, `cosine` = h.w_out.
inline float blinn_phong_pdf(float exponent, float lobe, float cosine) {
  return (exponent + 1.0f) * lobe / (8.0f * kPi * std::fmax(cosine, 1e-12f));
}

}  // namespace zonal
