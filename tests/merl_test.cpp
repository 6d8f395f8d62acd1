// MERL tables against the functions they were sampled from, against the database's own look-up, and against
// themselves: symmetries, sampling, what stands in for invalid cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/microfacet.h"
#include "tests/bsdf_quadrature.h"
#include "tests/merl_support.h"

namespace zonal {
namespace {

using namespace test;

MerlBrdf table_of(const MerlFunction& brdf) {
  return MerlBrdf(tabulate_merl(brdf, "test"));
}

/// Directions where angles are hard: normal incidence, both equal, mirrored, opposite, on the horizon, almost
/// so.
std::vector<vec3> hard_directions() {
  std::vector<vec3> w = {vec3(0, 0, 1), vec3(1e-6f, 0, 1), vec3(0, -1e-4f, 1)};
  for (float degrees : {0.001f, 30.0f, 60.0f, 89.0f, 89.99f}) {
    for (float azimuth : {0.0f, 1e-5f, 90.0f, 180.0f, -137.0f}) w.push_back(direction(degrees, azimuth));
  }
  w.push_back(glm::normalize(vec3(1, 0, 1e-7f)));
  w.push_back(glm::normalize(vec3(-1, 0, 1e-7f)));
  return w;
}

TEST(Merl, a_constant_comes_back_everywhere_up_to_the_horizon) {
  const glm::dvec3 f(0.7 / 3.14159265358979, 0.25, 0.01);
  const MerlBrdf table = table_of(constant(f));
  EXPECT_EQ(table.negative_samples, 0u);
  EXPECT_GT(table.cells_below_horizon,
            100000u);  // marked -1 by the writer: they must not darken grazing directions
  std::vector<vec3> all = hard_directions();
  Random random(1);
  for (int i = 0; i < 3000; ++i) all.push_back(random.hemisphere());
  for (size_t i = 0; i < all.size(); ++i) {
    for (size_t j = 0; j < std::min<size_t>(all.size(), 40); ++j) {
      if (all[i].z <= kMinCosine || all[j].z <= kMinCosine) continue;
      const vec3 found = table.evaluate(all[i], all[j]);
      // Three lerps of one value: a few units in the last place of 1.
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[c] / f[c], 1, 1e-6) << all[i].z << " " << all[j].z;
    }
  }
  EXPECT_EQ(table.evaluate(vec3(0, 0, 1), direction(90.1f, 0)), vec3(0));
  EXPECT_EQ(table.evaluate(direction(120, 3), vec3(0, 0, 1)), vec3(0));
}

/// The function in cells, where the table samples it; negative where there is no such pair of directions.
double in_cells(const Bsdf& bsdf, double h, double d, double p) {
  const MerlDirections w = merl_directions(h, d, p);
  if (w.out.z <= 0 || w.in.z <= 0) return -1;
  return evaluate(bsdf, prepare(bsdf, vec3(w.out)), vec3(w.in)).x;
}

TEST(Merl, interpolation_errs_no_more_than_curvature_over_a_cell_allows) {
  Random random(2);
  for (float roughness : {0.2f, 0.35f, 0.6f, 1.0f}) {
    const Bsdf bsdf = ggx(roughness);
    const MerlBrdf table = table_of(merl_function(bsdf));
    int tried = 0;
    double worst = 0, worst_relative = 0;
    while (tried < 400) {
      const double h = 1 + 87 * double(random.unit()), d = 1 + 87 * double(random.unit()),
                   p = 180 * double(random.unit());
      if (d + 2 > merl_horizon(h + 1.5, p)) continue;
      // Trilinear interpolation errs by at most 1/8 of the sum of the largest second derivatives along the
      // axes, in cells. Finite differences at 27 points of the cube around the place find them to within a
      // quarter.
      double bound = 0;
      const double step = 0.5;
      double along[3] = {};
      for (int i = 0; i < 27; ++i) {
        const double x[3] = {std::floor(h - 0.5) + 0.5 + 0.5 * (i % 3),
                             std::floor(d - 0.5) + 0.5 + 0.5 * (i / 3 % 3),
                             std::floor(p - 0.5) + 0.5 + 0.5 * (i / 9)};
        const double middle = in_cells(bsdf, x[0], x[1], x[2]);
        for (int a = 0; a < 3; ++a) {
          double low[3] = {x[0], x[1], x[2]}, high[3] = {x[0], x[1], x[2]};
          low[a] -= step, high[a] += step;
          const double left = in_cells(bsdf, low[0], low[1], low[2]),
                       right = in_cells(bsdf, high[0], high[1], high[2]);
          if (left < 0 || middle < 0 || right < 0) along[a] = kInfinity;
          along[a] = std::max(along[a], std::abs(left - 2 * middle + right) / (step * step));
        }
      }
      for (double a : along) bound += 1.25 * a / 8;
      if (!std::isfinite(bound)) continue;
      ++tried;
      const MerlDirections w = merl_directions(h, d, p);
      const double exact = in_cells(bsdf, h, d, p), found = table.evaluate(vec3(w.out), vec3(w.in)).x;
      // Single precision of the directions moves theta_h by 1e-7 rad: 1e-5 of a value whose lobe is 0.04 wide
      // or more.
      ASSERT_NEAR(found, exact, bound + 2e-5 * exact)
          << "roughness " << roughness << " cell " << h << " " << d << " " << p;
      worst = std::max(worst, std::abs(found - exact) / bound);
      worst_relative = std::max(worst_relative, std::abs(found - exact) / exact);
    }
    EXPECT_GT(worst, 0.01) << "the bound says nothing at roughness " << roughness;
    RecordProperty("worst_relative_" + std::to_string(roughness), std::to_string(worst_relative));
  }
}

TEST(Merl, cell_centres_hold_the_function) {
  const Bsdf bsdf = ggx(0.3f);
  const MerlBrdf table = table_of(merl_function(bsdf));
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const int h = int(random.unit() * 90), d = int(random.unit() * 80), p = int(random.unit() * 180);
    if (d + 1 > merl_horizon(h + 0.5, p + 0.5)) continue;
    const double exact = in_cells(bsdf, h + 0.5, d + 0.5, p + 0.5);
    const MerlDirections w = merl_directions(h + 0.5, d + 0.5, p + 0.5);
    // The function is in single precision too. alpha = 0.09; slope in theta_h at most 1.3 / alpha of the
    // value a radian, and positions err by 3e-7 rad.
    EXPECT_NEAR(table.cell(h, d, p).x, exact, 1e-5 * exact);
    EXPECT_NEAR(table.evaluate(vec3(w.out), vec3(w.in)).x, exact, 1e-4 * exact) << h << " " << d << " " << p;
  }
}

