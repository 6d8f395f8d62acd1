#include "integrators/vpl/vpl_gl.h"

#include "integrators/vpl/vpl.h"

namespace zonal::gl {
namespace {

class VplTwin : public Twin {
 public:
  VplTwin(const ShaderText& text, const VplIntegrator& cpu)
      : cpu_(cpu), gather_(Program::compute(text, "integrators/vpl/vpl.comp")) {}

  void begin_pass(const Pass& pass, SceneBuffers& scene) override {
    const VplParams& params = cpu_.params();
    const Lobes lobes = params.emission == VplParams::Emission::brdf ? Lobes::all : Lobes::diffuse;
    lights_ = LightBuffer(cpu_.lights(), lobes, scene.coats());
    scene.upload_coats();
    gather_.set("shortest", params.clamp * pass.scene.bounds().radius);
    gather_.set("yuksel", params.attenuation == VplParams::Attenuation::yuksel ? 1 : 0);
  }
  void gather(const GBuffer& points, const Texture2D& sum) override {
    gather_lights(gather_, lights_, points, sum);
  }

 private:
  const VplIntegrator& cpu_;
  Program gather_;
  LightBuffer lights_;
};

}  // namespace

std::unique_ptr<Twin> make_vpl_twin(const ShaderText& text, Integrator& cpu, const Scene& scene) {
  const auto& vpl = dynamic_cast<const VplIntegrator&>(cpu);
  refuse_unsupported("vpl", vpl, scene);
  return std::make_unique<VplTwin>(text, vpl);
}

}  // namespace zonal::gl
