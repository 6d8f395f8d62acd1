#pragma once
/// The shader's reader of .shmat bytes, compiled as C++: set `gpu::words` to a buffer, then call it.

#include <cmath>
#include <cstdint>
#include <glm/gtc/packing.hpp>

#include "core/glsl.h"
#include "core/vec.h"

namespace zonal::gpu {
// The buffer a shader would read.
inline const uint32_t* words = nullptr;
using glm::uintBitsToFloat;
using glm::unpackHalf2x16;
#define SHMAT_WORD(i) words[i]
// clang-format off
#include "sh/angle.glsl"
#include "materials/sh_material.glsl"
// clang-format on
}  // namespace zonal::gpu
