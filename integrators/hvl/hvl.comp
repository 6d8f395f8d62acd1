// Gathers from harmonic virtual lights: the GPU's driver of hvl.glsl. BANDS of the receiver (a zonal lobe's when ZONAL is 1; else
// of full spherical harmonics, of which only m >= 0 are there when MIRRORED is 1); EMISSION_BANDS of the lights, 0: their BRDF.
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"
#include "gl/lights.glsl"
#include "sh/basis.glsl"
#include "sh/angle.glsl"
#include "sh/sphere_light.glsl"
#include "materials/zonal_lobes.glsl"
#include "integrators/hvl/hvl.glsl"

uniform float soft_edge;

#if EMISSION_BANDS > 0
layout(binding = 11) uniform samplerBuffer emission;  // view frame, then coefficients of even l + m
uniform int chunk_first;                              // the chunk's first light among all

vec3 light_sends(int j, bool even, vec3 w) {
  int at = (chunk_first + j) * (3 + EMISSION_BANDS * (EMISSION_BANDS + 1) / 2);
  vec3 local = vec3(dot(w, texelFetch(emission, at).xyz), dot(w, texelFetch(emission, at + 1).xyz),
                    dot(w, texelFetch(emission, at + 2).xyz));
  HvlColors f;
  int k = at + 3;
  for (int l = 0; l < EMISSION_BANDS; ++l)
    for (int m = -l; m <= l; m += 2) f.c[l * (l + 1) + m] = texelFetch(emission, k++).rgb;
  return hvl_emission(EMISSION_BANDS, f, vec3(1.0), local);
}
#else
vec3 light_sends(int j, bool even, vec3 w) {
  return light_reflects(j, even, w);
}
#endif

#if ZONAL == 1
#include "gl/zonal_lobes.glsl"
#else
layout(binding = 12) uniform sampler2DArray receivers;  // of receive.comp: layer l(l+1)+m
#endif

vec3 gathered(Point p, ivec2 at, int first, int end) {
#if ZONAL == 1
  ZonalReceiver receiver = zonal_receiver(p);
#else
  HvlColors receiver;
  for (int l = 0; l < BANDS; ++l)
    for (int m = MIRRORED == 1 ? 0 : -l; m <= l; ++m)
      receiver.c[l * (l + 1) + m] = texelFetch(receivers, ivec3(at, l * (l + 1) + m), 0).rgb;
  // The view frame: x at the camera's azimuth.
  vec2 o = p.brdf.o.xy;
  float r2 = dot(o, o);
  vec2 turn = r2 > 1e-12 ? o / sqrt(r2) : vec2(1.0, 0.0);
  vec3 view_x = turn.x * p.x + turn.y * p.y;
  vec3 view_y = turn.x * p.y - turn.y * p.x;
#endif
  vec3 total = vec3(0.0);
  for (int j = first; j < end; ++j) {
    Light light = light_at(j);
    vec3 to_light = light.position - p.position;
    float d2 = dot(to_light, to_light);
    vec3 w = d2 > 0.0 ? to_light / sqrt(d2) : vec3(0.0);
    float facing = -dot(light.normal, w);
    float up = dot(p.z, w);
    ZonalCap cap = sphere_cap(d2, light.radius);
    // What lies wholly below either horizon brings nothing.
    float sine = sqrt(cap.sine2);
    if (facing <= 0.0 || up <= -sine || dot(p.normal, w) <= -sine) continue;
    vec3 L = hvl_radiance(light.power, light_sends(j, light.even, -w), facing, light.radius);
#if ZONAL == 1
    total += L * hvl_zonal_product(BANDS, receiver.diffuse, receiver.specular, receiver.lobe, cap, up,
                                   dot(receiver.axis, w));
#elif MIRRORED == 1
    total += L * hvl_mirrored_product(BANDS, receiver, cap, vec3(dot(view_x, w), dot(view_y, w), up), soft_edge);
#else
    total += L * hvl_product(BANDS, receiver, cap, vec3(dot(view_x, w), dot(view_y, w), up), soft_edge);
#endif
  }
  return total;
}

#include "gl/gather.glsl"
