// Virtual point and spherical lights, attenuation.

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
