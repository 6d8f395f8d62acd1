#pragma once
/// Integrals of a BRDF over the incoming hemisphere at one w_out, as a list of nodes that any basis can be
/// projected at.
///
///     HemisphereNodes nodes = hemisphere_nodes(bsdf, azimuth, theta_out, {.half = true});
///     project_nodes(nodes, 20, true, ShBasis::spherical, coefficients);
///
/// The nodes are those of polar coordinates of the half vector, theta = t^2 theta_max(phi): highlights sit at
/// t = 0 at every elevation, both measured formats are smooth there, and theta_max (ShQ-1) is the horizon, so
/// that no node lies below it and no cell crosses it. Cells of 6 x 6 Gauss nodes are halved until the basis
/// is resolved, then where the highest Legendre coefficients of the integrands F and F cos of each channel
/// and of F^2 within a cell are largest. Deterministic.

#include <vector>

#include "materials/bsdf.h"

namespace zonal {

struct HemisphereOptions {
  bool half =
      false;  ///< azimuths 0..pi alone, weights doubled: for materials symmetric about the plane of w_out
  bool average = false;        ///< with half: F is the mean of both sides, where they differ a little
  bool hemispherical = false;  ///< the nodes are meant for ShBasis::hemispherical too
  int resolve_bands = 32;      ///< the nodes resolve at least this many bands everywhere
  double tolerance = 5e-7;     ///< of one cell, as a share of the integral of F'
  int most_nodes = 105000;  ///< the search for better cells ends here; 2.2 times as many near the normal and
                            ///< near grazing, twice as many where not `half`
};

/// Directions are in the view frame of sh_material.h.
struct HemisphereNodes {
  std::vector<double> x, y, z;  ///< w_in
  std::vector<double> weight;   ///< steradians
  std::vector<double> f[3];     ///< weight times F
  double energy = 0;            ///< integral of F^2, channels summed
  double energy_cosine = 0;     ///< of F'^2
  double albedo[3] = {};        ///< integral of F'
  size_t evaluations = 0;       ///< nodes of halved cells included

  int size() const { return int(x.size()); }
};

/// `azimuth` of w_out in the shading frame, `theta_out` in [0, pi/2), radians.
HemisphereNodes hemisphere_nodes(const Bsdf& bsdf, double azimuth, double theta_out,
                                 const HemisphereOptions& options);

/// Norm of F's part that is odd in y over the norm of F, [0, 1]: what a table of m >= 0 alone loses.
double mirror_asymmetry(const Bsdf& bsdf, double theta_out);

enum class ShBasis { spherical, hemispherical };

/// out[channel * sh_count(bands, mirrored) + sh_index(l, m)] = sum of f Y_lm. bands <= 101.
void project_nodes(const HemisphereNodes& nodes, int bands, bool mirrored, ShBasis basis, double* out);

/// Coefficients of z times a function from its own, exactly: `out` has one band less than `in` (`bands` + 1).
/// z Y_l^m = A_{l+1}^m Y_{l+1}^m + A_l^m Y_{l-1}^m, A_l^m = sqrt((l^2 - m^2) / (4 l^2 - 1)). One channel.
void times_cosine(int bands, bool mirrored, ShBasis basis, const double* in, double* out);

}  // namespace zonal
