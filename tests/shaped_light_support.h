#pragma once
/// Lights that remember their shape, for tests that integrate them.

#include "lights/shaped_lights.h"

namespace zonal::test {

/// The parallelogram corner + s u + t v, facing cross(u, v).
inline TriangleLight shaped_quad(vec3 corner, vec3 u, vec3 v, bool two_sided = false) {
  return TriangleLight({{corner, corner + u, corner + u + v}, {corner, corner + u + v, corner + v}},
                       vec3(1, 2, 3), two_sided);
}

/// A picture of 5 x 3 texels, one of them 100 times brighter than the rest, one black.
inline TexturedLight bright_panel(vec3 corner, vec3 u, vec3 v, bool two_sided = false) {
  std::vector<vec3> texels;
  for (int i = 0; i < 15; ++i)
    texels.push_back(vec3(1, 2, 3) * (i == 7 ? 0.0f : i == 3 ? 100.0f : 0.3f + 0.1f * float(i)));
  return {corner, u, v, 5, 3, std::move(texels), two_sided};
}

/// The same as one quad a texel.
inline std::vector<TriangleLight> texels_of(const TexturedLight& light) {
  std::vector<TriangleLight> quads;
  const vec3 right = light.u / float(light.width), up = light.v / float(light.height);
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x) {
      const vec3 a = light.corner + right * float(x) + up * float(light.height - 1 - y);
      quads.emplace_back(
          std::vector<MeshLight::Triangle>{{a, a + right, a + right + up}, {a, a + right + up, a + up}},
          light.texels[size_t(y * light.width + x)], light.two_sided);
    }
  return quads;
}

}  // namespace zonal::test
