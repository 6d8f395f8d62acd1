// The kernels of `hvl`: lanes (integrators/hvl/hvl_lanes.h), their shared text (hvl.glsl), and closed forms
// or quadrature in double.
#include <gtest/gtest.h>

#include <random>

#include "core/glsl.h"
#include "integrators/hvl/hvl_kernels.h"
#include "sh/sphere_light.h"

namespace zonal {
namespace kernel {
// Each needs those before it.
// clang-format off
#include "sh/basis.glsl"
#include "sh/sphere_light.glsl"
#include "sh/angle.glsl"
#include "materials/zonal_lobes.glsl"
#include "integrators/hvl/hvl.glsl"
// clang-format on
}  // namespace kernel
namespace {

using dvec3 = glm::dvec3;
constexpr double kPiD = 3.14159265358979323846;

struct Random {
  std::mt19937 bits;
  explicit Random(unsigned seed) : bits(seed) {}
  float operator()() { return std::uniform_real_distribution<float>(0, 1)(bits); }
  float signed_one() { return 2 * (*this)() - 1; }
  vec3 direction() {
    const float z = signed_one(), phi = 2 * kPi * (*this)(), s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
  }
};

/// Integral of f over the cap of half angle `a` about `axis`, in double: midpoints, n in the cosine by 2n
/// azimuths.
template <class F>
double over_cap(dvec3 axis, double a, int n, F&& f) {
  const dvec3 up = std::abs(axis.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 x = glm::normalize(glm::cross(up, axis)), y = glm::cross(axis, x);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double q = (i + 0.5) / n, versine = 2 * std::pow(std::sin(a / 2), 2) * q, z = 1 - versine;
    const double s = std::sqrt(versine * (2 - versine));
    for (int j = 0; j < 2 * n; ++j) {
      const double phi = kPiD * (j + 0.5) / n;
      sum += f(x * (s * std::cos(phi)) + y * (s * std::sin(phi)) + axis * z);
    }
  }
  return sum * 2 * kPiD * 2 * std::pow(std::sin(a / 2), 2) / (2.0 * n * n);
}

/// A point at the origin whose frame is the world's, in every lane, and a light somewhere.
hvl::Sight look(vec3 to_light, vec3 normal, float radius) {
  const hvl::V zero = {};
  hvl::Sight s;
  hvl::look(zero, zero, zero, &to_light.x, &normal.x, radius, s);
  return s;
}

/// Runs `gather` for one point at the origin with z up, and one light that sends 1/sr everywhere: what the
/// light's power of pi r^2 / cos brings, which is the product of (HVL-5) or (HVL-7).
vec3 gathered(const hvl::Receivers& receivers, vec3 to_light, float radius, float soft = 0) {
  hvl::Light light;
  light.position = to_light, light.normal = -normalize(to_light), light.radius = radius;
  light.power = vec3(kPi * radius * radius);
  std::array<float, hvl::kPoints> r{}, g{}, b{};
  const auto emit = [](int, const hvl::V& x, const hvl::V&, const hvl::V&, hvl::V* out) {
    for (int c = 0; c < 3; ++c) out[c] = x * 0.0f + 1.0f;
  };
  hvl::gather(receivers, &light, 1, soft, emit, hvl::Out{r.data(), g.data(), b.data()});
  return {r[3], g[3], b[3]};
}
hvl::Receivers receivers_facing_up(hvl::Product product, int bands, bool mirrored) {
  hvl::Receivers r;
  r.product = product;
  r.gz.fill(1), r.nz.fill(1), r.ax.fill(1), r.by.fill(1);
  r.open(0, bands, mirrored);
  return r;
}
const std::vector<float> kOnes(hvl::kMaxBands, 1.0f);

class HvlProduct : public testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(HvlProduct, is_the_dot_product_with_a_spherical_light) {
  const auto [bands, mirrored] = GetParam();
  Random random(7);
  const int stride = sh_count(bands, mirrored);
  for (int trial = 0; trial < 20; ++trial) {
    hvl::Receivers receivers = receivers_facing_up(hvl::Product::sh, bands, mirrored);
    std::vector<float> table(3 * size_t(stride));
    for (float& c : table) c = random.signed_one();
    receivers.set_sh(3, bands, mirrored, stride, table.data(), kOnes.data());
    vec3 w = random.direction();
    w.z = std::abs(w.z);
    const float radius = 0.1f + random(), distance = radius * (1.02f + 3 * random());
    std::vector<double> L(sh::count(bands));
    sh::sphere_light<double>(bands, dvec3(0), dvec3(w * distance), double(radius), L.data());

    const vec3 found = gathered(receivers, w * distance, radius);
    for (int c = 0; c < 3; ++c) {
      double truth = 0, size = 0;
      for (int l = 0; l < bands; ++l)
        for (int m = mirrored ? 0 : -l; m <= l; ++m) {
          const int i = mirrored ? l * (l + 1) / 2 + m : l * (l + 1) + m;
          truth += L[sh::index(l, m)] * table[c * stride + i];
          size += std::pow(L[sh::index(l, m)], 2);
        }
      // Polynomials carry up to l^2 roundings of 6e-8 where they are largest; coefficients are random, of
      // size 1.
      EXPECT_NEAR(found[c], truth, (2e-6 + 1.5e-7 * bands * bands) * (std::sqrt(size) + 0.1))
          << "bands " << bands << " w " << w.x << " " << w.y << " " << w.z << " r/d " << radius / distance;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Bands, HvlProduct,
                         testing::Combine(testing::Values(1, 2, 3, 4, 5, 7, 9, 10, 20), testing::Bool()));

TEST(HvlKernel, lanes_are_the_shared_text) {
  Random random(8);
  for (int trial = 0; trial < 200; ++trial) {
    const int bands = 1 + trial % 10;
    const float soft = trial % 3 == 0 ? random() : 0;
    hvl::Receivers receivers = receivers_facing_up(hvl::Product::sh, bands, false);
    const int stride = bands * bands;
    std::vector<float> table(3 * size_t(stride));
    kernel::HvlColors f;
    for (int i = 0; i < stride; ++i)
      for (int c = 0; c < 3; ++c) f.c[i][c] = table[c * stride + i] = random.signed_one();
    receivers.set_sh(3, bands, false, stride, table.data(), kOnes.data());
    const vec3 w = random.direction();
    const float radius = 0.2f + random(), distance = radius * (0.3f + 2 * random());
    const kernel::ZonalCap cap = kernel::sphere_cap(distance * distance, radius);
    // Inside the sphere the power goes into the hemisphere's disk pi r^2 as well.
    const vec3 text = kernel::hvl_radiance(vec3(kPi * radius * radius), vec3(1), 1, radius) *
                      kernel::hvl_product(bands, f, cap, w, soft);
    const vec3 found = gathered(receivers, w * distance, radius, soft);
    if (std::abs(w.z + std::sqrt(cap.sine2)) < 1e-5f) continue;  // on the horizon either may be 0
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found[c], text[c], 3e-5f)
          << "bands " << bands << " d/r " << distance / radius << " soft " << soft;
  }
}

TEST(HvlKernel, zonal_lanes_are_the_shared_text) {
  Random random(9);
  for (int trial = 0; trial < 200; ++trial) {
    const int bands = 1 + trial % 24;
    hvl::Receivers receivers = receivers_facing_up(hvl::Product::zonal, bands, true);
    std::vector<float> lobe(bands);
    kernel::ZonalLobe text_lobe;
    for (int l = 0; l < bands; ++l) {
      lobe[l] = random.signed_one();
      text_lobe.weight[l] = lobe[l] * std::sqrt((2.0f * l + 1) / (4 * kPi));
    }
    receivers.set_zonal(3, bands, lobe.data(), kOnes.data());
    const vec3 axis = random.direction(), kd(random(), random(), random()), ks(random(), random(), random());
    receivers.ax[3] = axis.x, receivers.ay[3] = axis.y, receivers.az[3] = axis.z;
    for (int c = 0; c < 3; ++c) receivers.diffuse[c][3] = kd[c], receivers.specular[c][3] = ks[c];
    const vec3 w = random.direction();
    const float radius = 0.2f + random(), distance = radius * (0.3f + 2 * random());
    const kernel::ZonalCap cap = kernel::sphere_cap(distance * distance, radius);
    const vec3 text = kernel::hvl_zonal_product(bands, kd, ks, text_lobe, cap, w.z, dot(w, axis));
    const vec3 found = gathered(receivers, w * distance, radius);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], text[c], 2e-5f) << "bands " << bands << " w.z " << w.z;
  }
}

TEST(HvlKernel, a_zonal_lobe_meets_the_cap_as_their_product_does_on_the_sphere) {
  // Independent of any recurrence: the lobe's series times the cap, integrated in double. The cap is not cut
  // to its bands, which its product with a band-limited lobe does not see.
  Random random(10);
  for (int trial = 0; trial < 12; ++trial) {
    const int bands = 1 + trial;
    hvl::Receivers receivers = receivers_facing_up(hvl::Product::zonal, bands, true);
    std::vector<float> lobe(bands);
    for (float& F : lobe) F = random.signed_one();
    receivers.set_zonal(3, bands, lobe.data(), kOnes.data());
    receivers.specular[0][3] = 1;
    const vec3 axis = normalize(vec3(0.3f, 0.2f, 0.9f)),
               w = normalize(vec3(random.signed_one(), random.signed_one(), 1));
    receivers.ax[3] = axis.x, receivers.ay[3] = axis.y, receivers.az[3] = axis.z;
    const float radius = 0.5f, distance = 0.5f + random();
    const double a = std::asin(double(radius) / distance);
    const double truth = w.z * over_cap(dvec3(w), a, 200, [&](dvec3 v) {
                           const double x = glm::dot(v, dvec3(axis));
                           double p = 1, before = 0, sum = 0;
                           for (int l = 0; l < bands; ++l) {
                             sum += double(lobe[l]) * std::sqrt((2 * l + 1) / (4 * kPiD)) * p;
                             const double next = ((2 * l + 1) * x * p - l * before) / (l + 1);
                             before = p, p = next;
                           }
                           return sum;
                         });
    // The midpoint rule of 200 points: h^2/24 of the second derivative, up to l^2 = 144: 2e-4.
    EXPECT_NEAR(gathered(receivers, w * distance, radius).x, truth, 3e-4) << "bands " << bands;
  }
}

TEST(HvlKernel, the_diffuse_part_is_the_cap_cut_by_the_horizon) {
  for (const double ratio : {0.01, 0.1, 0.5, 0.9, 0.99}) {
    for (int i = 0; i <= 40; ++i) {
      const double theta = kPiD * i / 40, a = std::asin(ratio);
      const vec3 w(float(std::sin(theta)), 0, float(std::cos(theta)));
      hvl::Receivers receivers = receivers_facing_up(hvl::Product::zonal, 1, true);
      receivers.diffuse[0][3] = 1;
      const float radius = 0.25f;
      const double truth = over_cap(dvec3(w), a, 200, [](dvec3 v) { return std::max(v.z, 0.0); });
      const double found = gathered(receivers, w * float(radius / ratio), radius).x;
      // The kink at the horizon leaves the midpoint rule 1/n of a cell's share; polynomials of atan are good
      // to 1e-7.
      EXPECT_NEAR(found, truth, 2e-4 * kPiD * ratio * ratio * ratio + 2e-6 * ratio * ratio)
          << "r/d " << ratio << " theta " << theta;
      if (std::cos(theta) > ratio)
        EXPECT_NEAR(found, kPiD * ratio * ratio * std::cos(theta), 1e-6 * kPiD * ratio * ratio);
    }
  }
}

TEST(HvlKernel, inside_the_sphere_the_light_is_a_hemisphere) {
  hvl::Receivers receivers = receivers_facing_up(hvl::Product::zonal, 1, true);
  receivers.diffuse[0][3] = 1;
  for (const float d : {0.999f, 0.5f, 1e-3f, 1e-9f}) {
    for (const float cosine : {1.0f, 0.3f, 0.0f, -0.5f}) {
      const vec3 w(std::sqrt(1 - cosine * cosine), 0, cosine);
      // The cosine over the half of the hemisphere about w that lies above the horizon: pi (1 + cos)/2.
      EXPECT_NEAR(gathered(receivers, w * d, 1).x, kPi * (1 + cosine) / 2, 2e-6)
          << "d " << d << " cos " << cosine;
    }
  }
  EXPECT_EQ(look(vec3(0), vec3(0, 0, -1), 1).emitted[0], 0);  // on the centre itself nothing is sent
}

TEST(HvlKernel, emission_is_the_even_extension) {
  Random random(11);
  for (const bool mirrored : {true, false}) {
    for (int bands = 1; bands <= 12; ++bands) {
      std::vector<float> F(sh::count(bands)), c(3 * size_t(hvl::even_count(bands, mirrored)));
      for (int i = 0; i < sh::count(bands); ++i) F[i] = random.signed_one();
      hvl::for_each_even_coefficient(bands, mirrored, [&](int place, int l, int m, int i) {
        EXPECT_EQ(i, mirrored ? l * (l + 1) / 2 + m : sh::index(l, m));
        for (int k = 0; k < 3; ++k)
          c[3 * place + k] = 2 * (k + 1) * F[sh::index(l, m)] * hvl::Bands::table().norm(l, std::abs(m));
      });
      const vec3 w = random.direction();
      std::vector<double> up(sh::count(bands)), down(sh::count(bands));
      sh::evaluate<double>(bands, glm::normalize(dvec3(w)), up.data());
      sh::evaluate<double>(bands, glm::normalize(dvec3(w.x, w.y, -w.z)), down.data());
      double truth = 0;
      for (int l = 0; l < bands; ++l)
        for (int m = mirrored ? 0 : -l; m <= l; ++m) {
          const int i = sh::index(l, m);
          truth += F[i] * (up[i] + down[i]);  // F itself and its mirror image
        }
      const hvl::V zero = {};
      hvl::V out[3];
      if (mirrored)
        hvl::emission<0, true>(hvl::Bands::table(), bands, c.data(), zero + w.x, zero + w.y, zero + w.z, out);
      else
        hvl::emission<0, false>(hvl::Bands::table(), bands, c.data(), zero + w.x, zero + w.y, zero + w.z,
                                out);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(out[k][0], (k + 1) * truth, 2e-5 * bands * (k + 1)) << "bands " << bands;
      if (bands > 10) continue;
      kernel::HvlColors f;
      for (int i = 0; i < sh::count(bands); ++i) f.c[i] = vec3(F[i]);
      if (!mirrored && w.z > 0)
        EXPECT_NEAR(kernel::hvl_emission(bands, f, vec3(1), w).x, truth, 2e-5 * bands);
    }
  }
}

TEST(HvlKernel, a_soft_edge_keeps_the_power_and_rings_less) {
  // The cap's own series, seen at angles off its axis: receiver coefficients Y(v) make (HVL-5) the
  // reconstruction at v.
  constexpr int kBands = 12;
  const float radius = 0.5f, distance = 1;
  const double a = std::asin(0.5);
  const auto ring = [&](float soft, double* mean) {
    double least = 0;
    *mean = 0;
    const int n = 400;
    for (int i = 0; i < n; ++i) {
      const double z = -1 + 2 * (i + 0.5) / n;
      std::vector<float> Y(sh::count(kBands));
      sh::evaluate<float>(kBands, vec3(float(std::sqrt(1 - z * z)), 0, float(z)), Y.data());
      std::vector<float> table;
      for (int c = 0; c < 3; ++c) table.insert(table.end(), Y.begin(), Y.end());
      hvl::Receivers receivers = receivers_facing_up(hvl::Product::sh, kBands, false);
      receivers.set_sh(3, kBands, false, sh::count(kBands), table.data(), kOnes.data());
      const double value = gathered(receivers, vec3(0, 0, distance), radius, soft).x;
      least = std::min(least, value), *mean += 4 * kPiD * value / n;
    }
    return least;
  };
  double hard_power, soft_power;
  const double hard = ring(0, &hard_power), soft = ring(0.5f, &soft_power);
  const double solid_angle = 2 * kPiD * (1 - std::cos(a));
  EXPECT_NEAR(hard_power, solid_angle, 1e-3 * solid_angle);  // midpoint rule
  EXPECT_NEAR(soft_power, solid_angle, 1e-3 * solid_angle);
  EXPECT_LT(hard, -0.05);
  EXPECT_GT(soft, 0.25 * hard);
}

}  // namespace
}  // namespace zonal
