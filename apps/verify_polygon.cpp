// Golden files of polygonal lights: coefficients, solid angle, and their gradients for a moving point.
#include <fmt/format.h>

#include "apps/verify_kinds.h"
#include "sh/polygon.h"
#include "sh/solid_angle.h"

namespace zonal {
namespace {

template <class T>
std::vector<sh::Vec3<T>> vertices_of(const std::vector<double>& flat) {
  std::vector<sh::Vec3<T>> vertices;
  for (size_t i = 0; i < flat.size(); i += 3)
    vertices.emplace_back(T(flat[i]), T(flat[i + 1]), T(flat[i + 2]));
  return vertices;
}

/// One rounding of a double. Both precisions are computed in double.
constexpr double kDelta = 0x1p-53;

/// How much the solid angle's gradient changes when every vertex moves by one rounding: edges of a narrow or
/// far polygon cancel, and one that passes x closely turns with it.
double solid_angle_condition(const std::vector<dvec3>& v, const dvec3& x) {
  double sum = 0;
  for (size_t i = 0; i < v.size(); ++i) {
    const dvec3 a = v[i] - x, b = v[(i + 1) % v.size()] - x;
    const double length_a = std::hypot(a.x, a.y, a.z), length_b = std::hypot(b.x, b.y, b.z);
    const dvec3 u = a / length_a, w = b / length_b;
    const double tangent2 =
        glm::dot(u - w, u - w) / glm::dot(u + w, u + w);  // of half the angle between them
    if (std::isfinite(tangent2)) sum += (1 / length_a + 1 / length_b) * (1 + tangent2);
  }
  return 2 * kDelta * sum;
}

/// Relative change of the area vector when the differences of vertices are rounded: a rounding of the
/// farthest against the polygon's height.
double area_condition(const std::vector<dvec3>& v, const dvec3& x) {
  double farthest = 0, longest = 0;
  dvec3 area(0);
  for (size_t i = 0; i < v.size(); ++i) {
    const dvec3 p = v[i] - x, edge = v[(i + 1) % v.size()] - v[i];
    farthest = std::max(farthest, std::hypot(p.x, p.y, p.z));
    longest = std::max(longest, std::hypot(edge.x, edge.y, edge.z));
    if (i >= 2) area += glm::cross(v[i - 1] - v[0], v[i] - v[0]);
  }
  const double height = std::hypot(area.x, area.y, area.z) / longest;
  return !(height > 0) ? 0 : 4 * kDelta * farthest / height;
}

double largest(const std::vector<double>& values) {
  double m = 0;
  for (double x : values) m = std::max(m, std::abs(x));
  return m;
}

}  // namespace

void verify_polygons(const Golden& file, Report& report) {
  for (const Golden& c : file.objects("cases")) {
    const std::string label = label_of(c, report.cases++);
    const dvec3 x = c.point("x");
    const std::vector<double> corners = c.numbers("vertices", 0, 3);
    const int n = static_cast<int>(corners.size() / 3);
    if (n < 3) c.fail("vertices", fmt::format("found {} vertices, expected three or more", n));
    const std::vector<double> coeffs = c.numbers("coeffs");
    const int bands = c.bands("coeffs", coeffs.size());

    for (const Precision p : kPrecisions) {
      const dvec3 x_seen = seen(p, x);
      const std::vector<double> corners_seen = seen(p, corners);
      if (!held(corners_seen) || !held(components(x_seen))) continue;
      report.check(p, "coeffs", label, coeffs, [&](auto zero) {
        using T = decltype(zero);
        std::vector<T> L(coeffs.size());
        sh::polygon_light(bands, n, vertices_of<T>(corners_seen).data(), sh::Vec3<T>(x_seen), L.data());
        return L;
      });
      if (c.has("grad_x_coeffs")) {
        const std::vector<double> grad = c.numbers("grad_x_coeffs", coeffs.size(), 3);
        const auto gradient_of = [&](auto zero) {
          using T = decltype(zero);
          std::vector<T> L(coeffs.size());
          std::vector<sh::Vec3<T>> gradient(coeffs.size());
          sh::polygon_light(bands, n, vertices_of<T>(corners_seen).data(), sh::Vec3<T>(x_seen), L.data(),
                            gradient.data());
          return flat(gradient);
        };
        report.check(p, "grad_x_coeffs", label, grad, gradient_of,
                     largest(grad) * area_condition(vertices_of<double>(corners_seen), x_seen));
      }
      if (c.has("signed_solid_angle"))
        report.check(p, "signed_solid_angle", label, {c.number("signed_solid_angle")}, [&](auto zero) {
          using T = decltype(zero);
          return std::vector{
              sh::polygon_solid_angle(n, vertices_of<T>(corners_seen).data(), sh::Vec3<T>(x_seen))};
        });
      if (c.has("grad_x_signed_solid_angle"))
        report.check(
            p, "grad_x_signed_solid_angle", label, c.numbers("grad_x_signed_solid_angle", 3),
            [&](auto zero) {
              using T = decltype(zero);
              sh::Vec3<T> gradient(0);
              sh::polygon_solid_angle(n, vertices_of<T>(corners_seen).data(), sh::Vec3<T>(x_seen), &gradient);
              return components(gradient);
            },
            solid_angle_condition(vertices_of<double>(corners_seen), x_seen));
    }
  }
}

}  // namespace zonal
