#pragma once
/// Lets C++ include a kernel written in the common subset of GLSL and C++ (docs/conventions.md):
///
///     namespace zonal {
///     #include "integrators/vpl/vpl.glsl"
///     }
///
/// The subset: `0.5f` literals, OUT(type) for out-parameters, arrays inside structs, constructors rather than swizzles,
/// no main, no resources.

#include <cmath>

#include "core/vec.h"

#define OUT(type) type&
#define INOUT(type) type&
#define KERNEL inline

namespace zonal {
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::length;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::reflect;
using std::abs;
using std::exp;
using std::log;
using std::pow;
using std::sqrt;
}  // namespace zonal
