#include "integrators/hvl/hvl_bands.h"

#include "sh/tables.h"

namespace zonal::hvl {

Bands::Bands() {
  constexpr double pi = 3.14159265358979323846;
  for (int m = 0; m < kMaxBands; ++m) {
    // B[l - m]; 0 for l = m + 1, where the polynomial two bands below is not there.
    double B[kMaxBands + 1] = {}, at_pole[kMaxBands] = {1};
    for (int l = m + 2; l < kMaxBands; ++l) {
      const double k = double(l - 1) * (l - 1);
      B[l - m] = 4 * (k - double(m) * m) / (4 * k - 1);
    }
    for (int j = 1; m + j < kMaxBands; ++j)
      at_pole[j] = 2 * at_pole[j - 1] - (j > 1 ? B[j] * at_pole[j - 2] : 0);
    for (int j = 0; m + j < kMaxBands; ++j) {
      const int l = m + j, i = offset(m) + j;
      step_[i] = float(B[j]);
      norm_[i] = float(sh::tables<double>().column(m)[j].norm / at_pole[j]);
      if (j >= 2)
        even_step_[i] = float(B[j - 1] + B[j]), even_fall_[i] = float(j >= 4 ? B[j - 1] * B[j - 2] : 0);
      if (m == 0) legendre_[l] = float(1 / at_pole[j]);
      // g_l = 2 pi sin^2 a P_l'/(l(l+1)), and P_l'(1) = l(l+1)/2.
      if (m == 1) cap_[l] = float(pi / at_pole[j]);
    }
  }
  cap_[0] = float(2 * pi);
}

const Bands& Bands::table() {
  static const Bands bands;
  return bands;
}

}  // namespace zonal::hvl
