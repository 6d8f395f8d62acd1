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

Interval ratio_interval(const std::vector<double>& times, const std::vector<double>& others) {
  double mean[2] = {0, 0}, variance[2] = {0, 0};  // of the logarithm's mean
  const std::vector<double>* both[2] = {&times, &others};
  double satterthwaite = 0;
  for (int k = 0; k < 2; ++k) {
    const double n = static_cast<double>(both[k]->size());
    for (const double t : *both[k]) mean[k] += std::log(t) / n;
    if (n < 2) continue;
    for (const double t : *both[k])
      variance[k] += (std::log(t) - mean[k]) * (std::log(t) - mean[k]) / ((n - 1) * n);
    satterthwaite += variance[k] * variance[k] / (n - 1);
  }
  const double ratio = std::exp(mean[0] - mean[1]), sum = variance[0] + variance[1];
  if (!(satterthwaite > 0)) return {ratio, ratio, ratio};
  const int degrees = std::max(1, static_cast<int>(sum * sum / satterthwaite));
  const double half = student_95(degrees) * std::sqrt(2 * sum);
  return {ratio, ratio * std::exp(-half), ratio * std::exp(half)};
}

}  // namespace zonal
