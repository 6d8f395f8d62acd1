#pragma once
/// Many uniform triangles at once, exact to what is asked: the plane triangle is integrated (the area form of
/// polygon.h) by a cubature that its size against its distance decides, several triangles a SIMD register;
/// those too near for any are left to polygon_light. Any number of bands.
///
///     sh::TriangleBatch<float> triangles;
///     triangles.add(a, b, c, radiance, false);
///     triangles.accumulate(5, x, 1e-4f, sum);          // [colour][l(l+1)+m], zeroed by the caller
///
/// Seen from x, a point p of the triangle sends Y(p/|p|) |n.p|/|p|^3 dA. Its Taylor coefficients about the
/// centroid are at most binomial(l + k + 2, k) (e/d)^k of the largest value, e the distance of the farthest
/// corner from the centroid, d that of the centroid from x; a rule of degree q with positive weights leaves
/// those from k = q + 1 on, twice at most, and they fall by half or faster where a rule is used: 4 binomial(l
/// + q + 3, q + 1) (e/d)^(q+1).

#include <vector>

#include "sh/basis.h"

namespace zonal::sh {

template <class T>
class TriangleBatch {
 public:
  int count() const { return int(extent_.size()); }
  /// Corners counter-clockwise seen from the lit side; `two_sided`: both shine.
  void add(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c, const Vec3<T>& radiance, bool two_sided);

  /// sum[c * count(bands) + i] += coefficients of all triangles; where gradient is not null, gradient[(c * 3
  /// + axis) * count(bands) + i] += their derivatives with respect to x. `tolerance`: relative error allowed
  /// to each triangle's largest coefficient, by the bound above. Not to be called at a corner.
  void accumulate(int bands, const Vec3<T>& x, T tolerance, T* sum, T* gradient = nullptr) const;
  /// How many triangles go to polygon_light at x: for statistics and tests.
  int near(int bands, const Vec3<T>& x, T tolerance) const;

  const Vec3<T>& corner(int k, int i) const { return corners_[size_t(3 * k + i)]; }
  Vec3<T> radiance(int k) const { return {colour_[0][k], colour_[1][k], colour_[2][k]}; }
  bool two_sided(int k) const { return two_sided_[k] != 0; }
  T extent(int k) const { return extent_[k]; }

  /// The rules, for a copy elsewhere (a GPU): points as shares of the two edges from the first corner, with
  /// weights that sum to 1; and the largest extent over distance that each serves.
  struct Point {
    T s, t, weight;
  };
  static std::vector<std::vector<Point>> rule_points();
  static std::vector<T> reaches(int bands, T tolerance);

 private:
  struct Rules;
  static const Rules& rules();
  /// Which rule serves triangle k from x; -1: none needed, the number of rules: polygon_light.
  int rule_for(int k, const Vec3<T>& x, const T* reach) const;

  std::vector<Vec3<T>> corners_;
  std::vector<T> cx_, cy_, cz_, e1_[3], e2_[3],
      area_[3];  ///< centroid; b - a, c - a; area vector to the lit side
  std::vector<T> extent_, colour_[3];
  std::vector<unsigned char> two_sided_;
};

}  // namespace zonal::sh
