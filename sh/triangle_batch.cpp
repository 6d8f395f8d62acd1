#include "sh/triangle_batch.h"

#include <algorithm>
#include <cmath>

#include "sh/few_bands.h"
#include "sh/gauss_panel.h"
#include "sh/polygon.h"
#include "sh/zonal_lanes.h"

namespace zonal::sh {

/// Cubatures of a triangle: points as shares of the two edges from the first corner, weights that sum to 1.
template <class T>
struct TriangleBatch<T>::Rules {
  struct Rule {
    int degree;
    std::vector<Point> points;
  };
  std::vector<Rule> all;

  Rules() {
    all.push_back({1, {{T(1.0 / 3), T(1.0 / 3), T(1)}}});
    all.push_back({2,
                   {{T(1.0 / 6), T(1.0 / 6), T(1.0 / 3)},
                    {T(2.0 / 3), T(1.0 / 6), T(1.0 / 3)},
                    {T(1.0 / 6), T(2.0 / 3), T(1.0 / 3)}}});
    // Seven points of degree 5 (Radon 1948).
    Rule seven{5, {{T(1.0 / 3), T(1.0 / 3), T(0.225)}}};
    const double root = std::sqrt(15.0);
    for (const double sign : {-1.0, 1.0}) {
      const T a = T((6 + sign * root) / 21), rest = 1 - 2 * a, w = T((155 + sign * root) / 1200);
      seven.points.insert(seven.points.end(), {{a, a, w}, {rest, a, w}, {a, rest, w}});
    }
    all.push_back(seven);
    // Gauss-Legendre along and across (Duffy's coordinates): n^2 points, degree 2n - 2.
    for (const int n : {5, 6, 8}) {
      Rule rule{2 * n - 2, {}};
      const double *at = GaussPanels::get().nodes(n), *weight = GaussPanels::get().weights(n);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const double s = 0.5 + 0.5 * at[i], t = 0.5 + 0.5 * at[j];
          rule.points.push_back({T(s * (1 - t)), T(s * t), T(0.5 * s * weight[i] * weight[j])});
        }
      all.push_back(rule);
    }
  }
};

template <class T>
const typename TriangleBatch<T>::Rules& TriangleBatch<T>::rules() {
  static const Rules rules;
  return rules;
}

template <class T>
void TriangleBatch<T>::add(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c, const Vec3<T>& radiance,
                           bool two_sided) {
  const Vec3<T> centroid((Vec3<double>(a) + Vec3<double>(b) + Vec3<double>(c)) / 3.0), e1 = b - a, e2 = c - a;
  const Vec3<double> area =
      0.5 * glm::cross(Vec3<double>(b) - Vec3<double>(a), Vec3<double>(c) - Vec3<double>(a));
  corners_.insert(corners_.end(), {a, b, c});
  cx_.push_back(centroid.x), cy_.push_back(centroid.y), cz_.push_back(centroid.z);
  T extent = 0;
  for (const Vec3<T>& v : {a, b, c}) extent = std::max(extent, glm::length(v - centroid));
  extent_.push_back(extent);
  for (int k = 0; k < 3; ++k) {
    e1_[k].push_back(e1[k]), e2_[k].push_back(e2[k]), area_[k].push_back(T(area[k]));
    colour_[k].push_back(radiance[k]);
  }
  two_sided_.push_back(two_sided);
}

template <class T>
std::vector<std::vector<typename TriangleBatch<T>::Point>> TriangleBatch<T>::rule_points() {
  std::vector<std::vector<Point>> points;
  for (const auto& rule : rules().all) points.push_back(rule.points);
  return points;
}

/// By the bound of the header.
template <class T>
std::vector<T> TriangleBatch<T>::reaches(int bands, T tolerance) {
  std::vector<T> reach;
  for (const auto& rule : rules().all) {
    double binomial = 4;
    for (int k = 1; k <= rule.degree + 1; ++k) binomial *= double(bands + 1 + k) / k;
    // The terms fall by half where (l + q + 4)/(q + 2) e/d <= 1/2.
    reach.push_back(T(std::min(std::pow(double(tolerance) / binomial, 1.0 / (rule.degree + 1)),
                               0.5 * (rule.degree + 2) / (bands + rule.degree + 3.0))));
  }
  return reach;
}

