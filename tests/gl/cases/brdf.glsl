// BRDFs.

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
