#include <algorithm>
#include <utility>

#include "core/sampling.h"
#include "lights/light.h"

/// The picture is taken as it is: one radiance a texel, no blending, so that the density can follow it
/// exactly. Rows are bands of latitude; inside a band the cosine is sampled uniformly, so the density is
/// constant over each texel and the poles need no care:
///   u = 1/2 + (azimuth + rotation)/(2 pi), azimuth 0 at -z, pi/2 at +x;  row = angle from +y / pi * height
///   (ENV-1) pdf = p_texel / solid angle,  solid angle = 2 pi/width (cos(upper edge) - cos(lower edge))
///   (ENV-2)

namespace zonal {

struct EnvironmentLight::Impl {
  int width = 1, height = 1;
  std::vector<vec3> texels;
  float rotation = 0;
  Piecewise2D distribution;
  std::vector<double> edge_cosine;  ///< height + 1, from 1 to -1
  vec3 fluence{0};                  ///< radiance integrated over the sphere, W m^-2
  float largest_irradiance = 0;     ///< bound of the luminance of the irradiance of any surface
  BoundingSphere bounds;

  int row_of(float y) const {
    return std::clamp(static_cast<int>(y * static_cast<float>(height)), 0, height - 1);
  }
  int column_of(float x) const {
    return std::clamp(static_cast<int>(x * static_cast<float>(width)), 0, width - 1);
  }
  const vec3& texel(int row, int column) const {
    return texels[static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column)];
  }
  double band(int row) const { return edge_cosine[row] - edge_cosine[row + 1]; }

  /// Square coordinates of a direction (ENV-1). They are linear in angle, unlike those of `distribution`
  /// inside a row, but share its rows and columns.
  void locate(vec3 w, int* row, int* column) const {
    const float theta = std::atan2(std::sqrt(w.x * w.x + w.z * w.z), w.y);
    const float turns = 0.5f + (std::atan2(w.x, -w.z) + rotation) * (0.5f * kInvPi);
    *row = row_of(theta * kInvPi);
    *column = column_of(turns - std::floor(turns));
  }

  float density(int row, int column) const {
    const vec2 middle((static_cast<float>(column) + 0.5f) / static_cast<float>(width),
                      (static_cast<float>(row) + 0.5f) / static_cast<float>(height));
    return distribution.pdf(middle) / static_cast<float>(2 * M_PI * height * band(row));  // (ENV-2)
  }

  /// Direction towards the sky, its texel and density.
  vec3 sample(vec2 u, int* row, int* column, float* pdf) const {
    const vec2 p = distribution.sample(u, nullptr);
    *row = row_of(p.y), *column = column_of(p.x);
    // Near a pole the cosine alone holds the direction: in double, so that the thinnest band keeps its shape.
    const double inside = static_cast<double>(p.y) * height - *row;
    const double cosine = edge_cosine[*row] - inside * band(*row);
    const auto sine = static_cast<float>(std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine))));
    const float azimuth = 2 * kPi * (p.x - 0.5f) - rotation;
    *pdf = density(*row, *column);
    return {sine * std::sin(azimuth), static_cast<float>(cosine), -sine * std::cos(azimuth)};
  }
};

EnvironmentLight::EnvironmentLight(int width, int height, std::vector<vec3> texels, float rotation)
    : impl_(std::make_shared<Impl>()) {
  Impl& sky = *impl_;
  sky.width = width, sky.height = height, sky.rotation = rotation, sky.texels = std::move(texels);
  for (int row = 0; row <= height; ++row) sky.edge_cosine.push_back(std::cos(M_PI * row / height));

  // Texels are drawn by luminance times solid angle. Beside the total, sum the direction the light comes
  // from.
  std::vector<float> weights;
  weights.reserve(sky.texels.size());
  glm::dvec3 fluence(0), vector(0);
  double luminous_fluence = 0;
  for (int row = 0; row < height; ++row) {
    const double solid_angle = 2 * M_PI / width * sky.band(row);
    const double cosine = 0.5 * (sky.edge_cosine[row] + sky.edge_cosine[row + 1]);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    for (int column = 0; column < width; ++column) {
      const vec3 radiance = sky.texel(row, column);
      const double share = luminance(radiance) * solid_angle;
      weights.push_back(static_cast<float>(share));
      fluence += glm::dvec3(radiance) * solid_angle;
      luminous_fluence += share;
      const double azimuth = 2 * M_PI * ((column + 0.5) / width - 0.5) - rotation;
      // A texel as wide as the whole circle has no azimuth.
      const double across = width > 1 ? sine : 0;
      vector += share * glm::dvec3(across * std::sin(azimuth), cosine, -across * std::cos(azimuth));
    }
  }
  sky.distribution = Piecewise2D(weights, width, height);
  sky.fluence = vec3(fluence);
  // E(n) = integral of L max(0, n.w) = 1/2 (n . integral L w + integral L |n.w|) <= 1/2 (|integral L w| +
  // fluence).
  sky.largest_irradiance = static_cast<float>(0.5 * (glm::length(vector) + luminous_fluence));
}

void EnvironmentLight::set_scene_bounds(const BoundingSphere& bounds) {
  impl_->bounds = bounds;
}

vec3 EnvironmentLight::power() const {
  return impl_->fluence * (kPi * sqr(impl_->bounds.radius));
}

LightSample EnvironmentLight::sample(vec3, vec2 u) const {
  LightSample s;
  int row = 0, column = 0;
  s.w_in = impl_->sample(u, &row, &column, &s.pdf);
  s.distance = kInfinity;
  // The texel that was drawn, not the one the rounded direction falls into: value and density belong
  // together.
  s.radiance = impl_->texel(row, column);
  return s;
}

vec3 EnvironmentLight::radiance(const LightHit&, vec3 w) const {
  int row = 0, column = 0;
  impl_->locate(-w, &row, &column);
  return impl_->texel(row, column);
}

float EnvironmentLight::pdf(vec3, const LightHit& hit) const {
  int row = 0, column = 0;
  impl_->locate(hit.normal, &row, &column);
  return impl_->density(row, column);
}

EmissionSample EnvironmentLight::sample_emission(vec2 u_position, vec2 u_direction) const {
  EmissionSample s;
  int row = 0, column = 0;
  float pdf = 0;
  const vec3 w = impl_->sample(u_direction, &row, &column, &pdf);
  if (!(pdf > 0)) return s;
  // Parallel rays through a disk as wide as the scene, a hair outside it, facing it.
  const BoundingSphere& b = impl_->bounds;
  const vec2 p = concentric_disk(u_position) * b.radius;
  const Frame frame(w);
  s.origin = b.center + frame.x * p.x + frame.y * p.y + frame.z * (1.001f * b.radius);
  s.direction = -w;
  s.power = impl_->texel(row, column) * (kPi * sqr(b.radius) / pdf);
  return s;
}

float EnvironmentLight::importance(vec3) const {
  return std::fmin(impl_->largest_irradiance, 1e30f);
}

}  // namespace zonal
