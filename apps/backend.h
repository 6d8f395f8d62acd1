#pragma once
/// Who shades: the CPU, or the GPU where this build has that side.
///
///     const auto backend = make_backend(options.backend);       // throws SceneError: unknown, or not in
///     this build RenderReport report = backend->render(scene, *integrator, "vpl", film, budget, options,
///     on_pass, on_progress);

#include <memory>
#include <string>

#include "core/render.h"

namespace zonal {

class Backend {
 public:
  virtual ~Backend() = default;
  /// As zonal::render; `method` is the integrator's name. Throws SceneError where the backend lacks the
  /// method or a setting.
  virtual RenderReport render(const Scene& scene, Integrator& integrator, const std::string& method,
                              Film& film, const Budget& budget, const RenderOptions& options,
                              const std::function<void(const Film&, double seconds)>& on_pass,
                              const std::function<void(const Progress&)>& on_progress) = 0;
  /// A GPU draws each render's first pass once before its clock starts: drivers compile late.
  bool warm_up = false;
  /// The GPU's name; empty on the CPU.
  virtual std::string gpu() const { return ""; }
};

std::unique_ptr<Backend> make_backend(const std::string& name);

}  // namespace zonal
