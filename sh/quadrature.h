#pragma once
/// Gauss-Legendre nodes and the normalised Legendre functions at them: what exact integrals over the sphere
/// are made of.
///
///     const GaussLegendre rule = gauss_legendre(20, 0.0, 1.0);   // exact for polynomials up to degree 39 on
///     [0, 1]

#include <vector>

namespace zonal::sh {

struct GaussLegendre {
  std::vector<double> nodes;    ///< ascending, inside (low, high)
  std::vector<double> weights;  ///< sum to high - low
};

/// n >= 1 nodes: exact for polynomials up to degree 2n - 1.
GaussLegendre gauss_legendre(int n, double low = -1, double high = 1);

/// Where X_l^m lies, m >= 0, in an array of all l < bands that keeps each m together: l = m..bands-1.
constexpr int legendre_index(int bands, int l, int m) {
  return m * bands - m * (m - 1) / 2 + (l - m);
}
constexpr int legendre_count(int bands) {
  return bands * (bands + 1) / 2;
}

/// X_l^m(z), the part of Y_l^m that depends on z: Y_l^m = X_l^|m| times 1 (m = 0), sqrt2 cos m phi (m > 0) or
/// sqrt2 sin |m| phi (m < 0); Condon-Shortley phase inside. s = sqrt(1 - z^2) >= 0. Any number of bands.
void normalized_legendre(int bands, double z, double s, double* X);

}  // namespace zonal::sh
