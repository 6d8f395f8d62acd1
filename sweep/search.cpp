#include "sweep/search.h"

#include <algorithm>
#include <cmath>

namespace zonal {
namespace {

using Run = SearchResult::Run;

double distance(const Run& run, double target) {
  return std::fabs(std::log(run.value / target));
}

/// The next count to try: on the line through two measured points, else along the expected slope.
double next_count(const std::vector<Run>& runs, double target, double expected) {
  const Run* below = nullptr;  // the nearest counts on either side of the target
  const Run* above = nullptr;
  for (const Run& run : runs) {
    const bool low = (run.value < target) == (expected > 0);
    if (low && (!below || run.count > below->count)) below = &run;
    if (!low && (!above || run.count < above->count)) above = &run;
  }
  const Run *a = below, *b = above;
  if (!a || !b) {
    // Not bracketed yet: the last two points tell the slope, within reason, since noise may turn it.
    const Run& last = runs.back();
    double slope = expected;
    if (runs.size() > 1) {
      const Run& before = runs[runs.size() - 2];
      slope = std::log(last.value / before.value) / std::log(double(last.count) / before.count);
      slope = std::clamp(slope / expected, 0.2, 2.0) * expected;
    }
    return last.count * std::exp(std::clamp(std::log(target / last.value) / slope, -4.0, 4.0));
  }
  const double span = std::log(b->value / a->value);
  const double share = std::fabs(span) > 1e-9 ? std::log(target / a->value) / span : 0.5;
  return a->count * std::pow(double(b->count) / a->count, std::clamp(share, 0.02, 0.98));
}

}  // namespace

SearchResult search_count(const std::function<double(int)>& measure, double target,
                          const SearchOptions& options) {
  SearchResult result;
  int count = std::clamp(options.first, options.low, options.high);
  while (static_cast<int>(result.runs.size()) < options.most_runs) {
    const double value = measure(count);
    if (!(value > 0)) break;
    result.runs.push_back({count, value});
    if (std::fabs(value / target - 1) <= options.tolerance) break;
    const double next = std::round(next_count(result.runs, target, options.slope));
    count = static_cast<int>(std::clamp(next, double(options.low), double(options.high)));
    // Measured already: counts are whole numbers, nothing lies between.
    const auto same = [&](const Run& run) { return run.count == count; };
    if (std::any_of(result.runs.begin(), result.runs.end(), same)) break;
  }
  if (result.runs.empty()) return result;
  const auto best = std::min_element(result.runs.begin(), result.runs.end(), [&](const Run& a, const Run& b) {
    return distance(a, target) < distance(b, target);
  });
  result.count = best->count, result.value = best->value;
  result.reached = std::fabs(best->value / target - 1) <= options.tolerance;
  return result;
}

}  // namespace zonal
