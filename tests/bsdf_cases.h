#pragma once
/// One surface of every kind, at several roughnesses, and the directions to look at it from: what the tests
/// of reflection iterate over.

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "materials/material.h"

namespace zonal::test {

struct Case {
  std::string name;
  Bsdf bsdf;
  float width;  ///< of the narrowest lobe, as an angle of the half vector: where the quadrature must look
                ///< closely
};

inline Case lambert(vec3 albedo) {
  LambertMaterial m;
  m.albedo.value = albedo;
  return {"lambert", m.at(vec2(0)), 1};
}
inline Case blinn_phong(vec3 diffuse, vec3 specular, float exponent) {
  BlinnPhongMaterial m;
  m.diffuse.value = diffuse, m.specular.value = specular, m.exponent = exponent;
  return {"blinn_phong " + std::to_string(exponent), m.at(vec2(0)), std::min(1.0f, 1 / std::sqrt(exponent))};
}
inline Case narrow(const std::string& name, const Bsdf& b) {
  return {name, b, std::min(b.alpha_x, b.alpha_y)};
}
inline Case conductor(const std::string& metal, float roughness, float anisotropy = 0) {
  ConductorMaterial m;
  for (const Metal& entry : metals()) {
    if (entry.name == metal) m.eta = entry.eta, m.k = entry.k;
  }
  m.roughness.value = roughness, m.anisotropy = anisotropy;
  return narrow(metal + " " + std::to_string(roughness) + " " + std::to_string(anisotropy), m.at(vec2(0)));
}
inline Case coated(vec3 albedo, float roughness, float ior = 1.5f, float anisotropy = 0) {
  CoatedMaterial m;
  m.albedo.value = albedo, m.roughness.value = roughness, m.ior = ior, m.anisotropy = anisotropy;
  return narrow("coated " + std::to_string(roughness) + " " + std::to_string(anisotropy), m.at(vec2(0)));
}
inline Case metallic_roughness(vec3 base, float metallic, float roughness) {
  MetallicRoughnessMaterial m;
  m.base_color.value = base, m.metallic.value = metallic, m.roughness.value = roughness;
  return narrow("metallic_roughness " + std::to_string(metallic) + " " + std::to_string(roughness),
                m.at(vec2(0)));
}

inline std::vector<Case> all_kinds() {
  const vec3 warm(0.8f, 0.5f, 0.2f), half(0.5f);
  return {lambert(warm),
          blinn_phong(half, half, 1),
          blinn_phong(warm, vec3(0.2f), 50),
          blinn_phong(vec3(0), vec3(1), 3000),
          conductor("gold", 0.05f),
          conductor("copper", 0.3f),
          conductor("silver", 0.6f),
          conductor("iron", 1.0f),
          conductor("gold", 0.4f, 0.5f),
          conductor("gold", 0.5f, -0.8f),
          coated(warm, 0.05f),
          coated(warm, 0.3f),
          coated(warm, 1.0f, 2.0f),
          coated(warm, 0.4f, 1.5f, 0.6f),
          metallic_roughness(warm, 0, 0.1f),
          metallic_roughness(warm, 0.5f, 0.5f),
          metallic_roughness(warm, 1, 0.8f)};
}

inline vec3 direction(float degrees, float azimuth_degrees) {
  const float t = degrees * kPi / 180, p = azimuth_degrees * kPi / 180;
  return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
}
inline std::vector<vec3> views() {
  return {vec3(0, 0, 1), direction(30, 40), direction(60, -75), direction(85, 130), direction(89.5f, 10)};
}

struct Random {
  std::mt19937 bits;
  explicit Random(uint32_t seed) : bits(seed) {}
  float unit() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
  vec2 square() {
    const float x = unit();
    return {x, unit()};
  }
  vec3 hemisphere() {
    const float z = unit(), phi = 2 * kPi * unit(), s = safe_sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
  }
};

}  // namespace zonal::test
