#pragma once
/// Polygonal lights as the literature before Mézières 2022 has them, to compare with: the integral of zonal
/// lobes about fixed directions over each polygon, in closed form along its edges (Wang and Ramamoorthi 2018,
/// Wu et al. 2020), made coefficients by zonal factorisation in the end. As exact as sh/polygon.h but for
/// narrow or far polygons, whose edges cancel; the cost of a polygon is 3N lobes of N bands an edge.
///
///     sh::FactorizedPolygons polygons(5);
///     polygons.start(true);
///     for (...) polygons.add(3, corners_from_x, radiance);
///     polygons.finish(L, gradient);                       // L[c * 25 + i], gradient[(c * 3 + axis) * 25 +
///     i]

#include <vector>

#include "sh/zonal_factorization.h"

namespace zonal::sh {

class FactorizedPolygons {
 public:
  explicit FactorizedPolygons(int bands);

  /// Forgets what was added. Sums of several threads need an object each.
  void start(bool with_gradient);
  /// A plane polygon of n corners, given relative to x, none of them 0; both faces shine.
  void add(int n, const Vec3<double>* corners, const Vec3<double>& radiance);
  /// Adds to L and, where it was asked for, to the gradient with respect to x.
  void finish(float* L, float* gradient);

 private:
  void add_edge(const Vec3<double>& a, const Vec3<double>& b);

  ZonalFactorization<double> factors_;
  int bands_, lobes_;               ///< lobes: directions that bands share
  std::vector<double> x_, y_, z_;   ///< the directions
  std::vector<double> moments_[4];  ///< of the polygon, [l * lobes + direction]: value; gradient for x, y, z
  std::vector<double> sums_;        ///< [(l^2 + d) * functions + colour], then (colour * 3 + axis)
  int functions_ = 3;
};

}  // namespace zonal::sh
