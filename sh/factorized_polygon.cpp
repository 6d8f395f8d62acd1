#include "sh/factorized_polygon.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sh/polygon_geometry.h"

namespace zonal::sh {

FactorizedPolygons::FactorizedPolygons(int bands)
    : factors_(bands), bands_(bands), lobes_(int(factors_.directions().size())) {
  for (const auto& w : factors_.directions()) {
    const dvec3 unit = glm::normalize(w);
    x_.push_back(unit.x), y_.push_back(unit.y), z_.push_back(unit.z);
  }
  for (auto& m : moments_) m.resize(size_t(bands) * lobes_);
}

void FactorizedPolygons::start(bool with_gradient) {
  functions_ = with_gradient ? 12 : 3;
  sums_.assign(size_t(count(bands_)) * functions_, 0.0);
}

/// Along the edge, w(t) = u cos t + v sin t with t from 0 to T and n = u x v, the cosine with a lobe's axis
/// is z(t) = a cos t + b sin t. With B_l, D_l the integrals of P_l(z), P_l'(z) over t, e_l = [z' P_l(z)] at
/// both ends and nz the cosine of axis and n, so that a^2 + b^2 = 1 - nz^2:
///     (l+1)^2 B_{l+1} = l^2 B_{l-1} - (2l+1)(nz^2 D_l + e_l),   D_{l+1} = D_{l-1} + (2l+1) B_l
/// from d/dt [z' P_l] = -z P_l + (a^2 + b^2 - z^2) P_l'. The polygon's integral of P_l is the sum of nz
/// D_l/(l(l+1)). Its gradient is that of n times the integral of P_l/rho, 1/rho = p z + q z' along the edge.
void FactorizedPolygons::add_edge(const dvec3& from, const dvec3& to) {
  const dvec3 cross = exact_cross(from, to);
  const double sine = std::sqrt(glm::dot(cross, cross));
  if (!(sine > 0)) return;
  const double length = std::sqrt(glm::dot(from, from)), T = std::atan2(sine, glm::dot(from, to));
  const dvec3 n = cross / sine, u = from / length, v = glm::cross(n, u), edge = to - from;
  const double c = std::cos(T), s = std::sin(T);
  // 1/rho = alpha cos t + beta sin t, as in polygon.cpp.
  const double alpha = 1 / length, beta = -glm::dot(from, edge) / (length * sine);
  const bool with_gradient = functions_ > 3;
  constexpr double kAcross = 1e-8;  ///< of a^2 + b^2: below it p and q are lost, and P_l is a line in z
  for (int j = 0; j < lobes_; ++j) {
    const dvec3 axis(x_[j], y_[j], z_[j]);
    const double a = glm::dot(u, axis), b = glm::dot(v, axis), nz = glm::dot(n, axis), nz2 = nz * nz;
    const double z0 = a, z1 = a * c + b * s, slope0 = b, slope1 = b * c - a * s, along = a * a + b * b;
    double p0 = 1, p1 = 1, before0 = 1, before1 = 1;  // P_l and P_{l-1} at both ends; P_{-1} = 1
    double B = T, B_before = 0, D = 0, D_before = 0;
    const double p = (alpha * a + beta * b) / along, q = (alpha * b - beta * a) / along;
    for (int l = 0; l < bands_; ++l) {
      const double rising = slope1 * p1 - slope0 * p0;
      const double next = (l * l * B_before - (2 * l + 1) * (nz2 * D + rising)) / double((l + 1) * (l + 1));
      const double next0 = ((2 * l + 1) * z0 * p0 - l * before0) / (l + 1),
                   next1 = ((2 * l + 1) * z1 * p1 - l * before1) / (l + 1);
      const size_t at = size_t(l) * lobes_ + j;
      if (l > 0) moments_[0][at] += nz * D / (l * (l + 1));
      if (with_gradient) {
        double inverse_rho;
        if (along > kAcross) {
          inverse_rho = (p * ((l + 1) * next + l * B_before) + q * ((next1 - before1) - (next0 - before0))) /
                        (2 * l + 1);
        } else {
          // P_l(z) = P_l(0) + P_l'(0) z + O(1e-8).
          const double even = alpha * s + beta * (1 - c);
          const double odd =
              a * alpha * (T + s * c) / 2 + b * beta * (T - s * c) / 2 + (a * beta + b * alpha) * s * s / 2;
          inverse_rho = std::legendre(unsigned(l), 0.0) * even +
                        (l > 0 ? l * std::legendre(unsigned(l - 1), 0.0) : 0.0) * odd;
        }
        moments_[1][at] += n.x * inverse_rho, moments_[2][at] += n.y * inverse_rho,
            moments_[3][at] += n.z * inverse_rho;
      }
      const double D_next = D_before + (2 * l + 1) * B;
      D_before = D, D = D_next, B_before = B, B = next;
      before0 = p0, p0 = next0, before1 = p1, p1 = next1;
    }
  }
}

void FactorizedPolygons::add(int n, const dvec3* corners, const dvec3& radiance) {
  for (int k = 0; k < (functions_ > 3 ? 4 : 1); ++k) std::fill(moments_[k].begin(), moments_[k].end(), 0.0);
  double omega = 0;
  const auto seen = [&](int i) {
    return SeenVertex{corners[i], dvec3(0), std::sqrt(glm::dot(corners[i], corners[i]))};
  };
  for (int i = 2; i < n; ++i) omega += seen_solid_angle(seen(0), seen(i - 1), seen(i));
  std::fill_n(moments_[0].begin(), lobes_, omega);
  for (int i = 0; i < n; ++i) add_edge(corners[i], corners[(i + 1) % n]);
  const dvec3 shining = omega < 0 ? -radiance : radiance;
  for (int l = 0; l < bands_; ++l)
    for (int d = 0; d <= 2 * l; ++d) {
      const size_t at = size_t(l) * lobes_ + factors_.lobe(l, d);
      double* sum = sums_.data() + size_t(l * l + d) * functions_;
      for (int k = 0; k < 3; ++k) sum[k] += shining[k] * moments_[0][at];
      for (int f = 3; f < functions_; ++f) sum[f] += shining[(f - 3) / 3] * moments_[1 + f % 3][at];
    }
}

void FactorizedPolygons::finish(float* L, float* gradient) {
  std::vector<double> all(sums_.size());
  factors_.from_lobes(functions_, sums_.data(), all.data());
  const int n = count(bands_);
  for (int i = 0; i < n; ++i) {
    const double* one = all.data() + size_t(i) * functions_;
    for (int c = 0; c < 3; ++c) L[c * n + i] += float(one[c]);
    for (int f = 3; f < functions_; ++f) gradient[(f - 3) * n + i] += float(one[f]);
  }
}

}  // namespace zonal::sh
