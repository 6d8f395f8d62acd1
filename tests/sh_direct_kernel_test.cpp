// The kernels that shaders share with C++ (sh_direct.glsl) against what the CPU shades by.
#include <gtest/gtest.h>

#include <random>

#include "core/glsl.h"
#include "integrators/sh_direct/sh_cell.h"
#include "sh/light_batch.h"
#include "sh/simple_light_batch.h"
#include "sh/triangle_spheres.h"

namespace zonal {
namespace kernel {
// Each needs those before it.
// clang-format off
#include "sh/basis.glsl"
#include "sh/sphere_light.glsl"
#include "integrators/sh_direct/sh_direct.glsl"
// clang-format on
}  // namespace kernel
namespace {

using namespace kernel;

vec3 random_vector(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1, 1);
  return {unit(random), unit(random), unit(random)};
}

TEST(ShDirectKernels, cells_weigh_as_the_grid_does) {
  std::mt19937 random(1);
  using Interpolation = ShScheme::Interpolation;
  using Mixed = ShScheme::Mixed;
  for (const ShScheme scheme :
       {ShScheme{Interpolation::linear}, ShScheme{Interpolation::taylor},
        ShScheme{Interpolation::hermite, Mixed::zero}, ShScheme{Interpolation::hermite, Mixed::differences}})
    for (int k = 0; k < 100; ++k) {
      const vec3 t = 0.5f + 0.5f * random_vector(random), size = vec3(0.6f) + 0.4f * random_vector(random);
      ShdCell cell;
      if (scheme.interpolation == Interpolation::hermite)
        shd_hermite_cell(scheme.mixed == Mixed::differences ? 1 : 0, t, size, cell);
      else
        shd_linear_cell(scheme.interpolation == Interpolation::taylor ? 1 : 0, t, size, cell);
      const CellWeights expected = cell_weights(scheme, t, size);
      for (int corner = 0; corner < 8; ++corner)
        for (int part = 0; part < 4; ++part)
          // Weights are of order 1: sums of up to ten products, a rounding each.
          ASSERT_NEAR(cell.w[4 * corner + part], expected[corner][part], 2e-6f) << corner << " " << part;
    }
}

/// A light's coefficients and their slopes, from what it sends.
struct Sum {
  float value[25], slope[3][25];
  explicit Sum(const ShdSent& s) {
    ShCoefficients Y;
    ShGradient turn;
    sh_evaluate_gradient(5, s.w, Y, turn);
    CapBand band = cap_first(s.cap);
    for (int l = 0; l < 5; ++l) {
      if (l > 0) band = cap_next(s.cap, band, l);
      const float gain = s.dirac == 1 ? 1.0f : band.gain;
      const vec3 up = s.slope * gain - s.w * (s.dirac == 1 ? 0.0f : s.weight * band.slope * s.cap.dt);
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
        value[i] = s.weight * gain * Y.c[i];
        const vec3 g = up * Y.c[i] - turn.g[i] * (s.weight * gain * s.inverse_d);
        for (int axis = 0; axis < 3; ++axis) slope[axis][i] = g[axis];
      }
    }
  }
};

/// The largest difference, against the largest number.
double off(const Sum& found, const float* value, const float* slope) {
  double worst = 0, most = 0, worst_slope = 0, most_slope = 0;
  for (int i = 0; i < 25; ++i) {
    worst = std::fmax(worst, std::fabs(double(found.value[i]) - value[i]));
    most = std::fmax(most, std::fabs(double(value[i])));
    for (int axis = 0; axis < 3; ++axis) {
      worst_slope = std::fmax(worst_slope, std::fabs(double(found.slope[axis][i]) - slope[axis * 25 + i]));
      most_slope = std::fmax(most_slope, std::fabs(double(slope[axis * 25 + i])));
    }
  }
  return std::fmax(worst / std::fmax(most, 1e-30), worst_slope / std::fmax(most_slope, 1e-30));
}

TEST(ShDirectKernels, lights_send_what_the_batches_sum) {
  std::mt19937 random(2);
  for (int k = 0; k < 200; ++k) {
    const vec3 x = random_vector(random),
               y = x + 0.3f * glm::normalize(random_vector(random)) + random_vector(random) * 0.05f;
    const vec3 axis = glm::normalize(random_vector(random));
    const float radius = 0.05f, one = 1, inner = 0.9f, outer = -0.5f;
    sh::LightArrays<float> ball{
        .count = 1, .x = &y.x, .y = &y.y, .z = &y.z, .radius = &radius, .radiance = {&one, &one, &one}};
    for (const bool disk : {false, true})
      for (const float cell : {0.0f, 0.4f}) {
        ball.cell = cell;
        float value[75] = {}, slope[225] = {};
        sh::accumulate_lights_gradient(5, disk ? sh::LightShape::disk : sh::LightShape::sphere, x, ball,
                                       value, slope);
        ShdSent sent = shd_sphere(y - x, radius, disk ? 1 : 0);
        if (cell > 0) sent = shd_bounded(sent, radius, disk ? 1 : 0, cell);
        // Distances in float here, in double there: two roundings (1.2e-7) of places of order 1 over 0.25 m
        // are 1e-6 of them, and slopes of degree 4 fall like the seventh power.
        EXPECT_LT(off(Sum(sent), value, slope), 2e-5);
      }
    const sh::DiracArrays<float> lamp{1,       &y.x,    &y.y,   &y.z,  {&one, &one, &one}, nullptr, &axis.x,
                                      &axis.y, &axis.z, &inner, &outer};
    float value[75] = {}, slope[225] = {};
    sh::accumulate_point_lights(5, x, lamp, value, slope);
    EXPECT_LT(off(Sum(shd_point(y - x)), value, slope), 2e-5);
    std::fill_n(value, 75, 0.0f), std::fill_n(slope, 225, 0.0f);
    sh::accumulate_spot_lights(5, x, lamp, value, slope);
    EXPECT_LT(off(Sum(shd_spot(y - x, axis, inner, outer)), value, slope), 2e-5);
  }
}

TEST(ShDirectKernels, a_facing_sphere_stands_for_its_triangle) {
  std::mt19937 random(3);
  for (int k = 0; k < 200; ++k) {
    const vec3 corners[3] = {random_vector(random), random_vector(random), random_vector(random)};
    const sh::TriangleSphere<float> t = sh::triangle_sphere<float>(corners[0], corners[1], corners[2]);
    const vec3 x = t.center + glm::normalize(random_vector(random)) * (t.radius + 1.0f);
    float value[25];
    vec3 gradient[25];
    sh::triangle_sphere_light<float>(5, sh::TriangleMethod::main, t, x, value, gradient);
    float slope[75];
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < 25; ++i) slope[axis * 25 + i] = gradient[i][axis];
    EXPECT_LT(off(Sum(shd_facing_sphere(t.center - x, t.radius, t.normal, 1)), value, slope), 2e-5);
  }
}

}  // namespace
}  // namespace zonal
