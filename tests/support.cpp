#include "tests/support.h"
#include "tests/paths.h"

#include <cmath>

namespace zonal::test {

Scene scene_from(const std::string& json) {
  return parse_scene(json, test::source_dir() + "/tests/inline.json");
}

Scene bundled_scene(const std::string& name) {
  return load_scene(test::source_dir() + "/scenes/" + name + "/" + name + ".json");
}

Image render_with(const Scene& scene, const std::string& name, const RenderSpec& spec) {
  const auto integrator =
      find_integrator(name, "test").make(nlohmann::json::parse(spec.settings), "test", nullptr);
  Film film(spec.width, spec.height);
  render(scene, *integrator, film, {.passes = spec.passes},
         {.seed = spec.seed,
          .threads = spec.threads,
          .pixels = spec.jitter ? RenderOptions::Pixels::jitter : RenderOptions::Pixels::automatic});
  return film.radiance();
}

Estimate estimate(const std::vector<double>& values) {
  Estimate e{.samples = static_cast<int>(values.size())};
  for (double v : values) e.mean += v;
  e.mean /= e.samples;
  double squares = 0;
  for (double v : values) squares += (v - e.mean) * (v - e.mean);
  e.standard_error = std::sqrt(squares / (e.samples - 1) / e.samples);
  return e;
}

namespace {

/// Continued fraction of the incomplete beta function (Lentz's method; Abramowitz and Stegun 26.5.8).
double beta_fraction(double a, double b, double x) {
  const double tiny = 1e-300;
  double c = 1, d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < tiny ? tiny : d);
  double h = d;
  for (int m = 1; m < 500; ++m) {
    for (int part = 0; part < 2; ++part) {
      const double numerator = part == 0 ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                                         : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
      d = 1 + numerator * d;
      d = 1 / (std::abs(d) < tiny ? tiny : d);
      c = 1 + numerator / c;
      if (std::abs(c) < tiny) c = tiny;
      h *= d * c;
    }
    if (std::abs(d * c - 1) < 1e-14) break;
  }
  return h;
}

double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a
                                   : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

double two_sided_p(double t, double freedom) {
  return incomplete_beta(freedom / 2, 0.5, freedom / (freedom + t * t));
}

}  // namespace

double t_test_p(const Estimate& e, double truth) {
  const double difference = std::abs(e.mean - truth);
  if (e.standard_error == 0)
    return difference <= 1e-5 * std::abs(truth) ? 1 : 0;  // no scatter: equal to rounding, or wrong
  return two_sided_p(difference / e.standard_error, e.samples - 1);
}

double t_test_p(const Estimate& a, const Estimate& b) {
  const double va = a.standard_error * a.standard_error, vb = b.standard_error * b.standard_error;
  const double difference = std::abs(a.mean - b.mean);
  if (va + vb == 0) return difference <= 1e-5 * std::abs(b.mean) ? 1 : 0;
  const double freedom = (va + vb) * (va + vb) / (va * va / (a.samples - 1) + vb * vb / (b.samples - 1));
  return two_sided_p(difference / std::sqrt(va + vb), freedom);
}

}  // namespace zonal::test
