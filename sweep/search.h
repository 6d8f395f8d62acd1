#pragma once
/// Finds the count (lights, passes, samples) whose time or error is the wanted one.
///
///     auto found = search_count([&](int lights) { return seconds_with(lights); }, 0.5, {.first = 400});
///
/// Time and error are near powers of a count, so the search is a secant in logarithms, kept inside the
/// bracket once there is one.

#include <functional>
#include <vector>

namespace zonal {

struct SearchOptions {
  int first = 100;              ///< where to start
  int low = 1, high = 1 << 24;  ///< allowed counts
  double slope = 1;         ///< expected d ln(value) / d ln(count): 1 for time, -0.5 for the error of a mean
  double tolerance = 0.05;  ///< relative
  int most_runs = 6;
};

struct SearchResult {
  int count = 0;         ///< the one measured nearest to the target
  double value = 0;      ///< measured there
  bool reached = false;  ///< within the tolerance
  struct Run {
    int count;
    double value;
  };
  std::vector<Run> runs;
};

/// `measure` returns a positive number, or NaN to give up (the search ends with what it has).
SearchResult search_count(const std::function<double(int)>& measure, double target,
                          const SearchOptions& options);

}  // namespace zonal
