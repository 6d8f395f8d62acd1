#pragma once
/// `vpl`: instant radiosity (Keller 1997). Light paths leave virtual point lights where they meet surfaces; every
/// camera pixel gathers from all of them. Equations, parameters and failures: README.md beside this file.

#include "core/integrator.h"
#include "core/params.h"
#include "lights/virtual_lights.h"

namespace zonal {

struct VplParams {
  enum class Distribution { grid, paths };
  enum class Direct { sampled, none };
  enum class Occlusion { center, none };
  enum class Emission { brdf, diffuse };
  enum class Attenuation { clamp, yuksel };

  int lights = 400, bounces = 1;
  int pass_lights = 0;
  Distribution distribution = Distribution::grid;
  Direct direct = Direct::sampled;
  int direct_samples = 1;
  Occlusion occlusion = Occlusion::center;
  Emission emission = Emission::brdf;
  Attenuation attenuation = Attenuation::clamp;
  float clamp = 0;

  void visit(ParamVisitor& v) {
    v.integer("lights", lights, {1, 1e8}, "lights",
              "virtual lights stored in all, after all bounces, shared among primaries by power");
    v.integer("bounces", bounces, {1, 1000}, "bounces", "generations of virtual lights; direct light is bounce 0");
    v.integer("pass_lights", pass_lights, {0, 1e8}, "lights",
              "virtual lights of one pass; 0: all of `lights`, or, with --time, what a tenth of the time can gather");
    v.choice("distribution", distribution, {"grid", "paths"},
             "grid: over a reflective shadow map of spot, point and directional lights, by paths from the others; "
             "paths: low-discrepancy light paths from all");
    v.choice("direct", direct, {"sampled", "none"}, "who renders direct light");
    v.integer("direct_samples", direct_samples, {1, 4096}, "pairs of rays", "per pixel and pass, for direct light");
    v.choice("occlusion", occlusion, {"center", "none"}, "center: a shadow ray from each pixel to each virtual light");
    v.choice("emission", emission, {"brdf", "diffuse"},
             "brdf: a virtual light reflects by the whole BRDF of its surface; diffuse: by its diffuse part");
    v.choice("attenuation", attenuation, {"clamp", "yuksel"}, "1/d^2 cut off at `clamp`, or Yuksel 2020 with it as radius");
    v.number("clamp", clamp, {0, 1}, "scene radii", "shortest distance used, as a share of the scene's bounding radius");
  }
};

class VplIntegrator : public Integrator {
 public:
  explicit VplIntegrator(const VplParams& params) : params_(params) {}
  void begin_pass(const Pass&, const Stop&, PassStats&) override;
  void shade(const Tile&, vec3* radiance, Sampler*, const Stop&, TileStats&) const override;

 private:
  void trace_lights(const Pass&, int count, const Stop&, PassStats*);
  int lights_that_fit(const Pass&, const Stop&);
  double seconds_a_pass(const Pass&, const Stop&) const;

  VplParams params_;
  const Scene* scene_ = nullptr;
  float shortest_ = 0;    ///< metres: `clamp` times the scene's radius
  int pass_lights_ = 0;
  VirtualLightSet set_;
};

}  // namespace zonal
