// Coefficients of all lights at a grid's points and, when PARTS is 4, their slopes. Forward: an invocation takes a point with all
// its coefficients; REVERSE: one order m of a point, so that few numbers stay in registers (Mézières 2022, Sec. 3.3.3). BANDS;
// TRIANGLES: some are exact.
layout(local_size_x = 64) in;
#include "sh/basis.glsl"
#include "sh/sphere_light.glsl"
#include "integrators/sh_direct/sh_direct.glsl"
#include "integrators/sh_direct/lights.glsl"

layout(binding = 14) uniform samplerBuffer fixed_light;
layout(binding = 15) uniform samplerBuffer grid_places;
layout(binding = 0, std430) buffer Values { vec4 values[]; };  // [slot][part][coefficient]
uniform int count;
uniform ivec2 range;
uniform int chunk_first;
uniform int bands;  // BANDS: loops over it stay loops

#if REVERSE == 1
const int STORED = 2 * BANDS;
#define PLACE(l, m) (2 * (l) + ((m) < 0 ? 1 : 0))
#else
const int STORED = BANDS * BANDS;
#define PLACE(l, m) ((l) * ((l) + 1) + (m))
#endif

int first_order;
int last_order;
vec3 sum[STORED];
#if PARTS == 4
vec3 slope_x[STORED];
vec3 slope_y[STORED];
vec3 slope_z[STORED];
#endif

void add(int place, float value, vec3 slope, vec3 colour) {
  sum[place] += colour * value;
#if PARTS == 4
  slope_x[place] += colour * slope.x;
  slope_y[place] += colour * slope.y;
  slope_z[place] += colour * slope.z;
#endif
}

void take(ShdSent s, vec3 colour) {
  ShOrder row;
  for (int m = first_order; m <= last_order; ++m) {
    sh_evaluate_order(bands, m, s.w, row);
    CapBand band = cap_first(s.cap);
    for (int l = 0; l < bands; ++l) {
      if (l > 0) band = cap_next(s.cap, band, l);
      if (l < m) continue;
      float gain = s.dirac == 1 ? 1.0 : band.gain;
      // The cap's size changes as the point moves, and so does the weight.
      vec3 up = s.slope * gain - s.w * (s.dirac == 1 ? 0.0 : s.weight * band.slope * s.cap.dt);
      gain *= s.weight;
      float turn = -gain * s.inverse_d;
      add(PLACE(l, m), gain * row.plus[l], turn * row.plus_gradient[l] + up * row.plus[l], colour);
      if (m > 0) add(PLACE(l, -m), gain * row.minus[l], turn * row.minus_gradient[l] + up * row.minus[l], colour);
    }
  }
}
void take_solid_angle(float omega, vec3 colour) {
  if (first_order == 0) sum[0] += colour * (omega * 0.282094792);
}
void take_edge(vec3 w, vec3 n, float dt, float over_rho, vec3 colour) {
  ShOrder row;
  for (int m = first_order; m <= last_order; ++m) {
    sh_evaluate_order(bands, m, w, row);
    for (int l = m; l < bands; ++l) {
      float share = l > 0 ? dt / float(l * (l + 1)) : 0.0;
      vec3 turn = n * (dt * over_rho);
      add(PLACE(l, m), share * dot(row.plus_gradient[l], n), turn * row.plus[l], colour);
      if (m > 0) add(PLACE(l, -m), share * dot(row.minus_gradient[l], n), turn * row.minus[l], colour);
    }
  }
}

void store(int slot, int l, int m, bool start) {
  int i = l * (l + 1) + m;
  int at = slot * PARTS * bands * bands + i;
  vec3 value = sum[PLACE(l, m)];
  if (start) value += texelFetch(fixed_light, i).rgb;
  values[at] += vec4(value, 0.0);
#if PARTS == 4
  int n = bands * bands;
  values[at + n] += vec4(slope_x[PLACE(l, m)], 0.0);
  values[at + 2 * n] += vec4(slope_y[PLACE(l, m)], 0.0);
  values[at + 3 * n] += vec4(slope_z[PLACE(l, m)], 0.0);
#endif
}

void main() {
  int slot = int(gl_GlobalInvocationID.x);
#if REVERSE == 1
  if (slot >= count * bands) return;
  // Neighbours work on the same order.
  first_order = slot / count;
  last_order = first_order;
  slot %= count;
#else
  if (slot >= count) return;
  first_order = 0;
  last_order = bands - 1;
#endif
  for (int i = 0; i < STORED; ++i) {
    sum[i] = vec3(0.0);
#if PARTS == 4
    slope_x[i] = slope_y[i] = slope_z[i] = vec3(0.0);
#endif
  }
  all_lights(texelFetch(grid_places, slot).xyz, range.x, range.y);
  bool start = chunk_first + range.x == 0;
  for (int m = first_order; m <= last_order; ++m)
    for (int l = m; l < bands; ++l) {
      store(slot, l, m, start);
      if (m > 0) store(slot, l, -m, start);
    }
}
