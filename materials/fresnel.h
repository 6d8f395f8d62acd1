#pragma once
/// Fraction of unpolarised light that a smooth interface reflects, as a function of the cosine at the (micro)
/// normal.
///
///     vec3 F = fresnel_conductor(cosine, metal.eta, metal.k);

#include "core/vec.h"

namespace zonal {

/// From outside into a dielectric of relative index `ior` > 0 (Walter et al. 2007 eq. 22). 1 beyond the
/// critical angle.
inline float fresnel_dielectric(float cosine, float ior) {
  const float c = cosine;
  const float g2 = ior * ior - 1.0f + c * c;
  if (g2 <= 0.0f) return 1.0f;
  const float g = std::sqrt(g2);
  const float s = (g - c) / (g + c);
  const float p = (c * (g + c) - 1.0f) / (c * (g - c) + 1.0f);
  return 0.5f * s * s * (1.0f + p * p);
}

/// Into a conductor of complex index eta + i k, one channel (Born and Wolf, section 14.4; in Lagarde's
/// arrangement).
inline float fresnel_conductor(float cosine, float eta, float k) {
  const float c2 = std::fmax(cosine * cosine, 1e-12f);  // keeps 0/0 away at grazing
  const float s2 = 1.0f - c2;
  // a + i b = sqrt((eta + i k)^2 - sin^2). Taking the larger of a, b first avoids the cancellation in
  // silver's a.
  const float real = eta * eta - k * k - s2;
  const float modulus = std::sqrt(real * real + 4.0f * eta * eta * k * k);
  const float larger = std::sqrt(0.5f * (modulus + std::fabs(real)));
  const float a = real >= 0.0f ? larger : eta * k / larger;
  const float t = 2.0f * a * std::sqrt(c2);
  const float reflect_s = (modulus + c2 - t) / (modulus + c2 + t);
  const float u = c2 * modulus + s2 * s2;
  const float reflect_p = reflect_s * (u - t * s2) / (u + t * s2);
  return 0.5f * (reflect_s + reflect_p);
}
inline vec3 fresnel_conductor(float cosine, vec3 eta, vec3 k) {
  return {fresnel_conductor(cosine, eta.x, k.x), fresnel_conductor(cosine, eta.y, k.y),
          fresnel_conductor(cosine, eta.z, k.z)};
}

/// (1 - cosine)^5: how far Schlick's approximation has moved from F0 to 1.
inline float schlick_weight(float cosine) {
  const float m = 1.0f - cosine, m2 = m * m;
  return m2 * m2 * m;
}
/// Schlick 1994: F0 + (1 - F0) (1 - cosine)^5.
inline vec3 fresnel_schlick(float cosine, vec3 f0) {
  return f0 + (vec3(1.0f) - f0) * schlick_weight(cosine);
}

}  // namespace zonal
