// What each pixel's point does with light, on spherical harmonics: the coefficients of its F' that the gathering pass reads, one
// layer each.
layout(local_size_x = 8, local_size_y = 8) in;
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"
#include "sh/basis.glsl"
#include "sh/angle.glsl"
#include "gl/sh_tables.glsl"

layout(binding = 2, rgba32f) uniform image2DArray receivers;  // layer l(l+1)+m
uniform ivec2 size;
uniform int bands;                // loops over them stay loops: unrolled they take compilers minutes
uniform float lambert_zonal[10];  // of the clamped cosine over pi
uniform float window[10];         // one weight a band

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  Point p = point_read(at);
  if (!point_gathers(p)) return;
  for (int i = 0; i < bands * bands; ++i) sh_table.c[i] = vec3(0.0);
  if (sh_table_kind(p) == SH_LAMBERT) {
    for (int l = 0; l < bands; ++l) sh_table.c[l * (l + 1)] = p.albedo * lambert_zonal[l];
  } else {
    add_tables(p, 1u, bands);
  }
  for (int l = 0; l < bands; ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) imageStore(receivers, ivec3(at, i), vec4(sh_table.c[i] * window[l], 0.0));
}
