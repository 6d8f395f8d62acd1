#pragma once
/// A reflection model on spherical harmonics for any colours: three scalar tables, stored as the channels of
/// one ShMaterial, of which each colour channel of a point is a weighted sum. At one roughness, or linear
/// between levels of it.
///
///     layers.add_level(0.25f, cached_projection(at_quarter(ShLayers::load(bsdf)), options), true);
///     layers.look_up(bsdf, ShTable::brdf_cosine, w_out, 9, stride, rgb);
///
/// What the three channels are: metallic_roughness (F0 = 0; F0 = 1; F0 = 0 over a white base), coated (coat;
/// coat over a white base), blinn_phong (lobe; white diffuse), conductor (red, green, blue without tint).

#include <array>
#include <memory>
#include <vector>

#include "materials/bsdf.h"
#include "materials/sh_material.h"

namespace zonal {

class ShLayers {
 public:
  /// The Bsdf whose projection holds the tables of `bsdf`: its widths and indices, with other colours.
  static Bsdf load(const Bsdf& bsdf);

  /// Ascending in `roughness`, which is not read when one level stays the only one. `energies`: so that
  /// `bands` can tell what a mixture of colours needs; isotropic tables only.
  void add_level(float roughness, std::shared_ptr<const ShMaterial> table, bool energies);

  int levels() const { return static_cast<int>(levels_.size()); }
  float roughness(int level) const { return levels_[level].roughness; }
  const ShMaterial& table(int level) const { return *levels_[level].table; }

  bool mirrored() const { return levels_.empty() || levels_[0].table->mirrored(); }
  /// That F' of this mixture needs; of F at most as many.
  int bands(const Bsdf& bsdf, ShTable table, vec3 w_out, float share) const;
  /// As ShMaterial::look_up. Zero without levels.
  int look_up(const Bsdf& bsdf, ShTable table, vec3 w_out, int bands, int stride, float* out) const;

 private:
  /// out channel c = sum over k of weight[c][k] times stored channel k.
  using Weights = std::array<std::array<float, 3>, 3>;
  static Weights weights(const Bsdf& bsdf);
  /// xx, yy, zz, xy, xz, yz of a symmetric matrix.
  using Symmetric = std::array<float, 6>;

  struct Level {
    float roughness;
    std::shared_ptr<const ShMaterial> table;
    /// Of F': inner products of the channels' coefficients, bands 0..l summed, row after row; then their
    /// estimate for all bands.
    std::vector<Symmetric> energy;
    std::vector<int> start;  ///< of each elevation's row in `energy`
  };
  struct Place {
    size_t level;
    float blend;
  };
  Place place(const Bsdf& bsdf) const;

  std::vector<Level> levels_;
};

}  // namespace zonal
