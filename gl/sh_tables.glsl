// A point's reflection from the tables of gl/sh_tables.cpp. Needs gl/point.glsl, sh/basis.glsl and sh/angle.glsl before it.

layout(binding = 13) uniform usamplerBuffer sh_words;
layout(binding = 14) uniform samplerBuffer sh_records;
#define SHMAT_WORD(i) texelFetch(sh_words, int(i)).x
#include "materials/sh_material.glsl"
#include "materials/sh_layers.glsl"

// ShMaterials::Tables::Kind.
const int SH_LAMBERT = 0;
const int SH_MEASURED = 1;
const int SH_KIND_MEASURED = 6;  // of a BSDF

int sh_table_kind(Point p) {
  return int(texelFetch(sh_records, 2 * p.material).x);
}

// Where sums go: arrays handed to functions are copied number by number, which takes compilers a minute.
ShColors sh_table;

// Adds `share` of one file's coefficients, its channels mixed: colour = a x + b y + c z.
void add_table(Point p, int record, uint kind, int bands, float share, vec3 a, vec3 b, vec3 c) {
  vec4 level = texelFetch(sh_records, record);
  ShmatTable t = shmat_open((uint(level.y) << 12) + uint(level.z));
  ShmatPlace place = shmat_find(t, kind, p.brdf.o);
  for (int l = 0; l < bands; ++l) {
    for (int m = t.mirrored == 1u ? 0 : -l; m <= l; ++m) {
      vec3 stored = shmat_coefficient(t, place, shmat_index(t, l, m));
      sh_table.c[l * (l + 1) + m] += share * (a * stored.x + b * stored.y + c * stored.z);
    }
  }
}

// Adds the point's coefficients in its view frame; `kind` 0: of its BRDF, 1: of that times cosine. Nothing for Lambert and black.
void add_tables(Point p, uint kind, int bands) {
  vec4 record = texelFetch(sh_records, 2 * p.material);
  int levels = int(record.y);
  if (levels == 0) return;
  vec3 a = vec3(1.0, 0.0, 0.0);
  vec3 b = vec3(0.0, 1.0, 0.0);
  vec3 c = vec3(0.0, 0.0, 1.0);
  if (int(record.x) != SH_MEASURED) sh_layer_weights(p.kind, p.specular, p.albedo, a, b, c);
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
    if (share > 0.0) add_table(p, int(record.z) + level + i, kind, bands, share, a, b, c);
  }
}