namespace {

/// Adds Y(axis) weight, and its gradient for x, to one row a part.
template <int N, bool kGradient, class T, class V>
[[gnu::always_inline]] inline void add_points(int bands, V x, V y, V z, V inverse_d, V weight, V gx, V gy,
                                              V gz, V* rows) {
  const int n = count(bands);
  if constexpr (N > 0 && !kGradient) {
    V gain[N];
    for (int l = 0; l < N; ++l) gain[l] = weight;
    few_bands<N, T>(
        x, y, z, few_sine2(z, x * x + y * y),
        gain, [&](int i, V value) __attribute__((always_inline)) { rows[i] += value; });
    return;
  }
  constexpr int kWidth = int(sizeof(V) / sizeof(T));
  const DirectionLanes<T, V> d(x, y, z);
  const V one = weight * 0 + T(1);
  const auto add = [&](int i, V value, V vx, V vy, V vz) {
    rows[i] += value;
    if constexpr (kGradient) rows[n + i] += vx, rows[2 * n + i] += vy, rows[3 * n + i] += vz;
  };
  basis_lanes<T, kWidth, kGradient>(bands, d, [&](int l, int m, V X, V dX, V c, V s, V c1, V s1) {
    const V parity = l % 2 ? d.sign : one, q = parity * X;
    if constexpr (!kGradient) {
      add(index(l, m), weight * q * c, q, q, q);
      if (m > 0) add(index(l, -m), weight * q * s, q, q, q);
    } else {
      // weight grad_x Y + Y grad_x weight, as for points (simple_light_batch.h).
      const V turn = -inverse_d * weight * parity, flat = turn * X, up = turn * dX;
      const V along = -(up * d.z + T(m) * flat);
      V k = along * c, Y = q * c;
      add(index(l, m), weight * Y, flat * c1 + d.x * k + gx * Y, d.y * k - flat * s1 + gy * Y,
          up * c + d.z * k + gz * Y);
      if (m == 0) return;
      k = along * s, Y = q * s;
      add(index(l, -m), weight * Y, flat * s1 + d.x * k + gx * Y, flat * c1 + d.y * k + gy * Y,
          up * s + d.z * k + gz * Y);
    }
  });
}

}  // namespace

template <class T>
int TriangleBatch<T>::rule_for(int k, const Vec3<T>& x, const T* reach) const {
  const Vec3<T> w(cx_[k] - x.x, cy_[k] - x.y, cz_[k] - x.z), area(area_[0][k], area_[1][k], area_[2][k]);
  if (!two_sided_[k] && !(glm::dot(area, w) < 0)) return -1;
  const T ratio2 = extent_[k] * extent_[k], d2 = glm::dot(w, w);
  const int n = int(rules().all.size());
  int rule = 0;
  while (rule < n && !(ratio2 < reach[rule] * reach[rule] * d2)) ++rule;
  return rule;
}

template <class T>
int TriangleBatch<T>::near(int bands, const Vec3<T>& x, T tolerance) const {
  const std::vector<T> reach = reaches(bands, tolerance);
  int found = 0;
  for (int k = 0; k < count(); ++k) found += rule_for(k, x, reach.data()) == int(reach.size());
  return found;
}

