#pragma once
/// The scene's materials on spherical harmonics, textured ones too: what hvl and sh_direct shade with.
///
///     ShMaterials materials(scene.materials(), {.bands = 9}, stop);
///     int bands = materials.look_up(surface.material, bsdf, ShTable::brdf_cosine, w_out, 9, stride, rgb);
///
/// A measured or constant material is one table. A textured one is a sum of tables by roughness, weighted by the colours
/// of the point: diffuse, specular at F0 = 0 and at F0 = 1 (Schlick is linear in F0), and so on; docs/materials.md has the
/// sums. Coefficients are in the view frame of sh_material.h.

#include <memory>
#include <vector>

#include "core/stop.h"
#include "materials/material.h"
#include "materials/sh_material.h"

namespace zonal {

struct ShMaterialsOptions {
  int bands = 0;        ///< 0: as many as each material needs (`share`, `most_bands`)
  float share = 0.95f;
  int most_bands = 64;
};

class ShMaterials {
 public:
  ShMaterials() = default;
  ShMaterials(const std::vector<std::unique_ptr<Material>>& materials, const ShMaterialsOptions& options,
              const Stop& stop);

  /// No coefficient with m < 0: layouts as in sh_material.h.
  bool mirrored(uint32_t material) const;
  /// Bands worth reading for this point and view.
  int bands(uint32_t material, const Bsdf& bsdf, ShTable table, vec3 w_out) const;
  /// As ShMaterial::look_up, for the very point `bsdf` was made at.
  int look_up(uint32_t material, const Bsdf& bsdf, ShTable table, vec3 w_out, int bands, int stride, float* out) const;
  int max_bands() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace zonal
