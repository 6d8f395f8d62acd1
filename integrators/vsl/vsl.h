#pragma once
/// `vsl`: virtual spherical lights (Hasan, Krivanek, Walter and Bala 2009). A virtual light's flux is spread
/// over a sphere, and both BRDFs are integrated over the cone it is seen in: no 1/d^2, no spikes, some noise.
/// Equations, parameters and failures: README.md beside this file.

#include "integrators/many_lights.h"
#include "lights/virtual_light_radius.h"

namespace zonal {

struct VslParams : ManyLightsParams {
  enum class Sampling { cone, brdf, mis };

  int samples = 16;
  Sampling sampling = Sampling::cone;
  RadiusParams radius;
  /// Emission and the light's cosine taken at the direction to its centre, as hvl does: for tests, in C++
  /// alone.
  bool frozen = false;

  void visit(ParamVisitor& v) {
    ManyLightsParams::visit(v, {.occlusions = 3, .skip = true});
    v.integer("samples", samples, {1, 4096}, "samples", "directions a point and light");
    v.choice("sampling", sampling, {"cone", "brdf", "mis"},
             "directions drawn from the light's cone, from the point's BRDF, or half of each by the balance "
             "heuristic");
    radius.visit(v);
  }
};

class VslIntegrator : public ManyLights {
 public:
  explicit VslIntegrator(const VslParams& params);
  const VslParams& params() const { return params_; }
  /// Of the cone's directions: u, and the cosine and sine of the turn (lattice_u_ and so on).
  std::vector<vec3> lattice() const;

 protected:
  void prepare(const Pass&, const VirtualLightSet&, LightArrays&, const Stop&, PassStats&) override;
  std::unique_ptr<TileState> prepare_tile(const TilePoints&) const override;
  void gather(const TilePoints&, int first, int count, Contributions&) const override;

  bool gather_traces() const override { return true; }
  bool horizons_hide() const override { return true; }
  float most(const TilePoints&, const TileBounds&, int light) const override;

 private:
  struct OneLight;
  /// Adds the light's samples for the points [begin, end), multiples of 8.
  void sum_samples(OneLight&, int begin, int end) const;
  /// The same from the cone's samples alone, where light and points are matt. `sent`: the light's BRDF times
  /// its power.
  void sum_cosines(OneLight&, int begin, int end, vec3 sent) const;
  int cone_samples() const;
  int brdf_samples() const { return params_.samples - cone_samples(); }

  VslParams params_;
  BsdfArrays emitters_;              ///< the lights' BRDFs, seen from where their flux came from
  std::vector<Reflection> largest_;  ///< bounds of the lights' f cos
  /// Directions of the cone before each pair's own turn and shift: a lattice over the unit square.
  std::vector<float> lattice_u_, lattice_c_, lattice_s_;
};

}  // namespace zonal
