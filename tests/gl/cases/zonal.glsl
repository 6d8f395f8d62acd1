// Angles, zonal lobes, harmonic virtual lights.

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
KERNEL void case_hvl_mirrored_product(CaseInput c, INOUT(CaseOutput) r) {
  ZonalCap cap = sphere_cap(4.0f * c.u[10] + 0.04f, 0.1f + 0.4f * c.u[11]);
  put3(r, 0, hvl_mirrored_product(9, case_colors(c), cap, c.d[0], c.u[12]));
}
KERNEL void case_hvl_any_product(CaseInput c, INOUT(CaseOutput) r) {
  ZonalCap cap = sphere_cap(4.0f * c.u[10] + 0.04f, 0.1f + 0.4f * c.u[11]);
  put3(r, 0, hvl_any_product(5, c.u[13] < 0.5f, case_colors(c), cap, c.d[0], c.u[12]));
}
KERNEL void case_hvl_zonal_product(CaseInput c, INOUT(CaseOutput) r) {
  ZonalCap cap = sphere_cap(4.0f * c.u[10] + 0.04f, 0.1f + 0.4f * c.u[11]);
  put3(r, 0, hvl_zonal_product(10, three(c, 0), three(c, 3), case_lobe(c), cap, c.d[0].z, c.d[1].z));
}
