#include "materials/merl_grid.h"

namespace zonal {
namespace {

constexpr double kQuarterTurn = 1.57079632679489661923;

double polar_of_half(double h) {
  return (h / kMerlThetaH) * (h / kMerlThetaH) * kQuarterTurn;
}

}  // namespace

MerlDirections merl_directions(double h, double d, double p) {
  const double theta_h = polar_of_half(h), theta_d = d / kMerlThetaD * kQuarterTurn;
  const double phi_d = p / kMerlPhiD * 2 * kQuarterTurn;
  const double sine = std::sin(theta_h), cosine = std::cos(theta_h);
  const double x = std::sin(theta_d) * std::cos(phi_d), y = std::sin(theta_d) * std::sin(phi_d),
               z = std::cos(theta_d);
  const auto turned = [&](double px, double py) {
    return glm::dvec3(cosine * px + sine * z, py, cosine * z - sine * px);
  };
  return {turned(-x, -y), turned(x, y)};
}

double merl_horizon(double h, double p, double cosine) {
  // The lower direction has z = cos(theta_h) cos(theta_d) - sin(theta_h) |cos(phi_d)| sin(theta_d), which is
  // length cos(theta_d + lean).
  const double theta_h = polar_of_half(h), across = std::abs(std::cos(p / kMerlPhiD * 2 * kQuarterTurn));
  const double a = std::cos(theta_h), b = std::sin(theta_h) * across;
  const double length = std::hypot(a, b), lean = std::atan2(b, a);
  const double theta_d = std::acos(std::fmin(cosine / length, 1.0)) - lean;
  return std::fmax(theta_d, 0.0) / kQuarterTurn * kMerlThetaD;
}

}  // namespace zonal
