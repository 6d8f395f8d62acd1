#include "sh/polygon.h"

#include <algorithm>

#include "sh/gauss_panel.h"
#include "sh/polygon_geometry.h"
#include "sh/weighted_basis.h"

namespace zonal::sh {
namespace {

constexpr double kEdgesCancel =
    1e-3;  ///< below this ratio of solid angle to perimeter the area form takes over

/// Angle between two directions, exact from 0 to pi.
double angle_between(const SeenVertex& a, const SeenVertex& b, const dvec3& cross) {
  return std::atan2(std::sqrt(glm::dot(cross, cross)), glm::dot(a.p, b.p));
}

/// Nodes along the arc from a to b.
void add_edge(const SeenVertex& a, const SeenVertex& b, int bands, BoundarySum& sum) {
  const dvec3 cross = exact_cross(a.p, b.p);
  const double sine = std::sqrt(glm::dot(cross, cross));
  if (!(sine > 0)) return;  // no arc, or one through x
  const double angle = angle_between(a, b, cross);
  const dvec3 n = cross / sine, u = a.p / a.length, v = glm::cross(n, u);
  // 1/rho is sinusoidal along a line: from 1/l_a at t = 0 with its least distance h = |a x b|/|b - a|.
  const dvec3 edge = b.p - a.p;
  const double inverse_h = std::sqrt(glm::dot(edge, edge)) / sine;
  const double slope = -glm::dot(a.p, edge) / (a.length * sine);  // of 1/rho at t = 0

  const double phase = bands * angle / 2;
  const int panels = std::max(1, static_cast<int>(std::ceil(phase / GaussPanels::kMaxPanelPhase)));
  const int nodes = GaussPanels::nodes_for(phase / panels);
  const double* at = GaussPanels::get().nodes(nodes);
  const double* weight = GaussPanels::get().weights(nodes);
  const double half = angle / panels / 2;
  for (int k = 0; k < panels; ++k) {
    for (int i = 0; i < nodes; ++i) {
      const double t = half * (2 * k + 1 + at[i]), c = std::cos(t), s = std::sin(t);
      const double inverse_rho = std::min(c / a.length + s * slope, inverse_h);
      sum.add(u * c + v * s, n * (half * weight[i]), n * (half * weight[i] * inverse_rho));
    }
  }
}

/// Nodes over a plane triangle, `part` of the fan's triangle with determinant det and area vector A.
struct AreaForm {
  int bands;
  AreaSum& sum;
  double det;
  dvec3 area;

  void add(dvec3 a, dvec3 b, dvec3 c, double part, int depth) {
    // Let a lie opposite to the shortest edge: narrow triangles then need few nodes across.
    double ab = glm::dot(b - a, b - a), bc = glm::dot(c - b, c - b), ca = glm::dot(a - c, a - c);
    while (bc > ab || bc > ca) {
      const dvec3 first = a;
      a = b, b = c, c = first;
      const double length = ab;
      ab = bc, bc = ca, ca = length;
    }
    const double longest = std::sqrt(std::max(ab, ca));
    const dvec3 center = (a + b + c) / 3.0;
    const double nearest = std::sqrt(glm::dot(center, center)) - longest * 0.6667;
    if (longest > 0.6 * nearest && depth < 40) {
      if (ab > ca) {
        const dvec3 middle = (a + b) * 0.5;
        add(a, middle, c, part / 2, depth + 1), add(middle, b, c, part / 2, depth + 1);
      } else {
        const dvec3 middle = (a + c) * 0.5;
        add(a, b, middle, part / 2, depth + 1), add(middle, b, c, part / 2, depth + 1);
      }
      return;
    }
    const int along = nodes_for(longest / nearest), across = nodes_for(std::sqrt(bc) / nearest);
    const GaussPanels& gauss = GaussPanels::get();
    for (int i = 0; i < along; ++i) {
      const double s = 0.5 + 0.5 * gauss.nodes(along)[i];
      for (int j = 0; j < across; ++j) {
        const double t = 0.5 + 0.5 * gauss.nodes(across)[j];
        const double weight = part * s * 0.25 * gauss.weights(along)[i] * gauss.weights(across)[j];
        const dvec3 p = a + s * ((b - a) + t * (c - b));
        const double p2 = glm::dot(p, p);
        if (!(p2 > 0)) continue;
        const double inverse = 1 / std::sqrt(p2), cube = weight * inverse / p2;
        sum.add(p * inverse, det * cube, (area * -1.0 + p * (3 * det / p2)) * cube, -det * cube * inverse);
      }
    }
  }

