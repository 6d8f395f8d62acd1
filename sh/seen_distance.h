#pragma once
/// Distance, direction and d^2 - r^2 between a point and a ball, exact to the last digits: close to the
/// ball's surface d^2 - r^2 is the difference of two nearly equal numbers. float is computed in double;
/// double carries its rounding errors along (Dekker's and Knuth's error-free sums and products). Needs a
/// build without reassociation.

#include <cmath>
#include <type_traits>

#include "sh/basis.h"

namespace zonal::sh {

struct SeenDistance {
  Vec3<double> axis{0, 0, 1};  ///< unit
  double d = 0, r = 0;         ///< times `scale`
  double h2 = 0;               ///< d^2 - r^2, times scale^2
  double scale = 1;            ///< a power of two, 1 unless squares would leave the range of double
};

/// 1, or the power of two that brings m near 1 where m^2 could overflow or lose digits. float's squares fit
/// in double.
template <class T>
inline double range_scale(double m) {
  if constexpr (std::is_same_v<T, float>) return 1;
  if ((m > 1e-60 && m < 1e60) || !(m > 0)) return 1;
  int e;
  std::frexp(m, &e);
  return std::ldexp(1.0, e < -1000 ? 1000 : -e);
}

/// A sum that keeps what it rounds away.
struct DoubleSum {
  double high = 0, low = 0;

  void add(double v) {
    const double s = high + v, t = s - high;
    low += (high - (s - t)) + (v - t);
    high = s;
  }
  void add_product(double a, double b) {
    const double p = a * b;
    add(p);
    low += std::fma(a, b, -p);
  }
};

template <class T>
inline SeenDistance seen_distance(const Vec3<T>& x, const Vec3<T>& y, T r) {
  SeenDistance s;
  if constexpr (std::is_same_v<T, float>) {
    const Vec3<double> w = Vec3<double>(y) - Vec3<double>(x);
    const double d2 = w.x * w.x + w.y * w.y + w.z * w.z;
    s.r = r, s.d = std::sqrt(d2), s.h2 = d2 - s.r * s.r;
    if (d2 > 0) s.axis = w * (1 / s.d);
    return s;
  } else {
    const double m =
        std::fmax(std::fmax(std::fabs(y.x - x.x), std::fabs(y.y - x.y)), std::fmax(std::fabs(y.z - x.z), r));
    s.scale = range_scale<double>(m);
    s.r = r * s.scale;
    Vec3<double> w;
    DoubleSum sum;
    for (int k = 0; k < 3; ++k) {
      DoubleSum difference;
      difference.add(y[k] * s.scale), difference.add(-x[k] * s.scale);
      w[k] = difference.high;
      sum.add_product(w[k], w[k]);
      sum.low += 2 * w[k] * difference.low;
    }
    const double d2 = sum.high + sum.low;
    sum.add_product(-s.r, s.r);
    s.h2 = sum.high + sum.low;
    s.d = std::sqrt(d2);
    if (d2 > 0) s.axis = w * (1 / s.d);
    return s;
  }
}

}  // namespace zonal::sh
