// Virtual spherical Gaussian lights: from the texels of a block to two lights, and from such a light to a shaded point.
// Equations are numbered in README.md. Include spherical_gaussian.glsl first. Directions are unit; "local" is the shading
// frame, z = normal. alpha2 = (alpha_x^2, alpha_y^2), the squared GGX widths.

#ifndef ZONAL_VSGL
#define ZONAL_VSGL

// ---- What a texel sends -------------------------------------------------------------------------------------------------

// Mean direction's length of the SG that stands for Lambert's lobe, as 1 - length: the SG of sharpness 2 of the first
// generation, and of 2.292504 of the second.
const float VSGL_DIFFUSE_SHORTFALL_2015 = 0.4706834198711607f;
const float VSGL_DIFFUSE_SHORTFALL_2024 = 0.4250744456460668f;

// (VSGL-9) Sharpness of the SG over half vectors that stands for a GGX distribution of normals (Tokuyoshi and Harada 2019).
KERNEL float vsgl_distribution_sharpness(vec2 alpha2) {
  float a2 = sqrt(alpha2.x * alpha2.y);
  return max(2.0f / a2 - 2.0f, 0.0f);
}

// (VSGL-10) Axis (local) and sharpness of the reflection of light that comes from v: about the normal, widened by the
// Jacobian of the half vector, 1 / (4 n.v).
KERNEL float vsgl_reflection_2015(vec3 v, vec2 alpha2, OUT(vec3) axis) {
  axis = vec3(-v.x, -v.y, v.z);
  return min(vsgl_distribution_sharpness(alpha2) / (4.0f * max(v.z, 1e-8f)), SG_MAX_SHARPNESS);
}

// The middle one of the microfacet normals that v sees: where the normal of the hemisphere seen in stretched space goes.
KERNEL vec3 vsgl_dominant_normal(vec3 v, vec2 alpha2) {
  float stretch = sqrt(alpha2.x * v.x * v.x + alpha2.y * v.y * v.y + v.z * v.z);
  vec3 m = vec3(alpha2.x * v.x, alpha2.y * v.y, max(v.z, 0.0f) + stretch);
  return m / sqrt(max(dot(m, m), 1e-37f));
}

// (VSGL-11) The same about the dominant visible normal m: sharpness k_D m.z / (4 v.m).
KERNEL float vsgl_reflection_2024(vec3 v, vec2 alpha2, OUT(vec3) axis) {
  vec3 m = vsgl_dominant_normal(v, alpha2);
  float cosine = dot(v, m);
  axis = 2.0f * cosine * m - v;
  return min(vsgl_distribution_sharpness(alpha2) * m.z / (4.0f * max(cosine, 1e-8f)), SG_MAX_SHARPNESS);
}

// (VSGL-12) Share of the seen microfacets' reflection that leaves along the lobe's axis: Smith's G2 / G1, 0 where the axis
// points into the surface.
KERNEL float vsgl_unmasked(vec3 v, vec3 axis, vec2 alpha2) {
  float zv = max(v.z, 1e-8f);
  float za = max(axis.z, 0.0f);
  float sv = sqrt(alpha2.x * v.x * v.x + alpha2.y * v.y * v.y + zv * zv);
  float sa = sqrt(alpha2.x * axis.x * axis.x + alpha2.y * axis.y * axis.y + za * za);
  return za * (sv + zv) / (sv * za + sa * zv);
}

// ---- Sums over a block, and the light fitted to them --------------------------------------------------------------------

// Sums over the lobes of one kind. Positions and axes are relative to those of one texel of the block (`origin`,
// `reference`): so narrow blocks and narrow lobes keep their digits. All zero to begin with.
struct VsglMoments {
  vec3 flux;        // W
  vec3 position;    // m, times weight; the weight is the flux's R + G + B
  float square;     // m^2, squared distance, times weight
  vec3 axis;        // of shortened axes minus the reference, times weight
  float shortfall;  // of 1 - (shortened axis . reference), times weight
  float weight;
};

// One SG light: flux leaves a Gaussian cloud of points, along an SG of directions.
struct VsglLight {
  vec3 position;    // m, mean of the texels'
  float variance;   // m^2, along each axis of the surface
  vec3 flux;        // W, all the light sent
  float sharpness;
  vec3 axis;        // unit, the mean direction the light leaves in
};

