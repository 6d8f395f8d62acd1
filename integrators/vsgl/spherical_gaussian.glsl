// Spherical Gaussians (SG): G(w; a, k) = exp(k (w.a - 1)), a unit axis, k >= 0 the sharpness. Equations are numbered in
// README.md. All of it is for float: nearly equal numbers are never subtracted.

#ifndef ZONAL_SPHERICAL_GAUSSIAN
#define ZONAL_SPHERICAL_GAUSSIAN

// A lobe this flat is constant to 2e-4; with the floor, quotients by a sharpness stay finite.
const float SG_MIN_SHARPNESS = 1e-4f;
// Sharper lobes than this have no meaning in float.
const float SG_MAX_SHARPNESS = 2.199023255552e12f;  // 2^41

// exp(x^2) erfc(x) for x >= 0: t P(t), t = 1 / (1 + 0.4 x), with P a minimax polynomial fitted for this project (1.3e-7
// relative before rounding). P(0) = 0.4 / sqrt(pi) is the limit of large x.
KERNEL float sg_erfcx(float x) {
  float t = 1.0f / (1.0f + 0.4f * x);
  float p = 0.0502542317f;
  p = p * t - 0.182873643f;
  p = p * t + 0.169046059f;
  p = p * t - 0.00557892061f;
  p = p * t + 0.141420096f;
  p = p * t + 0.168544372f;
  p = p * t + 0.207842456f;
  p = p * t + 0.225669607f;
  p = p * t + 0.225675862f;
  return t * p;
}

// Complementary error function, which GLSL lacks. Relative error 4e-7 + 1.2e-7 x^2 (x > 0: the rounding of x^2).
KERNEL float sg_erfc(float x) {
  float positive = exp(-x * x) * sg_erfcx(abs(x));
  return x < 0.0f ? 2.0f - positive : positive;
}

// Error function for x >= 0, to 4e-7 absolute.
KERNEL float sg_erf_positive(float x) {
  return 1.0f - exp(-x * x) * sg_erfcx(x);
}

// Integral of erfc from x >= 0 to infinity: exp(-x^2) / sqrt(pi) - x erfc(x).
KERNEL float sg_integral_of_erfc(float x) {
  return exp(-x * x) * max(0.564189584f - x * sg_erfcx(x), 0.0f);  // 1 / sqrt(pi)
}

// (1 - exp(-x)) / x for x >= 0: the mean of exp(-t) over [0, x].
KERNEL float sg_mean_exp(float x) {
  float series =
      1.0f - x * (0.5f - x * (1.0f / 6.0f - x * (1.0f / 24.0f - x * (1.0f / 120.0f - x * (1.0f / 720.0f)))));
  return x < 0.2f ? series : (1.0f - exp(-x)) / max(x, 0.2f);
}

// (VSGL-1) Value at w; the exponent is written as a distance because 1 - w.a has no digits left for sharp lobes.
KERNEL float sg_evaluate(vec3 w, vec3 axis, float sharpness) {
  vec3 difference = w - axis;
  return exp(-0.5f * sharpness * dot(difference, difference));
}

// (VSGL-2) Integral over the sphere, 2 pi (1 - exp(-2k)) / k.
KERNEL float sg_integral(float sharpness) {
  return 12.5663706f * sg_mean_exp(2.0f * sharpness);  // 4 pi
}

// (VSGL-3) G(w; a1, k1) G(w; a2, k2) = exp(exponent) G(w; axis, k). Sharpness at least SG_MIN_SHARPNESS.
KERNEL float sg_product(vec3 axis1, float k1, vec3 axis2, float k2, OUT(vec3) axis, OUT(float) exponent) {
  vec3 sum = k1 * axis1 + k2 * axis2;
  vec3 difference = axis1 - axis2;
  float sharpness = max(sqrt(dot(sum, sum)), SG_MIN_SHARPNESS);
  axis = sum / sharpness;
  exponent = -k1 * k2 * dot(difference, difference) / (sharpness + k1 + k2);
  return sharpness;
}

// (VSGL-4) (1/pi) int G max(0, n.w) dw with the cosine taken for an SG of sharpness 2, whose exponent is smooth where the
// cosine ends. `cosine` = n.axis. Tokuyoshi 2015.
KERNEL float sg_cosine_2015(float cosine, float sharpness) {
  float k = 2.0f * sharpness / (sharpness + 2.0f);
  return 2.0f / (sharpness + 2.0f) * exp(k * (cosine - 1.0f));
}

