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
  double at_zero[kMaxBands];        // P_l(0)
  for (int l = 0; l < bands_; ++l) at_zero[l] = l % 2 ? 0.0 : l == 0 ? 1.0 : -at_zero[l - 2] * (l - 1) / l;
  // Lobes in the inner loops, in arrays of their own, so that the compiler sees that none is another.
  using Row = double[3 * kMaxBands];
  Row z0, z1, slope0, slope1, nz, p0, p1, before0, before1, B, B_before, D, D_before, p, q;
  const int count = lobes_;
  for (int j = 0; j < count; ++j) {
    const double a = u.x * x_[j] + u.y * y_[j] + u.z * z_[j], b = v.x * x_[j] + v.y * y_[j] + v.z * z_[j];
    const double along = std::max(a * a + b * b, kAcross);
    z0[j] = a, z1[j] = a * c + b * s, slope0[j] = b, slope1[j] = b * c - a * s;
    nz[j] = n.x * x_[j] + n.y * y_[j] + n.z * z_[j];
    p[j] = (alpha * a + beta * b) / along, q[j] = (alpha * b - beta * a) / along;
    p0[j] = p1[j] = before0[j] = before1[j] = 1;
    B[j] = T, B_before[j] = D[j] = D_before[j] = 0;
  }
  for (int l = 0; l < bands_; ++l) {
    const size_t first = size_t(l) * size_t(count);
    double *__restrict__ value = moments_[0].data() + first, *__restrict__ gx = moments_[1].data() + first,
           *__restrict__ gy = moments_[2].data() + first, *__restrict__ gz = moments_[3].data() + first;
    const double odd = 2 * l + 1, inverse = 1.0 / (l + 1), share = l > 0 ? 1.0 / (l * (l + 1)) : 0.0;
    struct Next {
      double B, p0, p1;
    };
    const auto step = [&](int j) {
      const double rising = slope1[j] * p1[j] - slope0[j] * p0[j];
      return Next{(l * l * B_before[j] - odd * (nz[j] * nz[j] * D[j] + rising)) * (inverse * inverse),
                  (odd * z0[j] * p0[j] - l * before0[j]) * inverse,
                  (odd * z1[j] * p1[j] - l * before1[j]) * inverse};
    };
    if (with_gradient) {
      // P_l(z) = P_l(0) + P_l'(0) z + O(1e-8) where z hardly moves.
      const double here = at_zero[l] * (alpha * s + beta * (1 - c)),
                   there = l > 0 ? l * at_zero[l - 1] / 2 : 0.0;
      for (int j = 0; j < count; ++j) {
        const double a = z0[j], b = slope0[j];
        const double line = here + there * (a * alpha * (T + s * c) + b * beta * (T - s * c) +
                                            (a * beta + b * alpha) * s * s);
        const Next next = step(j);
        const double whole = (p[j] * ((l + 1) * next.B + l * B_before[j]) +
                              q[j] * ((next.p1 - before1[j]) - (next.p0 - before0[j]))) /
                             odd;
        const double inverse_rho = a * a + b * b < kAcross ? line : whole;
        gx[j] += n.x * inverse_rho, gy[j] += n.y * inverse_rho, gz[j] += n.z * inverse_rho;
      }
    }
    for (int j = 0; j < count; ++j) {
      const Next next = step(j);
      value[j] += nz[j] * D[j] * share;
      const double D_next = D_before[j] + odd * B[j];
      D_before[j] = D[j], D[j] = D_next, B_before[j] = B[j], B[j] = next.B;
      before0[j] = p0[j], p0[j] = next.p0, before1[j] = p1[j], p1[j] = next.p1;
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
