#pragma once
/// MERL's measured isotropic BRDFs (Matusik et al. 2003): `.binary` files of 90 x 90 x 180 colours.
///
///     std::unique_ptr<MeasuredBrdf> nickel = load_merl("nickel.binary");
///
/// docs/materials.md has the layout, how values between the samples are found, and what is done about
/// negative ones.

#include <memory>
#include <string>
#include <vector>

#include "materials/measured_brdf.h"
#include "materials/merl_grid.h"
#include "materials/merl_sampler.h"

namespace zonal {

class MerlBrdf final : public MeasuredBrdf {
 public:
  /// `cells`: 3 kMerlCells colours interleaved, 1/sr, by merl_index; what is negative or missing is repaired
  /// here.
  explicit MerlBrdf(std::vector<float> cells);

  using MeasuredBrdf::evaluate;
  vec3 evaluate(vec3 w_out, vec3 w_in) const override;
  void evaluate_with_pdf(vec3 w_out, vec3 w_in, vec3* f, float* density) const override;
  vec3 sample_direction(vec3 w_out, float u_lobe, vec2 u) const override;
  float pdf(vec3 w_out, vec3 w_in) const override;
  bool isotropic() const override { return true; }
  const char* format() const override { return "MERL"; }

  /// The sample of the cell that holds the directions, nothing interpolated: how the database's own reader
  /// looks up.
  vec3 nearest(vec3 w_out, vec3 w_in) const;
  /// One sample after repair, 1/sr.
  vec3 cell(int h, int d, int p) const;

  /// Light reflected of what arrives from one direction, per channel, about 1 % exact: the elevation that
  /// reflects most. Above 1 where the measurement claims so; nothing is scaled down.
  vec3 largest_albedo{0};
  float largest_albedo_degrees = 0;  ///< polar angle of that direction

  /// Cells whose centre has a direction below the horizon and that hold nothing: filled from the nearest
  /// theta_d above.
  size_t cells_below_horizon = 0;

 protected:
  void evaluate_many(vec3 w_out, int n, const vec3* w_in, vec3* f) const override;

 private:
  std::vector<float> cells_;  ///< and one float more: colours are read as four
  MerlSampler sampler_;

  void repair();
  vec3 interpolate(MerlPoint point) const;
};

/// Reads a MERL file whole. Throws SceneError naming the file, the field, what was found and what was
/// expected; header and exact size are checked before anything is allocated.
std::unique_ptr<MeasuredBrdf> load_merl(const std::string& file);

}  // namespace zonal
