// From a material's textures and constants to the reflection of one point: what materials/materials.cpp and `prepare` of
// materials/bsdf.cpp do. Needs gl/scene.glsl and gl/brdf.glsl before it.

// BsdfKind.
const int KIND_BLACK = 0;
const int KIND_LAMBERT = 1;
const int KIND_BLINN_PHONG = 2;
const int KIND_CONDUCTOR = 3;
const int KIND_COATED = 4;
const int KIND_METALLIC_ROUGHNESS = 5;
const int KIND_MEASURED = 6;

struct Bsdf {
  int kind;
  vec3 diffuse;
  vec3 specular;
  vec3 eta;
  vec3 k;
  vec2 alpha;
  float exponent;
  int coat;
  float aspect;
};

vec3 textured(vec4 color, vec2 uv) {
  return color.w < 0.0 ? color.rgb : color.rgb * texture_at(int(color.w), uv).rgb;
}
float textured_number(vec3 number, vec2 uv) {
  return number.y < 0.0 ? number.x : number.x * texture_at(int(number.y), uv)[int(number.z)];
}

Bsdf material_at(int material, vec2 uv) {
  int at = 8 * material;
  vec4 a = texelFetch(materials, at);
  vec3 first = clamp(textured(texelFetch(materials, at + 1), uv), 0.0, 1.0);
  float rough = clamp(textured_number(texelFetch(materials, at + 4).xyz, uv), 0.0, 1.0);
  float alpha = max(rough * rough, 1e-4);
  float root = sqrt(a.z);
  Bsdf b;
  b.kind = int(a.x);
  b.diffuse = vec3(0.0);
  b.specular = vec3(0.0);
  b.eta = texelFetch(materials, at + 5).xyz;
  b.k = texelFetch(materials, at + 6).xyz;
  b.alpha = max(vec2(alpha / root, alpha * root), 1e-4);
  b.exponent = a.y;
  b.coat = int(a.w);
  b.aspect = a.z;
  if (b.kind == KIND_LAMBERT) {
    b.diffuse = first;
    if (first == vec3(0.0)) b.kind = KIND_BLACK;
  } else if (b.kind == KIND_BLINN_PHONG) {
    vec3 second = clamp(textured(texelFetch(materials, at + 2), uv), 0.0, 1.0);
    vec3 scale = 1.0 / max(first + second, vec3(1.0));
    b.diffuse = first * scale;
    b.specular = second * scale;
  } else if (b.kind == KIND_CONDUCTOR) {
    b.specular = first;
  } else if (b.kind == KIND_COATED) {
    b.diffuse = first;
    b.specular = vec3(1.0);
  } else if (b.kind == KIND_METALLIC_ROUGHNESS) {
    float metal = clamp(textured_number(texelFetch(materials, at + 3).xyz, uv), 0.0, 1.0);
    b.diffuse = first * (1.0 - metal);
    b.specular = mix(vec3(0.04), first, metal);
  }
  return b;
}

// The reflection seen from `o` (unit, shading frame). `kept` receives what a coat reflects towards o, 0 without one.
Brdf brdf_of(Bsdf b, vec3 o, OUT(float) kept) {
  Brdf r = Brdf(vec3(o.xy, max(o.z, BRDF_MIN_COSINE)), BRDF_CONSTANT, b.alpha, 1.0, -1, vec3(0.0), b.exponent, vec3(0.0),
                b.aspect, vec3(1.0), 1.0, vec3(0.0));
  kept = 0.0;
  if (o.z <= BRDF_MIN_COSINE || b.kind == KIND_BLACK || b.kind == KIND_MEASURED) return r;
  r.stretch = length(vec3(b.alpha * o.xy, o.z));
  if (b.kind == KIND_LAMBERT) {
    r.base = b.diffuse * 0.318309886;
  } else if (b.kind == KIND_BLINN_PHONG) {
    float n = b.exponent;
    r.kind = BRDF_BLINN_PHONG;
    // Giesen 2009, as blinn_phong_normalization.
    r.f = b.specular * ((n + 2.0) * (n + 4.0) / (25.1327412 * (exp2(-0.5 * n) + n)));
    r.base = b.diffuse * 0.318309886;
  } else if (b.kind == KIND_CONDUCTOR) {
    r.kind = BRDF_CONDUCTOR;
    r.f = b.eta;
    r.k = b.k;
    r.tint = b.specular;
  } else {
    r.kind = b.kind == KIND_COATED ? BRDF_DIELECTRIC : BRDF_SCHLICK;
    r.f = b.kind == KIND_COATED ? b.eta : b.specular;
    if (b.kind == KIND_COATED) r.tint = b.specular;
    kept = coat_kept(b.coat, b.aspect, b.alpha, o);
    if (b.diffuse != vec3(0.0)) {
      float below = 1.0 - coat_average(b.coat, b.alpha);
      float normalization = below > 1e-6 ? (1.0 - kept) / (3.14159265 * below) : 0.0;
      if (normalization > 0.0) {
        r.base = b.diffuse * normalization;
        r.coat = b.coat;
      }
    }
  }
  return r;
}
