#pragma once
/// The scene's materials on spherical harmonics, textured ones too: what hvl and sh_direct shade with.
///
///     ShMaterials materials(scene.materials(), {.bands = 9}, stop);
///     int bands = materials.look_up(surface.material, bsdf, ShTable::brdf_cosine, w_out, 9, stride, rgb);
///
/// Lambert's coefficients are closed forms, a measured material is one table. All others are sums of three
/// scalar tables weighted by the colours of the point (Schlick's Fresnel is linear in F0), at one roughness,
/// or at levels of it where it has a texture; docs/materials.md has the sums and the error of the levels.
/// Coefficients are in the view frame of sh_material.h.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/stop.h"
#include "materials/material.h"
#include "materials/sh_material.h"

namespace zonal {

struct ShMaterialsOptions {
  int bands = 0;  ///< 1..100 for every material; 0: as many as each material needs (`share`, `most_bands`)
  float share = 0.95f;  ///< of the energy of a row of F', (0, 1)
  int most_bands = 64;  ///< where bands == 0
  int azimuths = 36;    ///< of an anisotropic model's table, >= 1
  std::function<void(const std::string& material, double share)> progress =
      {};  ///< share of this material done
};

class ShMaterials {
 public:
  ShMaterials() = default;
  /// Projects, in parallel, what is not in the cache (sh_cache.h). When stopped, what is missing is black.
  /// Throws SceneError where a projection's file is damaged.
  ShMaterials(const std::vector<std::unique_ptr<Material>>& materials, const ShMaterialsOptions& options,
              const Stop& stop = {});

  /// No coefficient with m < 0: layouts as in sh_material.h.
  bool mirrored(uint32_t material) const;
  /// Bands worth reading for this point and view: what the options ask for, or what holds `share` of the
  /// energy of F' of this very mixture at the nearest tabulated view; of F at most as many.
  int bands(uint32_t material, const Bsdf& bsdf, ShTable table, vec3 w_out) const;
  /// As ShMaterial::look_up, for the very point `bsdf` was made at.
  int look_up(uint32_t material, const Bsdf& bsdf, ShTable table, vec3 w_out, int bands, int stride,
              float* out) const;
  /// What a material's coefficients are made of, for a copy elsewhere (a GPU).
  struct Tables {
    enum Kind { lambert, measured, layers } kind = lambert;
    struct Level {
      float roughness;  ///< layers with more than one level
      const ShMaterial* table;
    };
    std::vector<Level> levels;  ///< none: lambert, or black
  };
  Tables tables(uint32_t material) const;
  /// Of all materials and views.
  int max_bands() const;
  /// What is not as the scene says: one sentence each, naming the material.
  const std::vector<std::string>& notes() const;

  /// Of the levels of textured roughness, which are uniform in it.
  static constexpr int kRoughnessSteps = 16;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace zonal
