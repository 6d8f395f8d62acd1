// A BRDF seen from one side, in six texels (gl/pack_brdf.h), and its value for the other side's direction.
// The including shader declares `samplerBuffer coats`.

#include "materials/brdf.glsl"

const int BRDF_TEXELS = 6;

struct Brdf {
  vec3 o;          // the side that stays: unit, shading frame
  int kind;        // BRDF_...
  vec2 alpha;      // GGX widths
  float stretch;   // of o
  int coat;        // where its table of what the coat keeps starts; -1: no coat over the base
  vec3 f;          // Schlick: F0; dielectric, conductor: eta; Blinn-Phong: ks times the normalisation
  float exponent;  // Blinn-Phong
  vec3 k;          // conductor
  float aspect;    // of the coat
  vec3 tint;
  float specular;  // 1: there is a specular part
  vec3 base;       // diffuse part with all that hangs on o, 1/sr
};

Brdf brdf_unpack(vec4 a, vec4 b, vec4 c, vec4 d, vec4 e, vec4 f) {
  return Brdf(a.xyz, int(a.w), b.xy, b.z, int(b.w), c.xyz, c.w, d.xyz, d.w, e.xyz, e.w, f.xyz);
}

float coat_value(int start, int at) {
  return texelFetch(coats, start + at / 4)[at & 3];
}

// Bilinear in cosine and width: what SpecularAlbedo::Row::at interpolates, by the same nodes.
float coat_layer(int start, int azimuths, int layer, int alpha, float blend, float place) {
  int node = min(int(place), 95);
  float t = place - float(node);
  int lower = 48 + (alpha * azimuths + layer) * 97 + node;
  int upper = lower + azimuths * 97;
  float a = mix(coat_value(start, lower), coat_value(start, lower + 1), t);
  float b = mix(coat_value(start, upper), coat_value(start, upper + 1), t);
  return mix(a, b, blend);
}

// Where a width lies among the table's nodes.
float coat_width_place(vec2 alpha) {
  float root = sqrt(sqrt(sqrt(alpha.x * alpha.y)));
  return clamp((root - 0.1) * (47.0 / 0.9), 0.0, 47.0);
}

// What the coat reflects into the hemisphere, seen from w.
float coat_kept(int start, float aspect, vec2 widths, vec3 w) {
  float x = coat_width_place(widths);
  int alpha = min(int(x), 46);
  float blend = x - float(alpha);
  float place = brdf_coat_place(w.z, 97.0);
  if (aspect == 1.0) return coat_layer(start, 1, 0, alpha, blend, place);
  float x2 = w.x * w.x;
  float y2 = w.y * w.y;
  float width = sqrt(sqrt((x2 + aspect * aspect * y2 + 1e-20) / (x2 + y2 + 1e-20)));
  float side = sqrt(aspect);
  float azimuth = clamp((width - side) / (1.0 - side), 0.0, 1.0) * 8.0;
  int node = min(int(azimuth), 7);
  return mix(coat_layer(start, 9, node, alpha, blend, place), coat_layer(start, 9, node + 1, alpha, blend, place),
             azimuth - float(node));
}

float coat_average(int start, vec2 widths) {
  float x = coat_width_place(widths);
  int alpha = min(int(x), 46);
  return mix(coat_value(start, alpha), coat_value(start, alpha + 1), x - float(alpha));
}

// f, 1/sr; 0 below the horizon.
vec3 brdf_value(Brdf b, vec3 w) {
  if (w.z <= BRDF_MIN_COSINE) return vec3(0.0);
  vec3 value = b.base;
  if (b.kind == BRDF_CONSTANT) return value;
  if (b.coat >= 0) value *= 1.0 - coat_kept(b.coat, b.aspect, b.alpha, w);
  if (b.specular == 0.0) return value;
  if (b.kind == BRDF_BLINN_PHONG) return value + b.f * brdf_blinn_phong(b.o, w, b.exponent);
  float cosine;
  float density;
  float lobe = brdf_ggx(b.o, b.stretch, w, b.alpha, 1.0 / b.alpha, cosine, density);
  vec3 fresnel;
  if (b.kind == BRDF_SCHLICK) {
    fresnel = b.f + (1.0 - b.f) * brdf_schlick_weight(cosine);
  } else if (b.kind == BRDF_DIELECTRIC) {
    fresnel = b.tint * brdf_dielectric(cosine, b.f.x);
  } else {
    fresnel = b.tint * vec3(brdf_conductor(cosine, b.f.x, b.k.x), brdf_conductor(cosine, b.f.y, b.k.y),
                            brdf_conductor(cosine, b.f.z, b.k.z));
  }
  return value + fresnel * lobe;
}
