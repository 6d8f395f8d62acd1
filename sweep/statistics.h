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
/// Mean of at least one value with its 95 % confidence interval, supposing normal scatter.
Interval student_interval(const std::vector<double>& values);

}  // namespace zonal
