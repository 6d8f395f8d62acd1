// Spherical harmonics.

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
KERNEL void case_sh_evaluate_order(CaseInput c, INOUT(CaseOutput) r) {
  ShOrder row;
  sh_evaluate_order(6, 2, c.d[0], row);
  for (int l = 2; l < 6; ++l) {
    int at = 8 * (l - 2);
    r.v[at] = row.plus[l];
    r.v[at + 1] = row.minus[l];
    put3(r, at + 2, row.plus_gradient[l]);
    put3(r, at + 5, row.minus_gradient[l]);
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
