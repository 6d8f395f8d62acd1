// Virtual spherical Gaussian lights.

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
KERNEL void case_vsgl_coat(CaseInput c, INOUT(CaseOutput) r) {
  put3(r, 0, vsgl_coat(c.u[0], c.u[1], c.u[2]));
}
KERNEL void case_vsgl_coat_at(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = vsgl_coat_at(three(c, 0), c.u[3]);
}
KERNEL void case_vsgl_half_cosine(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = vsgl_half_cosine(c.d[0], c.d[1]);
}
KERNEL void case_vsgl_base_cosine(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = vsgl_base_cosine(c.d[0].z, 50.0f * c.u[0]);
}
