#include "integrators/hvl/hvl_gl.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "gl/sh_tables.h"
#include "gl/units.h"
#include "integrators/hvl/hvl.h"
#include "sh/clamped_cosine.h"

namespace zonal::gl {
namespace {

constexpr int kMostBands = 10;  ///< SH_MAX_BANDS of sh/basis.glsl
constexpr int kAutomaticZonalBands = 20;

class HvlTwin : public Twin {
 public:
  HvlTwin(const ShaderText& text, const HvlIntegrator& cpu, const Scene& scene) : cpu_(cpu), text_(text) {
    const HvlParams& params = cpu.params();
    zonal_ = params.product == HvlParams::Product::zonal;
    by_sh_ = params.emission == HvlParams::Emission::sh;
    bands_ = params.bands == kAuto ? kAutomaticZonalBands : params.bands;
    materials_ = static_cast<uint32_t>(scene.materials().size());
  }

  void begin_pass(const Pass&, SceneBuffers& scene) override {
    lights_ = LightBuffer(cpu_.lights(), Lobes::all, scene.coats());
    scene.upload_coats();
    if (by_sh_) upload_emission();
    // Materials are projected by now.
    if (gather_.id() == 0) prepare();
    gather_.set("soft_edge", cpu_.params().soft_edge);
  }

  void gather(const GBuffer& points, const Texture2D& sum) override {
    if (!zonal_) receive(points);
    if (by_sh_) emission_.bind(units::kMethod);
    if (zonal_)
      lobes_.bind(units::kMethod + 1);
    else
      receivers_.bind(units::kMethod + 1);
    gather_lights(gather_, lights_, points, sum, 1024);
  }

 private:
  /// Fills the layers that the gathering pass reads.
  void receive(const GBuffer& points) {
    if (receivers_.width() != points.width() || receivers_.height() != points.height())
      receivers_ = Texture2D(GL_RGBA32F, points.width(), points.height(), bands_ * bands_);
    receive_.use();
    receive_.set("size", ivec2(points.width(), points.height()));
    receive_.set("bands", bands_);
    tables_.bind(units::kMethod + 2, units::kMethod + 3);
    points.bind();
    receivers_.bind_image(2);
    glDispatchCompute((points.width() + 7) / 8, (points.height() + 7) / 8, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  }

  /// (HVL-2): six texels a light with three bands: its view frame lies in the light's own texels.
  void upload_emission() {
    const int bands = cpu_.emission_bands();
    std::vector<vec4> texels;
    for (int j = 0; j < cpu_.lights().count; ++j) {
      const HvlIntegrator::ShEmission e = cpu_.sh_emission(j);
      for (const vec3 axis : {e.x, e.y, e.z}) texels.emplace_back(axis, 0.0f);
      for (const vec3 c : e.coefficients) texels.emplace_back(c, 0.0f);
    }
    emission_ = TextureBuffer(std::span<const vec4>(texels));
    if (bands != emission_bands_) gather_ = Program();  // made anew for this number
    emission_bands_ = bands;
  }

  void prepare() {
    bool mirrored = true;
    if (!zonal_)
      for (uint32_t m = 0; m < materials_; ++m) mirrored = mirrored && cpu_.materials().mirrored(m);
    gather_ = Program::compute(text_, "integrators/hvl/hvl.comp",
                               {zonal_ ? "ZONAL 1" : "ZONAL 0", fmt::format("BANDS {}", bands_),
                                fmt::format("MIRRORED {}", mirrored ? 1 : 0),
                                fmt::format("EMISSION_BANDS {}", by_sh_ ? emission_bands_ : 0)});
    std::vector<float> window(static_cast<size_t>(bands_));
    cpu_.window(bands_, window.data());
    if (zonal_) {
      gather_.set("window", std::span<const float>(window));
      lobes_ = zonal_lobe_texels();
      return;
    }
    tables_ = ShTables(cpu_.materials(), materials_);
    float cosine[kMostBands];
    sh::clamped_cosine_zonal(kMostBands, cosine);
    for (float& c : cosine) c *= kInvPi;
    receive_ = Program::compute(text_, "integrators/hvl/receive.comp");
    receive_.set("window", std::span<const float>(window));
    receive_.set("lambert_zonal", std::span<const float>(cosine));
  }

  const HvlIntegrator& cpu_;
  ShaderText text_;
  Program gather_, receive_;
  LightBuffer lights_;
  ShTables tables_;
  TextureBuffer emission_, lobes_;
  Texture2D receivers_;
  bool zonal_, by_sh_;
  int bands_, emission_bands_ = 0;
  uint32_t materials_ = 0;
};

}  // namespace

std::unique_ptr<Twin> make_hvl_twin(const ShaderText& text, Integrator& cpu, const Scene& scene) {
  const auto& hvl = dynamic_cast<const HvlIntegrator&>(cpu);
  const HvlParams& params = hvl.params();
  const bool zonal = params.product == HvlParams::Product::zonal,
             by_sh = params.emission == HvlParams::Emission::sh;
  // Full spherical harmonics take measured materials by their tables.
  refuse_unsupported("hvl", hvl, scene, !zonal && by_sh);
  const auto check = [&](const char* key, int bands) {
    if (bands == kAuto || bands > kMostBands)
      refuse("hvl", key, bands == kAuto ? "auto" : fmt::format("{}", bands),
             fmt::format("1 to {}", kMostBands));
  };
  if (!zonal) check("bands", params.bands);
  if (zonal && params.soft_edge > 0)
    refuse("hvl", "soft_edge", fmt::format("{}", params.soft_edge), "0 with product zonal");
  if (by_sh) check("emission_bands", params.emission_bands);
  return std::make_unique<HvlTwin>(text, hvl, scene);
}

}  // namespace zonal::gl
