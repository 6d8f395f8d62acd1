// One case a kernel function, for C++ and GLSL alike: random numbers in, everything the function returns out. Nothing is
// computed on the way in that could round differently: numbers are scaled, directions come ready made. A shader takes one
// SUBJECT, the kernels of the others cost it seconds; C++ takes all (0).

#if SUBJECT == 0 || SUBJECT == 1
#include "integrators/vpl/vpl.glsl"
#include "integrators/vsl/vsl.glsl"
#include "sh/attenuation.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 2 || SUBJECT == 3
#include "sh/basis.glsl"
#include "sh/sphere_light.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 2
#include "sh/clamped_cosine.glsl"
#include "sh/rotation.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 3 || SUBJECT == 6
#include "sh/angle.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 3
#include "materials/zonal_lobes.glsl"
#include "integrators/hvl/hvl.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 4 || SUBJECT == 5
#include "integrators/vsgl/spherical_gaussian.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 5
#include "integrators/vsgl/vsgl.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 6
#include "materials/sh_material.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 7
#include "materials/brdf.glsl"
#endif

struct CaseInput {
  float u[16];  // [0, 1)
  vec3 d[6];    // unit; the last three with z > 0
};
struct CaseOutput {
  float v[144];  // the first RESULTS of them are written: a compiler pays for each
};

KERNEL void put3(INOUT(CaseOutput) r, int at, vec3 v) {
  r.v[at] = v.x;
  r.v[at + 1] = v.y;
  r.v[at + 2] = v.z;
}
KERNEL vec3 three(CaseInput c, int at) {
  return vec3(c.u[at], c.u[at + 1], c.u[at + 2]);
}

#if SUBJECT == 0 || SUBJECT == 2 || SUBJECT == 3
// A cap from outside and, sometimes, inside the sphere.
KERNEL ZonalCap case_cap(CaseInput c) {
  return sphere_cap(4.0f * c.u[0] + 0.04f, 0.1f + 0.4f * c.u[1]);
}
#endif

#if SUBJECT == 0 || SUBJECT == 1
// ---- vpl, vsl -----------------------------------------------------------------------------------------------------------
KERNEL void case_vpl_inverse_square(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = vpl_inverse_square(4.0f * c.u[0], c.u[1]);
}
KERNEL void case_vpl_yuksel(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = vpl_yuksel(4.0f * c.u[0], c.u[1]);
}
KERNEL void case_vpl_geometry(CaseInput c, INOUT(CaseOutput) r) {
  vec3 w;
  r.v[0] = vpl_geometry(three(c, 0) - three(c, 3), c.d[0], c.d[1], c.u[6], w);
  put3(r, 1, w);
}
KERNEL void case_vsl_cone(CaseInput c, INOUT(CaseOutput) r) {
  float per_radius2;
  r.v[0] = vsl_cone(4.0f * c.u[0], c.u[1], per_radius2);
  r.v[1] = per_radius2 * c.u[1] * c.u[1];
}
KERNEL void case_vsl_frame(CaseInput c, INOUT(CaseOutput) r) {
  vec3 x;
  vec3 y;
  vsl_frame(c.d[0], c.d[1], x, y);
  put3(r, 0, x);
  put3(r, 3, y);
}
KERNEL void case_vsl_direction(CaseInput c, INOUT(CaseOutput) r) {
  put3(r, 0, vsl_direction(c.d[0], c.d[1], c.d[2], c.u[0], c.u[1], c.u[2], c.u[3]));
}
KERNEL void case_vsl_turn(CaseInput c, INOUT(CaseOutput) r) {
  float x;
  float y;
  vsl_turn(c.u[0] - 0.5f, x, y);
  r.v[0] = x;
  r.v[1] = y;
}

KERNEL void case_inverse_square_attenuation(CaseInput c, INOUT(CaseOutput) r) {
  vec3 gradient;
  r.v[0] = inverse_square_attenuation(three(c, 0) + vec3(0.1f), gradient);
  put3(r, 1, gradient);
}
KERNEL void case_yuksel_attenuation(CaseInput c, INOUT(CaseOutput) r) {
  vec3 gradient;
  r.v[0] = yuksel_attenuation(three(c, 0) + vec3(0.1f), 0.1f + c.u[3], gradient);
  put3(r, 1, gradient);
}
#endif

