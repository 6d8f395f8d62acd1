#pragma once
/// Lights that remember their shape, for tests that integrate them.

#include "lights/shaped_lights.h"

namespace zonal::test {

/// The parallelogram corner + s u + t v, facing cross(u, v).
inline TriangleLight shaped_quad(vec3 corner, vec3 u, vec3 v, bool two_sided = false) {
  return TriangleLight({{corner, corner + u, corner + u + v}, {corner, corner + u + v, corner + v}},
                       vec3(1, 2, 3), two_sided);
}

}  // namespace zonal::test
