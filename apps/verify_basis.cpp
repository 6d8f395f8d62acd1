// Golden files of the basis and its gradient.
#include <algorithm>

#include "apps/verify_kinds.h"

namespace zonal {
namespace {

/// A row [l, m, value] of `high`.
struct HighValue {
  int index;
  double value;
};

std::vector<HighValue> high_values(const Golden& golden_case, int* bands) {
  std::vector<HighValue> all;
  const std::vector<double> rows = golden_case.numbers("high", 0, 3);
  for (size_t i = 0; i < rows.size(); i += 3) {
    const double l = rows[i], m = rows[i + 1];
    if (l != std::floor(l) || m != std::floor(m) || l < 0 || l >= sh::kMaxBands || std::abs(m) > l)
      golden_case.fail("high", "expected rows [l, m, value] with 0 <= l <= 100 and |m| <= l");
    *bands = std::max(*bands, static_cast<int>(l) + 1);
    all.push_back({sh::index(static_cast<int>(l), static_cast<int>(m)), rows[i + 2]});
  }
  return all;
}

template <class T>
std::vector<T> basis(int bands, const dvec3& unit) {
  std::vector<T> Y(sh::count(bands));
  sh::evaluate(bands, sh::Vec3<T>(unit), Y.data());
  return Y;
}

/// d/|d| as this precision holds it. What its rounding costs is not the evaluation's fault: near a pole,
/// where dY_l^0/dz = sqrt((2l+1)/4pi) l(l+1)/2, half a float's last digit of z is 1e-5 at l = 20.
dvec3 unit_direction(Precision p, const dvec3& d) {
  return p == Precision::kFloat ? dvec3(sh::normalized(sh::Vec3<float>(d))) : sh::normalized(d);
}

}  // namespace

void verify_basis(const Golden& file, Report& report) {
  for (const Golden& c : file.objects("cases")) {
    const std::string label = label_of(c, report.cases++);
    const dvec3 d = c.direction("d");
    const std::vector<double> Y = c.numbers("Y");
    const int bands = c.bands("Y", Y.size());
    int high_bands = 1;
    const std::vector<HighValue> high =
        c.has("high") ? high_values(c, &high_bands) : std::vector<HighValue>();
    std::vector<double> high_truth;
    for (const HighValue& h : high) high_truth.push_back(h.value);

    for (const Precision p : kPrecisions) {
      const dvec3 rounded = seen(p, d);
      if (!held(rounded)) continue;
      if (p == Precision::kFloat)
        report.check(p, "unit d", label, components(sh::normalized(d)), [&](auto zero) {
          return components(sh::normalized(sh::Vec3<decltype(zero)>(rounded)));
        });
      const dvec3 unit = unit_direction(p, rounded);
      report.check(p, bands <= 21 ? "Y" : "high", label, Y,
                   [&](auto zero) { return basis<decltype(zero)>(bands, unit); });
      // Few bands may take another way than many.
      for (int n = 1; n <= 10 && n < bands; ++n) {
        report.check(p, "Y", label, {Y.begin(), Y.begin() + sh::count(n)},
                     [&](auto zero) { return basis<decltype(zero)>(n, unit); });
      }
      if (high.empty()) continue;
      report.check(p, "high", label, high_truth, [&](auto zero) {
        using T = decltype(zero);
        const std::vector<T> all = basis<T>(high_bands, unit);
        std::vector<T> picked;
        for (const HighValue& h : high) picked.push_back(all[h.index]);
        return picked;
      });
    }
  }
}

void verify_gradient(const Golden& file, Report& report) {
  for (const Golden& c : file.objects("cases")) {
    const std::string label = label_of(c, report.cases++);
    const dvec3 d = c.direction("d");
    const std::vector<double> grad = c.numbers("grad", 0, 3);
    const int bands = c.bands("grad", grad.size() / 3);
    for (const Precision p : kPrecisions) {
      const dvec3 rounded = seen(p, d);
      if (!held(rounded)) continue;
      report.check(p, "grad", label, grad, [&](auto zero) {
        using T = decltype(zero);
        std::vector<T> Y(sh::count(bands));
        std::vector<sh::Vec3<T>> gradient(sh::count(bands));
        sh::evaluate_gradient(bands, sh::Vec3<T>(rounded), Y.data(), gradient.data());
        return flat(gradient);
      });
    }
  }
}

}  // namespace zonal
