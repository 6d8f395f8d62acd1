#pragma once
/// Vertices as seen from a point, with the determinants and cross products that decide small solid angles
/// kept exact to rounding. Needs a build without reassociation. Everything is in double.

#include <vector>

#include "sh/seen_distance.h"

namespace zonal::sh {

using dvec3 = Vec3<double>;

/// v - x, and what the subtraction rounded away.
struct SeenVertex {
  dvec3 p{0}, low{0};
  double length = 0;
};

/// Power of two that brings the farthest vertex near 1; 1 for ordinary scenes.
template <class T>
inline double polygon_scale(int n, const Vec3<T>* vertices, const Vec3<T>& x) {
  double m = 0;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) m = std::fmax(m, std::fabs(double(vertices[i][k]) - double(x[k])));
  }
  return range_scale<double>(m);
}

template <class T>
inline SeenVertex see_vertex(const Vec3<T>& v, const Vec3<T>& x, double scale) {
  SeenVertex s;
  for (int k = 0; k < 3; ++k) {
    DoubleSum difference;
    difference.add(double(v[k]) * scale), difference.add(-double(x[k]) * scale);
    s.p[k] = difference.high, s.low[k] = difference.low;
  }
  s.length = std::sqrt(glm::dot(s.p, s.p));
  return s;
}

/// ab - cd to about an ulp (Kahan).
inline double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  return std::fma(a, b, -cd) - std::fma(c, d, -cd);
}

inline dvec3 exact_cross(const dvec3& a, const dvec3& b) {
  return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
          difference_of_products(a.x, b.y, a.y, b.x)};
}

/// det(a, b, c) in twice the precision, first order in what the vertices lost.
inline double exact_determinant(const SeenVertex& a, const SeenVertex& b, const SeenVertex& c) {
  DoubleSum det;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    DoubleSum cross;
    cross.add_product(b.p[i], c.p[j]), cross.add_product(-b.p[j], c.p[i]);
    det.add_product(a.p[k], cross.high);
    det.low += a.p[k] * cross.low;
  }
  det.low += glm::dot(a.low, glm::cross(b.p, c.p)) + glm::dot(b.low, glm::cross(c.p, a.p)) +
             glm::dot(c.low, glm::cross(a.p, b.p));
  return det.high + det.low;
}

/// Signed solid angle of a triangle (Eq. 4.13).
inline double seen_solid_angle(const SeenVertex& a, const SeenVertex& b, const SeenVertex& c) {
  const double den = a.length * b.length * c.length + glm::dot(a.p, b.p) * c.length +
                     glm::dot(b.p, c.p) * a.length + glm::dot(c.p, a.p) * b.length;
  const double det = exact_determinant(a, b, c);
  return det == 0 && den == 0 ? 0 : 2 * std::atan2(det, den);
}

/// What the edge from a to b adds to the gradient of the solid angle (Eq. 4.16).
inline dvec3 solid_angle_gradient_term(const SeenVertex& a, const SeenVertex& b) {
  const double lengths = a.length * b.length, den = lengths + glm::dot(a.p, b.p);
  if (!(den > 0)) return dvec3(0);
  return exact_cross(a.p, b.p) * ((1 / a.length + 1 / b.length) / den);
}

}  // namespace zonal::sh
