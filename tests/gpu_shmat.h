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
inline float atan(float y, float x) {
  return std::atan2(y, x);
}
#define SHMAT_WORD(i) words[i]
#include "materials/sh_material.glsl"
}  // namespace zonal::gpu
