#include "materials/specular_albedo.h"

#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace zonal {
namespace {

/// E by the midpoint rule over the numbers that sample visible normals: the integrand F G2/G1 is bounded and
/// smooth there, however narrow the lobe. Only the last share alpha^2 of u.y, the distribution's far tail
/// that reflects below the horizon, is steep; u.y = 1 - v^2 gives it more of the points (24 x 24 of them:
/// error about 1e-4).
float directional_albedo(vec3 w_out, float alpha_x, float alpha_y, float ior) {
  constexpr int kAround = 24, kHeights = 24;
  // Isotropic surfaces are symmetric about the plane of incidence, so half of the azimuths do.
  const float turn = alpha_x == alpha_y ? 0.5f : 1.0f;
  const float stretch_out = ggx_stretch(w_out, alpha_x, alpha_y);
  double sum = 0;
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kHeights; ++j) {
      const float v = (j + 0.5f) / kHeights;
      const vec2 u(turn * (i + 0.5f) / kAround, 1.0f - v * v);
      const vec3 h = sample_visible_normal(w_out, alpha_x, alpha_y, u);
      const float o_dot_h = std::fmin(glm::dot(w_out, h), 1.0f);
      const vec3 w_in = 2.0f * o_dot_h * h - w_out;
      if (w_in.z <= 0.0f) continue;
      const float fresnel =
          ior > 0 ? fresnel_dielectric(o_dot_h, ior) : fresnel_schlick(o_dot_h, vec3(0.04f)).x;
      const float stretch_in = ggx_stretch(w_in, alpha_x, alpha_y);
      sum += 2.0f * v * fresnel * ggx_sample_weight(w_out.z, stretch_out, w_in.z, stretch_in);
    }
  }
  return static_cast<float>(sum / (kAround * kHeights));
}

/// Mean, weighted by the cosine, of a function linear between nodes uniform in t = cosine^(1/4):
/// 2 cos dcos = 8 t^7 dt.
double cosine_mean(const float* values, int count) {
  double mean = 0;
  for (int c = 0; c + 1 < count; ++c) {
    const double t0 = double(c) / (count - 1), t1 = double(c + 1) / (count - 1);
    const double slope = (values[c + 1] - values[c]) / (t1 - t0);
    mean += (values[c] - slope * t0) * (std::pow(t1, 8) - std::pow(t0, 8)) +
            slope * 8 / 9 * (std::pow(t1, 9) - std::pow(t0, 9));
  }
  return mean;
}

}  // namespace

SpecularAlbedo::SpecularAlbedo(float ior, float aspect)
    : ior_(ior), aspect_(aspect), values_(size_t(kAlphas) * azimuths() * kCosines), averages_(kAlphas) {
  // How much of the circle each azimuth node stands for, by linear interpolation between nodes.
  std::vector<double> share(azimuths(), azimuths() == 1 ? 1.0 : 0.0);
  constexpr int kSteps = 1024;
  for (int i = 0; azimuths() > 1 && i < kSteps; ++i) {
    const float phi = 0.5f * kPi * (i + 0.5f) / kSteps;
    const Node node(azimuth_coordinate(vec3(std::cos(phi), std::sin(phi), 0)), kAzimuths);
    share[node.index] += (1.0 - node.blend) / kSteps;
    share[node.index + 1] += double(node.blend) / kSteps;
  }
  for (int a = 0; a < kAlphas; ++a) {
    const float alpha = sqr(sqr(kFirstAlphaRoot + (1.0f - kFirstAlphaRoot) * float(a) / (kAlphas - 1)));
    const float alpha_x = alpha / std::sqrt(aspect), alpha_y = alpha * std::sqrt(aspect);
    double average = 0;
    for (int p = 0; p < azimuths(); ++p) {
      // Invert azimuth_coordinate: width^4 = cos^2 phi + aspect^2 sin^2 phi.
      float x = 1, y = 0;
      if (azimuths() > 1) {
        const float width = std::sqrt(aspect) + (1.0f - std::sqrt(aspect)) * float(p) / (kAzimuths - 1);
        const float sin2 = (1.0f - sqr(sqr(width))) / (1.0f - sqr(aspect));
        y = safe_sqrt(sin2), x = safe_sqrt(1.0f - sin2);
      }
      float* row = &values_[(size_t(a) * azimuths() + p) * kCosines];
      for (int c = 0; c < kCosines; ++c) {
        const float cosine = std::fmax(sqr(sqr(float(c) / (kCosines - 1))), 1e-7f);
        const float sine = safe_sqrt(1.0f - cosine * cosine);
        row[c] = directional_albedo(vec3(sine * x, sine * y, cosine), alpha_x, alpha_y, ior);
      }
      average += share[p] * cosine_mean(row, kCosines);
    }
    averages_[a] = static_cast<float>(average);
  }
}

const SpecularAlbedo& SpecularAlbedo::dielectric(float ior, float aspect) {
  static std::mutex mutex;
  static std::map<std::pair<float, float>, std::unique_ptr<const SpecularAlbedo>> tables;
  const std::lock_guard lock(mutex);
  auto& table = tables[{ior, aspect}];
  if (!table) table.reset(new SpecularAlbedo(ior, aspect));
  return *table;
}

const SpecularAlbedo& SpecularAlbedo::schlick() {
  static const SpecularAlbedo table(0.0f, 1.0f);
  return table;
}

}  // namespace zonal