// Adds one texel's lobe: `offset` from the block's origin (m), `spread` the variance inside the texel (m^2, per axis),
// `shortfall` 1 - length of the lobe's mean direction.
KERNEL void vsgl_add(INOUT(VsglMoments) m, vec3 flux, vec3 offset, float spread, vec3 axis, float shortfall,
                     vec3 reference) {
  float w = flux.x + flux.y + flux.z;
  vec3 turned = axis - reference;
  float apart = 0.5f * dot(turned, turned);  // 1 - axis . reference
  m.flux = m.flux + flux;
  m.weight = m.weight + w;
  m.position = m.position + w * offset;
  m.square = m.square + w * (dot(offset, offset) + 2.0f * spread);
  m.axis = m.axis + w * (turned - shortfall * axis);
  m.shortfall = m.shortfall + w * (apart + shortfall * (1.0f - apart));
}

// (VSGL-13) The light with the sums' flux, mean position, variance (of points on a plane: half the total) and mean
// direction. A block without weight gives a light without flux.
KERNEL VsglLight vsgl_fit(VsglMoments m, vec3 origin, vec3 reference) {
  float inverse = m.weight > 0.0f ? 1.0f / m.weight : 0.0f;
  vec3 mean = m.position * inverse;
  VsglLight light;
  light.flux = m.flux;
  light.position = origin + mean;
  light.variance = max(0.5f * (m.square * inverse - dot(mean, mean)), 0.0f);

  // r^2 = |reference + d|^2 = 1 - 2 s + |d|^2, so 1 - r = (2 s - |d|^2) / (1 + r): no 1 is subtracted from r.
  vec3 d = m.axis * inverse;
  float s = m.shortfall * inverse;
  float deficit = clamp(2.0f * s - dot(d, d), 0.0f, 1.0f);
  float r = sqrt(1.0f - deficit);
  vec3 direction = reference + d;
  float length2 = dot(direction, direction);
  light.axis = length2 > 1e-12f ? direction / sqrt(max(length2, 1e-12f)) : reference;
  light.sharpness = sg_sharpness_of(deficit / (1.0f + r));
  return light;
}

// ---- The light seen from a point ----------------------------------------------------------------------------------------

// (VSGL-14) The radiance that arrives at a point: flux times `scale` (1/(m^2 sr)) times G(w; axis, K), w towards the
// light. K is returned. `coefficient` = 1 / (2 pi I(k)), which the light alone decides; `least_share` bounds variance /
// squared distance from below, `least_variance` the variance (m^2).
KERNEL float vsgl_radiance(VsglLight light, float coefficient, vec3 point, float least_share, float least_variance,
                           OUT(vec3) axis, OUT(float) scale) {
  vec3 d = light.position - point;
  float r2 = dot(d, d);
  float variance = max(max(light.variance, r2 * least_share), least_variance);
  // On the light itself any direction does: the sharpness there is 0. (Numbers are chosen rather than vectors: compilers
  // then make a loop over points into vectors.)
  float inverse = r2 > 0.0f ? 1.0f / sqrt(max(r2, 1e-37f)) : 0.0f;
  vec3 towards = d * inverse - light.axis * (r2 > 0.0f ? 0.0f : 1.0f);
  // The light's emission, seen along w towards the light, is the SG about -axis.
  float exponent;
  float sharpness = sg_product(-light.axis, light.sharpness, towards, r2 / variance, axis, exponent);
  scale = coefficient / variance * exp(exponent);
  return sharpness;
}

// ---- A glossy point's reflection of it ----------------------------------------------------------------------------------

// What of a point's reflection (2015) depends on the camera's direction alone.
struct VsglAsgReceiver {
  vec2 heading;   // unit, the camera's direction laid on the surface, local x and y
  float sine, cosine;  // of the camera's direction
  float a2;       // alpha_x alpha_y: the lobe is isotropic
  float stretch;  // Smith's, of the camera's direction
};

