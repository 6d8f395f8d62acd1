#include "integrators/vsgl/vsgl_blocks.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "lights/virtual_light_radius.h"
#include "materials/fresnel.h"

namespace zonal {
#include "integrators/vsgl/spherical_gaussian.glsl"
#include "integrators/vsgl/vsgl.glsl"

namespace {

/// Share of light from w_in that leaves in the specular lobe about `axis`: of a coat its table says it;
/// elsewhere Fresnel's factor at the half vector of both, times what is not masked there (VSGL-12).
vec3 specular_share(const Bsdf& b, vec3 w_in, vec3 axis, vec2 alpha2) {
  if (b.kind == BsdfKind::coated) return b.specular * b.coat->row(std::sqrt(b.alpha_x * b.alpha_y)).at(w_in);
  const float cosine = vsgl_half_cosine(w_in, axis);
  vec3 fresnel = b.specular;
  if (b.kind == BsdfKind::conductor) fresnel *= fresnel_conductor(cosine, b.eta, b.k);
  if (b.kind == BsdfKind::metallic_roughness) fresnel = fresnel_schlick(cosine, b.specular);
  return fresnel * vsgl_unmasked(w_in, axis, alpha2);
}

/// Variance along each axis of a square as large as the texel: a texel is a patch, not a point.
float spread_of(float area) {
  return area / 12.0f;
}

VsglBlock fit_block(const VirtualLight* texels, uint32_t count, VsglGeneration generation) {
  // Sums are kept relative to the block's middle texel.
  const VirtualLight& middle = texels[count / 2];
  VsglMoments moments[2];
  vec3 reference[2];
  for (int l = 0; l < 2; ++l) {
    moments[l] = {vec3(0), vec3(0), 0, vec3(0), 0, 0};
    reference[l] = texel_lobes(middle, generation).axis[l];
  }
  for (uint32_t i = 0; i < count; ++i) {
    const VsglTexel t = texel_lobes(texels[i], generation);
    for (int l = 0; l < 2; ++l)
      vsgl_add(moments[l], t.flux[l], texels[i].position - middle.position, spread_of(texels[i].footprint),
               t.axis[l], t.shortfall[l], reference[l]);
  }
  VsglBlock block;
  for (int l = 0; l < 2; ++l) {
    const VsglLight light = vsgl_fit(moments[l], middle.position, reference[l]);
    block[l] = {light.position,  light.variance, light.flux,
                light.sharpness, light.axis,     1.0f / (2.0f * kPi * sg_integral(light.sharpness))};
  }
  return block;
}

/// Sizes of the lights without a block, m^2 in the set's order: their neighbours are at the distance at which
/// lights on a plane lie from each other. Empty when every light has its block.
std::vector<float> areas_without_map(const VirtualLightSet& set, float scene_radius) {
  const bool all_have = std::all_of(set.lights.begin(), set.lights.end(), [](const VirtualLight& v) {
    return v.texel_count > 0 || v.footprint > 0;
  });
  if (all_have) return {};
  // The radius is the diagonal of the square that each light has to itself.
  std::vector<float> areas = virtual_light_radii(set, {.rule = RadiusRule::density}, scene_radius);
  for (float& a : areas) a = 0.5f * a * a;
  return areas;
}

}  // namespace

bool vsgl_has_specular(const Bsdf& b) {
  return b.kind == BsdfKind::conductor || b.kind == BsdfKind::coated ||
         b.kind == BsdfKind::metallic_roughness || (b.kind == BsdfKind::blinn_phong && !is_black(b.specular));
}

vec2 vsgl_squared_widths(const Bsdf& b) {
  if (!vsgl_has_specular(b)) return vec2(1);
  if (b.kind == BsdfKind::blinn_phong) return vec2(std::fmin(2.0f / (b.exponent + 2.0f), 1.0f));
  return {sqr(b.alpha_x), sqr(b.alpha_y)};
}

VsglTexel texel_lobes(const VirtualLight& v, VsglGeneration generation) {
  const bool first = generation == VsglGeneration::y2015;
  VsglTexel t;
  const vec3 w_in = v.frame.to_local(v.w_in);
  const BsdfContext view = prepare(v.bsdf, w_in, PathEnd::light);

  // Of the base under a coat, what the coat has let through on the way in leaves again: rho (1 - E(w_in)).
  t.axis[0] = v.frame.z;
  t.shortfall[0] = first ? VSGL_DIFFUSE_SHORTFALL_2015 : VSGL_DIFFUSE_SHORTFALL_2024;
  t.flux[0] = v.power * v.bsdf.diffuse * (1.0f - view.specular_albedo_out);

  t.axis[1] = v.frame.z;
  if (!vsgl_has_specular(v.bsdf) || !(w_in.z > 0)) return t;
  const vec2 alpha2 = vsgl_squared_widths(v.bsdf);
  vec3 axis;
  const float sharpness =
      first ? vsgl_reflection_2015(w_in, alpha2, axis) : vsgl_reflection_2024(w_in, alpha2, axis);
  t.axis[1] = normalize(v.frame.to_world(axis));
  t.shortfall[1] = sg_shortfall_of(sharpness);
  t.flux[1] = v.power * specular_share(v.bsdf, w_in, axis, alpha2);
  return t;
}

std::vector<VsglBlock> fit_blocks(const VirtualLightSet& set, VsglGeneration generation, float scene_radius) {
  const std::vector<float> areas = areas_without_map(set, scene_radius);
  std::vector<VsglBlock> blocks(set.lights.size());
  tbb::parallel_for(size_t{0}, blocks.size(), [&](size_t i) {
    const VirtualLight& light = set.lights[i];
    if (light.texel_count > 0) {
      blocks[i] = fit_block(&set.texels[light.first_texel], light.texel_count, generation);
      return;
    }
    VirtualLight alone = light;
    if (alone.footprint <= 0) alone.footprint = areas[i];
    blocks[i] = fit_block(&alone, 1, generation);
  });
  return blocks;
}

}  // namespace zonal
