// Polygonal lights against the golden vectors, each other and their limits.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "sh/checked_lights.h"
#include "sh/factorized_polygon.h"
#include "sh/polygon.h"
#include "sh/simple_lights.h"
#include "sh/solid_angle.h"
#include "tests/paths.h"

namespace zonal::sh {
namespace {

using nlohmann::json;
using dvec3 = Vec3<double>;
using Polygon = std::vector<dvec3>;

json golden(const std::string& name) {
  std::ifstream file(test::source_dir() + "/tests/golden/" + name + ".json");
  EXPECT_TRUE(file) << name;
  return json::parse(file);
}

dvec3 vec(const json& j) {
  return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

double worst_of_largest(const double* got, const double* truth, int n) {
  double largest = 0, worst = 0;
  for (int i = 0; i < n; ++i) {
    if (!std::isfinite(got[i])) return INFINITY;
    largest = std::max(largest, std::abs(truth[i]));
    worst = std::max(worst, std::abs(got[i] - truth[i]));
  }
  return largest > 0 ? worst / largest : worst;
}

std::vector<double> flat(const json& rows) {
  std::vector<double> v;
  for (const json& row : rows) {
    for (const json& x : row) v.push_back(x.get<double>());
  }
  return v;
}

std::vector<double> light(int bands, const Polygon& p, dvec3 x, std::vector<dvec3>* gradient = nullptr) {
  std::vector<double> L(count(bands));
  if (gradient) gradient->resize(count(bands));
  polygon_light(bands, int(p.size()), p.data(), x, L.data(), gradient ? gradient->data() : nullptr);
  return L;
}

TEST(ShPolygon, golden_coefficients_gradients_and_solid_angles) {
  const json cases = golden("polygon_sh")["cases"];
  ASSERT_FALSE(cases.empty());
  for (const json& c : cases) {
    const std::string tag = c["tag"];
    const dvec3 x = vec(c["x"]);
    Polygon p;
    for (const json& v : c["vertices"]) p.push_back(vec(v));
    std::vector<dvec3> G;
    const std::vector<double> L = light(9, p, x, &G);
    const double e = worst_of_largest(L.data(), c["coeffs"].get<std::vector<double>>().data(), 81);
    const double eg = worst_of_largest(&G[0].x, flat(c["grad_x_coeffs"]).data(), 243);
    EXPECT_LT(e, 2e-13) << tag;
    EXPECT_LT(eg, 2e-12) << tag;
    dvec3 slope;
    const double omega = polygon_solid_angle(3, p.data(), x, &slope), truth = c["signed_solid_angle"];
    EXPECT_NEAR(omega / truth, 1, 1e-13) << tag;
    const dvec3 true_slope = vec(c["grad_x_signed_solid_angle"]);
    EXPECT_LT(glm::length(slope - true_slope), 1e-11 * glm::length(true_slope)) << tag;
  }
}

// The float entry computes in double: only the result rounds.
TEST(ShPolygon, float_is_as_good_as_its_inputs) {
  const json cases = golden("polygon_sh")["cases"];
  for (const json& c : cases) {
    Vec3<float> p[3], G[81];
    Polygon rounded;
    for (int i = 0; i < 3; ++i) p[i] = Vec3<float>(vec(c["vertices"][i])), rounded.push_back(dvec3(p[i]));
    const Vec3<float> x(vec(c["x"]));
    float L[81];
    polygon_light(9, 3, p, x, L, G);
    const std::vector<double> truth = light(9, rounded, dvec3(x));
    const std::vector<double> got(L, L + 81);
    EXPECT_LT(worst_of_largest(got.data(), truth.data(), 81), 1e-7) << c["tag"];
  }
}

// Edge form against area form: small parts take the other path. 40 bands, so phases are large as well.
TEST(ShPolygon, a_polygon_is_the_sum_of_its_parts_in_any_form) {
  const dvec3 x(0.1, -0.2, 0.3), a(1, 0.2, 0.9), b(-0.4, 1.1, 1.0), c(-0.2, -0.8, 1.3);
  const int bands = 40, parts = 64;
  std::vector<dvec3> G, g;
  const std::vector<double> whole = light(bands, {a, b, c}, x, &G);
  std::vector<double> sum(count(bands), 0);
  std::vector<dvec3> slope(count(bands), dvec3(0));
  for (int i = 0; i < parts; ++i) {  // slivers: solid angle over perimeter is below 1e-2, then below 1e-3
    for (int k = 0; k < 8; ++k) {
      const double s0 = double(i) / parts, s1 = double(i + 1) / parts, t0 = k / 8.0, t1 = (k + 1) / 8.0;
      const auto at = [&](double s, double t) { return a + t * ((b - a) + s * (c - b)); };
      const std::vector<double> part = light(bands, {at(s0, t0), at(s0, t1), at(s1, t1), at(s1, t0)}, x, &g);
      for (int j = 0; j < count(bands); ++j) sum[j] += part[j], slope[j] += g[j];
    }
  }
  EXPECT_LT(worst_of_largest(sum.data(), whole.data(), count(bands)), 1e-12);
  EXPECT_LT(worst_of_largest(&slope[0].x, &G[0].x, 3 * count(bands)), 1e-11);
}

// The polygon turned is the function turned: compared point by point, not through another rotation.
TEST(ShPolygon, rotating_the_polygon_rotates_the_function) {
  const int bands = 12;
  const double angle = 0.7;
  const auto turn = [&](dvec3 v) {  // about the axis (1,1,1)/sqrt 3, Rodrigues
    const dvec3 k = glm::normalize(dvec3(1, 1, 1));
    return v * std::cos(angle) + glm::cross(k, v) * std::sin(angle) +
           k * glm::dot(k, v) * (1 - std::cos(angle));
  };
  const Polygon p = {{1, 0, 1}, {0.5, 1, 0.8}, {-0.5, 0.8, 1.1}, {-0.3, -0.4, 1.3}};
  Polygon q;
  for (const dvec3& v : p) q.push_back(turn(v));
  const std::vector<double> a = light(bands, p, dvec3(0)), b = light(bands, q, dvec3(0));
  for (const dvec3& d : {dvec3(0, 0, 1), dvec3(0.6, -0.8, 0), glm::normalize(dvec3(1, 2, -3))}) {
    std::vector<double> Ya(count(bands)), Yb(count(bands));
    evaluate(bands, d, Ya.data()), evaluate(bands, turn(d), Yb.data());
    double fa = 0, fb = 0;
    for (int i = 0; i < count(bands); ++i) fa += a[i] * Ya[i], fb += b[i] * Yb[i];
    EXPECT_NEAR(fa, fb, 1e-13);
  }
}

// Far away: a point of intensity area times |cos|, relative error (l size/distance)^2 about 1e-10.
TEST(ShPolygon, far_polygon_is_a_point_light) {
  const dvec3 far(3e5, -2e5, 4e5), e1(1, 0, 0), e2(0, 1, 0);
  const Polygon p = {far - (e1 + e2) / 3.0, far + e1 - (e1 + e2) / 3.0, far + e2 - (e1 + e2) / 3.0};
  const double cosine = std::abs(far.z) / glm::length(far);
  double point[81];
  point_light(9, dvec3(0), far, 0.5 * cosine, point);
  EXPECT_LT(worst_of_largest(light(9, p, dvec3(0)).data(), point, 81), 1e-9);
}

TEST(ShPolygon, gradient_is_the_derivative_for_slivers_too) {
  const Polygon sliver = {{-1, 0.2, 1}, {1, 0.2, 1}, {0, 0.200001, 1}},
                edge_on = {{1, -0.5, 1e-4}, {1, 0.5, 1e-4}, {2, 0, 2.001e-4}},
                quad = {{1, -0.5, 0.2}, {1, 0.5, 0.3}, {1.2, 0.5, 1.4}, {1.2, -0.5, 1.3}};
  for (const Polygon& p : {sliver, edge_on, quad}) {
    std::vector<dvec3> G;
    const std::vector<double> L = light(8, p, dvec3(0), &G);
    const double h = &p == &edge_on ? 1e-10 : 1e-9;
    double largest = 0, worst = 0;
    for (int k = 0; k < 3; ++k) {
      dvec3 e(0);
      e[k] = h;
      const std::vector<double> a = light(8, p, e), b = light(8, p, -e);
      for (int i = 0; i < 64; ++i) {
        largest = std::max(largest, std::abs(G[i][k]));
        worst = std::max(worst, std::abs((a[i] - b[i]) / (2 * h) - G[i][k]));
      }
    }
    EXPECT_LT(worst, 1e-5 * largest);
  }
}

TEST(ShPolygon, order_of_vertices_and_convexity_do_not_matter) {
  const Polygon arrow = {{0, 0.9, 1}, {-0.8, -0.7, 1}, {0, -0.2, 1}, {0.8, -0.7, 1}};
  Polygon turned(arrow.rbegin(), arrow.rend());
  std::rotate(turned.begin(), turned.begin() + 1, turned.end());
  const std::vector<double> a = light(10, arrow, dvec3(0)), b = light(10, turned, dvec3(0));
  EXPECT_GT(a[0], 0);
  EXPECT_LT(worst_of_largest(b.data(), a.data(), 100), 1e-13);
  const std::vector<double> left = light(10, {arrow[0], arrow[1], arrow[2]}, dvec3(0)),
                            right = light(10, {arrow[0], arrow[2], arrow[3]}, dvec3(0));
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(a[i], left[i] + right[i], 1e-14);
}

// Vertices and points from 1e-30 to 1e30, degenerate polygons, x on the plane, an edge or a vertex: finite,
// sane.
template <class T>
void expect_sane() {
  using V = Vec3<T>;
  const V corners[3] = {{T(0.5), T(-0.3), 1}, {T(0.4), T(0.6), T(1.2)}, {T(-0.5), T(0.1), T(0.9)}};
  for (const double size : {1e-30, 1e-6, 1.0, 1e6, 1e30}) {
    const T s = T(size);
    const V v[3] = {corners[0] * s, corners[1] * s, corners[2] * s};
    for (const V x : {V(0), v[0], (v[0] + v[1]) * T(0.5), (v[0] + v[1] + v[2]) / T(3), v[0] * T(0.999999),
                      v[0] * T(1e-30)}) {
      T L[81];
      V G[81];
      polygon_light(9, 3, v, x, L, G);
      for (int i = 0; i < 81; ++i) {
        EXPECT_TRUE(std::isfinite(L[i])) << size;
        EXPECT_FALSE(std::isnan(G[i].x + G[i].y + G[i].z)) << size;
        EXPECT_LE(std::abs(L[i]), 25) << size;  // at most 4 pi max |Y|
      }
    }
  }
  const V line[3] = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, point[3] = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  for (const V* p : {line, point}) {
    T L[81];
    V G[81];
    polygon_light(9, 3, p, V(0), L, G);
    for (int i = 0; i < 81; ++i) EXPECT_EQ(L[i], 0);
  }
}
TEST(ShPolygon, extreme_and_degenerate_inputs_are_finite) {
  expect_sane<float>();
  expect_sane<double>();
}

TEST(ShPolygon, batches_are_sums) {
  const Polygon all = {{1, 0, 1}, {0.5, 1, 0.8}, {-0.5, 0.8, 1.1}, {0, 3, 1},
                       {1, 3, 1}, {1, 4, 1},     {0, 4, 1}};
  const int first[3] = {0, 3, 7};
  const dvec3 radiance[2] = {{1, 2, 3}, {0.5, 0, 4}};
  std::vector<dvec3> L(100, dvec3(0)), gx(100, dvec3(0)), gy = gx, gz = gx, g0, g1;
  dvec3* const G[3] = {gx.data(), gy.data(), gz.data()};
  accumulate_polygon_lights(10, 2, first, all.data(), radiance, dvec3(0.1), L.data(), G);
  const std::vector<double> a = light(10, {all[0], all[1], all[2]}, dvec3(0.1), &g0),
                            b = light(10, {all[3], all[4], all[5], all[6]}, dvec3(0.1), &g1);
  for (int i = 0; i < 100; ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(L[i][c], a[i] * radiance[0][c] + b[i] * radiance[1][c], 1e-14);
      EXPECT_NEAR(gy[i][c], g0[i].y * radiance[0][c] + g1[i].y * radiance[1][c], 1e-13);
    }
  }
}

constexpr TriangleMethod kMethods[] = {TriangleMethod::main, TriangleMethod::alternative,
                                       TriangleMethod::compromise_radius, TriangleMethod::compromise_angle};

// Central differences, step 1e-6: error 1e-10 of the largest times h^-1 rounding 1e-10.
TEST(ShTriangleSpheres, gradients_are_the_derivatives) {
  const TriangleSphere<double> t =
      triangle_sphere(dvec3(0.5, -0.3, 1.0), dvec3(0.4, 0.6, 1.2), dvec3(-0.5, 0.1, 0.9));
  const double h = 1e-6;
  for (const TriangleMethod method : kMethods) {
    for (const dvec3 x : {dvec3(0.1, 0.2, -0.4), dvec3(0.3, -0.2, 2.5)}) {
      double L[81], a[81], b[81];
      dvec3 G[81];
      triangle_sphere_light(9, method, t, x, L, G);
      EXPECT_GT(L[0], 0.01);
      for (int k = 0; k < 3; ++k) {
        dvec3 e(0);
        e[k] = h;
        triangle_sphere_light(9, method, t, x + e, a), triangle_sphere_light(9, method, t, x - e, b);
        for (int i = 0; i < 81; ++i)
          EXPECT_NEAR((a[i] - b[i]) / (2 * h), G[i][k], 1e-8) << int(method) << " " << i;
      }
    }
  }
}

// A small triangle far away, size/distance 1e-4: every method meets the exact polygon to the square of that.
TEST(ShTriangleSpheres, far_triangles_agree_with_the_polygon) {
  const Polygon p = {{10, 0, 50}, {10, 0.01, 50}, {10.01, 0.003, 50.004}};
  const std::vector<double> exact = light(9, p, dvec3(0));
  for (const TriangleMethod method : {TriangleMethod::main, TriangleMethod::alternative}) {
    double L[81];
    triangle_sphere_light(9, method, triangle_sphere(p[0], p[1], p[2]), dvec3(0), L);
    EXPECT_LT(worst_of_largest(L, exact.data(), 81), 1e-6) << int(method);
  }
}

TEST(ShTriangleSpheres, alternative_keeps_the_solid_angle) {
  const Polygon p = {{1000, 0, 1}, {-500, 800, 1}, {-500, -900, 1}};
  double L[9];
  triangle_sphere_light(3, TriangleMethod::alternative, triangle_sphere(p[0], p[1], p[2]), dvec3(0), L);
  EXPECT_NEAR(L[0], light(1, p, dvec3(0))[0], 1e-14);
}

template <class T>
void expect_defined() {
  const Vec3<T> a(T(0.5), T(-0.3), 1), b(T(0.4), T(0.6), T(1.2)), c(T(-0.5), T(0.1), T(0.9));
  for (const double size : {1e-30, 1.0, 1e30}) {
    const T s = T(size);
    const TriangleSphere<T> t = triangle_sphere(a * s, b * s, c * s);
    for (const TriangleMethod method : kMethods) {
      for (const Vec3<T> x : {t.center, t.center + t.normal * (T(0.1) * s), t.vertices[0], Vec3<T>(0),
                              t.center + (t.vertices[0] - t.center) * T(3)}) {
        T L[81];
        Vec3<T> G[81];
        triangle_sphere_light(9, method, t, x, L, G);
        for (int i = 0; i < 81; ++i)
          EXPECT_FALSE(std::isnan(L[i] + G[i].x + G[i].y + G[i].z)) << size << int(method);
      }
    }
  }
}
TEST(ShTriangleSpheres, defined_inside_the_sphere_in_the_plane_and_at_any_size) {
  expect_defined<float>();
  expect_defined<double>();
}

template <class F>
std::string refusal(F&& f) {
  try {
    f();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

TEST(ShCheckedLights, bad_input_is_named_with_its_value_and_range) {
  const Vec3<float> x(0), y(1, 2, 3), nan(NAN, 0, 0);
  float L[81];
  EXPECT_EQ(refusal([&] { checked::sphere_light(9, x, y, -1.0f, L); }),
            "radius is -1; it must be finite and above 0");
  EXPECT_EQ(refusal([&] { checked::sphere_light(0, x, y, 1.0f, L); }),
            "the number of bands is 0; it must be 1 to 101");
  EXPECT_EQ(refusal([&] { checked::disk_light(102, x, y, 1.0f, L); }),
            "the number of bands is 102; it must be 1 to 101");
  EXPECT_EQ(refusal([&] { checked::sphere_light(3, nan, y, 1.0f, L); }),
            "the point.x is nan; it must be finite");
  EXPECT_NE(refusal([&] { checked::directional_light(3, x, 1.0f, L); }), "accepted");
  EXPECT_NE(refusal([&] { checked::point_light(3, y, y, 1.0f, L); }), "accepted");
  EXPECT_NE(refusal([&] { checked::ggx_zonal(3, GgxLobe::ndf, 0.0f, L); }), "accepted");
  EXPECT_NE(refusal([&] { checked::cap_zonal(3, 4.0f, L); }), "accepted");
  const Vec3<float> line[3] = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, good[3] = {{1, 1, 1}, {2, 2, 2}, {3, 3, 4}};
  EXPECT_NE(refusal([&] { checked::polygon_light(3, 3, line, x, L); }), "accepted");
  EXPECT_NE(refusal([&] { checked::polygon_light(3, 2, good, x, L); }), "accepted");
  EXPECT_NE(refusal([&] { checked::polygon_light(3, 3, good, good[0], L); }), "accepted");
  EXPECT_EQ(refusal([&] { checked::polygon_light(3, 3, good, x, L); }), "accepted");
  EXPECT_EQ(refusal([&] { checked::sphere_light(9, x, y, 1.0f, L); }), "accepted");
}

TEST(FactorizedPolygons, are_the_exact_ones_with_their_gradients) {
  std::mt19937 bits(9);
  std::uniform_real_distribution<double> number(-1, 1);
  for (const int bands : {1, 4, 9}) {
    FactorizedPolygons factorized(bands);
    std::vector<float> L(3 * count(bands)), gradient(9 * count(bands));
    std::vector<double> truth(L.size()), slopes(gradient.size());
    factorized.start(true);
    for (int k = 0; k < 20; ++k) {
      Polygon p;
      const dvec3 center(2 * number(bits), 2 * number(bits), 2 * number(bits));
      for (int i = 0; i < 3; ++i) p.push_back(center + dvec3(number(bits), number(bits), number(bits)));
      // The last few lie on the axes' planes, wound either way, where lobes may be edge on.
      if (k > 15) p = {{k - 15.0, 0, 0}, {0, k > 17 ? 2.0 : -2.0, 0}, {0, 0, 1}};
      const dvec3 colour(1 + number(bits), 1 + number(bits), 1 + number(bits));
      factorized.add(3, p.data(), colour);
      std::vector<dvec3> G;
      const std::vector<double> one = light(bands, p, dvec3(0), &G);
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < count(bands); ++i) {
          truth[c * count(bands) + i] += colour[c] * one[i];
          for (int axis = 0; axis < 3; ++axis)
            slopes[(c * 3 + axis) * count(bands) + i] += colour[c] * G[i][axis];
        }
    }
    factorized.finish(L.data(), gradient.data());
    // Sums rounded to float; the lobes' conditions are below 10.
    const std::vector<double> values(L.begin(), L.end()), derivatives(gradient.begin(), gradient.end());
    EXPECT_LT(worst_of_largest(values.data(), truth.data(), int(truth.size())), 1e-6) << bands;
    EXPECT_LT(worst_of_largest(derivatives.data(), slopes.data(), int(slopes.size())), 1e-6) << bands;
  }
}

TEST(FactorizedPolygons, a_lobe_along_an_edges_normal_is_no_trouble) {
  // An edge whose plane a lobe's axis is normal to: 1/rho has no part along z there.
  const int bands = 6;
  const dvec3 axis = glm::normalize(ZonalFactorization<double>(bands).directions()[5]);
  const dvec3 side = glm::normalize(glm::cross(axis, dvec3(1, 0, 0))), up = glm::cross(axis, side);
  for (const double tilt : {0.0, 1e-9, 1e-5, 1e-3}) {
    const Polygon p = {side * 2.0 + axis * tilt, up * 1.5, side + up + axis};
    FactorizedPolygons factorized(bands);
    std::vector<float> L(3 * count(bands)), gradient(9 * count(bands));
    factorized.start(true);
    factorized.add(3, p.data(), dvec3(1));
    factorized.finish(L.data(), gradient.data());
    std::vector<dvec3> G;
    light(bands, p, dvec3(0), &G);
    for (int i = 0; i < count(bands); ++i)
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(gradient[k * count(bands) + i], G[i][k], 1e-6) << tilt << ' ' << i;
  }
}

}  // namespace
}  // namespace zonal::sh