// (VSGL-5) The same integral, nearly exact: interpolated between its values at cosine -1 and 1, which are known, by a
// weight that is that of a Gaussian over a half plane. Tokuyoshi et al. 2024; their weight, rearranged here as
// max(c, 0) + (J(t |c|) - J(t)) / (2t) with J the integral of erfc, so that nothing cancels.
KERNEL float sg_cosine_2024(float cosine, float sharpness) {
  float k = max(sharpness, SG_MIN_SHARPNESS);
  // Scale of the Gaussian; coefficients fitted by Tokuyoshi et al.
  float numerator = (k + 2.7360831611f) * k + 17.0212977817f;
  float denominator = ((k + 4.0100826729f) * k + 15.2191562631f) * k + 76.0878962724f;
  float t = k * sqrt(0.5f * numerator / denominator);
  float difference = sg_integral_of_erfc(t * abs(cosine)) - sg_integral_of_erfc(t);
  float weight = clamp(max(cosine, 0.0f) + 0.5f * difference / t, 0.0f, 1.0f);

  // The integral over pi for cosine 1 and -1; series in k where the closed forms cancel.
  float tail = exp(-k);
  float mean = sg_mean_exp(k);
  float upper_series =
      0.5f - k * (1.0f / 6.0f -
                  k * (1.0f / 24.0f - k * (1.0f / 120.0f - k * (1.0f / 720.0f - k * (1.0f / 5040.0f - k / 40320.0f)))));
  float lower_series =
      0.5f - k * (2.0f / 6.0f -
                  k * (3.0f / 24.0f - k * (4.0f / 120.0f - k * (5.0f / 720.0f - k * (6.0f / 5040.0f - k * (7.0f / 40320.0f))))));
  float upper = k < 0.5f ? upper_series : (1.0f - mean) / k;
  float lower = tail * (k < 0.5f ? lower_series : max(mean - tail, 0.0f) / k);
  return 2.0f * (lower + weight * (upper - lower));
}

// (VSGL-6) Share of the SG's integral that lies above the plane through the origin with cosine = normal.axis
// (Tokuyoshi 2022's fit).
KERNEL float sg_above_horizon(float cosine, float sharpness) {
  float k = max(sharpness, SG_MIN_SHARPNESS);
  float ratio = (0.5f * k + 0.6517328827f) / ((k + 1.3418280033f) * k + 7.2216687799f);
  float q = k * sqrt(ratio);
  // Clamped: below 1e-3 both error functions are rounding, and the share is 1/2 anyway.
  float half_share = clamp(0.5f * sg_erf_positive(q * abs(cosine)) / max(sg_erf_positive(q), 1e-6f), 0.0f, 0.5f);
  float share = 0.5f + (cosine < 0.0f ? -half_share : half_share);
  float tail = exp(-k);
  return (tail + (1.0f - tail) * share) / (1.0f + tail);
}

// (VSGL-7) Sharpness of the SG whose mean direction has the length 1 - shortfall (Banerjee et al. 2005):
// r (3 - r^2) / (1 - r^2), written in 1 - r.
KERNEL float sg_sharpness_of(float shortfall) {
  float s = clamp(shortfall, 4.547473508864641e-13f, 1.0f);  // 2^-41
  return (1.0f - s) * (2.0f + 2.0f * s - s * s) / (s * (2.0f - s));
}

// (VSGL-8) The inverse: 1 - length of the mean direction for a sharpness, the root in (0, 1] of
// s^3 + (k - 3) s^2 - 2 k s + 2 = 0, by Newton's method from below, where the cubic is positive and falls.
KERNEL float sg_shortfall_of(float sharpness) {
  float k = sharpness;
  float s = 1.0f / (1.0f + k);
  for (int i = 0; i < 6; ++i) {
    float value = ((s + (k - 3.0f)) * s - 2.0f * k) * s + 2.0f;
    float slope = (3.0f * s + 2.0f * (k - 3.0f)) * s - 2.0f * k;
    s = clamp(s - value / min(slope, -1e-6f), 0.0f, 1.0f);
  }
  return s;
}

#endif
