// Gathers from virtual spherical lights by directions of their cones: the GPU's driver of vsl.glsl.
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"
#include "gl/lights.glsl"
#include "gl/hash.glsl"
#include "integrators/vsl/vsl.glsl"

layout(binding = 11) uniform samplerBuffer lattice;  // u in [0, 1), cos and sin of its turn
uniform int samples;
uniform uint pass_key;
uniform int chunk_first;  // the chunk's first light among all

vec3 from_light(Point p, uint seed, vec3 side, int j) {
  Light light = light_at(j);
  vec3 to_light = light.position - p.position;
  float d2 = dot(to_light, to_light);
  float per_radius2;
  float one_minus_cos = vsl_cone(d2, light.radius, per_radius2);
  // At the light itself every direction is as good: its normal reversed.
  float inverse = 1.0 / sqrt(max(d2, 1e-30));
  vec3 axis = d2 > 1e-30 ? to_light * inverse : -light.normal;
  // Some of the cone is above a horizon when its axis is less than its half angle below it.
  float sine = min(light.radius * inverse, 1.0);
  if (-dot(light.normal, axis) <= -sine || dot(axis, p.z) <= -sine) return vec3(0.0);
  vec3 x;
  vec3 y;
  vsl_frame(axis, side, x, y);

  // The pair's own turn and shift of the lattice.
  uint h = hash32(seed ^ (uint(chunk_first + j) * 0x9e3779b9u));
  float turn_c;
  float turn_s;
  vsl_turn(float(int(h)) * 2.32830644e-10, turn_c, turn_s);
  h *= 0x9e3779b9u;
  h ^= h >> 16;
  float shift = float(h >> 8) * 5.96046448e-8;

  vec3 total = vec3(0.0);
  for (int i = 0; i < samples; ++i) {
    vec3 point = texelFetch(lattice, i).xyz;
    float u = point.x + shift;
    u = u >= 1.0 ? u - 1.0 : u;
    vec3 w = vsl_direction(axis, x, y, one_minus_cos, u, turn_c * point.y - turn_s * point.z,
                           turn_s * point.y + turn_c * point.z);
    float receiver = dot(w, p.z);
    float emitter = -dot(light.normal, w);
    if (receiver <= 0.0 || emitter <= 0.0 || dot(w, p.normal) <= 0.0) continue;
    // (VSL-4)
    vec3 f = brdf_value(p.brdf, vec3(dot(w, p.x), dot(w, p.y), receiver));
    float weight = receiver * emitter * 2.0 * per_radius2 / float(samples);
    total += min(f * weight * light_reflects(j, light.even, -w), MOST);
  }
  return min(total * light.power, MOST);
}

vec3 gathered(Point p, ivec2 at, int first, int end) {
  uint seed = hash32(pass_key, uint(at.x), uint(at.y));
  // A vector of the scene's own that is hardly ever along w.
  vec3 side = p.x * p.brdf.o.x + p.y * p.brdf.o.y + p.z * p.brdf.o.z + 0.618 * p.z;
  vec3 total = vec3(0.0);
  for (int j = first; j < end; ++j) total += from_light(p, seed, side, j);
  return total;
}

#include "gl/gather.glsl"
