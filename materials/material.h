#pragma once
/// A named material of the scene: textures and constants that become a Bsdf at each surface point.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/texture.h"
#include "materials/bsdf.h"

namespace zonal {

/// A constant, times a texture where there is one.
struct TexturedColor {
  vec3 value{1};
  const Texture* texture = nullptr;
  vec3 at(vec2 uv) const { return texture ? value * texture->rgb(uv) : value; }
};
struct TexturedNumber {
  float value = 1;
  const Texture* texture = nullptr;
  int channel = 0;  ///< 0..3 = r, g, b, a
  float at(vec2 uv) const { return texture ? value * texture->sample(uv)[channel] : value; }
};

class Material {
 public:
  virtual ~Material() = default;
  virtual Bsdf at(vec2 uv) const = 0;
  virtual const char* type() const = 0;  ///< the scene file's name of the kind
  /// The texture `at` reads first, or null: Scene::look_up asks the cache for it ahead of time.
  virtual const Texture* first_texture() const { return nullptr; }

  std::string name;
  const Texture* normal_map = nullptr;  ///< tangent space, xyz = 2 rgb - 1, y up
  float normal_scale = 1;
  const Texture* mask = nullptr;  ///< surface exists where the channel >= mask_cutoff
  int mask_channel = 3;
  float mask_cutoff = 0.5f;

  /// True where the surface is cut away.
  bool masked(vec2 uv) const { return mask && mask->sample(uv)[mask_channel] < mask_cutoff; }
};

struct LambertMaterial : Material {
  TexturedColor albedo{vec3(0.5f)};
  Bsdf at(vec2 uv) const override;
  const Texture* first_texture() const override { return albedo.texture; }
  const char* type() const override { return "lambert"; }
};

/// Normalised Blinn-Phong (Giesen's normalisation): diffuse + specular lobe of cos^exponent(half angle). Where diffuse +
/// specular exceeds 1 in a channel, both are divided by the sum.
struct BlinnPhongMaterial : Material {
  TexturedColor diffuse{vec3(0.5f)}, specular{vec3(0.04f)};
  float exponent = 50;
  Bsdf at(vec2 uv) const override;
  const Texture* first_texture() const override { return diffuse.texture; }
  const char* type() const override { return "blinn_phong"; }
};

/// GGX with exact conductor Fresnel. roughness is glTF's: alpha = roughness^2, at least 1e-4. anisotropy in [-1,1]
/// stretches highlights along x (negative: along y): alpha_y / alpha_x = 1 - 0.9 anisotropy (Burley 2012), the product
/// of the two staying alpha^2.
struct ConductorMaterial : Material {
  vec3 eta{0.2f, 0.92f, 1.1f}, k{3.9f, 2.45f, 2.14f};
  TexturedColor tint{vec3(1)};
  TexturedNumber roughness{0.3f};
  float anisotropy = 0;
  Bsdf at(vec2 uv) const override;
  const Texture* first_texture() const override { return tint.texture ? tint.texture : roughness.texture; }
  const char* type() const override { return "conductor"; }
};

/// A dielectric GGX coat over a diffuse base; what the coat does not reflect reaches the base, so white over white
/// reflects everything (Kelemen and Szirmay-Kalos 2001).
struct CoatedMaterial : Material {
  TexturedColor albedo{vec3(0.5f)};
  TexturedNumber roughness{0.3f};
  float ior = 1.5f;  ///< of the coat, >= 1
  float anisotropy = 0;
  CoatTable table;  ///< of (ior, anisotropy); made by the first call of `at`
  Bsdf at(vec2 uv) const override;
  const Texture* first_texture() const override { return albedo.texture ? albedo.texture : roughness.texture; }
  const char* type() const override { return "coated"; }
};

/// glTF 2.0's metallic-roughness model, the base of imported glTF materials.
struct MetallicRoughnessMaterial : Material {
  TexturedColor base_color{vec3(0.8f)};
  TexturedNumber metallic{0, nullptr, 2}, roughness{0.5f, nullptr, 1};
  Bsdf at(vec2 uv) const override;
  const Texture* first_texture() const override { return base_color.texture ? base_color.texture : roughness.texture; }
  const char* type() const override { return "metallic_roughness"; }
};

/// A MERL or RGL file, or an entry of the material database.
struct MeasuredMaterial : Material {
  std::shared_ptr<const MeasuredBrdf> brdf;
  std::string sh_file;  ///< its projection in the database; empty: projected when a method asks for it
  Bsdf at(vec2) const override;
  const char* type() const override { return "measured"; }
};

/// Complex index of refraction of a named metal ("gold", "aluminium", ...) in red, green and blue: 630, 550, 465 nm.
struct Metal {
  std::string name;
  vec3 eta, k;
};
const std::vector<Metal>& metals();

/// Name and one-line meaning of each kind, for `zonal list materials` and error messages.
struct MaterialKind {
  std::string name, summary;
};
const std::vector<MaterialKind>& material_kinds();

}  // namespace zonal
