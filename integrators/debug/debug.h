#pragma once
/// `normal`, `albedo`, `depth`: what the camera's rays met, as a picture. For finding mistakes in scenes.

#include "core/integrator.h"
#include "core/params.h"

namespace zonal {

struct DebugParams {
  void visit(ParamVisitor&) {}
};

enum class DebugQuantity { normal, albedo, depth };

class DebugIntegrator : public Integrator {
 public:
  explicit DebugIntegrator(DebugQuantity quantity) : quantity_(quantity) {}
  void begin_pass(const Pass& pass, const Stop&, PassStats&) override { radius_ = pass.scene.bounds().radius; }
  void shade(const Tile&, vec3* radiance, Sampler*, const Stop&, TileStats&) const override;

 private:
  DebugQuantity quantity_;
  float radius_ = 1;
};

}  // namespace zonal
