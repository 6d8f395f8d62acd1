#include "sweep/statistics.h"

#include <algorithm>
#include <cmath>

namespace zonal {

double median(std::vector<double> values) {
  const size_t half = values.size() / 2;
  std::nth_element(values.begin(), values.begin() + half, values.end());
  if (values.size() % 2 == 1) return values[half];
  return 0.5 * (values[half] + *std::max_element(values.begin(), values.begin() + half));
}

double student_95(int degrees) {
  // Up to 4 degrees from the tables; from there the expansion of the quantile in 1/degrees about the normal
  // one (Abramowitz and Stegun 26.7.5) is right to 4 digits.
  constexpr double kTable[] = {12.7062047, 4.3026527, 3.1824463, 2.7764451};
  if (degrees <= 4) return kTable[std::max(degrees, 1) - 1];
  const double x = 1.959963985, n = degrees, x2 = x * x;
  const double g1 = x * (x2 + 1) / 4, g2 = x * ((5 * x2 + 16) * x2 + 3) / 96;
  const double g3 = x * (((3 * x2 + 19) * x2 + 17) * x2 - 15) / 384;
  const double g4 = x * ((((79 * x2 + 776) * x2 + 1482) * x2 - 1920) * x2 - 945) / 92160;
  return x + (g1 + (g2 + (g3 + g4 / n) / n) / n) / n;
}

Interval student_interval(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) squares += (v - mean) * (v - mean);
  if (values.size() < 2) return {mean, mean, mean};
  const double half = student_95(static_cast<int>(values.size()) - 1) * std::sqrt(squares / (n - 1) / n);
  return {mean, mean - half, mean + half};
}

}  // namespace zonal