/// The look-up that comes with the database, from its description: angles by arc cosines, in double, rounded
/// down.
struct LookUp {
  int index[3];
  double place[3];  ///< before rounding
};
LookUp database_look_up(glm::dvec3 out, glm::dvec3 in) {
  const double pi = 3.14159265358979323846;
  const glm::dvec3 h = glm::normalize(out + in);
  const double theta_h = std::acos(std::clamp(h.z, -1.0, 1.0)), phi_h = std::atan2(h.y, h.x);
  const auto turn_z = [](glm::dvec3 v, double a) {
    return glm::dvec3(std::cos(a) * v.x - std::sin(a) * v.y, std::sin(a) * v.x + std::cos(a) * v.y, v.z);
  };
  const auto turn_y = [](glm::dvec3 v, double a) {
    return glm::dvec3(std::cos(a) * v.x + std::sin(a) * v.z, v.y, -std::sin(a) * v.x + std::cos(a) * v.z);
  };
  const glm::dvec3 diff = turn_y(turn_z(in, -phi_h), -theta_h);
  double phi_d = std::atan2(diff.y, diff.x);
  if (phi_d < 0) phi_d += pi;
  LookUp a;
  a.place[0] = 90 * std::sqrt(theta_h / (pi / 2));
  a.place[1] = 90 * std::acos(std::clamp(diff.z, -1.0, 1.0)) / (pi / 2);
  a.place[2] = 180 * phi_d / pi;
  const int cells[3] = {90, 90, 180};
  for (int i = 0; i < 3; ++i) a.index[i] = std::clamp(int(std::floor(a.place[i])), 0, cells[i] - 1);
  return a;
}

