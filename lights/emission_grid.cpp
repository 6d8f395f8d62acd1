#include "lights/emission_grid.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/sampling.h"

namespace zonal {

namespace {

constexpr float kWidestCone = 80 * kPi / 180;  ///< half angle; the plane's corners carry cos^3 = 0.2 % there
constexpr int kTries = 256;

/// The frame whose z looks through face 0..5 of a cube.
Frame cube_face(int face) {
  vec3 axis(0);
  axis[face / 2] = face % 2 ? -1.0f : 1.0f;
  return Frame(axis);
}

/// 1 - cos of the angle whose tangent squared is q2, without cancellation.
double versine(double q2) {
  const double secant = std::sqrt(1 + q2);
  return q2 / (secant * (secant + 1));
}

/// What flows through a disk of the plane about the axis, per radian around it, as a function of its squared
/// radius: by Stokes the flux through a rectangle is the integral of G dphi along its edges. Nothing flows
/// beyond `end2`.
struct Spread {
  const SpotCone* cone;         ///< null: 1 everywhere within end2, directional light's disk
  double start2 = 0, end2 = 0;  ///< squared radii between which the falloff falls

  explicit Spread(const SpotCone& c)
      : cone(&c), start2(sqr(std::tan(c.inner))), end2(sqr(std::tan(c.outer))) {}
  explicit Spread(double radius) : cone(nullptr), start2(radius * radius), end2(radius * radius) {}

