// Lights on spherical harmonics, and the weights of a grid's cell.

KERNEL vec3 case_to_light(CaseInput c) {
  return c.d[0] * (0.3f + 2.0f * c.u[0]);
}
KERNEL void put_sent(INOUT(CaseOutput) r, ShdSent s) {
  put3(r, 0, s.w);
  r.v[3] = s.inverse_d;
  r.v[4] = s.weight;
  put3(r, 5, s.slope);
  r.v[8] = s.cap.versine;
  r.v[9] = s.cap.sine2;
  r.v[10] = s.cap.dt;
}
KERNEL void case_shd_dirac(CaseInput c, INOUT(CaseOutput) r) {
  put_sent(r, shd_dirac(case_to_light(c)));
}
KERNEL void case_shd_sphere(CaseInput c, INOUT(CaseOutput) r) {
  put_sent(r, shd_sphere(case_to_light(c), 0.05f + 0.2f * c.u[1], int(2.0f * c.u[2])));
}
KERNEL void case_shd_bounded(CaseInput c, INOUT(CaseOutput) r) {
  float radius = 0.05f + 0.2f * c.u[1];
  int disk = int(2.0f * c.u[2]);
  put_sent(r, shd_bounded(shd_sphere(case_to_light(c), radius, disk), radius, disk, 0.2f + 0.5f * c.u[3]));
}
KERNEL void case_shd_point(CaseInput c, INOUT(CaseOutput) r) {
  put_sent(r, shd_point(case_to_light(c)));
}
KERNEL void case_shd_spot(CaseInput c, INOUT(CaseOutput) r) {
  put_sent(r, shd_spot(case_to_light(c), c.d[1], 0.5f + 0.4f * c.u[1], 0.4f * c.u[2] - 0.5f));
}
KERNEL void case_shd_facing_sphere(CaseInput c, INOUT(CaseOutput) r) {
  put_sent(r, shd_facing_sphere(case_to_light(c), 0.05f + 0.2f * c.u[1], c.d[1], int(2.0f * c.u[2])));
}
KERNEL void case_shd_triangle_point(CaseInput c, INOUT(CaseOutput) r) {
  put_sent(r, shd_triangle_point(case_to_light(c), c.d[1] * c.u[1], c.u[2]));
}
KERNEL void case_shd_reflect(CaseInput c, INOUT(CaseOutput) r) {
  ShColors f;
  for (int i = 0; i < 25; ++i) f.c[i] = vec3(c.u[i % 16], c.u[(i + 5) % 16], c.u[(i + 9) % 16]) - vec3(0.5f);
  put3(r, 0, shd_reflect(5, shd_sphere(case_to_light(c), 0.05f + 0.2f * c.u[1], 0), f));
}
KERNEL void case_shd_zonal(CaseInput c, INOUT(CaseOutput) r) {
  ShdWeights a;
  ShdWeights b;
  for (int l = 0; l < 8; ++l) {
    a.c[l] = c.u[l] - 0.5f;
    b.c[l] = c.u[15 - l] - 0.5f;
  }
  ShdSent s = shd_sphere(case_to_light(c), 0.05f + 0.2f * c.u[1], 0);
  vec2 sums = shd_zonal(8, s, c.d[1].z, c.d[2].z, a, b);
  r.v[0] = sums.x;
  r.v[1] = sums.y;
}
KERNEL void put_cell(INOUT(CaseOutput) r, ShdCell cell) {
  for (int i = 0; i < 32; ++i) r.v[i] = cell.w[i];
}
KERNEL vec3 case_cell_size(CaseInput c) {
  return vec3(0.2f) + three(c, 3);
}
KERNEL void case_shd_linear_cell(CaseInput c, INOUT(CaseOutput) r) {
  ShdCell cell;
  shd_linear_cell(1, three(c, 0), case_cell_size(c), cell);
  put_cell(r, cell);
}
KERNEL void case_shd_hermite_cell(CaseInput c, INOUT(CaseOutput) r) {
  ShdCell cell;
  shd_hermite_cell(1, three(c, 0), case_cell_size(c), cell);
  put_cell(r, cell);
}
KERNEL void case_shd_difference(CaseInput c, INOUT(CaseOutput) r) {
  ShdDerivatives all;
  for (int i = 0; i < 64; ++i) all.w[i] = c.u[i % 16] - 0.5f;
  shd_difference(7, case_cell_size(c), all);
  for (int i = 0; i < 64; ++i) r.v[i] = all.w[i];
}