#if SUBJECT == 0 || SUBJECT == 2
// ---- spherical harmonics ------------------------------------------------------------------------------------------------
KERNEL void case_sh_direction(CaseInput c, INOUT(CaseOutput) r) {
  float u;
  put3(r, 0, sh_direction(c.d[0], u));
  r.v[3] = u;
}
KERNEL void case_sh_evaluate(CaseInput c, INOUT(CaseOutput) r) {
  ShCoefficients Y;
  sh_evaluate(10, c.d[0], Y);
  for (int i = 0; i < 100; ++i) r.v[i] = Y.c[i];
}
KERNEL void case_sh_evaluate_gradient(CaseInput c, INOUT(CaseOutput) r) {
  ShCoefficients Y;
  ShGradient gradient;
  sh_evaluate_gradient(3, c.d[0], Y, gradient);
  for (int i = 0; i < 9; ++i) {
    r.v[4 * i] = Y.c[i];
    put3(r, 4 * i + 1, gradient.g[i]);
  }
}
KERNEL void case_sh_dot(CaseInput c, INOUT(CaseOutput) r) {
  ShCoefficients a;
  ShCoefficients b;
  for (int i = 0; i < 9; ++i) {
    a.c[i] = c.u[i];
    b.c[i] = c.u[15 - i];
  }
  r.v[0] = sh_dot(3, a, b);
}
KERNEL void case_sh_clamped_cosine(CaseInput c, INOUT(CaseOutput) r) {
  int l1 = int(c.u[0] * 10.0f);
  int l2 = int(c.u[1] * 10.0f);
  int low = l1 < l2 ? l1 : l2;
  r.v[0] = sh_clamped_cosine(l1, l2, int(c.u[2] * float(low + 1)));
}
KERNEL void case_sh_clamped_cosine_product(CaseInput c, INOUT(CaseOutput) r) {
  ShCoefficients light;
  ShCoefficients product;
  for (int i = 0; i < 100; ++i) light.c[i] = c.u[i % 16] - 0.5f;
  sh_clamped_cosine_product(10, light, product);
  for (int i = 0; i < 100; ++i) r.v[i] = product.c[i];
}
KERNEL void case_sh_next_multiple(CaseInput c, INOUT(CaseOutput) r) {
  vec2 next = sh_next_multiple(vec2(c.u[0], c.u[1]), c.u[2], c.u[3]);
  r.v[0] = next.x;
  r.v[1] = next.y;
}
KERNEL void case_sh_rotate_pair(CaseInput c, INOUT(CaseOutput) r) {
  float plus = c.u[2];
  float minus = c.u[3];
  sh_rotate_pair(vec2(c.u[0], c.u[1]), plus, minus);
  r.v[0] = plus;
  r.v[1] = minus;
}
KERNEL void put_cap(INOUT(CaseOutput) r, ZonalCap cap) {
  r.v[0] = cap.versine;
  r.v[1] = cap.sine2;
  r.v[2] = cap.dt;
}
KERNEL void put_band(INOUT(CaseOutput) r, int at, CapBand band) {
  r.v[at] = band.gain;
  r.v[at + 1] = band.slope;
  r.v[at + 2] = band.p;
  r.v[at + 3] = band.dp;
  r.v[at + 4] = band.q;
  r.v[at + 5] = band.dq;
}
KERNEL void case_sphere_cap(CaseInput c, INOUT(CaseOutput) r) {
  put_cap(r, sphere_cap(4.0f * c.u[0] + 0.3f, 0.1f + 0.4f * c.u[1]));
}
KERNEL void case_disk_cap(CaseInput c, INOUT(CaseOutput) r) {
  put_cap(r, disk_cap(4.0f * c.u[0] + 0.01f, 0.1f + c.u[1]));
}
KERNEL void case_cap_first(CaseInput c, INOUT(CaseOutput) r) {
  put_band(r, 0, cap_first(case_cap(c)));
}
KERNEL void case_cap_next(CaseInput c, INOUT(CaseOutput) r) {
  ZonalCap cap = case_cap(c);
  CapBand band = cap_first(cap);
  for (int l = 1; l < 10; ++l) band = cap_next(cap, band, l);
  put_band(r, 0, band);
}
#endif

