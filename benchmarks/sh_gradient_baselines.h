#pragma once
/// What the basis with gradient is compared with: the three methods of table 3.1 of Mézières 2022 from their
/// formulas, and straight-line scalar code with constants known to the compiler, the kind that generators
/// write (Sloan 2013, Peters 2025). All fill Y[N^2] and the gradient's components for one unit direction away
/// from the poles.

#include <array>
#include <cmath>
#include <numbers>

namespace zonal::baseline {

constexpr double root(double a) {
  if (a <= 0) return 0;
  double r = a > 1 ? a : 1;
  for (int k = 0; k < 60; ++k) r = 0.5 * (r + a / r);
  return r;
}

/// Normalisation J_l^m of (3.22), all orders.
template <int N>
constexpr auto normalisation() {
  std::array<std::array<double, N>, N> J{};
  for (int l = 0; l < N; ++l) {
    for (int m = 0; m <= l; ++m) {
      double ratio = (2 * l + 1) / (4 * std::numbers::pi) * (m > 0 ? 2 : 1);
      for (int k = l - m + 1; k <= l + m; ++k) ratio /= k;
      J[l][m] = root(ratio);
    }
  }
  return J;
}

struct Output {
  float *Y, *x, *y, *z;
};

/// (3.15) from derivatives in theta and phi; 1/(x^2+y^2) is where the poles are lost.
inline void to_cartesian(const Output& o, int i, float theta, float phi, const float (&jacobian)[5]) {
  o.x[i] = jacobian[0] * theta - jacobian[1] * phi;
  o.y[i] = jacobian[2] * theta + jacobian[3] * phi;
  o.z[i] = jacobian[4] * theta;
}

/// "Direct": Legendre functions, their derivative by (3.18), multiples of the angle by (3.13) without sin^m.
template <int N>
void direct(float x, float y, float z, const Output& o) {
  static constexpr auto J = normalisation<N>();
  const float s2 = x * x + y * y, s = std::sqrt(s2), psi = 1 / s;
  const float jacobian[5] = {x * z * psi, y / s2, y * z * psi, x / s2, -s};
  float P[N + 1][N + 1] = {};
#pragma GCC unroll 32
  for (int m = 0; m < N; ++m) {
    P[m][m] = m == 0 ? 1 : (1 - 2 * m) * s * P[m - 1][m - 1];
    if (m + 1 < N) P[m + 1][m] = (2 * m + 1) * z * P[m][m];
#pragma GCC unroll 32
    for (int l = m + 2; l < N; ++l)
      P[l][m] = ((2 * l - 1) * z * P[l - 1][m] - (l + m - 1) * P[l - 2][m]) * (1.0f / (l - m));
  }
  const float cosine = x / s, sine = y / s;
  float c = 1, v = 0;
#pragma GCC unroll 32
  for (int m = 0; m < N; ++m) {
#pragma GCC unroll 32
    for (int l = m; l < N; ++l) {
      const float norm = float(J[l][m]);
      const float T =
          m == 0 ? P[l][1]
                 : -0.5f * ((l - m + 1) * (l + m) * P[l][m > 0 ? m - 1 : 0] - P[l][m + 1]);  // (3.18)
      const float f = norm * P[l][m], df = norm * T;
      const int a = l * (l + 1) - m, b = l * (l + 1) + m;
      o.Y[a] = f * v, o.Y[b] = f * c;
      if (m > 0) to_cartesian(o, a, df * v, m * f * c, jacobian);
      to_cartesian(o, b, df * c, -m * f * v, jacobian);
    }
    const float next = cosine * c - sine * v;
    v = cosine * v + sine * c, c = next;
  }
}

/// "Sloan's like": (3.13), (3.24) and (3.25).
template <int N>
void sloan_like(float x, float y, float z, const Output& o) {
  static constexpr auto J = normalisation<N>();
  const float s2 = x * x + y * y, s = std::sqrt(s2), psi = 1 / s, cotangent = z * psi;
  const float jacobian[5] = {x * z * psi, y / s2, y * z * psi, x / s2, -s};
  float U = 1, V = 0;
  double start = 1;  // Q_m^m: a constant, folded by the compiler
#pragma GCC unroll 32
  for (int m = 0; m < N; ++m) {
    float X1 = 0, X2 = 0, Z1 = 0, Z2 = 0;
#pragma GCC unroll 32
    for (int l = m; l < N; ++l) {
      float X, Z;
      if (l == m) {
        X = float(J[m][m] * start), Z = 0;
      } else {
        const float a = float((2 * l - 1) * J[l][m] / J[l - 1][m] / (l - m));
        const float b = l > m + 1 ? float((l + m - 1) * J[l][m] / J[l > 1 ? l - 2 : 0][m] / (l - m)) : 0.0f;
        X = l > m + 1 ? a * z * X1 - b * X2 : a * z * X1;
        Z = l > m + 1 ? a * (z * Z1 - s * X1) - b * Z2 : -a * s * X1;
      }
      X2 = X1, X1 = X, Z2 = Z1, Z1 = Z;
      const float theta = X * (m * cotangent) + Z;  // (3.23)
      const int i = l * (l + 1) - m, k = l * (l + 1) + m;
      o.Y[i] = X * V, o.Y[k] = X * U;
      if (m > 0) to_cartesian(o, i, theta * V, m * X * U, jacobian);
      to_cartesian(o, k, theta * U, -m * X * V, jacobian);
    }
    const float next = x * U - y * V;
    V = x * V + y * U, U = next;
    start *= -(2 * m + 1);
  }
}

/// Polynomial form: each function's polynomial in z and its derivative by Horner's rule, times (x+iy)^m; the
/// gradient's tangent part at the end.
template <int N>
void polynomial(float x, float y, float z, const Output& o) {
  static constexpr auto coefficients = [] {
    std::array<std::array<std::array<double, N>, N>, N> a{};  // [l][m][k] of z^(l-m-2k)
    constexpr auto J = normalisation<N>();
    for (int l = 0; l < N; ++l) {
      for (int m = 0; m <= l; ++m) {
        double c = J[l][m] * (m % 2 ? -1 : 1);  // (2l)! / (2^l l! (l-m)!)
        for (int k = l + 1; k <= 2 * l; ++k) c *= k;
        for (int k = 1; k <= l - m; ++k) c /= k;
        for (int k = 0; k < l; ++k) c /= 2;
        for (int k = 0; 2 * k <= l - m; ++k) {
          a[l][m][k] = c;
          c *= -double(l - m - 2 * k) * (l - m - 2 * k - 1) / (2.0 * (k + 1) * (2 * l - 2 * k - 1));
        }
      }
    }
    return a;
  }();
  const float z2 = z * z;
  float c = 1, s = 0, c1 = 0, s1 = 0;
#pragma GCC unroll 32
  for (int m = 0; m < N; ++m) {
#pragma GCC unroll 32
    for (int l = m; l < N; ++l) {
      const int degree = l - m, terms = degree / 2 + 1;
      float f = float(coefficients[l][m][0]), df = degree * f;
#pragma GCC unroll 32
      for (int k = 1; k < terms; ++k) {
        const float a = float(coefficients[l][m][k]);
        f = f * z2 + a;
        if (degree - 2 * k > 0) df = df * z2 + (degree - 2 * k) * a;
      }
      if (degree % 2) f *= z;
      if (degree % 2 == 0) df *= z;
      const float radial = m * f + z * df;
      const int a = l * (l + 1) - m, b = l * (l + 1) + m;
      o.Y[a] = f * s, o.x[a] = m * f * s1 - radial * x * s, o.y[a] = m * f * c1 - radial * y * s,
      o.z[a] = (df - z * radial) * s;
      o.Y[b] = f * c, o.x[b] = m * f * c1 - radial * x * c, o.y[b] = -m * f * s1 - radial * y * c,
      o.z[b] = (df - z * radial) * c;
    }
    const float next = x * c - y * s;
    c1 = c, s1 = s;
    s = x * s + y * c, c = next;
  }
}

/// Straight-line code of the generated kind: recurrences with constants, derivative from the next order.
template <int N>
void generated(float x, float y, float z, const Output& o) {
  static constexpr auto J = normalisation<N>();
  float q[N + 1][N + 1] = {};
  double start = 1;
#pragma GCC unroll 32
  for (int m = 0; m < N; ++m) {
    q[m][m] = float(J[m][m] * start);
    if (m + 1 < N) q[m + 1][m] = float((2 * m + 1) * J[m + 1][m] / J[m][m]) * z * q[m][m];
#pragma GCC unroll 32
    for (int l = m + 2; l < N; ++l) {
      q[l][m] = float((2 * l - 1) * J[l][m] / J[l - 1][m] / (l - m)) * z * q[l - 1][m] -
                float((l + m - 1) * J[l][m] / J[l - 2][m] / (l - m)) * q[l - 2][m];
    }
    start *= -(2 * m + 1);
  }
  float c = 1, s = 0, c1 = 0, s1 = 0;
#pragma GCC unroll 32
  for (int m = 0; m < N; ++m) {
#pragma GCC unroll 32
    for (int l = m; l < N; ++l) {
      const float f = q[l][m],
                  df = l > m ? -float(J[l][m] / (m + 1 < N ? J[l][m + 1] : 1)) * q[l][m + 1] : 0.0f;
      const float mf = m * f, radial = mf + z * df, rx = radial * x, ry = radial * y, up = df - z * radial;
      const int a = l * (l + 1) - m, b = l * (l + 1) + m;
      if (m > 0) o.Y[a] = f * s, o.x[a] = mf * s1 - rx * s, o.y[a] = mf * c1 - ry * s, o.z[a] = up * s;
      o.Y[b] = f * c, o.x[b] = mf * c1 - rx * c, o.y[b] = -mf * s1 - ry * c, o.z[b] = up * c;
    }
    const float next = x * c - y * s;
    c1 = c, s1 = s;
    s = x * s + y * c, c = next;
  }
}

}  // namespace zonal::baseline
