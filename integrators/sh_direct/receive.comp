// What each pixel's point does with light when the light meets the clamped cosine first (SHD-3): as the product with the cosine
// is symmetric, it is taken on the reflection's side, once a pixel, and what is left of light is one dot product. BANDS of the
// receiver; GENERAL: the product by the whole tensor (Eq. 2.48, 4.5), else by Eq. 4.6.
layout(local_size_x = 8, local_size_y = 8) in;
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"
#include "sh/basis.glsl"
#include "sh/angle.glsl"
#include "sh/sphere_light.glsl"
#include "sh/clamped_cosine.glsl"
#include "materials/zonal_lobes.glsl"
#include "gl/zonal_lobes.glsl"
#include "gl/sh_tables.glsl"

layout(binding = 2, rgba32f) uniform image2DArray receivers;  // view frame: layer l(l+1)+m
layout(binding = 11) uniform samplerBuffer entries;  // GENERAL: of the tensor: i, j, k, value; the cosine is the second factor
uniform ivec2 size;
uniform int bands;        // BANDS: loops over it stay loops
uniform int light_bands;
uniform int entry_count;
uniform float cosine[10];          // zonal, of the second factor
uniform float diffuse_weights[10];  // zonal, of what diffuse light is read from
uniform float light_weights[10];    // the window of light

ShCoefficients times_cosine(ShCoefficients f) {
  ShCoefficients product;
#if GENERAL == 1
  ShCoefficients turned;
  for (int i = 0; i < bands * bands; ++i) {
    turned.c[i] = 0.0;
    product.c[i] = 0.0;
  }
  for (int l = 0; l < bands; ++l) turned.c[l * (l + 1)] = cosine[l];
  for (int e = 0; e < entry_count; ++e) {
    vec4 entry = texelFetch(entries, e);
    product.c[int(entry.z)] += entry.w * f.c[int(entry.x)] * turned.c[int(entry.y)];
  }
#else
  sh_clamped_cosine_product(bands, f, product);
#endif
  return product;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  Point p = point_read(at);
  if (!point_gathers(p)) return;
  ShCoefficients f;
  bool ggx = p.kind == 3 || p.kind == 4 || p.kind == 5;
  if (p.kind != SH_KIND_MEASURED && !(ggx && p.brdf.alpha.x != p.brdf.alpha.y)) {
    // A diffuse part and a zonal lobe.
    ZonalReceiver z = zonal_receiver(p);
    // The lobe's axis has the azimuth opposite to the camera's, which is x of the view frame.
    vec3 local = vec3(dot(z.axis, p.x), dot(z.axis, p.y), dot(z.axis, p.z));
    vec2 o = p.brdf.o.xy;
    float r2 = dot(o, o);
    vec2 turn = r2 > 1e-12 ? o / sqrt(r2) : vec2(1.0, 0.0);
    vec3 axis = vec3(turn.x * local.x + turn.y * local.y, turn.x * local.y - turn.y * local.x, local.z);
    sh_evaluate(bands, axis, f);
    for (int l = 0; l < bands; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i)
        f.c[i] *= z.lobe.weight[l] * (12.5663706 / (2.0 * float(l) + 1.0));
    ShCoefficients weighted = times_cosine(f);
    vec3 diffuse = p.kind == 1 ? p.albedo * 0.318309886 : z.diffuse;
    for (int l = 0; l < light_bands; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
        vec3 value = z.specular * (weighted.c[i] * light_weights[l]);
        if (i == l * (l + 1)) value += diffuse * diffuse_weights[l];
        imageStore(receivers, ivec3(at, i), vec4(value, 0.0));
      }
    return;
  }
  // No axis of symmetry: the table of the BRDF without cosine, colour after colour.
  for (int i = 0; i < bands * bands; ++i) sh_table.c[i] = vec3(0.0);
  add_tables(p, 0u, bands);
  ShColors result;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < bands; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) f.c[i] = sh_table.c[i][k] * window[l];
    ShCoefficients weighted = times_cosine(f);
    for (int i = 0; i < light_bands * light_bands; ++i) result.c[i][k] = weighted.c[i];
  }
  for (int l = 0; l < light_bands; ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i)
      imageStore(receivers, ivec3(at, i), vec4(result.c[i] * light_weights[l], 0.0));
}
