// The factors of a BRDF's value, for many evaluations at once: shaders, and the CPU's arrays (integrators/bsdf_arrays.cpp).
// Nothing branches on data. Directions are unit vectors of the shading frame (z = normal) with z > 0: `o` is the one that
// stays, `w` the other. docs/materials.md has the equations; materials/bsdf.cpp evaluates one point at a time, and the tests
// compare the two.

// Which Fresnel factor the specular lobe has; BRDF_CONSTANT has no lobe, BRDF_BLINN_PHONG no Fresnel.
const int BRDF_CONSTANT = 0;
const int BRDF_SCHLICK = 1;
const int BRDF_DIELECTRIC = 2;
const int BRDF_CONDUCTOR = 3;
const int BRDF_BLINN_PHONG = 4;

// Directions with a smaller cosine are below the horizon.
const float BRDF_MIN_COSINE = 1e-8f;

// (1 - cosine)^5: how far Schlick's approximation has moved from F0 to 1.
KERNEL float brdf_schlick_weight(float cosine) {
  float m = 1.0f - cosine;
  float m2 = m * m;
  return m2 * m2 * m;
}

// From outside into a dielectric of relative index >= 1 (Walter et al. 2007, Eq. 22).
KERNEL float brdf_dielectric(float cosine, float ior) {
  float root = sqrt(max(ior * ior - 1.0f + cosine * cosine, 1e-12f));
  float ratio = (root - cosine) / (root + cosine);
  float p = (cosine * (root + cosine) - 1.0f) / (cosine * (root - cosine) + 1.0f);
  return 0.5f * ratio * ratio * (1.0f + p * p);
}

// Into a conductor of complex index eta + i k (Born and Wolf, Sec. 14.4), a + i b = sqrt((eta + i k)^2 - sin^2): the larger of
// a and b first, so that silver's small a does not cancel away.
KERNEL float brdf_conductor(float cosine, float eta, float k) {
  float c2 = max(cosine * cosine, 1e-12f);
  float s2 = 1.0f - c2;
  float real = eta * eta - k * k - s2;
  float modulus = sqrt(real * real + 4.0f * eta * eta * k * k);
  float larger = sqrt(0.5f * (modulus + abs(real)));
  float smaller = eta * k / max(larger, 1e-12f);
  float positive = real >= 0.0f ? 1.0f : 0.0f;
  float t = 2.0f * (smaller + positive * (larger - smaller)) * sqrt(c2);
  float reflect_s = (modulus + c2 - t) / (modulus + c2 + t);
  float u = c2 * modulus + s2 * s2;
  float reflect_p = reflect_s * (u - t * s2) / (u + t * s2);
  return 0.5f * (reflect_s + reflect_p);
}

// GGX: distribution times visibility (Walter et al. 2007, Eq. 33; Heitz 2014, Eq. 99), which share a division. `stretch` is
// |(alpha_x x, alpha_y y, z)| of o; `inverse` one over alpha. `cosine` receives that of the half vector with either direction,
// `density` that of drawing w by the normals o sees, 1/sr (Heitz 2018, Eq. 17).
KERNEL float brdf_ggx(vec3 o, float stretch, vec3 w, vec2 alpha, vec2 inverse, OUT(float) cosine, OUT(float) density) {
  float sx = w.x + o.x;
  float sy = w.y + o.y;
  float sz = w.z + o.z;
  float scale = 1.0f / sqrt(sx * sx + sy * sy + sz * sz);
  float hx = sx * scale;
  float hy = sy * scale;
  float hz = sz * scale;
  cosine = min(max(o.x * hx + o.y * hy + o.z * hz, 0.0f), 1.0f);
  float px = hx * inverse.x;
  float py = hy * inverse.y;
  float s = px * px + py * py + hz * hz;
  float qx = alpha.x * w.x;
  float qy = alpha.y * w.y;
  float stretch_in = sqrt(qx * qx + qy * qy + w.z * w.z);
  float numerator = 0.318309886f * inverse.x * inverse.y;  // 1/pi
  density = 0.5f * numerator / (s * s * (o.z + stretch));
  return 0.5f * numerator / (s * s * (o.z * stretch_in + w.z * stretch));
}

// (n.h)^exponent (Blinn 1977), not normalised. Near the normal h.z has lost the digits that a large exponent needs, so its
// logarithm comes from h.x and h.y: log(1 - x)/2 = -atanh(x / (2 - x)), x = sin^2 <= 1/2, whose series ends below 1e-8.
KERNEL float brdf_blinn_phong(vec3 o, vec3 w, float exponent) {
  float sx = w.x + o.x;
  float sy = w.y + o.y;
  float sz = w.z + o.z;
  float inverse2 = 1.0f / (sx * sx + sy * sy + sz * sz);
  float x = min((sx * sx + sy * sy) * inverse2, 0.5f);
  float q = x / (2.0f - x);
  float q2 = q * q;
  float near = -q * (1.0f + q2 * (0.333333333f + q2 * (0.2f + q2 * (0.142857143f +
               q2 * (0.111111111f + q2 * (0.0909090909f + q2 * 0.0769230769f))))));
  float z2 = max(sz * sz * inverse2, 1e-37f);
  float far = 0.5f * log(z2);
  return exp(exponent * (z2 >= 0.5f ? near : far));
}

// Where a cosine lies among the nodes of a coat's table, which are even in its fourth root: 0 to `nodes` - 1.
KERNEL float brdf_coat_place(float cosine, float nodes) {
  return sqrt(sqrt(clamp(cosine, 0.0f, 1.0f))) * (nodes - 1.0f);
}
