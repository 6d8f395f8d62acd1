#pragma once
/// A material as measured: what MERL and RGL files have in common, behind `Bsdf` with kind `measured`.
///
///     std::unique_ptr<MeasuredBrdf> paper = load_measured("paper_white_rgb.bsdf");
///     vec3 f = paper->evaluate(w_out, w_in);       // 1/sr
///
/// Directions are unit, in the shading frame, away from the surface. Measurements are not exactly reciprocal: w_out (the
/// camera's side) is the direction that indexes the data, w_in the other one; docs/materials.md has the size of the
/// difference. Immutable after loading, so that all threads share it.

#include <memory>
#include <string>

#include "materials/bsdf.h"

namespace zonal {

class MeasuredBrdf {
 public:
  virtual ~MeasuredBrdf() = default;

  /// BRDF, 1/sr, linear Rec. 709, finite and >= 0; 0 below the horizon of either direction.
  virtual vec3 evaluate(vec3 w_out, vec3 w_in) const = 0;
  /// Draws w_in; z <= 0 where none was found.
  virtual vec3 sample_direction(vec3 w_out, float u_lobe, vec2 u) const = 0;
  /// Density of `sample_direction`, 1/sr.
  virtual float pdf(vec3 w_out, vec3 w_in) const = 0;

  /// Depends on the difference of azimuths only.
  virtual bool isotropic() const = 0;
  /// "MERL" or "RGL": the format's name.
  virtual const char* format() const = 0;

  std::string file;          ///< as given to load_measured
  std::string description;   ///< what the file says of itself, may be empty
  vec3 albedo{0};            ///< hemispherical, [0, 1], approximate: mean over cosine-weighted w_out
  size_t negative_samples = 0;  ///< clamped to 0 while loading
};

/// Reads a file by what it contains: RGL's "tensor_file" magic, else MERL's dimensions. Throws SceneError with the file,
/// the field, what was found and what was expected; no allocation is sized by an unchecked header.
std::unique_ptr<MeasuredBrdf> load_measured(const std::string& file);

}  // namespace zonal
