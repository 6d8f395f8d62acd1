#pragma once
/// `hvl` on the GPU: the lights, the projected materials and the kernels (hvl.glsl,
/// materials/zonal_lobes.glsl) of its CPU twin, gathered by hvl.comp. Up to 10 bands of full spherical
/// harmonics, 64 of a zonal lobe.

#include "gl/twin.h"

namespace zonal::gl {

std::unique_ptr<Twin> make_hvl_twin(const ShaderText& text, Integrator& cpu, const Scene& scene);

}  // namespace zonal::gl
