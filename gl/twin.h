#pragma once
/// A method's driver on the GPU. It is made from its CPU twin and gathers from the very lights that one has
/// traced.
///
///     auto twin = make_twin("vpl", text, *integrator, scene);    // throws SceneError: what has no twin, and
///     what has integrator->begin_pass(pass, stop, stats); twin->begin_pass(pass, buffers);
///     twin->gather(points, sum);

#include <memory>
#include <string>
#include <vector>

#include "core/integrator.h"
#include "gl/gbuffer.h"
#include "gl/light_buffer.h"

namespace zonal {
class ManyLights;
}

namespace zonal::gl {

class Twin {
 public:
  virtual ~Twin() = default;
  /// Takes over what the CPU twin has prepared for this pass.
  virtual void begin_pass(const Pass& pass, SceneBuffers& scene) = 0;
  /// Adds to `sum`, for each pixel, the radiance (W m^-2 sr^-1) its point reflects of the method's lights. It
  /// may be below 0 where a method is band-limited: what counts is the larger of it and 0.
  virtual void gather(const GBuffer& points, const Texture2D& sum) = 0;
};

/// Goes through the chunks of a light buffer, `batch` lights a dispatch, so that no single one takes long.
void gather_lights(const Program& program, const LightBuffer& lights, const GBuffer& points,
                   const Texture2D& sum, int batch = 4096);

/// Names of the methods that have a twin.
const std::vector<std::string>& twin_names();
/// Throws SceneError where the method, one of its settings or a material of the scene has no twin.
std::unique_ptr<Twin> make_twin(const std::string& method, const ShaderText& text, Integrator& cpu,
                                const Scene& scene);

/// Whether the method leaves direct light to DirectLight; and whether its pictures show what glows.
bool samples_direct(const Integrator& cpu);
bool shows_glow(const Integrator& cpu);

/// For twins: throws SceneError saying that `key` is `found` and what the GPU side has instead.
[[noreturn]] void refuse(const std::string& method, const std::string& key, const std::string& found,
                         const std::string& expected);
/// What every many-light twin asks for: no occlusion of virtual lights and, unless it has them, no measured
/// material.
void refuse_unsupported(const std::string& method, const ManyLights& cpu, const Scene& scene,
                        bool measured = false);

}  // namespace zonal::gl
