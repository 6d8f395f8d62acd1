#pragma once
/// A material as measured: what MERL and RGL files have in common, behind `Bsdf` with kind `measured`.
///
///     std::unique_ptr<MeasuredBrdf> paper = load_measured("paper_white_rgb.bsdf");
///     vec3 f = paper->evaluate(w_out, w_in);       // 1/sr
///     paper->evaluate(w_out, n, w_in, f);          // many w_in at once: what depends on w_out is done once
///
/// Directions are unit, in the shading frame, away from the surface. Measurements are not exactly reciprocal:
/// w_out (the camera's side) is the direction that indexes the data, w_in the other one; docs/materials.md
/// has the size of the difference. Immutable after loading, so that all threads share it.

#include <memory>
#include <string>
#include <vector>

#include "materials/bsdf.h"

namespace zonal {

class MeasuredBrdf {
 public:
  virtual ~MeasuredBrdf() = default;

  /// BRDF, 1/sr, linear Rec. 709, finite and >= 0; 0 below the horizon of either direction.
  virtual vec3 evaluate(vec3 w_out, vec3 w_in) const = 0;
  /// Draws w_in; z <= 0 where none was found.
  virtual vec3 sample_direction(vec3 w_out, float u_lobe, vec2 u) const = 0;
  /// Density of `sample_direction`, 1/sr; > 0 wherever `evaluate` is. Its integral lacks of 1 the share of
  /// draws without a direction.
  virtual float pdf(vec3 w_out, vec3 w_in) const = 0;

  /// f[i] = evaluate(w_out, w_in[i]) up to rounding, for i < n. w_in and f may not overlap.
  void evaluate(vec3 w_out, int n, const vec3* w_in, vec3* f) const { evaluate_many(w_out, n, w_in, f); }
  /// Both at once, for those who need both: the formats share the search for the place in the data.
  virtual void evaluate_with_pdf(vec3 w_out, vec3 w_in, vec3* f, float* density) const {
    *f = evaluate(w_out, w_in), *density = pdf(w_out, w_in);
  }

  /// Depends on the difference of azimuths only.
  virtual bool isotropic() const = 0;
  /// "MERL" or "RGL": the format's name.
  virtual const char* format() const = 0;

  std::string file;             ///< as given to load_measured
  std::string description;      ///< what the file says of itself, may be empty
  vec3 albedo{0};               ///< hemispherical, [0, 1], approximate: mean over cosine-weighted w_out
  size_t negative_samples = 0;  ///< of the file, noise and out-of-gamut colours; `evaluate` answers 0 there
  std::vector<std::string> notes;  ///< what a user should know of this file, a sentence each; mostly none

 protected:
  /// A format that gains from sharing w_out overrides this.
  virtual void evaluate_many(vec3 w_out, int n, const vec3* w_in, vec3* f) const;
  /// Sets `albedo` from the three functions above: a few thousand samples, some milliseconds.
  void estimate_albedo();
};

/// Reads a file by what it contains: RGL's "tensor_file" magic, else MERL's dimensions. Throws SceneError
/// with the file, the field, what was found and what was expected; no allocation is sized by an unchecked
/// header.
std::unique_ptr<MeasuredBrdf> load_measured(const std::string& file);

}  // namespace zonal
