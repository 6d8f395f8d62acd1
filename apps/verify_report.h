#pragma once
/// Collects deviations of one golden-vector file: computes a quantity in either precision, finds its truth
/// and its tolerance, keeps the worst.
///
///     Report report("sh_basis");
///     report.check("Y", {label}, golden, condition, [&](auto zero) {
///       using T = decltype(zero);
///       std::vector<T> Y(441);
///       sh::evaluate(21, round_to<T>(d), Y.data());
///       return Y;
///     });

#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "apps/verify.h"
#include "apps/verify_tolerances.h"

namespace zonal {

/// The precision a check runs in: inputs are rounded to float for the float path, whose truth is the double
/// path at the same rounded inputs.
enum class Precision { kFloat, kDouble };

/// `x` as the path of this precision sees it.
inline double seen(Precision p, double x) {
  return p == Precision::kFloat ? static_cast<float>(x) : x;
}

class Report {
 public:
  explicit Report(std::string kind) : kind_(std::move(kind)) {}

  /// Runs `compute(T{})`, which returns std::vector<T>, in precision `p`. `label` names the case. `golden` is
  /// the file's truth. `condition` (absolute) is added to the tolerance where the table says so.
  template <class Compute>
  void check(Precision p, const char* quantity, const std::string& label, const std::vector<double>& golden,
             Compute compute, double condition = 0) {
    if (p == Precision::kDouble) return compare(p, quantity, label, compute(double{}), golden, condition);
    const std::vector<float> got = compute(float{});
    compare(p, quantity, label, std::vector<double>(got.begin(), got.end()), compute(double{}), condition);
  }

  /// Also for results that were computed elsewhere.
  void compare(Precision p, const char* quantity, const std::string& label, const std::vector<double>& got,
               const std::vector<double>& truth, double condition = 0);

  std::vector<Deviation> in_float, in_double;
  size_t cases = 0;

 private:
  std::string kind_;
};

}  // namespace zonal
