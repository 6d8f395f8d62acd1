#pragma once
/// `vsgl`: virtual spherical Gaussian lights (Tokuyoshi 2015). A block of a reflective shadow map becomes two
/// lights with a size and a lobe, and every camera pixel integrates all of them against its BRDF in closed
/// form: no spots in corners, no highlight a light. Equations, parameters and failures: README.md beside this
/// file.

#include "integrators/many_lights.h"
#include "integrators/vsgl/vsgl_blocks.h"

namespace zonal {

struct VsglParams : ManyLightsParams {
  VsglGeneration generation = VsglGeneration::y2024;

  VsglParams() { block_texels = 14; }  // Mézières 2022, section 5.2.8
  void visit(ParamVisitor& v) {
    ManyLightsParams::visit(v, {.occlusions = 2, .split = false});
    v.choice("generation", generation, {"2015", "2024"},
             "2015: the lobes that Mézières 2022 compares with; 2024: those of the public code since then");
  }
};

class VsglIntegrator : public ManyLights {
 public:
  /// Throws SceneError for `distribution: paths`, which leaves no blocks.
  explicit VsglIntegrator(const VsglParams& params);

  /// Of the current pass, one a light of light_set().
  const std::vector<VsglBlock>& blocks() const { return blocks_; }
  const VsglParams& params() const { return params_; }
  /// Bounds from below of vsgl_radiance: variance over squared distance, and variance (m^2).
  float least_share() const;
  float least_variance() const { return least_variance_; }

 protected:
  void adjust(VirtualLightOptions& options) const override { options.keep_texels = true; }
  /// Throws SceneError where the scene has a measured material: its BRDF has no lobe to fit.
  void prepare(const Pass&, const VirtualLightSet&, LightArrays&, const Stop&, PassStats&) override;
  std::unique_ptr<TileState> prepare_tile(const TilePoints&) const override;
  void gather(const TilePoints&, int first, int count, Contributions&) const override;
  bool gather_traces() const override { return true; }

 private:
  VsglParams params_;
  std::vector<VsglBlock> blocks_;
  float least_variance_ = 0;  ///< m^2: nothing is smaller than a millionth of the scene
};

}  // namespace zonal
