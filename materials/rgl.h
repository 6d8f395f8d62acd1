#pragma once
/// BRDFs of the RGL database (Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient Material
/// Acquisition and Rendering"): .bsdf files with colours, isotropic or not.
///
///     std::unique_ptr<MeasuredBrdf> paper = load_rgl("paper_white_rgb.bsdf");
///
/// The camera's direction w_out chooses the slices of the data. The half vector m of w_out and w_in, as a
/// point of the unit square, is sent through the inverse of the density of visible normals; the colour C
/// found there gives
///
///     f = C D(m) / (4 sigma(w_out)) / max(cos w_in, cos 89.5 degrees) (RGL-1)
///
/// since the data hold f times the cosine of w_in. docs/materials.md has the energy that the maximum costs.

#include <memory>
#include <vector>

#include "materials/measured_brdf.h"
#include "materials/rgl_warp.h"
#include "materials/tensor_file.h"

namespace zonal {

class RglBrdf final : public MeasuredBrdf {
 public:
  /// Share of directions that `sample_direction` draws by the cosine alone, so that the density is nowhere 0:
  /// the data's own densities have zeros where interpolated colours have none.
  static constexpr float kCosineShare = 0.1f;
  /// Of w_in: cos 89.5 degrees.
  static constexpr float kSmallestCosine = 0.008726535f;

  /// Throws SceneError naming file, field, found and expected.
  explicit RglBrdf(const TensorFile& tensors);

  using MeasuredBrdf::evaluate;
  vec3 evaluate(vec3 w_out, vec3 w_in) const override;
  vec3 sample_direction(vec3 w_out, float u_lobe, vec2 u) const override;
  float pdf(vec3 w_out, vec3 w_in) const override;
  void evaluate_with_pdf(vec3 w_out, vec3 w_in, vec3* f, float* density) const override;
  bool isotropic() const override { return isotropic_; }
  const char* format() const override { return "RGL"; }

 protected:
  void evaluate_many(vec3 w_out, int n, const vec3* w_in, vec3* f) const override;

 private:
  /// Numbers at the vertices of a grid on the unit square.
  struct Grid {
    int width = 0, height = 0;
    std::vector<float> values;
    float at(vec2 p) const;
  };
  /// What can be found in the data at a half vector.
  struct Tables {
    WarpGrid normals;  ///< density of visible normals: from half vectors to places of the colours
    std::vector<vec4>
        colors;  ///< slices of side x side: red, green, blue, and the density that colours are drawn with
  };
  struct View;   ///< what depends on w_out alone
  struct Place;  ///< a half vector in the data

  bool isotropic_ = true;
  int side_ = 0;  ///< of a slice of colours
  int reduction_ =
      1;  ///< 2, 4: the data cover a half, a quarter of the azimuths, the rest is their mirror image
  std::vector<float> theta_, phi_;  ///< of the slices: elevation and azimuth of w_out, radians, ascending
  vec2 middle_{0};      ///< reduction 2, 4: cosine and sine of the azimuth in the middle of the data
  bool scaled_ = true;  ///< colours still lack the factor D / (4 sigma)
  Grid ndf_, sigma_;
  Tables tables_;
  WarpGrid luminance_;  ///< what directions are drawn with

  View view(vec3 w_out) const;
  Place place(const View& view, vec3 half) const;
  vec4 color(const Tables& tables, const SliceMix& mix, vec2 s) const;
  vec3 value(const View& view, const Place& place, vec4 color, float cosine) const;
  float density(const Place& place, float normals, float colors) const;
};

std::unique_ptr<MeasuredBrdf> load_rgl(const std::string& file);

}  // namespace zonal
