#pragma once
/// `vsgl` on the GPU: the blocks and the kernels (spherical_gaussian.glsl, vsgl.glsl) of its CPU twin,
/// gathered by vsgl.comp.

#include "gl/twin.h"

namespace zonal::gl {

std::unique_ptr<Twin> make_vsgl_twin(const ShaderText& text, Integrator& cpu, const Scene& scene);

}  // namespace zonal::gl