KERNEL VsglAsgReceiver vsgl_asg_receiver(vec3 v, vec2 alpha2) {
  VsglAsgReceiver r;
  float sine = sqrt(v.x * v.x + v.y * v.y);
  r.heading = sine > 1e-12f ? vec2(v.x / max(sine, 1e-12f), v.y / max(sine, 1e-12f)) : vec2(1.0f, 0.0f);
  r.sine = sine;
  r.cosine = max(v.z, 1e-6f);
  r.a2 = sqrt(alpha2.x * alpha2.y);
  r.stretch = sqrt(r.a2 * sine * sine + r.cosine * r.cosine);
  return r;
}

// (VSGL-15) Integral of f cos (without Fresnel's factor) over G(w; axis, K), `axis` local. GGX is an anisotropic SG about
// the mirrored direction z (Xu et al. 2013), whose product with an isotropic SG has a closed integral; what is left of
// the BRDF, shadowing and cosine, is taken at the product's axis, `peak`.
KERNEL float vsgl_specular_2015(VsglAsgReceiver r, vec3 axis, float K, OUT(vec3) peak) {
  float sharp = max(1.0f / r.a2 - 1.0f, 0.0f);  // over half vectors
  float along = 0.25f * sharp;                   // in the plane of camera and normal
  float across = along / (r.cosine * r.cosine);
  // Coordinates of the axis in the lobe's frame: z mirrored direction, y in the plane, x across it.
  float forward = r.heading.x * axis.x + r.heading.y * axis.y;
  float ax = r.heading.x * axis.y - r.heading.y * axis.x;
  float ay = r.cosine * forward + r.sine * axis.z;
  float az = r.cosine * axis.z - r.sine * forward;

  float h = 0.5f * K;
  float sx = across + h;
  float sy = along + h;
  float decay = across * (h / sx) * ax * ax + along * (h / sy) * ay * ay;
  float integral = 3.14159265f / sqrt(sx * sy) * max(az, 0.0f) * exp(-decay);

  // n and squared length of 2 sqrt(along across) z + K axis.
  float weight = 2.0f * along / r.cosine;
  vec3 sum = vec3(K * axis.x - weight * r.sine * r.heading.x, K * axis.y - weight * r.sine * r.heading.y,
                  K * axis.z + weight * r.cosine);
  peak = sum * (1.0f / sqrt(max(dot(sum, sum), 1e-37f)));
  float cosine = clamp(peak.z, 0.0f, 1.0f);
  float stretch = sqrt(r.a2 * (1.0f - cosine * cosine) + cosine * cosine);
  return integral * cosine / (6.28318531f * r.a2 * (r.stretch * cosine + stretch * r.cosine));
}

// What of a point's reflection (2024) depends on the camera's direction alone.
struct VsglFilteredReceiver {
  vec3 v;             // local
  vec2 width;         // GGX of slopes projected on the disk of half vectors: alpha^2 / (1 - alpha^2), along x and y
  vec3 spread;        // xx, xy, yy of J J^T, J = d(half vector) / d(direction) at half vector = normal
  float determinant;  // of J J^T
  vec3 mirror;        // mirrored direction times the reflection's sharpness
};

KERNEL VsglFilteredReceiver vsgl_filtered_receiver(vec3 v, vec2 alpha2) {
  VsglFilteredReceiver r;
  float z = max(v.z, 1e-6f);
  r.v = v;
  r.width = vec2(alpha2.x / max(1.0f - alpha2.x, 1e-6f), alpha2.y / max(1.0f - alpha2.y, 1e-6f));
  float sine2 = v.x * v.x + v.y * v.y;
  float c2 = sine2 > 1e-24f ? v.x * v.x / max(sine2, 1e-24f) : 1.0f;
  float cs = sine2 > 1e-24f ? v.x * v.y / max(sine2, 1e-24f) : 0.0f;
  float along = 0.25f;
  float across = 0.25f / (z * z);
  r.spread = vec3(c2 * along + (1.0f - c2) * across, cs * (along - across), (1.0f - c2) * along + c2 * across);
  r.determinant = along * across;
  float a2 = max(alpha2.x, alpha2.y);
  vec3 m = vsgl_dominant_normal(v, alpha2);
  r.mirror = (0.5f * (1.0f - a2) / a2) * (2.0f * dot(v, m) * m - v);
  return r;
}

