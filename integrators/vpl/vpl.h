#pragma once
/// `vpl`: instant radiosity (Keller 1997). Light paths leave virtual point lights where they meet surfaces;
/// every camera pixel gathers from all of them. Equations, parameters and failures: README.md beside this
/// file.

#include "integrators/many_lights.h"

namespace zonal {

struct VplParams : ManyLightsParams {
  enum class Emission { brdf, diffuse };
  enum class Attenuation { clamp, yuksel };

  Emission emission = Emission::brdf;
  Attenuation attenuation = Attenuation::clamp;
  float clamp = 0;

  void visit(ParamVisitor& v) {
    ManyLightsParams::visit(v, {.occlusions = 2, .skip = true});
    v.choice("emission", emission, {"brdf", "diffuse"},
             "brdf: a virtual light reflects by the whole BRDF of its surface; diffuse: by its diffuse part");
    v.choice("attenuation", attenuation, {"clamp", "yuksel"},
             "1/d^2 cut off at `clamp`, or Yuksel 2020 with it as radius");
    v.number("clamp", clamp, {0, 1}, "scene radii",
             "shortest distance used, as a share of the scene's bounding radius");
  }
};

class VplIntegrator : public ManyLights {
 public:
  explicit VplIntegrator(const VplParams& params) : ManyLights(params), params_(params) {}
  const VplParams& params() const { return params_; }

 protected:
  void prepare(const Pass&, const VirtualLightSet&, LightArrays&, const Stop&, PassStats&) override;
  std::unique_ptr<TileState> prepare_tile(const TilePoints&) const override;
  void gather(const TilePoints&, int first, int count, Contributions&) const override;
  void gather_sums(const TilePoints&, int first, int count, PointSums&) const override;
  bool horizons_hide() const override { return true; }
  float most(const TilePoints&, const TileBounds&, int light) const override;
  bool accounts() const override { return shortest_ > 0; }
  void account(const TilePoints&, int first, int count, const Contributions&, TileStats&) const override;

 private:
  /// Radiance that light `l` sends to the camera by way of each point.
  void gather_one(const TilePoints&, int l, float* r, float* g, float* b) const;

  VplParams params_;
  BsdfArrays emitters_;              ///< the lights' BRDFs, seen from where their flux came from
  std::vector<Reflection> largest_;  ///< bounds of the lights' f cos
  float shortest_ = 0;               ///< metres: `clamp` times the scene's radius
};

}  // namespace zonal
