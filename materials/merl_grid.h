#pragma once
/// Where a pair of directions lies in a MERL table: Rusinkiewicz's half and difference angles, in cells.
///
///     MerlPoint p = merl_point(half_difference(w_out, w_in));   // p.h = 0 .. 90, p.d = 0 .. 90, p.p = 0 ..
///     180
///
/// A table holds 90 x 90 x 180 colours over (theta_h, theta_d, phi_d) (Matusik et al. 2003): theta_h =
/// (x/90)^2 90 degrees, so that cells are dense around the mirror direction, the other two in cells of one
/// degree. phi_d has period pi, which is reciprocity. Everything is symmetric under exchange of the
/// directions to the last bit.

#include <array>

#include "core/vec.h"

namespace zonal {

inline constexpr int kMerlThetaH = 90, kMerlThetaD = 90, kMerlPhiD = 180;
inline constexpr size_t kMerlCells = size_t(kMerlThetaH) * kMerlThetaD * kMerlPhiD;  ///< of one colour
/// What the stored numbers are multiplied by, red, green, blue: BRDF in 1/sr.
inline constexpr std::array<double, 3> kMerlScale = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

/// Index of a cell within one colour's plane.
inline constexpr size_t merl_index(int h, int d, int p) {
  return (size_t(h) * kMerlThetaD + size_t(d)) * kMerlPhiD + size_t(p);
}

/// Sum and difference of two unit directions: 2 cos(theta_d) h and 2 sin(theta_d) times the tangent of their
/// circle.
struct HalfDifference {
  vec3 sum, difference;  ///< perpendicular
  float rho;             ///< length of the part of `sum` in the surface's plane, [0, 2]
  float length;          ///< of sum, (0, 2]
};
inline HalfDifference half_difference(vec3 w_out, vec3 w_in) {
  HalfDifference a;
  a.sum = w_out + w_in, a.difference = w_in - w_out;
  const float rho2 = a.sum.x * a.sum.x + a.sum.y * a.sum.y;
  a.rho = std::sqrt(rho2);
  a.length = std::sqrt(rho2 + a.sum.z * a.sum.z);
  return a;
}

/// Position in cells: cell i covers [i, i+1), and its sample stands for i + 1/2.
struct MerlPoint {
  float h, d, p;  ///< [0, 90], [0, 90], [0, 180]
};

/// Arc tangent of y/x in [0, pi/2] for y, x >= 0; 0 where both are 0. Absolute error 1e-8 before rounding
/// (Chebyshev interpolation of atan(t)/t in t^2 over [0, 1]); branch-free, so that loops over it vectorise.
inline float quadrant_angle(float y, float x) {
  const float small = y < x ? y : x, large = y < x ? x : y;
  const float t = small / (large > 0.0f ? large : 1.0f), t2 = t * t;
  float p = 0.0027662835f;
  p = p * t2 - 0.0157312491f;
  p = p * t2 + 0.0421376236f;
  p = p * t2 - 0.0745685483f;
  p = p * t2 + 0.1061837064f;
  p = p * t2 - 0.1419779779f;
  p = p * t2 + 0.1999187203f;
  p = p * t2 - 0.3333303671f;
  p = p * t2 + 0.9999999818f;
  const float angle = p * t;
  return y < x ? angle : (large > 0.0f ? 0.5f * kPi - angle : 0.0f);
}

/// Angles from lengths, never from an arc cosine, which knows nothing of angles below 0.02 degrees.
inline MerlPoint merl_point(const HalfDifference& a) {
  // The frame of the half vector: x towards larger theta_h, y = (-sin phi_h, cos phi_h, 0). Where theta_h =
  // 0, phi_h = 0.
  const bool upright = !(a.rho > 0.0f);
  const float cosine = upright ? 1.0f : a.sum.x / a.rho, sine = upright ? 0.0f : a.sum.y / a.rho;
  const float outward = cosine * a.difference.x + sine * a.difference.y;
  float x = (a.sum.z * outward - a.rho * a.difference.z) / a.length;
  float y = cosine * a.difference.y - sine * a.difference.x;
  // Exchanging the directions turns the difference round: phi_d is taken modulo pi.
  const bool turn = y < 0.0f || (y == 0.0f && x < 0.0f);
  x = turn ? -x : x, y = turn ? -y : y;
  const float apart = std::sqrt(glm::dot(a.difference, a.difference));
  const float theta_h = quadrant_angle(a.rho, a.sum.z), theta_d = quadrant_angle(apart, a.length);
  const float folded = quadrant_angle(y, x < 0.0f ? -x : x);
  const float phi_d = x < 0.0f ? kPi - folded : folded;
  return {kMerlThetaH * std::sqrt(theta_h * (2.0f * kInvPi)), theta_d * (kMerlThetaD * 2.0f * kInvPi),
          phi_d * (kMerlPhiD * kInvPi)};
}

/// The unit directions of a point of the table, with phi_h = 0: `in` is the one that phi_d is measured to.
struct MerlDirections {
  glm::dvec3 out, in;
};
MerlDirections merl_directions(double h, double d, double p);

/// theta_d, in cells, at which the lower of the two directions has `cosine` (0: reaches the horizon).
double merl_horizon(double h, double p, double cosine = 0);

}  // namespace zonal