#if SUBJECT == 0 || SUBJECT == 3
// ---- zonal lobes and hvl ------------------------------------------------------------------------------------------------
KERNEL void case_legendre_first(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = legendre_first().p + c.u[0];
  r.v[1] = legendre_first().before;
}
KERNEL void case_legendre_next(CaseInput c, INOUT(CaseOutput) r) {
  LegendreBand band = legendre_first();
  for (int l = 1; l < 20; ++l) {
    band = legendre_next(band, c.d[0].z, l);
    r.v[l - 1] = band.p;
  }
}
KERNEL ZonalLobe case_lobe(CaseInput c) {
  ZonalLobe lobe;
  for (int l = 0; l < ZONAL_LOBE_BANDS; ++l) lobe.weight[l] = c.u[l % 8];
  return lobe;
}
KERNEL void case_zonal_lobe_cap(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = zonal_lobe_cap(case_lobe(c), sphere_cap(4.0f * c.u[10] + 0.04f, 0.1f + 0.4f * c.u[11]), c.d[0].z, 10);
}
KERNEL void case_zonal_diffuse(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = zonal_diffuse(c.u[0], c.u[1], c.u[2], c.d[0].z);
}
KERNEL void case_atan_tail(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = atan_tail(c.u[0]);
}
KERNEL void case_upper_angle(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = upper_angle(c.u[0], c.d[0].x);
}
KERNEL void case_cap_irradiance(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = cap_irradiance(case_cap(c), c.d[0].z);
}
KERNEL HvlColors case_colors(CaseInput c) {
  HvlColors f;
  for (int i = 0; i < SH_MAX_COUNT; ++i) f.c[i] = vec3(c.u[i % 7], c.u[i % 5 + 3], c.u[i % 3 + 6]);
  return f;
}
KERNEL void case_hvl_radiance(CaseInput c, INOUT(CaseOutput) r) {
  put3(r, 0, hvl_radiance(three(c, 0), three(c, 3), c.d[0].z, 0.1f + c.u[6]));
}
KERNEL void case_hvl_emission(CaseInput c, INOUT(CaseOutput) r) {
  put3(r, 0, hvl_emission(5, case_colors(c), three(c, 10), c.d[0]));
}
KERNEL void case_hvl_edge(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = hvl_edge(case_cap(c), 4.0f * c.u[2]);
}
KERNEL void case_hvl_product(CaseInput c, INOUT(CaseOutput) r) {
  ZonalCap cap = sphere_cap(4.0f * c.u[10] + 0.04f, 0.1f + 0.4f * c.u[11]);
  put3(r, 0, hvl_product(9, case_colors(c), cap, c.d[0], c.u[12]));
}
KERNEL void case_hvl_zonal_product(CaseInput c, INOUT(CaseOutput) r) {
  ZonalCap cap = sphere_cap(4.0f * c.u[10] + 0.04f, 0.1f + 0.4f * c.u[11]);
  put3(r, 0, hvl_zonal_product(10, three(c, 0), three(c, 3), case_lobe(c), cap, c.d[0].z, c.d[1].z));
}
#endif

#if SUBJECT == 0 || SUBJECT == 4
// ---- spherical Gaussians ------------------------------------------------------------------------------------------------
// Sharpness over eight decades: 1e-3 to 1e5.
KERNEL float case_sharpness(float u) {
  float root = u * 10.0f;
  float square = root * root;
  return 1e-3f + square * square * root;
}
KERNEL void case_sg_erfcx(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_erfcx(10.0f * c.u[0]);
}
KERNEL void case_sg_erfc(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_erfc(6.0f * c.u[0] - 3.0f);
}
KERNEL void case_sg_erf_positive(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_erf_positive(3.0f * c.u[0]);
}
KERNEL void case_sg_integral_of_erfc(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_integral_of_erfc(3.0f * c.u[0]);
}
KERNEL void case_sg_mean_exp(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_mean_exp(case_sharpness(c.u[0]));
}
KERNEL void case_sg_evaluate(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_evaluate(c.d[0], c.d[1], 20.0f * c.u[0]);
}
KERNEL void case_sg_integral(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_integral(case_sharpness(c.u[0]));
}
KERNEL void case_sg_product(CaseInput c, INOUT(CaseOutput) r) {
  vec3 axis;
  float exponent;
  r.v[0] = sg_product(c.d[0], 30.0f * c.u[0], c.d[1], 1.0f + 30.0f * c.u[1], axis, exponent);
  put3(r, 1, axis);
  r.v[4] = exponent;
}
KERNEL void case_sg_cosine_2015(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_cosine_2015(c.d[0].z, case_sharpness(c.u[0]));
}
KERNEL void case_sg_cosine_2024(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_cosine_2024(c.d[0].z, case_sharpness(c.u[0]));
}
KERNEL void case_sg_above_horizon(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_above_horizon(c.d[0].z, case_sharpness(c.u[0]));
}
KERNEL void case_sg_sharpness_of(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_sharpness_of(c.u[0]);
}
KERNEL void case_sg_shortfall_of(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sg_shortfall_of(case_sharpness(c.u[0]));
}
#endif