// (VSGL-16) Integral of f cos (without Fresnel's factor) over G(w; axis, K), `axis` local: the distribution of normals is
// widened by the light's own spread, seen through the half vector's Jacobian, and evaluated once; the share of the light
// above the horizon stands for shadowing. `peak` is the axis of light and reflection together.
KERNEL float vsgl_specular_2024(VsglFilteredReceiver r, vec3 axis, float K, OUT(vec3) peak) {
  // Widened in the projected space, where an SG of sharpness K has the variance 1/K.
  float t = 2.0f / K;
  float fxx = r.width.x + t * r.spread.x;
  float fxy = t * r.spread.y;
  float fyy = r.width.y + t * r.spread.z;
  float det = r.width.x * r.width.y + t * (r.width.x * r.spread.z + r.width.y * r.spread.x) + t * t * r.determinant;
  // Back to squared widths.
  float inverse = 1.0f / (1.0f + fxx + fyy + det);
  float rxx = (fxx + det) * inverse;
  float rxy = fxy * inverse;
  float ryy = (fyy + det) * inverse;
  float det_r = det * inverse;

  vec3 h = r.v + axis;
  float h2 = dot(h, h);
  // Opposite directions have no half vector; the normal will do, their cosines are what counts.
  float inverse_h = h2 > 1e-12f ? 1.0f / sqrt(max(h2, 1e-12f)) : 0.0f;
  h = h * inverse_h + vec3(0.0f, 0.0f, h2 > 1e-12f ? 0.0f : 1.0f);
  // Widths are at most 1, so the form is at least |h.xy|^2; rounding must not take it below.
  float form = (ryy * h.x * h.x - 2.0f * rxy * h.x * h.y + rxx * h.y * h.y) / det_r;
  float s = max(form, h.x * h.x + h.y * h.y) + h.z * h.z;
  float distribution = 0.318309886f / (sqrt(det_r) * s * s);
  float seen = rxx * r.v.x * r.v.x + 2.0f * rxy * r.v.x * r.v.y + ryy * r.v.y * r.v.y;
  float lobe = 0.25f * distribution / sqrt(max(seen, 0.0f) + r.v.z * r.v.z);

  vec3 u = r.mirror + K * axis;
  float length_u = max(sqrt(dot(u, u)), 1e-20f);
  peak = u * (1.0f / length_u);
  float lit = sg_above_horizon(peak.z, length_u);
  return lit * lobe * sg_integral(K);
}

// (VSGL-17) Cosine between a direction and the half vector of it and another: Fresnel's angle.
KERNEL float vsgl_half_cosine(vec3 v, vec3 w) {
  return sqrt(clamp(0.5f + 0.5f * dot(v, w), 0.0f, 1.0f));
}

// (VSGL-18) Cosine at which a coat's loss is looked up: that of the product of the light's SG and of an SG of sharpness 2
// about the normal, the mean direction of the light that the base gets.
KERNEL float vsgl_base_cosine(float cosine, float K) {
  float length2 = K * K + 4.0f + 4.0f * K * cosine;
  return clamp((K * cosine + 2.0f) / sqrt(max(length2, 1e-12f)), 0.0f, 1.0f);
}

// (VSGL-19) What a coat leaves of light that comes in at the cosine c: x + y s^2 + z s^5, s = 1 - c, through the shares at the
// cosines 1, 0.4 and 0.1.
KERNEL vec3 vsgl_coat(float at_normal, float at_middle, float at_low) {
  // s = 0.6 and 0.9: the powers' determinant.
  float inverse = 1.0f / (0.36f * 0.59049f - 0.07776f * 0.81f);
  float middle = at_middle - at_normal;
  float low = at_low - at_normal;
  return vec3(at_normal, (middle * 0.59049f - low * 0.07776f) * inverse, (low * 0.36f - middle * 0.81f) * inverse);
}
KERNEL float vsgl_coat_at(vec3 coat, float cosine) {
  float s = 1.0f - cosine;
  float s2 = s * s;
  return max(coat.x + coat.y * s2 + coat.z * (s2 * s2 * s), 0.0f);
}

#endif
