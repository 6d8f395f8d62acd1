#pragma once
/// What several test files share: scenes from text, pictures from a method's name, and statistics that decide.

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "core/render.h"
#include "core/scene_loader.h"
#include "integrators/table.h"

namespace zonal::test {

/// A scene from JSON text; relative paths start at the tests folder.
Scene scene_from(const std::string& json);

/// Renders with the method `name`. `settings` is JSON text such as R"({"lights": 50})".
struct RenderSpec {
  std::string settings = "{}";
  int passes = 1, width = 16, height = 16, threads = 2;
  uint64_t seed = 0;
  bool jitter = false;  ///< also with one pass
};
Image render_with(const Scene& scene, const std::string& name, const RenderSpec& spec);

/// Mean of a value over `samples` independent estimates, and its standard error.
struct Estimate {
  double mean = 0, standard_error = 0;
  int samples = 0;
};
Estimate estimate(const std::vector<double>& values);

/// Two-sided probability that `estimate` lies at least this far from `truth` by chance (Student's t).
double t_test_p(const Estimate& estimate, double truth);
/// The same for two estimates of one quantity (Welch).
double t_test_p(const Estimate& a, const Estimate& b);

/// A fixed analytic scene bundled with the project: "furnace", "sphere_over_plane" or "box_lit_by_sphere".
Scene bundled_scene(const std::string& name);

}  // namespace zonal::test

namespace zonal {
/// How GoogleTest names a row in its reports.
inline void PrintTo(const IntegratorRow& row, std::ostream* out) { *out << row.name; }
}  // namespace zonal
