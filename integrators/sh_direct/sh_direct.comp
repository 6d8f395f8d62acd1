// Meets each pixel's reflection (of turn.comp) with the light at its point: light by light, or between the points of a grid.
// BANDS of light; AT_GRID; ZONAL: the lobe light by light; TRIANGLES: some are exact.
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"
#include "sh/basis.glsl"
#include "sh/angle.glsl"
#include "sh/sphere_light.glsl"
#include "materials/zonal_lobes.glsl"
#include "integrators/sh_direct/sh_direct.glsl"
#include "integrators/sh_direct/lights.glsl"

layout(binding = 11) uniform sampler2DArray receivers;  // world frame: layer l(l+1)+m
layout(binding = 14) uniform samplerBuffer fixed_light;  // of parallel light and environment
uniform int chunk_first;  // the chunk's first light among all
uniform int bands;        // BANDS: what compilers take seconds to unroll stays a loop

vec3 total;
ShColors receiver;

#if ZONAL == 1
#include "gl/zonal_lobes.glsl"
uniform float cosine_weights[BANDS];
ZonalReceiver zonal;
vec3 zonal_normal;

void take(ShdSent s, vec3 colour) {
  ShdWeights cosine;
  ShdWeights lobe;
  for (int l = 0; l < BANDS; ++l) {
    cosine.c[l] = cosine_weights[l];
    lobe.c[l] = zonal.lobe.weight[l];
  }
  vec2 sums = shd_zonal(BANDS, s, dot(zonal_normal, s.w), dot(zonal.axis, s.w), cosine, lobe);
  total += colour * (zonal.diffuse * sums.x + zonal.specular * sums.y);
}
#else
void take(ShdSent s, vec3 colour) {
  total += colour * shd_reflect(BANDS, s, receiver);
}
#endif

void take_solid_angle(float omega, vec3 colour) {
  total += colour * receiver.c[0] * (omega * 0.282094792);
}
void take_edge(vec3 w, vec3 n, float dt, float over_rho, vec3 colour) {
  ShOrder row;
  vec3 sum = vec3(0.0);
  for (int m = 0; m < bands; ++m) {
    sh_evaluate_order(bands, m, w, row);
    for (int l = max(m, 1); l < bands; ++l) {
      int i = l * (l + 1);
      vec3 part = receiver.c[i + m] * dot(row.plus_gradient[l], n);
      if (m > 0) part += receiver.c[i - m] * dot(row.minus_gradient[l], n);
      sum += part / float(i);
    }
  }
  total += colour * sum * dt;
}

#if AT_GRID == 1
layout(binding = 15) uniform samplerBuffer grid_values;  // [slot][part][coefficient]
layout(binding = 16) uniform usamplerBuffer grid_slots;  // of each point, one more than where its values are; 0: it has none
uniform vec3 grid_low;
uniform vec3 grid_size;    // of a cell, metres
uniform vec3 grid_points;  // along each axis
uniform int interpolation;  // 0 Hermite, 1 Taylor, 2 linear
uniform int differences;
uniform int parts;

// What arrives between the eight points around x; false where one of them is missing.
bool reflect_grid(vec3 x) {
  vec3 place = (x - grid_low) / grid_size;
  if (any(lessThan(place, vec3(0.0))) || any(greaterThan(place, grid_points - 1.0))) return false;
  ivec3 points = ivec3(grid_points);
  ivec3 corner = min(ivec3(place), points - 2);
  vec3 t = clamp(place - vec3(corner), 0.0, 1.0);
  int slots[8];
  for (int k = 0; k < 8; ++k) {
    ivec3 p = corner + ivec3(k & 1, k >> 1 & 1, k >> 2);
    slots[k] = int(texelFetch(grid_slots, (p.z * points.y + p.y) * points.x + p.x).x) - 1;
    if (slots[k] < 0) return false;
  }
  ShdCell cell;
  if (interpolation == 0) {
    shd_hermite_cell(differences, t, grid_size, cell);
  } else {
    shd_linear_cell(interpolation == 1 ? 1 : 0, t, grid_size, cell);
  }
  for (int k = 0; k < 8; ++k)
    for (int part = 0; part < parts; ++part) {
      float weight = cell.w[4 * k + part];
      int at = (slots[k] * parts + part) * BANDS * BANDS;
      for (int i = 0; i < BANDS * BANDS; ++i) total += receiver.c[i] * texelFetch(grid_values, at + i).rgb * weight;
    }
  return true;
}
#endif

vec3 gathered(Point p, ivec2 at, int first, int end) {
  total = vec3(0.0);
  for (int i = 0; i < BANDS * BANDS; ++i) receiver.c[i] = texelFetch(receivers, ivec3(at, i), 0).rgb;
  bool start = chunk_first + first == 0;
#if AT_GRID == 1
  bool inside = reflect_grid(p.position);
  if (inside) return start ? total : vec3(0.0);
#endif
  if (start)
    for (int i = 0; i < BANDS * BANDS; ++i) total += receiver.c[i] * texelFetch(fixed_light, i).rgb;
#if ZONAL == 1
  zonal = zonal_receiver(p);
  zonal_normal = p.z;
#endif
  all_lights(p.position, first, end);
  return total;
}

#include "gl/gather.glsl"
