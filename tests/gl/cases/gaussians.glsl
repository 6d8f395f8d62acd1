// Spherical Gaussians.

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
