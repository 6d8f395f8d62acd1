#pragma once
/// From the blocks of texels of a virtual light set to spherical Gaussian lights: two a block, one for what
/// its surfaces reflect diffusely, one for what they reflect about the mirrored direction.
///
///     std::vector<VsglBlock> blocks = fit_blocks(set, VsglGeneration::y2024, scene.bounds().radius);
///     vec3 sent = blocks[0].lobe[0].flux + blocks[0].lobe[1].flux;       // W

#include <array>
#include <vector>

#include "core/glsl.h"
#include "lights/virtual_lights.h"

namespace zonal {

/// Which publication's lobes: Tokuyoshi 2015 as Mézières 2022 compares with, or the public code since 2024.
enum class VsglGeneration { y2015, y2024 };

/// The part of vsgl.glsl that host code keeps; the kernel's own struct has these members in this order.
struct VsglLobe {
  vec3 position{0};    ///< metres
  float variance = 0;  ///< m^2 along each axis of the surface
  vec3 flux{0};        ///< W
  float sharpness = 0;
  vec3 axis{0, 0, 1};     ///< unit, the mean direction the light leaves in
  float coefficient = 0;  ///< 1 / (2 pi I(sharpness))
};

/// A diffuse and a specular lobe; flux 0 where there is none.
using VsglBlock = std::array<VsglLobe, 2>;

/// What one texel reflects, by lobe.
struct VsglTexel {
  vec3 flux[2] = {vec3(0), vec3(0)};              ///< W
  vec3 axis[2] = {vec3(0, 0, 1), vec3(0, 0, 1)};  ///< unit, world
  float shortfall[2] = {0, 0};                    ///< 1 - length of the lobe's mean direction
};
VsglTexel texel_lobes(const VirtualLight& texel, VsglGeneration generation);

/// Squared GGX widths of a surface's specular lobe, along its frame's x and y; Blinn-Phong's by alpha^2 = 2 /
/// (n + 2) (Walter et al. 2007), whose lobe is as wide at the normal. (1, 1) where there is no lobe.
vec2 vsgl_squared_widths(const Bsdf& bsdf);
bool vsgl_has_specular(const Bsdf& bsdf);

/// One block a light of the set, in its order. Lights that stand for no block (paths, later bounces) become
/// one texel each, as large as the distance to their neighbours says. `scene_radius`: metres, of the bounding
/// sphere.
std::vector<VsglBlock> fit_blocks(const VirtualLightSet& set, VsglGeneration generation, float scene_radius);

}  // namespace zonal
