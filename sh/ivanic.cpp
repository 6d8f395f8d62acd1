#include "sh/ivanic.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace zonal::sh {
namespace {

/// The paper's u, v and w of every |m| (its Table 1, corrected), over sqrt(l(2l-1)) so that each row of C has
/// length 1.
struct Couplings {
  std::vector<double> u, v, w;

  explicit Couplings(int l) : u(l + 1), v(l + 1), w(l + 1) {
    const double norm = 1 / std::sqrt(double(l) * (2 * l - 1));
    for (int m = 0; m <= l; ++m) {
      u[m] = norm * std::sqrt(double(l + m) * (l - m));
      v[m] = norm * 0.5 * std::sqrt((m <= 1 ? 2.0 : 1.0) * (l + m - 1) * (l + m));
      w[m] = m == 0 || m == l ? 0 : -norm * 0.5 * std::sqrt(double(l - m - 1) * (l - m));
    }
    v[0] = -v[0];
  }
};

/// One entry of a row of C: which order of band 1, which of band l-1, and how much.
struct Term {
  int i, a;
  double factor;
};

int terms_of(const Couplings& c, int l, int m, Term* terms) {
  const int k = std::abs(m);
  int size = 0;
  const auto add = [&](int i, int a, double factor) {
    if (factor != 0 && std::abs(a) < l) terms[size++] = {i, a, factor};
  };
  add(0, m, c.u[k]);
  if (m == 0) {
    add(1, 1, c.v[0]), add(-1, -1, c.v[0]);
  } else if (m > 0) {
    add(1, m - 1, c.v[k]);
    if (m > 1) add(-1, 1 - m, -c.v[k]);
    add(1, m + 1, c.w[k]), add(-1, -m - 1, c.w[k]);
  } else {
    if (m < -1) add(1, m + 1, c.v[k]);
    add(-1, -m - 1, c.v[k]);
    add(1, m - 1, c.w[k]), add(-1, 1 - m, -c.w[k]);
  }
  return size;
}

/// Row m of band l: first over the orders of band 1 and l-1 that make m, for each of the three columns j of
/// band 1...
void couple_rows(const Term* terms, int size, int l, const double (*band1)[3], const double* before,
                 double* t[3]) {
  const int width = 2 * l - 1;
  for (int j = 0; j < 3; ++j) {
    std::fill(t[j], t[j] + width, 0.0);
    for (int k = 0; k < size; ++k) {
      const double factor = terms[k].factor * band1[terms[k].i + 1][j];
      if (factor == 0) continue;
      const double* row = before + size_t(terms[k].a + l - 1) * width;
      for (int b = 0; b < width; ++b) t[j][b] += factor * row[b];
    }
  }
}

/// ... then over those that make each n. Arrays are centred on order 0 and readable two entries beyond their
/// ends.
void couple_columns(const Couplings& c, int l, const double* low, const double* middle, const double* high,
                    double* out) {
  out[0] = c.u[0] * middle[0] + c.v[0] * (high[1] + low[-1]);
  out[1] = c.u[1] * middle[1] + c.v[1] * high[0] + c.w[1] * (high[2] + low[-2]);
  out[-1] = c.u[1] * middle[-1] + c.v[1] * low[0] + c.w[1] * (high[-2] - low[2]);
  for (int n = 2; n <= l; ++n) {
    out[n] = c.u[n] * middle[n] + c.v[n] * (high[n - 1] - low[1 - n]) + c.w[n] * (high[n + 1] + low[-n - 1]);
    out[-n] =
        c.u[n] * middle[-n] + c.v[n] * (high[1 - n] + low[n - 1]) + c.w[n] * (high[-n - 1] - low[n + 1]);
  }
}

}  // namespace

template <class T>
void ivanic_ruedenberg(int bands, const Mat3<double>& R, T* columns) {
  // Band 1 in the order (Y_1^-1, Y_1^0, Y_1^1) ~ (-y, z, -x). The Condon-Shortley signs multiply element (m,
  // n) of every band by (-1)^(m+n), which the couplings preserve, so they need no other change.
  constexpr int axis[3] = {1, 2, 0};
  constexpr double sign[3] = {-1, 1, -1};
  double band1[3][3];
  for (int m = 0; m < 3; ++m)
    for (int n = 0; n < 3; ++n) band1[m][n] = sign[m] * sign[n] * R[axis[n]][axis[m]];

  columns[0] = 1;
  std::vector<double> before(size_t(2 * bands + 1) * (2 * bands + 1)), band(before.size());
  before[0] = 1;
  const int padded = 2 * bands + 5;  // two zeros at either end
  std::vector<double> sums(3 * size_t(padded));
  for (int l = 1; l < bands; ++l) {
    const int size = 2 * l + 1;
    const Couplings couplings(l);
    std::fill(sums.begin(), sums.end(), 0.0);
    double* t[3];
    for (int j = 0; j < 3; ++j) t[j] = sums.data() + j * padded + 2;
    for (int m = -l; m <= l; ++m) {
      Term terms[5];
      couple_rows(terms, terms_of(couplings, l, m, terms), l, band1, before.data(), t);
      couple_columns(couplings, l, t[0] + l - 1, t[1] + l - 1, t[2] + l - 1,
                     band.data() + size_t(m + l) * size + l);
    }
    T* out = columns + Rotation<T>::band_offset(l);
    for (int m = 0; m < size; ++m)
      for (int n = 0; n < size; ++n) out[n * size + m] = T(band[size_t(m) * size + n]);
    std::swap(before, band);
  }
}

template void ivanic_ruedenberg(int, const Mat3<double>&, float*);
template void ivanic_ruedenberg(int, const Mat3<double>&, double*);

}  // namespace zonal::sh
