#include "sh/tables.h"

#include <cmath>
#include <numbers>

namespace zonal::sh {

namespace {

template <class T>
Tables<T> make_tables() {
  Tables<T> t{};
  double start = std::sqrt(0.25 / std::numbers::pi);
  for (int m = 0; m < kMaxBands; ++m) {
    // X_m^m = -sqrt((2m+1)/(2m)) X_{m-1}^{m-1} with the square roots folded in, never (2m-1)!!; sqrt(2)
    // enters at m = 1.
    if (m > 0) start *= -std::sqrt((m == 1 ? 2.0 : 1.0) * (2.0 * m + 1.0) / (2.0 * m));
    double norm = start;
    for (int l = m; l < kMaxBands; ++l) {
      const double below = l - m, above = l + m;
      if (l > m) norm *= std::sqrt((2 * l + 1.0) / (2 * l - 1.0) * (above / below));
      // At the pole the derivative of the Legendre function's m-th derivative is (l-m)(l+m+1) / (2(m+1))
      // times itself.
      const double slope = norm * below * (above + 1) / (2 * (m + 1));
      const double curve = slope * (below - 1) * (above + 2) / (2 * (m + 2));
      t.steps[t.offset(m) + l - m] = {l > m ? T((2 * l - 1) / above) : T(0),
                                      l > m ? T((below - 1) / above) : T(0), T(norm), T(slope), T(curve)};
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
