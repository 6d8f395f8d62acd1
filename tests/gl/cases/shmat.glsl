// Tables of materials: two files lie behind one another in the buffer, at SHMAT_FIRST and SHMAT_SECOND.

KERNEL ShmatTable case_table(CaseInput c) {
  return shmat_open(c.u[0] < 0.5f ? SHMAT_FIRST : SHMAT_SECOND);
}
KERNEL void case_sh_layer_weights(CaseInput c, INOUT(CaseOutput) r) {
  vec3 x;
  vec3 y;
  vec3 z;
  sh_layer_weights(int(7.0f * c.u[6]), three(c, 0), three(c, 3), x, y, z);
  put3(r, 0, x);
  put3(r, 3, y);
  put3(r, 6, z);
}
KERNEL void case_sh_layer_place(CaseInput c, INOUT(CaseOutput) r) {
  r.v[0] = sh_layer_place(vec2(c.u[0], c.u[1]), 0.25f, 0.0625f, 9.0f);
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
