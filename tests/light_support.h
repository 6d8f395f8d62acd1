#pragma once
/// What the tests of lights share: random numbers, means with their errors, and lights to try.

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "core/sampling.h"
#include "lights/light.h"

namespace zonal::test {

inline std::mt19937 random_bits(1);
inline vec2 random_pair() {
  const float x = unit_float(random_bits());
  return {x, unit_float(random_bits())};
}

struct Mean {
  double value = 0, error = 0;  ///< and its standard error
};
inline Mean mean_of(int n, const std::function<double()>& draw) {
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double x = draw();
    sum += x, squares += x * x;
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

/// Five standard errors (chance exceeds them once in 1.7 million) and some ten roundings of float.
#define EXPECT_MEAN(estimate, truth)                                                           \
  do {                                                                                         \
    const Mean m = estimate;                                                                   \
    const double t = truth;                                                                    \
    EXPECT_NEAR(m.value, t, 5 * m.error + 2e-6 * std::abs(t)) << "standard error " << m.error; \
  } while (false)

inline SphereLight ball(vec3 center, float radius, bool two_sided = false) {
  SphereLight light;
  light.center = center, light.radius = radius, light.emission = vec3(1, 2, 3), light.two_sided = two_sided;
  return light;
}

/// The parallelogram corner + s u + t v, facing cross(u, v).
inline MeshLight quad(vec3 corner, vec3 u, vec3 v, bool two_sided = false) {
  return MeshLight({{corner, corner + u, corner + u + v}, {corner, corner + u + v, corner + v}},
                   vec3(1, 2, 3), two_sided);
}

/// A sky with a sun 1e5 times brighter than the rest, and black parts.
inline EnvironmentLight sunny_sky(float rotation) {
  std::vector<vec3> texels;
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 32; ++column)
      texels.push_back(row == 3 && column == 7 ? vec3(1e5f)
                                               : vec3(row > 12 ? 0.0f : 0.1f + 0.01f * float(column)));
  return EnvironmentLight(32, 16, texels, rotation);
}

}  // namespace zonal::test
