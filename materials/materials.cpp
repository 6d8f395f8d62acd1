/// From a material's textures and constants to the Bsdf of one point. Whatever a texture holds, the Bsdf is
/// physical: colours and shares are clamped to [0,1], roughness becomes a width of at least kMinAlpha.

#include <cmath>

#include "materials/material.h"
#include "materials/microfacet.h"

namespace zonal {
namespace {

/// Also turns NaN, which an HDR texture may hold, into 0.
float clamp01(float x) {
  return std::fmin(std::fmax(x, 0.0f), 1.0f);
}
vec3 clamp01(vec3 c) {
  return {clamp01(c.x), clamp01(c.y), clamp01(c.z)};
}

/// alpha_y / alpha_x. Burley 2012, "Physically Based Shading at Disney": 1 - 0.9 anisotropy; its inverse for
/// the negative ones, so that they are the same surfaces turned by 90 degrees.
float aspect_of(float anisotropy) {
  const float a = std::fmin(std::fmax(anisotropy, -1.0f), 1.0f);
  return a >= 0.0f ? 1.0f - 0.9f * a : 1.0f / (1.0f + 0.9f * a);
}

void set_widths(Bsdf* b, float roughness, float aspect) {
  const float alpha = std::fmax(sqr(clamp01(roughness)), kMinAlpha);
  const float root = aspect == 1.0f ? 1.0f : std::sqrt(aspect);
  b->alpha_x = std::fmax(alpha / root, kMinAlpha);
  b->alpha_y = std::fmax(alpha * root, kMinAlpha);
}

}  // namespace

Bsdf LambertMaterial::at(vec2 uv) const {
  Bsdf b;
  b.diffuse = clamp01(albedo.at(uv));
  b.kind = is_black(b.diffuse) ? BsdfKind::black : BsdfKind::lambert;
  return b;
}

Bsdf BlinnPhongMaterial::at(vec2 uv) const {
  Bsdf b;
  b.kind = BsdfKind::blinn_phong;
  b.diffuse = clamp01(diffuse.at(uv));
  b.specular = clamp01(specular.at(uv));
  // Together the two may not reflect more than arrives.
  const vec3 scale = 1.0f / glm::max(b.diffuse + b.specular, vec3(1.0f));
  b.diffuse *= scale;
  b.specular *= scale;
  b.exponent = std::fmax(exponent, 0.0f);
  return b;
}

Bsdf ConductorMaterial::at(vec2 uv) const {
  Bsdf b;
  b.kind = BsdfKind::conductor;
  b.specular = clamp01(tint.at(uv));
  b.eta = glm::max(eta, vec3(1e-3f));  // eta = k = 0 has no Fresnel reflectance
  b.k = glm::max(k, vec3(0.0f));
  set_widths(&b, roughness.at(uv), aspect_of(anisotropy));
  return b;
}

Bsdf CoatedMaterial::at(vec2 uv) const {
  Bsdf b;
  b.kind = BsdfKind::coated;
  b.diffuse = clamp01(albedo.at(uv));
  b.specular = vec3(1.0f);
  b.eta = vec3(std::fmax(ior, 1.0f));
  const float aspect = aspect_of(anisotropy);
  set_widths(&b, roughness.at(uv), aspect);
  b.coat = &table.get(b.eta.x, aspect);
  return b;
}

Bsdf MetallicRoughnessMaterial::at(vec2 uv) const {
  Bsdf b;
  b.kind = BsdfKind::metallic_roughness;
  const vec3 base = clamp01(base_color.at(uv));
  const float metal = clamp01(metallic.at(uv));
  b.diffuse = base * (1.0f - metal);
  b.specular = glm::mix(vec3(0.04f), base, metal);
  set_widths(&b, roughness.at(uv), 1.0f);
  static const SpecularAlbedo& coat = SpecularAlbedo::schlick();
  b.coat = &coat;
  return b;
}

Bsdf MeasuredMaterial::at(vec2) const {
  Bsdf b;
  b.kind = BsdfKind::measured;
  b.measured = brdf.get();
  return b;
}

const std::vector<MaterialKind>& material_kinds() {
  static const std::vector<MaterialKind> kinds = {
      {"lambert", "diffuse: albedo"},
      {"blinn_phong", "diffuse plus a normalised Blinn-Phong lobe: diffuse, specular, exponent"},
      {"conductor", "GGX metal with exact Fresnel: metal, or eta and k; tint, roughness, anisotropy"},
      {"coated", "diffuse under a GGX dielectric coat: albedo, roughness, ior, anisotropy"},
      {"metallic_roughness", "glTF 2.0's model: base_color, metallic, roughness"},
      {"measured", "a MERL .binary or RGL .bsdf file: file"},
  };
  return kinds;
}

}  // namespace zonal
