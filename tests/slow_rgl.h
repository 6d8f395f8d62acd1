#pragma once
/// RGL's evaluation once more, slowly: what materials/rgl is tested against.

#include <algorithm>
#include <cmath>
#include <vector>

#include "materials/tensor_file.h"
#include "tests/measured_files.h"

namespace zonal::test {

/// The evaluation by the format's definition, in double: materials/rgl.h's equation, one integral after the
/// other.
class SlowRgl {
 public:
  explicit SlowRgl(const TensorFile& file) {
    const auto load = [&](const char* name) { return file.floats(*file.find(name)); };
    theta_ = load("theta_i"), phi_ = load("phi_i");
    ndf_ = grid(file, "ndf"), sigma_ = grid(file, "sigma"), vndf_ = grid(file, "vndf"),
    rgb_ = grid(file, "rgb");
    luminance_ = grid(file, "luminance");
    isotropic_ = phi_.size() <= 2;
  }
  struct Value {
    Vec f_cos;
    double density;  ///< of the data's own sampling
  };
  Value operator()(Vec wo, Vec wi) const {  // wo indexes
    const Vec m = glm::normalize(wo + wi);
    const double phi_o = std::atan2(wo.y, wo.x);
    double phi_m = std::atan2(m.y, m.x) - (isotropic_ ? phi_o : 0);
    phi_m -= 2 * kPiDouble * std::floor((phi_m + kPiDouble) / (2 * kPiDouble));
    const double um = std::sqrt(2 * std::acos(m.z) / kPiDouble), vm = (phi_m + kPiDouble) / (2 * kPiDouble);
    const double uo = std::sqrt(2 * std::acos(wo.z) / kPiDouble), vo = (phi_o + kPiDouble) / (2 * kPiDouble);
    const auto slices = mix(std::acos(wo.z), phi_o);

    SlowWarp vndf = blend(vndf_, slices, 1, 0), luminance = blend(luminance_, slices, 1, 0);
    const glm::dvec2 s = vndf.invert(um, vm);
    Value v;
    for (int k = 0; k < 3; ++k)
      v.f_cos[k] =
          std::max(blend(rgb_, slices, 3, k).at(s.x, s.y), 0.0) * ndf_.at(um, vm) / (4 * sigma_.at(uo, vo));
    const double jacobian = 2 * kPiDouble * kPiDouble * um * std::sin(std::acos(m.z)) * 4 * glm::dot(m, wo);
    v.density = vndf.density(um, vm) * luminance.density(s.x, s.y) / jacobian;
    return v;
  }

 private:
  struct Share {
    size_t slice;
    double weight;
  };
  std::vector<float> theta_, phi_;
  SlowWarp ndf_, sigma_, vndf_, luminance_, rgb_;  // the last three: all slices one below the other
  bool isotropic_;

  static SlowWarp grid(const TensorFile& file, const char* name) {
    const TensorField& field = *file.find(name);
    const std::vector<float> values = file.floats(field);
    const size_t n = field.shape.size();
    return {int(field.shape[n - 1]), int(field.shape[n - 2]), {values.begin(), values.end()}};
  }
  static void interval(const std::vector<float>& knots, double x, size_t* first, double* second) {
    *first = 0, *second = 0;
    if (knots.size() < 2) return;
    while (*first + 2 < knots.size() && x >= double(knots[*first + 1])) ++*first;
    *second = std::clamp((x - knots[*first]) / (double(knots[*first + 1]) - knots[*first]), 0.0, 1.0);
  }
  std::vector<Share> mix(double theta, double phi) const {
    size_t t, p;
    double wt, wp;
    interval(theta_, theta, &t, &wt), interval(phi_, phi, &p, &wp);
    std::vector<Share> shares;
    for (size_t i = 0; i < 2; ++i)
      for (size_t j = 0; j < 2; ++j)
        if (const double w = (i ? wp : 1 - wp) * (j ? wt : 1 - wt); w > 0)
          shares.push_back({(p + i) * theta_.size() + t + j, w});
    return shares;
  }
  /// Densities are blended after each slice's integral has been made 1, colours as they are.
  static SlowWarp blend(const SlowWarp& all, const std::vector<Share>& shares, size_t channels,
                        size_t channel) {
    const size_t area = size_t(all.width) * size_t(all.height);
    SlowWarp sum{all.width, all.height, std::vector<double>(area, 0.0)};
    for (const Share& share : shares) {
      const auto from = all.values.begin() + std::ptrdiff_t((share.slice * channels + channel) * area);
      SlowWarp one{all.width, all.height, std::vector<double>(from, from + std::ptrdiff_t(area))};
      const double norm = channels == 1 ? 1 / one.area(1) : 1.0;
      for (size_t i = 0; i < area; ++i) sum.values[i] += share.weight * norm * one.values[i];
    }
    return sum;
  }
};

}  // namespace zonal::test