  double G(double q2) const {
    if (!cone) return 0.5 * std::min(q2, end2);
    const double v = versine(q2), in = cone->v_inner, edge = cone->v_edge;
    if (v <= in || !(edge > 0)) return std::min(v, in);
    // The falloff is t^2 (3 - 2t), t = (v_out - v)/edge; what is left of its integral beyond v is edge (t^3 -
    // t^4/2).
    const double t = std::max(0.0, (in + edge - v) / edge);
    return in + edge * (0.5 - t * t * t * (1 - 0.5 * t));
  }
};

/// Integral of G dphi along the edge x = x0, y from y0 to y1: dphi = x0 dy/(x0^2 + y^2).
double along_edge(const Spread& spread, double x0, double y0, double y1) {
  constexpr double node[] = {0, 0.5384693101056831, 0.9061798459386640};  // Gauss-Legendre, 5 points
  constexpr double weight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  // Split where the falloff begins and ends.
  double cuts[6] = {y0, y1};
  int count = 2;
  for (const double r2 : {spread.start2, spread.end2}) {
    if (r2 <= x0 * x0) continue;
    const double y = std::sqrt(r2 - x0 * x0);
    for (const double cut : {-y, y})
      if (cut > y0 && cut < y1) cuts[count++] = cut;
  }
  std::sort(cuts, cuts + count);

  double sum = 0;
  for (int i = 0; i + 1 < count; ++i) {
    const double a = cuts[i], b = cuts[i + 1], middle = 0.5 * (a + b), half = 0.5 * (b - a);
    if (x0 * x0 + middle * middle >= spread.end2) {
      if (x0 != 0) sum += spread.G(spread.end2) * (std::atan(b / x0) - std::atan(a / x0));
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      for (int sign = -1; sign <= (k ? 1 : -1); sign += 2) {
        const double y = middle + sign * half * node[k], q2 = x0 * x0 + y * y;
        if (q2 > 0) sum += half * weight[k] * spread.G(q2) * x0 / q2;
      }
    }
  }
  return sum;
}

/// The flux through a rectangle, its edges divided into `parts`.
double through_rectangle(const Spread& spread, vec2 low, vec2 high, int parts) {
  double sum = 0;
  for (int i = 0; i < parts; ++i) {
    const auto at = [&](double l, double h, int j) { return l + (h - l) * j / parts; };
    const double y0 = at(low.y, high.y, i), y1 = at(low.y, high.y, i + 1);
    const double x0 = at(low.x, high.x, i), x1 = at(low.x, high.x, i + 1);
    sum += along_edge(spread, high.x, y0, y1) - along_edge(spread, low.x, y0, y1);
    sum += along_edge(spread, high.y, x0, x1) - along_edge(spread, low.y, x0, x1);
  }
  return std::max(sum, 0.0);
}

/// Solid angle of a rectangle of the plane at distance 1.
double solid_angle(vec2 low, vec2 high) {
  const auto corner = [](double x, double y) { return std::atan(x * y / std::sqrt(1 + x * x + y * y)); };
  return corner(high.x, high.y) - corner(low.x, high.y) - corner(high.x, low.y) + corner(low.x, low.y);
}

/// The point of a rectangle nearest to the axis, where it is brightest.
vec2 nearest_to_axis(vec2 low, vec2 high) {
  return glm::clamp(vec2(0), low, high);
}

}  // namespace

bool EmissionGrid::suits(const Light& light) {
  if (const auto* spot = dynamic_cast<const SpotLight*>(&light)) return spot->cone.outer <= kWidestCone;
  return dynamic_cast<const PointLight*>(&light) || dynamic_cast<const DirectionalLight*>(&light);
}

EmissionGrid::EmissionGrid(const Light& light, double cells, int block_texels)
    : light_(&light), block_(block_texels) {
  assert(suits(light) && block_texels >= 1);
  if (dynamic_cast<const PointLight*>(&light)) faces_ = 6;
  if (const auto* spot = dynamic_cast<const SpotLight*>(&light)) half_width_ = std::tan(spot->cone.outer);
  if (const auto* sun = dynamic_cast<const DirectionalLight*>(&light)) half_width_ = sun->bounds.radius;
  const double per_face = std::clamp(cells / faces_, 1.0, 1e8);
  columns_ = std::max(1, static_cast<int>(std::lround(std::sqrt(per_face))));
  rows_ = std::max(1, static_cast<int>(std::lround(per_face / columns_)));
}

float EmissionGrid::fov() const {
  if (dynamic_cast<const DirectionalLight*>(light_)) return 0;
  return 2.0f * std::atan(half_width_);
}

int EmissionGrid::texel(int cell, int i) const {
  const int face = cell / (columns_ * rows_), row = cell / columns_ % rows_, column = cell % columns_;
  const int x = column * block_ + i % block_, y = row * block_ + i / block_;
  return (face * rows_ * block_ + y) * columns_ * block_ + x;
}

EmissionGrid::Rectangle EmissionGrid::rectangle(int texel) const {
  const int width = columns_ * block_, height = rows_ * block_;
  const int x = texel % width, y = texel / width % height;
  const auto edge = [this](int i, int n) {
    return half_width_ * (2.0f * static_cast<float>(i) / static_cast<float>(n) - 1.0f);
  };
  return {
      {edge(x, width), edge(y, height)}, {edge(x + 1, width), edge(y + 1, height)}, texel / (width * height)};
}

float EmissionGrid::weight(int texel) const {
  const Rectangle r = rectangle(texel);
  if (dynamic_cast<const PointLight*>(light_)) return static_cast<float>(solid_angle(r.low, r.high));
  // Coarse cells have long edges: they are integrated in parts.
  const int parts = std::max(1, 16 / (std::min(columns_, rows_) * block_));
  const auto* spot = dynamic_cast<const SpotLight*>(light_);
  const Spread spread = spot ? Spread(spot->cone) : Spread(half_width_);
  const vec2 nearest = nearest_to_axis(r.low, r.high), farthest = glm::max(glm::abs(r.low), glm::abs(r.high));
  if (glm::dot(nearest, nearest) >= spread.end2) return 0;
  if (glm::dot(farthest, farthest) <= spread.start2)
    return static_cast<float>(spot ? solid_angle(r.low, r.high)
                                   : double(r.high.x - r.low.x) * (r.high.y - r.low.y));
  return static_cast<float>(through_rectangle(spread, r.low, r.high, parts));
}

vec3 EmissionGrid::flux(float weight) const {
  if (const auto* point = dynamic_cast<const PointLight*>(light_)) return point->intensity * weight;
  if (const auto* spot = dynamic_cast<const SpotLight*>(light_)) return spot->intensity * weight;
  return static_cast<const DirectionalLight*>(light_)->irradiance * weight;
}

float EmissionGrid::density(vec2 q) const {
  const float q2 = glm::dot(q, q);
  if (dynamic_cast<const DirectionalLight*>(light_)) return q2 <= sqr(half_width_) ? 1.0f : 0.0f;
  const float cosine = 1.0f / std::sqrt(1.0f + q2), solid = cosine * cosine * cosine;
  const auto* spot = dynamic_cast<const SpotLight*>(light_);
  return spot ? spot->falloff_versine(static_cast<float>(versine(q2))) * solid : solid;
}

EmissionSample EmissionGrid::through(const Rectangle& r, vec2 q) const {
  EmissionSample s;
  if (const auto* sun = dynamic_cast<const DirectionalLight*>(light_)) {
    const Frame frame(-sun->direction);
    s.direction = sun->direction;
    s.origin = sun->bounds.center + frame.x * q.x + frame.y * q.y + frame.z * (1.001f * half_width_);
    return s;
  }
  const auto* spot = dynamic_cast<const SpotLight*>(light_);
  const Frame frame = spot ? Frame(spot->direction) : cube_face(r.face);
  s.origin = spot ? spot->position : static_cast<const PointLight*>(light_)->position;
  s.direction = glm::normalize(frame.to_world({q.x, q.y, 1.0f}));
  return s;
}

EmissionSample EmissionGrid::sample(int texel, vec2 u) const {
  const float w = weight(texel);
  const Rectangle r = rectangle(texel);
  if (!(w > 0)) return through(r, glm::mix(r.low, r.high, u));
  const uint32_t key = hash32(std::bit_cast<uint32_t>(u.x), std::bit_cast<uint32_t>(u.y));
  const vec2 brightest = nearest_to_axis(r.low, r.high);
  const float most = density(brightest);
  // Keep a point with the probability of its flux; where hardly any is kept, the brightest stands for all.
  vec2 q = brightest;
  for (uint32_t i = 0; i < kTries; ++i) {
    const vec2 p = glm::mix(r.low, r.high, u);
    if (unit_float(hash32(key, 3 * i, 0x6b656570u)) * most < density(p)) {
      q = p;
      break;
    }
    u = {unit_float(hash32(key, 3 * i + 1, 0x6b656570u)), unit_float(hash32(key, 3 * i + 2, 0x6b656570u))};
  }
  EmissionSample s = through(r, q);
  s.power = flux(w);
  return s;
}

EmissionSample EmissionGrid::center(int texel) const {
  const float w = weight(texel);
  const Rectangle r = rectangle(texel);
  const vec2 middle = 0.5f * (r.low + r.high);
  EmissionSample s = through(r, density(middle) > 0 || !(w > 0) ? middle : nearest_to_axis(r.low, r.high));
  s.power = flux(w);
  return s;
}

}  // namespace zonal