TEST(Merl, nearest_is_the_database_s_own_look_up) {
  const MerlBrdf table(random_cells(4));
  Random random(5);
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3 out = random.hemisphere(), in = random.hemisphere();
    const LookUp a = database_look_up(glm::dvec3(out), glm::dvec3(in));
    // Single precision may fall on the other side of an edge.
    bool near_edge = a.place[0] < 1;
    for (double x : a.place) near_edge |= std::abs(x - std::round(x)) < 1e-3;
    if (near_edge || out.z <= 0.001f || in.z <= 0.001f) continue;
    ++compared;
    ASSERT_EQ(table.nearest(out, in), table.cell(a.index[0], a.index[1], a.index[2]))
        << a.place[0] << " " << a.place[1] << " " << a.place[2];
  }
  EXPECT_GT(compared, 15000);
}

TEST(Merl, exchanging_the_directions_changes_no_bit) {
  const MerlBrdf table(random_cells(6));
  Random random(7);
  std::vector<vec3> all = hard_directions();
  for (int i = 0; i < 400; ++i) all.push_back(random.hemisphere());
  for (vec3 a : all) {
    for (vec3 b : all) {
      const vec3 f = table.evaluate(a, b);
      ASSERT_EQ(f, table.evaluate(b, a));
      ASSERT_TRUE(is_finite(f) && f.x >= 0 && f.x <= 1 + 1e-6f) << f.x;  // between the samples
    }
  }
}

TEST(Merl, turning_both_directions_changes_rounding_only) {
  const MerlBrdf table(random_cells(8));
  EXPECT_TRUE(table.isotropic());
  Random random(9);
  for (int i = 0; i < 5000; ++i) {
    const vec3 a = random.hemisphere(), b = random.hemisphere();
    const float t = 6.28f * random.unit(), c = std::cos(t), s = std::sin(t);
    const auto turn = [&](vec3 w) { return glm::normalize(vec3(c * w.x - s * w.y, s * w.x + c * w.y, w.z)); };
    // Angles err by 3e-7 rad, divided by the sine that defines phi; samples of neighbours differ by up to 1 a
    // cell, and a cell is 1 degree, or less than 0.1 degree of theta_h below 1 degree.
    const HalfDifference hd = half_difference(a, b);
    const float sine_h = hd.rho / hd.length,
                sine_d = 0.5f * std::sqrt(glm::dot(hd.difference, hd.difference));
    if (sine_h < 0.02f || sine_d < 0.02f || a.z < 1e-3f || b.z < 1e-3f) continue;
    EXPECT_NEAR(table.evaluate(a, b).y, table.evaluate(turn(a), turn(b)).y,
                3e-7f * 57 * 6 / (sine_h * sine_d) + 1e-4f);
  }
}

TEST(Merl, many_directions_at_once_are_one_after_the_other) {
  const MerlBrdf table(random_cells(10));
  Random random(11);
  const vec3 w_out = direction(37, 12);
  std::vector<vec3> w_in = hard_directions();
  w_in.push_back(direction(100, 0));
  for (int i = 0; i < 500; ++i) w_in.push_back(random.hemisphere());
  std::vector<vec3> f(w_in.size(), vec3(7));
  table.evaluate(w_out, int(w_in.size()), w_in.data(), f.data());
  for (size_t i = 0; i < w_in.size(); ++i) {
    const vec3 one = table.evaluate(w_out, w_in[i]);
    // Fused multiply-adds differ between the two loops: 1e-7 rad, 57 cells a radian, more near theta_h = 0.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(f[i][c], one[c], 2e-3) << i;
    vec3 both;
    float density;
    table.evaluate_with_pdf(w_out, w_in[i], &both, &density);
    EXPECT_EQ(both, one);
    EXPECT_EQ(density, table.pdf(w_out, w_in[i]));
  }
}

