#include "sh/tables.h"

#include <cmath>
#include <numbers>

namespace zonal::sh {

namespace {

double rise(int l, int m) {
  return std::sqrt((4.0 * l * l - 1.0) / (double(l - m) * double(l + m)));
}

template <class T>
Tables<T> make_tables() {
  Tables<T> t;
  t.steps.resize(kMaxBands * (kMaxBands + 1) / 2);
  double start = std::sqrt(0.25 / std::numbers::pi);
  for (int m = 0; m < kMaxBands; ++m) {
    // X_m^m = -sqrt((2m+1)/(2m)) X_{m-1}^{m-1} with the square roots folded in, never (2m-1)!!; sqrt(2)
    // enters at m = 1.
    if (m > 0) start *= -std::sqrt((m == 1 ? 2.0 : 1.0) * (2.0 * m + 1.0) / (2.0 * m));
    t.start[m] = T(start);
    auto* column = const_cast<typename Tables<T>::Step*>(t.column(m));
    double before = 0, last = 1;  // q_{l-2} and q_{l-1} at the pole, over start
    for (int l = m; l < kMaxBands; ++l) {
      auto& step = column[l - m];
      step.rise = l > m ? T(rise(l, m)) : T(0);
      if (l > m + 1) {
        // The pole is where rounded constants hurt most: `fall` takes up the rounding of `rise` there.
        const double next = rise(l, m) * (last - before / rise(l - 1, m));
        step.fall = T((last - next / double(step.rise)) / before);
        before = last, last = next;
      } else if (l == m + 1) {
        before = 1, last = rise(l, m);
      }
      step.slope = T(std::sqrt(double(l + m + 1) * double(l - m) * (m == 0 ? 0.5 : 1.0)));
    }
  }
  return t;
}

}  // namespace

template <class T>
const Tables<T>& tables() {
  static const Tables<T> t = make_tables<T>();
  return t;
}

template const Tables<float>& tables();
template const Tables<double>& tables();

}  // namespace zonal::sh
