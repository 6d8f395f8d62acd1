#pragma once
/// `sh_direct` on the GPU: the lights, the projected materials and the windows of its CPU twin, and its
/// kernels (sh_direct.glsl). At pixels, or on a grid that a compute pass fills, by point or by point and
/// order. Up to 10 bands.

#include "gl/twin.h"

namespace zonal::gl {

std::unique_ptr<Twin> make_sh_direct_twin(const ShaderText& text, Integrator& cpu, const Scene& scene);

}  // namespace zonal::gl
