// Gathers from virtual point lights: the GPU's driver of vpl.glsl.
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"
#include "gl/lights.glsl"
#include "integrators/vpl/vpl.glsl"

uniform float shortest;  // metres
uniform int yuksel;      // 1: that attenuation, with `shortest` as its radius

vec3 gathered(Point p, ivec2 at, int first, int end) {
  vec3 total = vec3(0.0);
  for (int j = first; j < end; ++j) {
    Light light = light_at(j);
    vec3 to_light = light.position - p.position;
    float d2 = dot(to_light, to_light);
    float attenuation = yuksel == 1 ? vpl_yuksel(d2, shortest) : vpl_inverse_square(d2, shortest);
    vec3 w;
    float geometry = vpl_geometry(to_light, p.z, light.normal, attenuation, w);
    // Light must arrive on the side of the true surface that the camera sees.
    if (geometry <= 0.0 || dot(w, p.normal) <= 0.0) continue;
    vec3 f = brdf_value(p.brdf, vec3(dot(w, p.x), dot(w, p.y), dot(w, p.z)));
    // (VPL-4)
    total += min(f * (geometry * light_reflects(j, light.even, -w) * light.power), MOST);
  }
  return total;
}

#include "gl/gather.glsl"