#if SUBJECT == 0 || SUBJECT == 5
// ---- vsgl ---------------------------------------------------------------------------------------------------------------
KERNEL vec2 case_alpha2(CaseInput c) {
  return vec2(0.01f + 0.98f * c.u[14], 0.01f + 0.98f * c.u[15]);
}
KERNEL void case_vsgl_distribution_sharpness(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = vsgl_distribution_sharpness(case_alpha2(c));
}
KERNEL void case_vsgl_reflection_2015(CaseInput c, INOUT(CaseOutput) r) {
  vec3 axis;
  r.v[0] = vsgl_reflection_2015(c.d[3], case_alpha2(c), axis);
  put3(r, 1, axis);
}
KERNEL void case_vsgl_dominant_normal(CaseInput c, INOUT(CaseOutput) r) {
  put3(r, 0, vsgl_dominant_normal(c.d[3], case_alpha2(c)));
}
KERNEL void case_vsgl_reflection_2024(CaseInput c, INOUT(CaseOutput) r) {
  vec3 axis;
  r.v[0] = vsgl_reflection_2024(c.d[3], case_alpha2(c), axis);
  put3(r, 1, axis);
}
KERNEL void case_vsgl_unmasked(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = vsgl_unmasked(c.d[3], c.d[0], case_alpha2(c));
}
KERNEL VsglMoments case_moments(CaseInput c) {
  VsglMoments m;
  m.flux = vec3(0.0f);
  m.position = vec3(0.0f);
  m.square = 0.0f;
  m.axis = vec3(0.0f);
  m.shortfall = 0.0f;
  m.weight = 0.0f;
  for (int i = 0; i < 3; ++i) vsgl_add(m, three(c, i), three(c, i + 3), c.u[i + 6], c.d[i + 3], c.u[i + 9], c.d[5]);
  return m;
}
KERNEL void case_vsgl_add(CaseInput c, INOUT(CaseOutput) r) {
  VsglMoments m = case_moments(c);
  put3(r, 0, m.flux);
  put3(r, 3, m.position);
  put3(r, 6, m.axis);
  r.v[9] = m.square;
  r.v[10] = m.shortfall;
  r.v[11] = m.weight;
}
KERNEL void case_vsgl_fit(CaseInput c, INOUT(CaseOutput) r) {
  VsglLight light = vsgl_fit(case_moments(c), three(c, 12), c.d[5]);
  put3(r, 0, light.position);
  put3(r, 3, light.flux);
  put3(r, 6, light.axis);
  r.v[9] = light.variance;
  r.v[10] = light.sharpness;
}
KERNEL void case_vsgl_radiance(CaseInput c, INOUT(CaseOutput) r) {
  VsglLight light;
  light.position = three(c, 0);
  light.variance = 0.01f + 0.1f * c.u[3];
  light.flux = three(c, 4);
  light.sharpness = 20.0f * c.u[7];
  light.axis = c.d[0];
  vec3 axis;
  float scale;
  r.v[0] = vsgl_radiance(light, 0.1f + c.u[8], three(c, 9) + vec3(1.0f, 0.0f, 0.0f), 1e-8f, 1e-8f, axis, scale);
  put3(r, 1, axis);
  r.v[4] = scale;
}
KERNEL void case_vsgl_asg_receiver(CaseInput c, INOUT(CaseOutput) r) {
  VsglAsgReceiver a = vsgl_asg_receiver(c.d[3], case_alpha2(c));
  r.v[0] = a.heading.x;
  r.v[1] = a.heading.y;
  r.v[2] = a.sine;
  r.v[3] = a.cosine;
  r.v[4] = a.a2;
  r.v[5] = a.stretch;
}
KERNEL void case_vsgl_specular_2015(CaseInput c, INOUT(CaseOutput) r) {
  vec3 peak;
  r.v[0] = vsgl_specular_2015(vsgl_asg_receiver(c.d[3], case_alpha2(c)), c.d[0], 50.0f * c.u[0], peak);
  put3(r, 1, peak);
}
KERNEL void case_vsgl_filtered_receiver(CaseInput c, INOUT(CaseOutput) r) {
  VsglFilteredReceiver f = vsgl_filtered_receiver(c.d[3], case_alpha2(c));
  put3(r, 0, f.v);
  r.v[3] = f.width.x;
  r.v[4] = f.width.y;
  put3(r, 5, f.spread);
  r.v[8] = f.determinant;
  put3(r, 9, f.mirror);
}
KERNEL void case_vsgl_specular_2024(CaseInput c, INOUT(CaseOutput) r) {
  vec3 peak;
  r.v[0] = vsgl_specular_2024(vsgl_filtered_receiver(c.d[3], case_alpha2(c)), c.d[0], 0.5f + 50.0f * c.u[0], peak);
  put3(r, 1, peak);
}
KERNEL void case_vsgl_half_cosine(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = vsgl_half_cosine(c.d[0], c.d[1]);
}
KERNEL void case_vsgl_base_cosine(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = vsgl_base_cosine(c.d[0].z, 50.0f * c.u[0]);
}
#endif

