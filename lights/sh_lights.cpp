#include "lights/sh_lights.h"

#include <algorithm>
#include <cassert>

#include "sh/light_batch_hessian.h"

namespace zonal {

void ShLights::Arrays::add(vec3 position, vec3 value) {
  x.push_back(position.x), y.push_back(position.y), z.push_back(position.z);
  for (int c = 0; c < 3; ++c) colour[c].push_back(value[c]);
}

sh::LightArrays<float> ShLights::Arrays::caps(float cell) const {
  return {.count = count(),
          .x = x.data(),
          .y = y.data(),
          .z = z.data(),
          .radius = radius.data(),
          .radiance = {colour[0].data(), colour[1].data(), colour[2].data()},
          .cell = cell};
}

sh::DiracArrays<float> ShLights::Arrays::diracs() const {
  return {count(),
          x.data(),
          y.data(),
          z.data(),
          {colour[0].data(), colour[1].data(), colour[2].data()},
          nullptr,
          axis_x.data(),
          axis_y.data(),
          axis_z.data(),
          cos_inner.data(),
          cos_outer.data()};
}

namespace {

std::vector<const Light*> pointers(const std::vector<std::unique_ptr<Light>>& lights) {
  std::vector<const Light*> result;
  for (const auto& light : lights) result.push_back(light.get());
  return result;
}

}  // namespace

ShLights::ShLights(const std::vector<std::unique_ptr<Light>>& lights, const ShLightOptions& options)
    : ShLights(pointers(lights), options) {}

ShLights::ShLights(const std::vector<const Light*>& lights, const ShLightOptions& options)
    : options_(options), fixed_(3 * size_t(sh::count(options.bands))) {
  for (const Light* light : lights) {
    if (const auto* sphere = dynamic_cast<const SphereLight*>(light)) {
      spheres_.add(sphere->center, sphere->emission);
      spheres_.radius.push_back(sphere->radius);
    } else if (const auto* mesh = dynamic_cast<const TriangleLight*>(light)) {
      add_mesh(*mesh);
    } else if (const auto* picture = dynamic_cast<const TexturedLight*>(light)) {
      add_picture(*picture);
    } else if (const auto* point = dynamic_cast<const PointLight*>(light)) {
      points_.add(point->position, point->intensity);
    } else if (const auto* spot = dynamic_cast<const SpotLight*>(light)) {
      spots_.add(spot->position, spot->intensity);
      spots_.axis_x.push_back(spot->direction.x), spots_.axis_y.push_back(spot->direction.y);
      spots_.axis_z.push_back(spot->direction.z);
      const float inner = 1 - spot->cone.v_inner;
      // A hard edge is a very steep one: a step has no gradient.
      spots_.cos_inner.push_back(inner),
          spots_.cos_outer.push_back(std::min(1 - spot->cone.v_outer, inner - 1e-6f));
    } else if (const auto* sun = dynamic_cast<const DirectionalLight*>(light)) {
      const sh::DiracArrays<float> one{1,
                                       &sun->direction.x,
                                       &sun->direction.y,
                                       &sun->direction.z,
                                       {&sun->irradiance.x, &sun->irradiance.y, &sun->irradiance.z}};
      sh::accumulate_directional_lights(options_.bands, one, fixed_.data());
    } else if (const auto* sky = dynamic_cast<const PictureLight*>(light)) {
      add_environment(*sky);
    } else {
      assert(!"a light without a projection");
    }
  }
}

int ShLights::count() const {
  return spheres_.count() + points_.count() + spots_.count() + exact_.count() + triangles_.spheres.count();
}

void ShLights::coefficients(int bands, vec3 x, float* L) const {
  all(bands, x, L, nullptr, 0);
}

void ShLights::gradient(int bands, vec3 x, float* L, float* gradient, float cell) const {
  all(bands, x, L, gradient, cell);
}

/// `gradient` may be null. `spheres`: with them.
void ShLights::all(int bands, vec3 x, float* L, float* gradient, float cell, bool spheres) const {
  const size_t n = sh::count(bands), fixed = sh::count(options_.bands);
  for (int c = 0; c < 3; ++c) std::copy_n(fixed_.data() + c * fixed, n, L + c * n);
  if (gradient) std::fill_n(gradient, 9 * n, 0.0f);
  if (spheres && spheres_.count() > 0) {
    if (gradient)
      sh::accumulate_lights_gradient(bands, options_.shape, x, spheres_.caps(cell), L, gradient);
    else
      sh::accumulate_lights(bands, options_.shape, x, spheres_.caps(), L);
  }
  if (points_.count() > 0) sh::accumulate_point_lights(bands, x, points_.diracs(), L, gradient);
  if (spots_.count() > 0) sh::accumulate_spot_lights(bands, x, spots_.diracs(), L, gradient);
  if (exact_.count() > 0) exact_.accumulate(bands, x, options_.tolerance, L, gradient);
  if (triangles_.spheres.count() == 0) return;
  if (options_.polygons == ShLightOptions::Polygons::main)
    triangles_as_spheres(bands, x, L, gradient, cell);
  else if (options_.polygons == ShLightOptions::Polygons::factorized)
    triangles_factorized(bands, x, L, gradient);
  else
    triangles_one_by_one(bands, x, L, gradient);
}

void ShLights::hessian(int bands, vec3 x, float step, float* L, float* gradient, float* hessian,
                       float cell) const {
  const size_t n = sh::count(bands);
  std::fill_n(hessian, 18 * n, 0.0f);
  all(bands, x, L, gradient, cell, false);
  if (count() > spheres_.count()) {
    constexpr size_t kPlace[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    thread_local std::vector<float> ignored, slopes[2];
    ignored.resize(3 * n), slopes[0].resize(9 * n), slopes[1].resize(9 * n);
    for (size_t along = 0; along < 3; ++along) {
      vec3 h(0);
      h[along] = step;
      all(bands, x + h, ignored.data(), slopes[0].data(), cell, false);
      all(bands, x - h, ignored.data(), slopes[1].data(), cell, false);
      for (size_t axis = 0; axis < 3; ++axis) {
        // Mixed ones are had twice: the slope along one axis of the derivative for the other.
        const float scale = (axis == along ? 0.5f : 0.25f) / step;
        for (size_t c = 0; c < 3; ++c)
          for (size_t i = 0; i < n; ++i) {
            const size_t from = (c * 3 + axis) * n + i;
            hessian[(c * 6 + kPlace[axis][along]) * n + i] += (slopes[0][from] - slopes[1][from]) * scale;
          }
      }
    }
  }
  if (spheres_.count() > 0)
    sh::accumulate_lights_hessian(bands, options_.shape, x, spheres_.caps(cell), L, gradient, hessian);
}

/// Light of degree l falls like d^-(l+2) at most: its fourth derivative times h^4/384, what a cubic leaves,
/// is (l+2)(l+3)(l+4)(l+5)/384 (h/d)^4 of it, and never more than all. A small cap has the norm Omega
/// N/sqrt(4 pi).
float ShLights::missed(int bands, vec3 x, float cell) const {
  const float N = float(bands), share = (N + 1) * (N + 2) * (N + 3) * (N + 4) / 384;
  const float h2 = cell * cell;
  const Arrays& s = spheres_;
  float squares = 0;
  for (int k = 0; k < s.count(); ++k) {
    const float dx = s.x[k] - x.x, dy = s.y[k] - x.y, dz = s.z[k] - x.z, r2 = s.radius[k] * s.radius[k];
    const float d2 = std::max(dx * dx + dy * dy + dz * dz, r2), near = h2 / d2, sine2 = r2 / d2;
    const float omega = sine2 / (1 + std::sqrt(1 - sine2)),
                part = omega * std::min(1.0f, share * near * near);
    squares += part * part * (sqr(s.colour[0][k]) + sqr(s.colour[1][k]) + sqr(s.colour[2][k]));
  }
  return std::sqrt(squares * kPi) * N;  // (2 pi N)^2/(4 pi)
}

}  // namespace zonal
