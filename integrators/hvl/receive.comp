// What each pixel's point does with light, on spherical harmonics: the coefficients of its F' that the gathering pass reads, one
// layer each.
layout(local_size_x = 8, local_size_y = 8) in;
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"
#include "sh/angle.glsl"

layout(binding = 12) uniform usamplerBuffer sh_words;
layout(binding = 13) uniform samplerBuffer sh_records;
layout(binding = 2, rgba32f) uniform image2DArray receivers;  // layer l(l+1)+m
#define SHMAT_WORD(i) texelFetch(sh_words, int(i)).x
#include "materials/sh_material.glsl"
#include "materials/sh_layers.glsl"

// ShMaterials::Tables::Kind.
const int SH_LAMBERT = 0;
const int SH_MEASURED = 1;

uniform ivec2 size;
uniform int bands;                // loops over them stay loops: unrolled they take compilers minutes
uniform float lambert_zonal[10];  // of the clamped cosine over pi
uniform float window[10];         // one weight a band

// Adds `share` of one file's coefficients, its channels mixed: colour = a x + b y + c z.
void add_table(ivec2 at, int record, vec3 o, float share, vec3 a, vec3 b, vec3 c) {
  vec4 level = texelFetch(sh_records, record);
  ShmatTable t = shmat_open((uint(level.y) << 12) + uint(level.z));
  ShmatPlace place = shmat_find(t, 1u, o);
  for (int l = 0; l < bands; ++l) {
    for (int m = t.mirrored == 1u ? 0 : -l; m <= l; ++m) {
      vec3 stored = shmat_coefficient(t, place, shmat_index(t, l, m));
      ivec3 layer = ivec3(at, l * (l + 1) + m);
      vec3 value = (share * window[l]) * (a * stored.x + b * stored.y + c * stored.z);
      imageStore(receivers, layer, imageLoad(receivers, layer) + vec4(value, 0.0));
    }
  }
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  Point p = point_read(at);
  if (!point_gathers(p)) return;
  for (int i = 0; i < bands * bands; ++i) imageStore(receivers, ivec3(at, i), vec4(0.0));
  vec4 record = texelFetch(sh_records, 2 * p.material);
  int kind = int(record.x);
  int levels = int(record.y);
  int first = int(record.z);
  if (kind == SH_LAMBERT) {
    for (int l = 0; l < bands; ++l)
      imageStore(receivers, ivec3(at, l * (l + 1)), vec4(p.albedo * (lambert_zonal[l] * window[l]), 0.0));
    return;
  }
  if (levels == 0) return;
  vec3 a = vec3(1.0, 0.0, 0.0);
  vec3 b = vec3(0.0, 1.0, 0.0);
  vec3 c = vec3(0.0, 0.0, 1.0);
  if (kind != SH_MEASURED) sh_layer_weights(p.kind, p.specular, p.albedo, a, b, c);
  // Between two levels of roughness, or the only one.
  int level = 0;
  float blend = 0.0;
  if (levels > 1) {
    vec2 range = texelFetch(sh_records, 2 * p.material + 1).xy;
    float x = sh_layer_place(p.brdf.alpha, range.x, range.y, float(levels));
    level = min(int(x), levels - 2);
    blend = x - float(level);
  }
  for (int i = 0; i < 2; ++i) {
    float share = i == 0 ? 1.0 - blend : blend;
    if (share > 0.0) add_table(at, first + level + i, p.brdf.o, share, a, b, c);
  }
}
