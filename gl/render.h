#pragma once
/// The pass loop on the GPU: what core/render.h does with the CPU twin's `shade`, done with a Twin. Passes
/// take a common place inside all pixels, where the CPU jitters each one for itself.
///
///     auto context = gl::Context::headless();
///     RenderReport report = gl::render(*context, ShaderText(), scene, *integrator, "vpl", film, {.passes =
///     1}, {});

#include "core/render.h"
#include "gl/context.h"
#include "gl/shader_text.h"

namespace zonal::gl {

/// As zonal::render. report.pass.numbers holds gpu_points_seconds, gpu_gather_seconds and, with direct light,
/// gpu_direct_seconds, of all passes:
/// timer queries, or a finished queue's wall clock where those mean nothing; uploads and reading back are in
/// neither. `warm_up`: the first pass is drawn once before the clock starts, for drivers that compile late.
RenderReport render(const Context& context, const ShaderText& text, const Scene& scene, Integrator& cpu,
                    const std::string& method, Film& film, const Budget& budget, const RenderOptions& options,
                    const std::function<void(const Film&, double seconds)>& on_pass = {},
                    const std::function<void(const Progress&)>& on_progress = {}, bool warm_up = false);

}  // namespace zonal::gl