TEST(Merl, negative_samples_count_and_read_as_zero) {
  std::vector<float> cells = tabulate_merl(constant(glm::dvec3(0.2)), "test");
  for (int d = 10; d < 13; ++d) cells[3 * merl_index(20, d, 30) + 1] = -0.5f;
  const MerlBrdf table(std::move(cells));
  EXPECT_EQ(table.negative_samples, 3u);
  ASSERT_EQ(table.notes.size(), 1u);
  EXPECT_EQ(table.notes[0], "3 of 4374000 samples are negative and read as 0");
  EXPECT_EQ(table.cell(20, 11, 30), vec3(0.2f, 0, 0.2f));
  const MerlDirections w = merl_directions(20.5, 11.5, 30.5);
  EXPECT_NEAR(table.evaluate(vec3(w.out), vec3(w.in)).y, 0, 1e-3);
}

TEST(Merl, light_beyond_what_arrives_is_reported_and_kept) {
  const MerlBrdf table = table_of(constant(glm::dvec3(1.5, 0.5, 0.2) / 3.14159265358979));
  EXPECT_NEAR(table.largest_albedo.x, 1.5f, 1e-3f);
  EXPECT_EQ(table.albedo.x, 1.0f);
  ASSERT_EQ(table.notes.size(), 1u);
  EXPECT_EQ(table.notes[0].rfind("reflects 1.50 of the light", 0), 0u) << table.notes[0];
  EXPECT_NEAR(table.albedo.y, 0.5f, 1e-3f);
  EXPECT_NEAR(table.evaluate(vec3(0, 0, 1), direction(40, 0)).x, 1.5f * kInvPi, 1e-6f);
}

/// What the table reflects of light from w, by quadrature over directions with cells that shrink towards the
/// lobe.
double reflected(const MerlBrdf& table, vec3 w, double width) {
  double sum = 0;
  SphericalGrid(w, width).integrate(
      [&](vec3 v, double weight) { sum += luminance(table.evaluate(w, v)) * v.z * weight; });
  return sum;
}

struct Weights {
  double mean = 0, deviation = 0, largest = 0;  ///< of f cos / pdf; the last two relative to the mean
};
Weights weights_of(const MerlBrdf& table, vec3 w_out, int samples) {
  Random random(12);
  double sum = 0, squares = 0, largest = 0;
  for (int i = 0; i < samples; ++i) {
    const float u_lobe = random.unit();
    const vec3 w_in = table.sample_direction(w_out, u_lobe, random.square());
    if (w_in.z <= kMinCosine) continue;
    vec3 f;
    float density;
    table.evaluate_with_pdf(w_out, w_in, &f, &density);
    EXPECT_GT(density, 0);
    const double weight = double(luminance(f)) * w_in.z / density;
    sum += weight, squares += weight * weight, largest = std::max(largest, weight);
  }
  Weights w;
  w.mean = sum / samples;
  w.deviation = std::sqrt(std::max(squares / samples - w.mean * w.mean, 0.0)) / w.mean;
  w.largest = largest / w.mean;
  return w;
}

TEST(Merl, samples_estimate_the_albedo_with_little_noise) {
  for (float roughness : {0.15f, 0.4f, 0.8f}) {
    const MerlBrdf table = table_of(merl_function(ggx(roughness)));
    for (float degrees : {0.0f, 40.0f, 75.0f}) {
      const vec3 w_out = direction(degrees, 20);
      const int samples = 20000;
      const Weights w = weights_of(table, w_out, samples);
      const double exact = reflected(table, w_out, roughness * roughness);
      // Five standard errors, and half a percent for the quadrature of a function with a kink at every cell.
      EXPECT_NEAR(w.mean, exact, (5 * w.deviation / std::sqrt(samples) + 5e-3) * exact)
          << roughness << " " << degrees;
      // Cosine sampling of roughness 0.15 has a deviation of about 1 / (2 alpha) = 20.
      EXPECT_LT(w.deviation, 0.5) << roughness << " " << degrees;
      EXPECT_LT(w.largest, 60) << roughness << " " << degrees;
    }
  }
}

