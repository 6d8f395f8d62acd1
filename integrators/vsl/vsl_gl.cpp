#include "integrators/vsl/vsl_gl.h"

#include "gl/units.h"
#include "integrators/vsl/vsl.h"

namespace zonal::gl {
namespace {

class VslTwin : public Twin {
 public:
  VslTwin(const ShaderText& text, const VslIntegrator& cpu)
      : cpu_(cpu), gather_(Program::compute(text, "integrators/vsl/vsl.comp")) {
    const std::vector<vec3> directions = cpu.lattice();
    std::vector<vec4> texels;
    for (const vec3& d : directions) texels.emplace_back(d, 0.0f);
    lattice_ = TextureBuffer(std::span<const vec4>(texels));
    gather_.set("samples", static_cast<int>(directions.size()));
  }

  void begin_pass(const Pass&, SceneBuffers& scene) override {
    lights_ = LightBuffer(cpu_.lights(), Lobes::all, scene.coats());
    scene.upload_coats();
    gather_.set("pass_key", cpu_.pass_key());
  }
  void gather(const GBuffer& points, const Texture2D& sum) override {
    lattice_.bind(units::kMethod);
    gather_lights(gather_, lights_, points, sum);
  }

 private:
  const VslIntegrator& cpu_;
  Program gather_;
  TextureBuffer lattice_;
  LightBuffer lights_;
};

}  // namespace

std::unique_ptr<Twin> make_vsl_twin(const ShaderText& text, Integrator& cpu, const Scene& scene) {
  const auto& vsl = dynamic_cast<const VslIntegrator&>(cpu);
  refuse_unsupported("vsl", vsl, scene);
  if (vsl.params().sampling != VslParams::Sampling::cone)
    refuse("vsl", "sampling", vsl.params().sampling == VslParams::Sampling::brdf ? "brdf" : "mis",
           "\"cone\"");
  return std::make_unique<VslTwin>(text, vsl);
}

}  // namespace zonal::gl