template <class T>
void TriangleBatch<T>::accumulate(int bands, const Vec3<T>& x, T tolerance, T* sum, T* gradient) const {
  constexpr int kWidth = lane_count<T>;
  using V = Lanes<T, kWidth>;
  using D = Lanes<double, kWidth>;
  struct Scratch {
    std::vector<std::vector<int>> of_rule;
    std::vector<V> rows, lanes;
    std::vector<T> one;
    std::vector<Vec3<T>> slope;
    std::vector<T> reach;
    int bands = 0;
    T tolerance = 0;
  };
  thread_local Scratch scratch;
  const Rules& rules = TriangleBatch::rules();
  if (scratch.bands != bands || scratch.tolerance != tolerance)
    scratch.reach = reaches(bands, tolerance), scratch.bands = bands, scratch.tolerance = tolerance;
  const int parts = gradient ? 4 : 1, n = sh::count(bands);
  scratch.of_rule.resize(rules.all.size() + 1);
  for (auto& list : scratch.of_rule) list.clear();
  for (int k = 0; k < count(); ++k) {
    const int rule = rule_for(k, x, scratch.reach.data());
    if (rule >= 0) scratch.of_rule[size_t(rule)].push_back(k);
  }
  scratch.lanes.assign(size_t(parts) * 3 * n, V{});

  for (size_t r = 0; r < rules.all.size(); ++r) {
    const std::vector<int>& list = scratch.of_rule[r];
    for (size_t first = 0; first < list.size(); first += kWidth) {
      const int filled = int(std::min<size_t>(kWidth, list.size() - first));
      D ax{}, ay{}, az{};
      V e1[3]{}, e2[3]{}, area[3]{}, colour[3]{};
      for (int lane = 0; lane < kWidth; ++lane) {
        const int k = list[first + size_t(std::min(lane, filled - 1))];
        const Vec3<T>& a = corners_[size_t(3) * k];
        ax[lane] = double(a.x) - double(x.x), ay[lane] = double(a.y) - double(x.y),
        az[lane] = double(a.z) - double(x.z);
        // The side that is seen shines towards x.
        const T side =
            area_[0][k] * (cx_[k] - x.x) + area_[1][k] * (cy_[k] - x.y) + area_[2][k] * (cz_[k] - x.z) > 0
                ? T(1)
                : T(-1);
        for (int axis = 0; axis < 3; ++axis) {
          e1[axis][lane] = e1_[axis][k], e2[axis][lane] = e2_[axis][k],
          area[axis][lane] = side * area_[axis][k];
          colour[axis][lane] = lane < filled ? colour_[axis][k] : T(0);
        }
      }
      const V a0 = __builtin_convertvector(ax, V), a1 = __builtin_convertvector(ay, V),
              a2 = __builtin_convertvector(az, V);
      // A.p is the same at every point of the plane.
      const V det = area[0] * a0 + area[1] * a1 + area[2] * a2;
      scratch.rows.assign(size_t(parts) * n, V{});
      V* rows = scratch.rows.data();
      for (const auto& point : rules.all[r].points) {
        const V px = a0 + point.s * e1[0] + point.t * e2[0], py = a1 + point.s * e1[1] + point.t * e2[1],
                pz = a2 + point.s * e1[2] + point.t * e2[2];
        const V inverse = T(1) / sqrt_lanes(px * px + py * py + pz * pz);
        const V dx = px * inverse, dy = py * inverse, dz = pz * inverse;
        const V cube = inverse * inverse * inverse * point.weight, weight = det * cube;
        if (!gradient) {
          const auto add = [&](auto few) {
            add_points<decltype(few)::value, false, T>(bands, dx, dy, dz, inverse, weight, weight, weight,
                                                       weight, rows);
          };
          switch (bands) {
            case 3:
              add(std::integral_constant<int, 3>{});
              break;
            case 4:
              add(std::integral_constant<int, 4>{});
              break;
            case 5:
              add(std::integral_constant<int, 5>{});
              break;
            case 6:
              add(std::integral_constant<int, 6>{});
              break;
            default:
              add(std::integral_constant<int, 0>{});
          }
        } else {
          // grad_x of A.p/|p|^3, p = v - x: (3 (A.p) p/|p|^2 - A)/|p|^3.
          const V fall = T(3) * weight * inverse;
          add_points<0, true, T>(bands, dx, dy, dz, inverse, weight, fall * dx - area[0] * cube,
                                 fall * dy - area[1] * cube, fall * dz - area[2] * cube, rows);
        }
      }
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < parts * n; ++i) scratch.lanes[size_t(c) * parts * n + i] += colour[c] * rows[i];
    }
  }
  for (int c = 0; c < 3; ++c)
    for (int part = 0; part < parts; ++part)
      for (int i = 0; i < n; ++i) {
        const V& v = scratch.lanes[(size_t(c) * parts + part) * n + i];
        T total = 0;
        for (int lane = 0; lane < kWidth; ++lane) total += v[lane];
        (part == 0 ? sum[c * n + i] : gradient[(c * 3 + part - 1) * n + i]) += total;
      }

  scratch.one.resize(n), scratch.slope.resize(gradient ? n : 0);
  for (const int k : scratch.of_rule.back()) {
    polygon_light<T>(bands, 3, &corners_[size_t(3) * k], x, scratch.one.data(),
                     gradient ? scratch.slope.data() : nullptr);
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < n; ++i) {
        sum[c * n + i] += colour_[c][k] * scratch.one[i];
        if (gradient)
          for (int axis = 0; axis < 3; ++axis)
            gradient[(c * 3 + axis) * n + i] += colour_[c][k] * scratch.slope[i][axis];
      }
  }
}

template class TriangleBatch<float>;
template class TriangleBatch<double>;

}  // namespace zonal::sh
