#pragma once
/// `path`: the reference. Unidirectional path tracing with next-event estimation, MIS and Russian roulette; unbiased.
/// Equations and parameters: README.md beside this file.

#include "core/integrator.h"
#include "core/params.h"

namespace zonal {

struct PathParams {
  enum class Occlusion { full, none };

  int min_bounces = 0, max_bounces = 1000;
  int roulette_after = 3;
  Occlusion occlusion = Occlusion::full, direct_occlusion = Occlusion::full;

  void visit(ParamVisitor& v) {
    v.integer("min_bounces", min_bounces, {0, 1e6}, "bounces",
              "fewest bounces counted; direct light is bounce 0, and emitters seen directly belong to it");
    v.integer("max_bounces", max_bounces, {0, 1e6}, "bounces", "most bounces followed");
    v.integer("roulette_after", roulette_after, {0, 1e6}, "bounces", "bounces before Russian roulette may end a path");
    v.choice("occlusion", occlusion, {"full", "none"},
             "none: nothing blocks indirect light on the segment that reaches the camera's surface");
    v.choice("direct_occlusion", direct_occlusion, {"full", "none"},
             "none: nothing blocks direct light on its way to the camera's surface");
  }
};

class PathIntegrator : public Integrator {
 public:
  explicit PathIntegrator(const PathParams& params) : params_(params) {}
  void begin_pass(const Pass&, const Stop&, PassStats&) override;
  void shade(const Tile&, vec3* radiance, Sampler*, const Stop&, TileStats&) const override;

 private:
  struct Wave;
  vec3 seen_directly(const Tile&, int i) const;
  vec3 first_segment_unoccluded(const Surface&, const Bsdf&, Sampler&, TileStats&, Wave*, int pixel) const;
  void follow(Wave& wave, int bounce, vec3* radiance, Sampler*, const Stop&, TileStats&) const;
  int scatter(Wave& wave, int bounce, vec3* radiance, Sampler*, TileStats&) const;

  PathParams params_;
  const Scene* scene_ = nullptr;  ///< of the current pass
  bool hittable_lights_ = true;
};

}  // namespace zonal
