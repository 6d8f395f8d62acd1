#include "integrators/vsgl/vsgl_gl.h"

#include "gl/units.h"
#include "integrators/vsgl/vsgl.h"

namespace zonal::gl {
namespace {

class VsglTwin : public Twin {
 public:
  VsglTwin(const ShaderText& text, const VsglIntegrator& cpu)
      : cpu_(cpu),
        gather_(Program::compute(
            text, "integrators/vsgl/vsgl.comp",
            {cpu.params().generation == VsglGeneration::y2024 ? "GENERATION 2024" : "GENERATION 2015"})) {}

  void begin_pass(const Pass&, SceneBuffers&) override {
    std::vector<vec4> texels;
    for (const VsglBlock& block : cpu_.blocks()) {
      for (const VsglLobe& lobe : block) {
        if (is_black(lobe.flux)) continue;
        texels.emplace_back(lobe.position, lobe.variance);
        texels.emplace_back(lobe.flux, lobe.sharpness);
        texels.emplace_back(lobe.axis, lobe.coefficient);
      }
    }
    lights_ = LightBuffer(texels, kTexels);
    gather_.set("least_share", cpu_.least_share());
    gather_.set("least_variance", cpu_.least_variance());
  }
  void gather(const GBuffer& points, const Texture2D& sum) override {
    gather_lights(gather_, lights_, points, sum);
  }

 private:
  static constexpr int kTexels = 3;  ///< a lobe; vsgl.comp
  const VsglIntegrator& cpu_;
  Program gather_;
  LightBuffer lights_;
};

}  // namespace

std::unique_ptr<Twin> make_vsgl_twin(const ShaderText& text, Integrator& cpu, const Scene& scene) {
  const auto& vsgl = dynamic_cast<const VsglIntegrator&>(cpu);
  refuse_unsupported("vsgl", vsgl, scene);
  return std::make_unique<VsglTwin>(text, vsgl);
}

}  // namespace zonal::gl