/// Pearson's test in the density's own pieces: rings and sectors of the half vector, whose expected counts
/// come from the density alone by the midpoint rule, 8 x 8 points a piece, and everything without a direction
/// in one more.
double chi_square_p(const MerlBrdf& table, vec3 w_out, int samples, uint32_t seed, double pdf_factor = 1) {
  constexpr int rings = 90, sectors = MerlSampler::kSectors, n = 8;
  std::vector<double> expected(rings * sectors + 1), observed(expected.size());
  const double pi = 3.14159265358979323846, azimuth = std::atan2(double(w_out.y), double(w_out.x));
  const auto edge = [&](int i) { return 2 * std::pow(std::sin(pi / 4 * i * i / (90.0 * 90.0)), 2); };
  double mass = 0;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double solid = (edge(i + 1) - edge(i)) * 2 * pi / sectors / (n * n);
      for (int k = 0; k < n * n; ++k) {
        const double v = edge(i) + (edge(i + 1) - edge(i)) * (k / n + 0.5) / n;
        const double phi = azimuth + 2 * pi * (j + (k % n + 0.5) / n) / sectors, r = std::sqrt(v * (2 - v));
        const glm::dvec3 h(r * std::cos(phi), r * std::sin(phi), 1 - v), o(w_out);
        const double cosine = glm::dot(o, h);
        const glm::dvec3 w_in = 2 * cosine * h - o;
        if (cosine <= 0 || w_in.z <= 1e-6) continue;
        expected[size_t(i * sectors + j)] +=
            pdf_factor * double(table.pdf(w_out, vec3(w_in))) * 4 * cosine * solid;
      }
      mass += expected[size_t(i * sectors + j)];
    }
  }
  expected.back() = std::max(1 - mass, 0.0);
  EXPECT_LT(mass, 1.005 * pdf_factor);
  Random random(seed);
  for (int s = 0; s < samples; ++s) {
    const float u_lobe = random.unit();
    const vec3 w_in = table.sample_direction(w_out, u_lobe, random.square());
    size_t at = expected.size() - 1;
    if (w_in.z > kMinCosine) {
      const glm::dvec3 sum = glm::dvec3(w_out) + glm::dvec3(w_in);
      const double theta = std::atan2(std::hypot(sum.x, sum.y), sum.z);
      double turn = (std::atan2(sum.y, sum.x) - azimuth) / (2 * pi);
      turn -= std::floor(turn);
      at = size_t(std::min(int(90 * std::sqrt(theta / (pi / 2))), rings - 1) * sectors +
                  std::min(int(turn * sectors), sectors - 1));
    }
    ++observed[at];
  }
  std::vector<size_t> order(expected.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  // Pieces that expect little are pooled; 25 rather than the usual 5, since those on the horizon are a few
  // percent off.
  double statistic = 0, e = 0, o = 0;
  int cells = 0;
  for (size_t i : order) {
    e += expected[i] * samples, o += observed[i];
    if (e < 25) continue;
    statistic += (o - e) * (o - e) / e, ++cells, e = o = 0;
  }
  return gamma_q(0.5 * (cells - 1), 0.5 * statistic);
}

TEST(Merl, samples_follow_their_density) {
  // 15 tests at 1e-4: a correct sampler fails one in 700 seeds, and the seed is fixed.
  uint32_t seed = 13;
  for (float roughness : {0.15f, 0.5f}) {
    const MerlBrdf table = table_of(merl_function(ggx(roughness)));
    for (vec3 w_out : views())
      EXPECT_GT(chi_square_p(table, w_out, 60000, seed++), 1e-4) << roughness << " " << w_out.z;
  }
  const MerlBrdf noise(random_cells(14));
  for (vec3 w_out : views()) EXPECT_GT(chi_square_p(noise, w_out, 60000, seed++), 1e-4) << w_out.z;
  EXPECT_LT(chi_square_p(noise, views()[1], 60000, seed, 1.1), 1e-4)
      << "a density 10 % too large goes unnoticed";
}

}  // namespace
}  // namespace zonal
