#pragma once
/// `vsl` on the GPU: the lights and the kernel (vsl.glsl) of its CPU twin, gathered by vsl.comp. Directions
/// come from the light's cone; sampling the point's BRDF is the CPU's alone.

#include "gl/twin.h"

namespace zonal::gl {

std::unique_ptr<Twin> make_vsl_twin(const ShaderText& text, Integrator& cpu, const Scene& scene);

}  // namespace zonal::gl
