#include "sh/tables.h"

#include <cmath>
#include <memory>
#include <numbers>

#include "sh/basis_rows.h"

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

namespace rows {

template <class T>
const RowTables<T>& row_tables() {
  static const std::unique_ptr<const RowTables<T>> shared = [] {
    auto t = std::make_unique<RowTables<T>>();
    constexpr int W = kWidth<T>;
    for (int m = 0; m < kMaxBands; ++m) {
      for (int l = m; l < kMaxBands; ++l) {
        const Step<T>& step = tables<T>().column(m)[l - m];
        auto& entry = t->entries[l][m / W];
        entry.rise[m % W] = step.rise;
        entry.fall[m % W] = step.fall;
        entry.norm[m % W] = step.norm;
        entry.slope[m % W] = step.slope;
      }
    }
    return t;
  }();
  return *shared;
}

template const RowTables<float>& row_tables();
template const RowTables<double>& row_tables();

}  // namespace rows

template const Tables<float>& tables();
template const Tables<double>& tables();

}  // namespace zonal::sh
