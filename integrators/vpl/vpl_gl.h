#pragma once
/// `vpl` on the GPU: the lights and the kernel (vpl.glsl) of its CPU twin, gathered by vpl.comp.

#include "gl/twin.h"

namespace zonal::gl {

std::unique_ptr<Twin> make_vpl_twin(const ShaderText& text, Integrator& cpu, const Scene& scene);

}  // namespace zonal::gl
