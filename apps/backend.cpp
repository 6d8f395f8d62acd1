#include "apps/backend.h"

#include "core/backend.h"
#ifdef ZONAL_HAS_GL
#include "gl/render.h"
#endif

namespace zonal {
namespace {

class CpuBackend : public Backend {
 public:
  RenderReport render(const Scene& scene, Integrator& integrator, const std::string&, Film& film,
                      const Budget& budget, const RenderOptions& options,
                      const std::function<void(const Film&, double)>& on_pass,
                      const std::function<void(const Progress&)>& on_progress) override {
    return zonal::render(scene, integrator, film, budget, options, on_pass, on_progress);
  }
};

#ifdef ZONAL_HAS_GL
class GlBackend : public Backend {
 public:
  RenderReport render(const Scene& scene, Integrator& integrator, const std::string& method, Film& film,
                      const Budget& budget, const RenderOptions& options,
                      const std::function<void(const Film&, double)>& on_pass,
                      const std::function<void(const Progress&)>& on_progress) override {
    return gl::render(*context_, gl::ShaderText(), scene, integrator, method, film, budget, options, on_pass,
                      on_progress, warm_up);
  }
  std::string gpu() const override { return context_->info().renderer; }

 private:
  std::unique_ptr<gl::Context> context_ = gl::Context::headless();
};
#endif

}  // namespace

std::unique_ptr<Backend> make_backend(const std::string& name) {
  check_backend(name, "--backend");
#ifdef ZONAL_HAS_GL
  if (name == "gl") return std::make_unique<GlBackend>();
#endif
  return std::make_unique<CpuBackend>();
}

}  // namespace zonal