  /// An extent e seen from distance 1: |p|^-3 has its singularity at 2/e half lengths (error (4/e)^-2n), Y
  /// oscillates.
  int nodes_for(double e) const {
    if (!(e < 1)) return kMaxPanel;
    const double n = 18.5 / std::log(4 / std::max(e, 1e-15)) + 0.25 * bands * e;
    return std::min(kMaxPanel, static_cast<int>(n) + 2);
  }
};

/// Positive coefficients in double; returns false if nothing is seen. `gradient` in units of the scaled
/// vertices.
template <class T>
void polygon_in_double(int bands, int n, const Vec3<T>* vertices, const Vec3<T>& x, WeightedBasis& result,
                       double& scale, bool with_gradient) {
  thread_local std::vector<SeenVertex> seen;
  seen.resize(n);
  scale = polygon_scale(n, vertices, x);
  for (int i = 0; i < n; ++i) seen[i] = see_vertex(vertices[i], x, scale);
  double omega = 0, perimeter = 0;
  for (int i = 2; i < n; ++i) omega += seen_solid_angle(seen[0], seen[i - 1], seen[i]);
  for (int i = 0; i < n; ++i) {
    const SeenVertex &a = seen[i], &b = seen[(i + 1) % n];
    perimeter += angle_between(a, b, exact_cross(a.p, b.p));
  }
  const double sign = omega < 0 ? -1 : 1;
  result.start(bands, with_gradient);
  if (std::fabs(omega) >= kEdgesCancel * perimeter) {
    BoundarySum sum(result);
    for (int i = 0; i < n; ++i) add_edge(seen[i], seen[(i + 1) % n], bands, sum);
    sum.finish();
    result.value(0) = omega * 0.28209479177387814347;
    for (int l = 1; l < bands; ++l) {
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) result.value(i) /= l * (l + 1);
    }
  } else {
    AreaSum sum(result);
    for (int i = 2; i < n; ++i) {
      const SeenVertex &a = seen[0], &b = seen[i - 1], &c = seen[i];
      AreaForm{bands, sum, exact_determinant(a, b, c), exact_cross(b.p - a.p, c.p - a.p)}.add(a.p, b.p, c.p,
                                                                                              1, 0);
    }
    sum.finish();
  }
  result.multiply(sign);
}

}  // namespace

template <class T>
void polygon_light(int bands, int n, const Vec3<T>* vertices, const Vec3<T>& x, T* L, Vec3<T>* gradient) {
  thread_local WeightedBasis result;
  double scale;
  polygon_in_double(bands, n, vertices, x, result, scale, gradient != nullptr);
  for (int i = 0; i < count(bands); ++i) {
    L[i] = T(result.value(i));
    if (gradient) gradient[i] = Vec3<T>(result.gradient(i) * scale);
  }
}

template <class T>
void accumulate_polygon_lights(int bands, int polygons, const int* first, const Vec3<T>* vertices,
                               const Vec3<T>* radiance, const Vec3<T>& x, Vec3<T>* L,
                               Vec3<T>* const gradient[3]) {
  thread_local WeightedBasis result;
  for (int k = 0; k < polygons; ++k) {
    double scale;
    polygon_in_double(bands, first[k + 1] - first[k], vertices + first[k], x, result, scale,
                      gradient != nullptr);
    for (int i = 0; i < count(bands); ++i) {
      L[i] += radiance[k] * T(result.value(i));
      if (!gradient) continue;
      const dvec3 slope = result.gradient(i) * scale;
      for (int axis = 0; axis < 3; ++axis) gradient[axis][i] += radiance[k] * T(slope[axis]);
    }
  }
}

#define ZONAL_INSTANTIATE(T)                                                                       \
  template void polygon_light<T>(int, int, const Vec3<T>*, const Vec3<T>&, T*, Vec3<T>*);          \
  template void accumulate_polygon_lights<T>(int, int, const int*, const Vec3<T>*, const Vec3<T>*, \
                                             const Vec3<T>&, Vec3<T>*, Vec3<T>* const*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
