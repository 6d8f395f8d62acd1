#pragma once
/// What the tests of `vsgl` share: its kernel as other compilers see it, surfaces, and texels by hand.

#include "core/glsl.h"
#include "integrators/vsgl/vsgl.h"
#include "integrators/vsgl/vsgl_receivers.h"

namespace zonal {
namespace kernel {
#include "integrators/vsgl/spherical_gaussian.glsl"
#include "integrators/vsgl/vsgl.glsl"
}  // namespace kernel

namespace test {

inline constexpr VsglGeneration kGenerations[] = {VsglGeneration::y2015, VsglGeneration::y2024};

inline Bsdf lambert(vec3 albedo) {
  Bsdf b;
  b.kind = BsdfKind::lambert, b.diffuse = albedo;
  return b;
}
inline Bsdf coated(float alpha, vec3 albedo = vec3(0.5f)) {
  Bsdf b;
  b.kind = BsdfKind::coated, b.diffuse = albedo, b.specular = vec3(1), b.eta = vec3(1.5f);
  b.alpha_x = b.alpha_y = alpha, b.coat = &SpecularAlbedo::dielectric(1.5f);
  return b;
}
inline Bsdf gold(float alpha_x, float alpha_y) {
  Bsdf b;
  b.kind = BsdfKind::conductor, b.specular = vec3(1), b.eta = vec3(0.2f, 0.4f, 1.4f),
  b.k = vec3(3.5f, 2.4f, 1.8f);
  b.alpha_x = alpha_x, b.alpha_y = alpha_y;
  return b;
}

inline VirtualLight texel(vec3 position, vec3 normal, vec3 w_in, vec3 power, const Bsdf& bsdf) {
  VirtualLight v;
  v.position = position, v.normal = normal, v.frame = Frame(normal), v.w_in = w_in, v.power = power,
  v.bsdf = bsdf;
  return v;
}

}  // namespace test
}  // namespace zonal
