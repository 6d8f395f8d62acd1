// Golden files of spheres and disks, of GGX lobes and of point lights' attenuation.
#include <fmt/format.h>

#include "apps/verify_kinds.h"
#include "core/json_fields.h"
#include "sh/attenuation.h"
#include "sh/disk_light.h"
#include "sh/ggx_lobe.h"
#include "sh/sphere_light.h"

namespace zonal {
namespace {

constexpr int kMostBands = sh::kMaxBands;

int zonal_bands(const Golden& c, const char* key, size_t size) {
  if (size > kMostBands)
    c.fail(key, fmt::format("found {} values, expected one a band, at most {}", size, kMostBands));
  return static_cast<int>(size);
}

/// Zonal coefficients by radius and distance.
void verify_zonal(const Golden& c, const std::string& label, Report& report) {
  const double r = c.positive("r"), d = c.positive("d");
  const std::vector<double> zh = c.numbers("zh");
  const int bands = zonal_bands(c, "zh", zh.size());
  for (const Precision p : kPrecisions) {
    const double r_seen = seen(p, r), d_seen = seen(p, d);
    if (!held(r_seen) || !held(d_seen)) continue;
    report.check(p, "zh", label, zh, [&](auto zero) {
      using T = decltype(zero);
      std::vector<T> z(bands);
      sh::sphere_light_zonal<T>(bands, T(d_seen), T(r_seen), z.data());
      return z;
    });
    if (!c.has("dzh_dd")) continue;
    report.check(p, "dzh_dd", label, c.numbers("dzh_dd", bands), [&](auto zero) {
      using T = decltype(zero);
      std::vector<T> z(bands), dz(bands);
      sh::sphere_light_zonal<T>(bands, T(d_seen), T(r_seen), z.data(), dz.data());
      return dz;
    });
  }
}

/// Coefficients and gradient of a sphere or disk at y seen from x.
void verify_light(const Golden& c, const std::string& label, Report& report) {
  const std::string kind = c.text("kind", "sphere");
  if (kind != "sphere" && kind != "disk")
    c.fail("kind", fmt::format("found {}, expected \"sphere\" or \"disk\"", in_quotes(kind)));
  const dvec3 x = c.point("x"), y = c.point("y");
  const double r = c.positive("r");
  const std::vector<double> coeffs = c.numbers("coeffs");
  const int bands = c.bands("coeffs", coeffs.size());
  for (const Precision p : kPrecisions) {
    const dvec3 x_seen = seen(p, x), y_seen = seen(p, y);
    const double r_seen = seen(p, r);
    if (!held(r_seen) || !held(components(x_seen)) || !held(components(y_seen))) continue;
    // The first bands alone as well: few bands take another way than many.
    for (int n = 1; n <= bands; ++n) {
      report.check(p, "coeffs", label, {coeffs.begin(), coeffs.begin() + sh::count(n)}, [&](auto zero) {
        using T = decltype(zero);
        std::vector<T> L(sh::count(n));
        (kind == "disk" ? sh::disk_light<T> : sh::sphere_light<T>)(n, sh::Vec3<T>(x_seen),
                                                                   sh::Vec3<T>(y_seen), T(r_seen), L.data());
        return L;
      });
    }
    if (!c.has("grad_x")) continue;
    report.check(p, "grad_x", label, c.numbers("grad_x", coeffs.size(), 3), [&](auto zero) {
      using T = decltype(zero);
      std::vector<T> L(sh::count(bands));
      std::vector<sh::Vec3<T>> gradient(sh::count(bands));
      (kind == "disk" ? sh::disk_light_gradient<T>
                      : sh::sphere_light_gradient<T>)(bands, sh::Vec3<T>(x_seen), sh::Vec3<T>(y_seen),
                                                      T(r_seen), L.data(), gradient.data());
      return flat(gradient);
    });
  }
}

}  // namespace

void verify_sphere_and_disk(const Golden& file, Report& report) {
  size_t index = 0;
  if (file.has("cases"))
    for (const Golden& c : file.objects("cases")) verify_zonal(c, label_of(c, index++), report);
  report.cases += index, index = 0;
  if (file.has("sh_cases"))
    for (const Golden& c : file.objects("sh_cases")) verify_light(c, label_of(c, index++, "sh_case"), report);
  report.cases += index;
}

void verify_ggx(const Golden& file, Report& report) {
  constexpr std::pair<const char*, sh::GgxLobe> kLobes[] = {
      {"ndf", sh::GgxLobe::ndf},
      {"ndf_cos", sh::GgxLobe::ndf_cos},
      {"reflect_normal_incidence", sh::GgxLobe::reflect_normal_incidence}};
  for (const Golden& c : file.objects("cases")) {
    const double alpha = c.positive("alpha");
    if (alpha < 1e-6 || alpha > 1)
      c.fail("alpha", fmt::format("found {}, expected a number in [1e-6, 1]", alpha));
    const std::string label = fmt::format("case {} alpha {}", report.cases++, alpha);
    for (const auto& [key, lobe] : kLobes) {
      if (!c.has(key)) continue;
      const std::vector<double> truth = c.numbers(key);
      const int bands = zonal_bands(c, key, truth.size());
      for (const Precision p : kPrecisions) {
        // float(1e-6) lies below 1e-6.
        const double alpha_seen = std::max(seen(p, alpha), 1e-6);
        report.check(p, key, label, truth, [&](auto zero) {
          using T = decltype(zero);
          std::vector<T> z(bands);
          sh::ggx_zonal<T>(bands, lobe, T(alpha_seen), z.data());
          return z;
        });
      }
    }
  }
}

void verify_attenuation(const Golden& file, Report& report) {
  for (const Golden& c : file.objects("cases")) {
    const std::string label = label_of(c, report.cases++);
    const dvec3 w = c.point("y") - c.point("x");
    const double r = c.positive("r");
    // The vector to the light is the function's input, so that is what gets rounded.
    for (const Precision p : kPrecisions) {
      const dvec3 w_seen = seen(p, w);
      const double r_seen = seen(p, r);
      if (!held(r_seen) || !held(w_seen)) continue;
      const auto yuksel = [&](auto zero) {
        return sh::yuksel(sh::Vec3<decltype(zero)>(w_seen), decltype(zero)(r_seen));
      };
      const auto inverse = [&](auto zero) { return sh::inverse_square(sh::Vec3<decltype(zero)>(w_seen)); };
      report.check(p, "attenuation", label, {c.number("attenuation")},
                   [&](auto zero) { return std::vector{yuksel(zero).value}; });
      if (c.has("grad_x"))
        report.check(p, "grad_x", label, c.numbers("grad_x", 3),
                     [&](auto zero) { return components(yuksel(zero).gradient); });
      if (c.has("inv_sq"))
        report.check(p, "inv_sq", label, {c.number("inv_sq")},
                     [&](auto zero) { return std::vector{inverse(zero).value}; });
      if (c.has("grad_x_inv_sq"))
        report.check(p, "grad_x_inv_sq", label, c.numbers("grad_x_inv_sq", 3),
                     [&](auto zero) { return components(inverse(zero).gradient); });
    }
  }
}

}  // namespace zonal
