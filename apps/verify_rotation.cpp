// Golden files of rotation: every method of rotating has to give the same coefficients.
#include <fmt/format.h>

#include "apps/verify_kinds.h"
#include "sh/rotation.h"

namespace zonal {
namespace {

/// w, x, y, z, without overflow or underflow when it is normalised.
template <class T>
glm::qua<T> quaternion(const std::vector<double>& wxyz) {
  return glm::qua<T>(T(wxyz[0]), T(wxyz[1]), T(wxyz[2]), T(wxyz[3]));
}

template <class T>
sh::Mat3<T> matrix(const std::vector<double>& wxyz) {
  double largest = 0;
  for (double x : wxyz) largest = std::max(largest, std::abs(x));
  const glm::dquat q = quaternion<double>(wxyz) / largest;
  return sh::Mat3<T>(glm::mat3_cast(glm::normalize(q)));
}

}  // namespace

void verify_rotations(const Golden& file, Report& report) {
  for (const Golden& c : file.objects("cases")) {
    const std::string label = label_of(c, report.cases++);
    const std::vector<double> q = c.numbers("quat_wxyz", 4);
    if (q == std::vector<double>(4, 0)) c.fail("quat_wxyz", "found the zero quaternion, expected a rotation");
    const std::vector<double> coeffs = c.numbers("coeffs");
    const std::vector<double> rotated = c.numbers("rotated", coeffs.size());
    const int bands = c.bands("coeffs", coeffs.size());

    for (const Precision p : kPrecisions) {
      const std::vector<double> q_seen = seen(p, q), in = seen(p, coeffs), back = seen(p, rotated);
      if (!held(in) || !held(back) || !held(q_seen) || q_seen == std::vector<double>(4, 0)) continue;
      report.check(p, "rotated", label, rotated, [&](auto zero) {
        using T = decltype(zero);
        std::vector<T> out(in.size());
        sh::Rotation<T>(bands, quaternion<T>(q_seen)).apply(as<T>(in).data(), out.data());
        return out;
      });
      report.check(p, "rotated by zxzxz", label, rotated, [&](auto zero) {
        using T = decltype(zero);
        std::vector<T> out(in.size());
        sh::rotate_zxzxz(bands, matrix<T>(q_seen), as<T>(in).data(), out.data());
        return out;
      });
      report.check(p, "rotated back", label, coeffs, [&](auto zero) {
        using T = decltype(zero);
        std::vector<T> out(in.size());
        sh::Rotation<T>(bands, quaternion<T>(q_seen)).apply_inverse(as<T>(back).data(), out.data());
        return out;
      });

      if (!c.has("zonal_rotated_of_unit")) continue;
      const std::vector<double> zonal = c.numbers("zonal_rotated_of_unit");
      const int zonal_bands = c.bands("zonal_rotated_of_unit", zonal.size());
      const dvec3 axis = seen(p, matrix<double>(q_seen)[2]);
      report.check(p, "zonal_rotated_of_unit", label, zonal, [&](auto zero) {
        using T = decltype(zero);
        const std::vector<T> ones(zonal_bands, T(1));
        std::vector<T> out(zonal.size());
        sh::rotate_zonal(zonal_bands, sh::normalized(sh::Vec3<T>(axis)), ones.data(), out.data());
        return out;
      });
    }
  }
}

}  // namespace zonal
