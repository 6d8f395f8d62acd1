// Gathers from virtual spherical Gaussian lights: the GPU's driver of vsgl.glsl, for one GENERATION.
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"
#include "integrators/vsgl/spherical_gaussian.glsl"
#include "integrators/vsgl/vsgl.glsl"

layout(binding = 10) uniform samplerBuffer lights;  // three texels a lobe
uniform float least_share;
uniform float least_variance;

// BsdfKind.
const int KIND_BLINN_PHONG = 2;
const int KIND_CONDUCTOR = 3;
const int KIND_COATED = 4;
const int KIND_METALLIC_ROUGHNESS = 5;

struct Receiver {
  bool specular;  // reflects about the mirrored direction
  vec3 coat;      // (VSGL-19): what a coat leaves of the light to the base
#if GENERATION == 2024
  VsglFilteredReceiver lobe;
#else
  VsglAsgReceiver lobe;
#endif
};

// pi f cos of Lambert's base under a coat, relative to it alone, for light at the cosine c; between the axes of an anisotropic
// one.
float base_share(Point p, float normalization, float c) {
  float side = sqrt(0.5 * (1.0 - c * c));
  return 3.14159265 * normalization * (1.0 - coat_kept(p.brdf.coat, p.brdf.aspect, p.brdf.alpha, vec3(side, side, c)));
}

Receiver receiver_of(Point p) {
  Receiver r;
  bool coated = p.kind == KIND_COATED || p.kind == KIND_METALLIC_ROUGHNESS;
  r.specular = coated || p.kind == KIND_CONDUCTOR || (p.kind == KIND_BLINN_PHONG && p.specular != vec3(0.0));
  r.coat = vec3(coated ? 0.0 : 1.0, 0.0, 0.0);
  if (p.brdf.coat >= 0) {
    float normalization = (1.0 - p.kept) / (3.14159265 * (1.0 - coat_average(p.brdf.coat, p.brdf.alpha)));
    r.coat = vsgl_coat(base_share(p, normalization, 1.0), base_share(p, normalization, 0.4),
                       base_share(p, normalization, 0.1));
  }
  vec2 alpha2 = p.brdf.alpha * p.brdf.alpha;
  if (p.kind == KIND_BLINN_PHONG) alpha2 = vec2(min(2.0 / (p.brdf.exponent + 2.0), 1.0));
  if (!r.specular) alpha2 = vec2(1.0);
#if GENERATION == 2024
  r.lobe = vsgl_filtered_receiver(p.brdf.o, alpha2);
#else
  r.lobe = vsgl_asg_receiver(p.brdf.o, alpha2);
#endif
  return r;
}

// (VSGL-17) Fresnel's factor at the half vector of camera and peak.
vec3 fresnel_at(Point p, float cosine) {
  if (p.kind == KIND_BLINN_PHONG) return p.specular;
  if (p.kind == KIND_METALLIC_ROUGHNESS) return p.specular + (1.0 - p.specular) * brdf_schlick_weight(cosine);
  return p.brdf.tint * vec3(brdf_conductor(cosine, p.brdf.f.x, p.brdf.k.x), brdf_conductor(cosine, p.brdf.f.y, p.brdf.k.y),
                            brdf_conductor(cosine, p.brdf.f.z, p.brdf.k.z));
}

vec3 gathered(Point p, ivec2 at, int first, int end) {
  Receiver r = receiver_of(p);
  vec3 total = vec3(0.0);
  for (int j = first; j < end; ++j) {
    vec4 a = texelFetch(lights, 3 * j);
    vec4 b = texelFetch(lights, 3 * j + 1);
    vec4 c = texelFetch(lights, 3 * j + 2);
    VsglLight light = VsglLight(a.xyz, a.w, b.rgb, b.w, c.xyz);
    vec3 axis;
    float scale;
    float K = vsgl_radiance(light, c.w, p.position, least_share, least_variance, axis, scale);
    vec3 local = vec3(dot(axis, p.x), dot(axis, p.y), dot(axis, p.z));
#if GENERATION == 2024
    float diffuse = sg_cosine_2024(local.z, K);
#else
    float diffuse = sg_cosine_2015(local.z, K);
#endif
    vec3 specular = vec3(0.0);
    if (r.specular) {
      diffuse *= vsgl_coat_at(r.coat, vsgl_base_cosine(local.z, K));
      vec3 peak;
#if GENERATION == 2024
      float reflected = vsgl_specular_2024(r.lobe, local, K, peak);
#else
      float reflected = vsgl_specular_2015(r.lobe, local, K, peak);
#endif
      specular = fresnel_at(p, vsgl_half_cosine(p.brdf.o, peak)) * reflected;
    }
    total += light.flux * scale * (p.albedo * diffuse + specular);
  }
  return total;
}

#include "gl/gather.glsl"