#if SUBJECT == 0 || SUBJECT == 7
// ---- BRDFs --------------------------------------------------------------------------------------------------------------
KERNEL void case_brdf_schlick_weight(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = brdf_schlick_weight(c.u[0]);
}
KERNEL void case_brdf_dielectric(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = brdf_dielectric(c.u[0], 1.0f + 2.0f * c.u[1]);
}
KERNEL void case_brdf_conductor(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = brdf_conductor(c.u[0], 0.05f + 3.0f * c.u[1], 5.0f * c.u[2]);
}
KERNEL void case_brdf_ggx(CaseInput c, INOUT(CaseOutput) r) {
  vec2 alpha = vec2(0.1f + 0.9f * c.u[0], 0.1f + 0.9f * c.u[1]);
  float cosine;
  float density;
  r.v[0] = brdf_ggx(c.d[3], 0.5f + c.u[2], c.d[4], alpha, vec2(1.0f / alpha.x, 1.0f / alpha.y), cosine, density);
  r.v[1] = cosine;
  r.v[2] = density;
}
KERNEL void case_brdf_blinn_phong(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = brdf_blinn_phong(c.d[3], c.d[4], 100.0f * c.u[0]);
}
KERNEL void case_brdf_coat_place(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = brdf_coat_place(c.u[0], 97.0f);
}
#endif

#if SUBJECT == 0 || SUBJECT == 6
// ---- .shmat: two files lie behind one another in the buffer, at SHMAT_FIRST and SHMAT_SECOND ----------------------------
KERNEL ShmatTable case_table(CaseInput c) {
  return shmat_open(c.u[0] < 0.5f ? SHMAT_FIRST : SHMAT_SECOND);
}
KERNEL void case_shmat_open(CaseInput c, INOUT(CaseOutput) r) {
  ShmatTable t = case_table(c);
  r.v[0] = float(t.rows);
  r.v[1] = float(t.data);
  r.v[2] = float(t.azimuths);
  r.v[3] = float(t.half_floats);
  r.v[4] = float(t.mirrored);
}
KERNEL void case_shmat_index(CaseInput c, INOUT(CaseOutput) r) {
  int l = int(c.u[1] * 7.0f);
  r.v[0] = float(shmat_index(case_table(c), l, int(c.u[2] * float(l + 1))));
}
KERNEL void case_shmat_row(CaseInput c, INOUT(CaseOutput) r) {
  ShmatTable t = case_table(c);
  uint word = shmat_row(t, uint(c.u[1] * 2.0f), uint(c.u[2] * float(t.azimuths)), uint(c.u[3] * 91.0f));
  r.v[0] = float(word & 255u);
  r.v[1] = float(word >> 8);
}
KERNEL void case_shmat_find(CaseInput c, INOUT(CaseOutput) r) {
  ShmatPlace p = shmat_find(case_table(c), uint(c.u[1] * 2.0f), c.d[3]);
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k) {
    r.v[k] = float(p.word[k] >> 8);
    sum += p.weight[k];
  }
  r.v[4] = sum;
}
KERNEL void case_shmat_bands(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = float(shmat_bands(shmat_find(case_table(c), uint(c.u[1] * 2.0f), c.d[3])));
}
KERNEL void case_shmat_coefficient(CaseInput c, INOUT(CaseOutput) r) {
  ShmatTable t = case_table(c);
  ShmatPlace place = shmat_find(t, uint(c.u[1] * 2.0f), c.d[3]);
  put3(r, 0, shmat_coefficient(t, place, uint(c.u[2] * 28.0f)));
}
#endif
