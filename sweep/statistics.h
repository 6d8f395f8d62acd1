#pragma once
/// What several runs or seeds say together.
///
///     const Interval time = student_interval({5.1, 5.0, 5.3});   // mean and its 95 % confidence interval

#include <vector>

namespace zonal {

struct Interval {
  double mean = 0, low = 0, high = 0;  ///< low = high = mean from a single value
};

double median(std::vector<double> values);  ///< of at least one value
/// Half width of a two-sided 95 % interval in standard errors, `degrees` >= 1 (Student 1908).
double student_95(int degrees);
/// Ratio of the (geometric) mean of `times` to that of `others`, all > 0, and the interval in which the ratio
/// of another such measurement falls in 95 % of cases: Welch's t on logarithms, wider than a confidence
/// interval by sqrt(2), since the other measurement scatters as much.
Interval ratio_interval(const std::vector<double>& times, const std::vector<double>& others);
/// Mean of at least one value with its 95 % confidence interval, supposing normal scatter.
Interval student_interval(const std::vector<double>& values);

}  // namespace zonal
