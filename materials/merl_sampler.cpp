#include "materials/merl_sampler.h"

#include <algorithm>
#include <array>

#include <tbb/parallel_for.h>

namespace zonal {
namespace {

constexpr int kRings = kMerlThetaH;

/// 1 - cos(theta_h) at the lower edge of each ring: uniform in it is uniform in solid angle, and small angles
/// keep their digits.
const std::array<float, kRings + 1>& ring_edges() {
  static const std::array<float, kRings + 1> edges = [] {
    std::array<float, kRings + 1> v;
    for (int i = 0; i <= kRings; ++i) {
      const double share = double(i) / kRings, sine = std::sin(share * share * 0.78539816339744830962);
      v[size_t(i)] = float(2 * sine * sine);
    }
    return v;
  }();
  return edges;
}

/// Unit direction of w's azimuth; x for the pole.
vec2 azimuth(vec3 w) {
  const float length = std::sqrt(w.x * w.x + w.y * w.y);
  return length > 0.0f ? vec2(w.x, w.y) / length : vec2(1, 0);
}

/// Half vector at an azimuth of 2 pi `turn` from w_out's, 1 - cos(theta_h) = v.
vec3 half_at(vec2 towards_out, float turn, float v) {
  const float phi = 2.0f * kPi * turn, radius = safe_sqrt(v * (2.0f - v));
  const float c = std::cos(phi) * radius, s = std::sin(phi) * radius;
  return {c * towards_out.x - s * towards_out.y, s * towards_out.x + c * towards_out.y, 1.0f - v};
}

vec3 reflect(vec3 w, vec3 h) {
  return 2.0f * glm::dot(w, h) * h - w;
}

}  // namespace

MerlSampler::MerlSampler(const std::function<vec3(vec3, vec3)>& brdf) : elevations_(kElevations) {
  const auto& edges = ring_edges();
  tbb::parallel_for(0, kElevations, [&](int e) {
    // Two polar angles stand for all of the elevation's.
    const float step = 0.5f * kPi / kElevations;
    const std::array<float, 2> polar = {(float(e) + 0.25f) * step, (float(e) + 0.75f) * step};

    // The floor: what four fifths of the directions, weighted by the cosine, exceed.
    std::vector<float> values;
    for (int i = 0; i < 8; ++i) {
      for (int j = 0; j < 16; ++j) {
        const float t = polar[size_t(i % 2)];
        const vec3 w_in = cosine_hemisphere({(float(i) + 0.5f) / 8, (float(j) + 0.5f) / 16});
        values.push_back(luminance(brdf({std::sin(t), 0, std::cos(t)}, w_in)));
      }
    }
    const auto fifth = values.begin() + ptrdiff_t(values.size() / 5);
    std::nth_element(values.begin(), fifth, values.end());
    const float floor = *fifth;

    // The rest, over half vectors; four points in each cell.
    std::vector<float> weights(size_t(kRings) * kSectors);
    double rest = 0;
    for (int i = 0; i < kRings; ++i) {
      for (int j = 0; j < kSectors; ++j) {
        float sum = 0;
        for (int k = 0; k < 4; ++k) {
          const float t = polar[size_t(k % 2)],
                      v = edges[size_t(i)] + (edges[size_t(i) + 1] - edges[size_t(i)]) * 0.5f;
          const vec3 w_out(std::sin(t), 0, std::cos(t));
          const vec3 h = half_at({1, 0}, (float(j) + (k < 2 ? 0.25f : 0.75f)) / kSectors, v);
          const vec3 w_in = reflect(w_out, h);
          const float toward = glm::dot(w_out, h);
          if (toward <= 0 || w_in.z <= 0) continue;
          sum += std::fmax(luminance(brdf(w_out, w_in)) - floor, 0.0f) * w_in.z * 4 * toward;
        }
        const double solid_angle = 2 * double(kPi) * (edges[size_t(i) + 1] - edges[size_t(i)]) / kSectors;
        weights[size_t(i) * kSectors + size_t(j)] = float(sum * 0.25 * solid_angle);
        rest += sum * 0.25 * solid_angle;
      }
    }
    Elevation& entry = elevations_[size_t(e)];
    entry.half = Piecewise2D(weights, kSectors, kRings);
    // A tenth at least, for the light that falls between the points of the table.
    const double diffuse = double(floor) * double(kPi);
    entry.cosine_share = rest > 0 ? float(std::clamp(diffuse / (diffuse + rest), 0.1, 1.0)) : 1.0f;
  });
}

const MerlSampler::Elevation& MerlSampler::elevation(vec3 w_out) const {
  const float theta = quadrant_angle(std::sqrt(w_out.x * w_out.x + w_out.y * w_out.y), w_out.z);
  const int e = int(theta * (kElevations * 2.0f * kInvPi));
  return elevations_[size_t(std::clamp(e, 0, kElevations - 1))];
}

vec3 MerlSampler::sample(vec3 w_out, float u_lobe, vec2 u) const {
  const Elevation& e = elevation(w_out);
  if (u_lobe < e.cosine_share) return cosine_hemisphere(u);

  float unused;
  const vec2 p = e.half.sample(u, &unused);
  const float y = p.y * kRings;
  const int ring = std::min(int(y), kRings - 1);
  const auto& edges = ring_edges();
  const float low = edges[size_t(ring)], high = edges[size_t(ring) + 1];
  const vec3 h = half_at(azimuth(w_out), p.x, low + (high - low) * (y - float(ring)));
  if (glm::dot(w_out, h) <= 0.0f) return vec3(0.0f);
  return glm::normalize(reflect(w_out, h));
}

float MerlSampler::pdf(vec3 w_out, vec3 w_in, const HalfDifference& a) const {
  const Elevation& e = elevation(w_out);
  const float cosine = w_in.z * kInvPi;
  if (e.cosine_share == 1.0f) return cosine;

  // Where the half vector lies in the table: azimuth from w_out's, ring.
  const vec2 towards_out = azimuth(w_out);
  const float along = a.sum.x * towards_out.x + a.sum.y * towards_out.y;
  const float aside = a.sum.y * towards_out.x - a.sum.x * towards_out.y;
  const float quarter = quadrant_angle(std::abs(aside), std::abs(along));
  const float half_turn = along < 0.0f ? kPi - quarter : quarter;
  const float turn = (aside < 0.0f ? 2.0f * kPi - half_turn : half_turn) * (0.5f * kInvPi);
  const float theta_h = quadrant_angle(a.rho, a.sum.z);
  const float y = kRings * std::sqrt(theta_h * (2.0f * kInvPi));
  const int ring = std::min(int(y), kRings - 1);

  // The unit square's density times its area per solid angle of half vectors, times d(h)/d(w_in) = 1 / (4
  // w_out.h).
  const auto& edges = ring_edges();
  const float ring_angle = 2.0f * kPi * (edges[size_t(ring) + 1] - edges[size_t(ring)]);
  const float square = e.half.pdf({std::fmin(turn, 1.0f), std::fmin((float(ring) + 0.5f) / kRings, 1.0f)});
  const float half = square / (kRings * ring_angle * 2.0f * a.length);
  return e.cosine_share * cosine + (1.0f - e.cosine_share) * half;
}

}  // namespace zonal
