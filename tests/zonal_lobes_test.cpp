// Zonal lobes against quadrature of the true BRDF, and the shared kernel against closed forms and full
// spherical harmonics.
#include "materials/zonal_lobes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/glsl.h"
#include "sh/clamped_cosine.h"
#include "sh/ggx_lobe.h"
#include "sh/rotation.h"
#include "sh/zonal.h"
#include "tests/bsdf_cases.h"
#include "tests/bsdf_quadrature.h"

namespace zonal::test {
namespace {

// The shaders' text, in a namespace of its own: C++'s functions have the same names.
namespace shader {
#include "sh/sphere_light.glsl"
//
#include "sh/angle.glsl"
#include "materials/zonal_lobes.glsl"
}  // namespace shader

constexpr double kPiD = 3.14159265358979323846;

shader::ZonalCap cap_of(double a) {
  return {static_cast<float>(2 * std::pow(std::sin(a / 2), 2)), static_cast<float>(std::pow(std::sin(a), 2)),
          0};
}

/// White metal: Fresnel is 1 everywhere, so only the lobe is seen.
Case white(float roughness) {
  return metallic_roughness(vec3(1), 1, roughness);
}

double reconstruct(const float* F, int bands, double x) {
  double before = 0, p = 1, sum = 0;
  for (int l = 0; l < bands; ++l) {
    sum += F[l] * std::sqrt((2 * l + 1) / (4 * kPiD)) * p;
    const double next = ((2 * l + 1) * x * p - l * before) / (l + 1);
    before = p, p = next;
  }
  return sum;
}

/// Energy of f cos, of its difference to max(0, lobe) cos, and what either reflects.
struct LobeError {
  double relative = 0, albedo = 0, lobe_albedo = 0;
};
template <class LobeFunction>
LobeError compare(const Case& c, vec3 w_out, const LobeFunction& lobe) {
  const BsdfContext view = prepare(c.bsdf, w_out);
  double energy = 1e-300, difference = 0;
  LobeError e;
  SphericalGrid(w_out, c.width).integrate([&](vec3 w, double weight) {
    const double z = std::max(double(w.z), 0.0), f = evaluate(c.bsdf, view, w, Lobes::specular).y;
    const double g = lobe(w);
    energy += f * f * z * z * weight, difference += (f - g) * (f - g) * z * z * weight;
    e.albedo += f * z * weight, e.lobe_albedo += g * z * weight;
  });
  e.relative = std::sqrt(difference / energy);
  return e;
}
LobeError error_of(const Case& c, vec3 w_out, int bands = kMaxZonalBands) {
  const ZonalBrdf z = zonal_brdf(c.bsdf, prepare(c.bsdf, w_out), bands);
  return compare(c, w_out, [&](vec3 w) {
    return z.specular.y * reconstruct(z.lobe.data(), bands, glm::dot(glm::dvec3(w), glm::dvec3(z.axis)));
  });
}

// Weighting each circle's mean by the cosine keeps the albedo exactly. What is left: linear interpolation in
// the table (nodes a tenth of alpha and a sixteenth of the cosine apart, an eighth of their squares'
// curvature: below 0.4 %) and the bands above 64, which hold less than 0.1 % of these widths; at 88 degrees,
// where the horizon cuts the lobe, 2.4 % of the narrowest.
TEST(ZonalLobes, reflects_what_the_true_lobe_reflects) {
  for (float roughness : {0.42f, 0.55f, 0.73f, 0.9f, 1.0f}) {
    for (float degrees : {0.0f, 13.0f, 41.0f, 67.0f, 81.0f, 88.0f}) {
      const LobeError e = error_of(white(roughness), direction(degrees, 33));
      EXPECT_NEAR(e.lobe_albedo / e.albedo, 1, degrees > 85 ? 0.03 : 0.005)
          << "roughness " << roughness << ", " << degrees << " degrees";
    }
  }
  for (float exponent : {0.0f, 1.0f, 7.0f, 43.0f}) {
    for (float degrees : {0.0f, 35.0f, 72.0f}) {
      const LobeError e = error_of(blinn_phong(vec3(0.3f), vec3(0.6f), exponent), direction(degrees, -120));
      EXPECT_NEAR(e.lobe_albedo / e.albedo, 1, 0.005)
          << "exponent " << exponent << ", " << degrees << " degrees";
    }
  }
}

// Each coefficient by brute force: means over circles about the returned axis, of `evaluate`, on a grid that
// shares nothing with the table's. The tolerance is the interpolation's, in shares of coefficient 0: 0.5 %.
TEST(ZonalLobes, coefficients_are_those_of_the_mean_over_circles) {
  for (const Case& c : {white(0.35f), white(0.62f), blinn_phong(vec3(0), vec3(1), 60)}) {
    for (float degrees : {0.0f, 24.0f, 58.0f, 76.0f}) {
      const vec3 w_out = direction(degrees, 70);
      const BsdfContext view = prepare(c.bsdf, w_out);
      const ZonalBrdf z = zonal_brdf(c.bsdf, view, 24);
      const Frame frame(z.axis);
      // Below the horizon: the value just above it, opposite to the lobe.
      const vec3 away = vec3(view.w_out.x, view.w_out.y, 0) + vec3(1e-12f, 0, 0);
      const double below =
          evaluate(c.bsdf, view, glm::normalize(away) + vec3(0, 0, 1e-6f), Lobes::specular).x;
      double F[24] = {};
      constexpr int kCircles = 4000, kAround = 720;
      for (int i = 0; i < kCircles; ++i) {
        const double u = (i + 0.5) / kCircles, angle = kPiD * u * u, step = 2 * kPiD * u / kCircles;
        double reflected = 0, cosines = 0;
        const int around = std::min(kAround, 64 + i);
        for (int k = 0; k < around; ++k) {
          const double psi = 2 * kPiD * (k + 0.5) / around;
          const vec3 w = frame.to_world(
              vec3(std::sin(angle) * std::cos(psi), std::sin(angle) * std::sin(psi), std::cos(angle)));
          if (w.z <= 1e-6f) continue;
          reflected += double(evaluate(c.bsdf, view, w, Lobes::specular).x) * w.z, cosines += w.z;
        }
        const double mean = cosines > 0 ? reflected / cosines : below;
        const double x = std::cos(angle);
        double before = 0, p = 1;
        for (int l = 0; l < 24; ++l) {
          F[l] += 2 * kPiD * std::sqrt((2 * l + 1) / (4 * kPiD)) * mean * p * std::sin(angle) * step;
          const double next = ((2 * l + 1) * x * p - l * before) / (l + 1);
          before = p, p = next;
        }
      }
      for (int l = 0; l < 24; ++l) {
        EXPECT_NEAR(z.specular.x * z.lobe[l] / F[0], F[l] / F[0], 0.01 * std::sqrt(2 * l + 1.0))
            << c.name << ", " << degrees << " degrees, l = " << l;
      }
    }
  }
}

// The lobe of normal incidence, turned to the mirror direction and scaled to the true albedo, is the thesis'
// "by roughness alone" at its best. Ours must be nearer everywhere, and as near as the page says:
// docs/materials.md has the exact errors.
TEST(ZonalLobes, is_nearer_to_the_true_lobe_than_one_by_roughness_alone) {
  struct Row {
    float roughness, degrees;
    double at_most;
  };
  for (const Row& row : std::vector<Row>{{0.5f, 30, 0.16},
                                         {0.5f, 60, 0.30},
                                         {0.5f, 75, 0.40},
                                         {0.707f, 30, 0.20},
                                         {0.707f, 60, 0.23},
                                         {0.707f, 80, 0.23},
                                         {1, 30, 0.01},
                                         {1, 80, 0.01}}) {
    const Case c = white(row.roughness);
    const vec3 w_out = direction(row.degrees, 0), mirror(-w_out.x, -w_out.y, w_out.z);
    double F[kMaxZonalBands];
    sh::ggx_zonal(kMaxZonalBands, sh::GgxLobe::reflect_normal_incidence, double(c.bsdf.alpha_x), F);
    std::vector<float> by_roughness(F, F + kMaxZonalBands);
    const auto fixed = [&](double scale) {
      return compare(c, w_out, [&](vec3 w) {
        return scale * reconstruct(by_roughness.data(), kMaxZonalBands, glm::dot(w, mirror));
      });
    };
    const LobeError unit = fixed(1), scaled = fixed(unit.albedo / unit.lobe_albedo),
                    ours = error_of(c, w_out);
    EXPECT_LT(ours.relative, row.at_most) << c.name << ", " << row.degrees << " degrees";
    EXPECT_LT(ours.relative, scaled.relative) << c.name << ", " << row.degrees << " degrees";
  }
}

// Schlick's Fresnel is linear in its weight, whose mean the table holds; the coat's albedo is the table it
// dims its base by; a metal's curve is a little off Schlick's. (At the half vector of w_out and axis rough
// dielectrics would reflect 2.6 times too much at 85 degrees.)
TEST(ZonalLobes, fresnel_is_the_mean_over_the_lobe) {
  struct Row {
    Case c;
    double tolerance;
  };
  for (const Row& row : std::vector<Row>{{metallic_roughness(vec3(0), 0, 0.5f), 0.01},
                                         {metallic_roughness(vec3(0), 0, 0.8f), 0.01},
                                         {coated(vec3(0), 0.5f), 0.01},
                                         {coated(vec3(0.5f), 0.9f, 2.0f), 0.01},
                                         {conductor("copper", 0.5f), 0.03},
                                         {conductor("iron", 0.8f), 0.03}}) {
    for (float degrees : {0.0f, 45.0f, 75.0f, 85.0f}) {
      const LobeError e = error_of(row.c, direction(degrees, 100));
      EXPECT_NEAR(e.lobe_albedo / e.albedo, 1, row.tolerance) << row.c.name << ", " << degrees << " degrees";
    }
  }
}

TEST(ZonalLobes, at_normal_incidence_the_lobe_is_exact) {
  for (float roughness : {0.5f, 0.8f, 1.0f}) {
    // 0.5 %: the table's interpolation.
    EXPECT_LT(error_of(white(roughness), vec3(0, 0, 1)).relative, 0.01) << roughness;
  }
}

TEST(ZonalLobes, diffuse_part_reflects_what_the_true_one_reflects) {
  const vec3 warm(0.8f, 0.5f, 0.2f);
  for (const Case& c : {lambert(warm), blinn_phong(warm, vec3(0.1f), 20), coated(warm, 0.3f),
                        coated(warm, 0.8f), metallic_roughness(warm, 0.4f, 0.5f)}) {
    for (float degrees : {0.0f, 45.0f, 85.0f}) {
      const vec3 w_out = direction(degrees, 10);
      const BsdfContext view = prepare(c.bsdf, w_out);
      double reflected = 0;
      SphericalGrid(w_out, 1).integrate([&](vec3 w, double weight) {
        reflected += double(evaluate(c.bsdf, view, w, Lobes::diffuse).x) * std::max(w.z, 0.0f) * weight;
      });
      // The coat's E_avg is the mean of its own interpolant; 8 x 8 points a cell see its knots to 1e-4.
      EXPECT_NEAR(zonal_brdf(c.bsdf, view, 3).diffuse.x * kPiD, reflected, 3e-4) << c.name << ", " << degrees;
    }
  }
}

TEST(ZonalLobes, kinds_without_a_symmetric_lobe_are_refused_by_reason) {
  Bsdf measured;
  measured.kind = BsdfKind::measured;
  EXPECT_NE(zonal_lobe_refusal(measured).find("is measured"), std::string::npos);
  EXPECT_NE(zonal_lobe_refusal(conductor("gold", 0.4f, 0.5f).bsdf).find("is anisotropic"), std::string::npos);
  EXPECT_NE(zonal_lobe_refusal(coated(vec3(0.5f), 0.4f, 1.5f, 0.6f).bsdf).find("is anisotropic"),
            std::string::npos);
  EXPECT_TRUE(has_zonal_lobe(Bsdf{}));
  for (const Case& c : all_kinds()) {
    if (c.bsdf.alpha_x == c.bsdf.alpha_y) {
      EXPECT_TRUE(has_zonal_lobe(c.bsdf)) << c.name;
    }
  }
}

TEST(ZonalLobes, everything_is_finite_at_any_roughness_and_elevation) {
  for (float roughness : {0.01f, 0.02f, 0.1f, 0.3f, 1.0f}) {
    for (float z : {1e-9f, 2e-8f, 1e-5f, 1e-3f, 0.1f, 0.9999999f, 1.0f}) {
      const vec3 w_out(0, safe_sqrt((1 - z) * (1 + z)), z);
      for (const Case& c : {white(roughness), coated(vec3(0.5f), roughness), conductor("gold", roughness),
                            blinn_phong(vec3(0.5f), vec3(0.5f), 2 / sqr(sqr(roughness)) - 2)}) {
        const ZonalBrdf b = zonal_brdf(c.bsdf, prepare(c.bsdf, w_out), kMaxZonalBands);
        EXPECT_TRUE(is_finite(b.diffuse) && is_finite(b.specular) && is_finite(b.axis)) << c.name << " " << z;
        EXPECT_NEAR(glm::length(b.axis), 1, 1e-5) << c.name << " " << z;
        for (float F : b.lobe) EXPECT_TRUE(std::isfinite(F)) << c.name << " " << z;
        EXPECT_GE(b.lobe[0], 0) << c.name << " " << z;
      }
    }
  }
}

/// Irradiance of a cap by quadrature over its circles, each of them in closed form.
double irradiance_by_quadrature(double a, double z) {
  const double s = std::sqrt((1 - z) * (1 + z));
  constexpr int kCircles = 4000;
  double sum = 0;
  for (int i = 0; i < kCircles; ++i) {
    const double g = a * (i + 0.5) / kCircles, level = std::cos(g) * z, swing = std::sin(g) * s;
    double around = 0;
    if (level >= swing) {
      around = 2 * kPiD * level;
    } else if (level > -swing) {
      const double half = std::acos(-level / swing);
      around = 2 * (level * half + swing * std::sin(half));
    }
    sum += around * std::sin(g) * a / kCircles;
  }
  return sum;
}

// Relative to the irradiance sin a of the way up, pi sin^3 a. Rounding of some ten operations in float: 1e-6;
// the midpoint rule adds 1e-7 (1/4000^2, and its kinks).
TEST(ZonalKernel, irradiance_of_a_cap_is_exact_across_the_horizon) {
  for (double a : {1e-5, 1e-3, 0.05, 0.4, 0.77, 0.8, 1.2, 1.5, 1.5707}) {
    for (double t = -1.3; t < 1.31; t += 0.1) {
      const double z = t * std::sin(a);
      if (std::abs(z) > 1) continue;
      const double scale = kPiD * std::pow(std::sin(a), 3);
      EXPECT_NEAR(shader::cap_irradiance(cap_of(a), float(z)) / scale, irradiance_by_quadrature(a, z) / scale,
                  3e-6)
          << "a = " << a << ", z = " << z;
    }
  }
}

TEST(ZonalKernel, irradiance_above_the_horizon_is_that_of_a_point_light) {
  for (double d : {1.2, 3.0, 50.0, 2e4}) {
    for (double z : {0.9, 1.0}) {
      const double a = std::asin(1 / d);
      if (z < std::sin(a)) continue;
      const shader::ZonalCap cap = shader::sphere_cap(float(d * d), 1.0f);
      EXPECT_NEAR(shader::cap_irradiance(cap, float(z)) * d * d / (kPiD * z), 1, 2e-6) << d;
    }
  }
  EXPECT_EQ(shader::cap_irradiance(shader::sphere_cap(100, 1), -0.2f), 0);
  EXPECT_EQ(shader::cap_irradiance({0, 0, 0}, 0.5f), 0);
  // On or inside the sphere: a hemisphere of light about w, pi (1 + z)/2.
  for (float z : {-1.0f, -0.4f, 0.0f, 0.7f, 1.0f}) {
    EXPECT_NEAR(shader::cap_irradiance(shader::sphere_cap(0.5f, 1), z), kPiD * (1 + z) / 2, 3e-6) << z;
  }
}

// The quadratic form is the exact product of two functions cut to 3 bands; float rounding of terms up to 4.
TEST(ZonalKernel, diffuse_form_is_the_product_of_three_bands) {
  double cosine[3], light[3];
  sh::clamped_cosine_zonal(3, cosine);
  for (double a : {0.05, 0.6, 1.4}) {
    sh::cap_zonal(3, sh::cap_from_half_angle(a), light);
    for (double z = -1; z <= 1; z += 0.125) {
      const double legendre[3] = {1, z, 1.5 * z * z - 0.5};
      double exact = 0;
      for (int l = 0; l < 3; ++l) exact += cosine[l] * light[l] * legendre[l];
      EXPECT_NEAR(shader::zonal_diffuse(float(light[0]), float(light[1]), float(light[2]), float(z)), exact,
                  2.5e-6);
    }
  }
}

// Eq. 5.14, one sum over bands, against 5.13, the dot product of both functions' full spherical harmonics.
// Float recurrences to 20 bands: 1e-5 of the largest sum.
TEST(ZonalKernel, one_sum_over_bands_is_the_full_product) {
  constexpr int kBands = 20;
  const Case c = white(0.3f);
  const vec3 w_out = direction(40, 20);
  const ZonalBrdf z = zonal_brdf(c.bsdf, prepare(c.bsdf, w_out), kBands);
  shader::ZonalLobe lobe = {};
  double F[kBands], light[kBands];
  for (int l = 0; l < kBands; ++l) {
    F[l] = z.lobe[l];
    lobe.weight[l] = z.lobe[l] * static_cast<float>(std::sqrt((2 * l + 1) / (4 * kPiD)));
  }
  std::vector<double> lobe_sh(kBands * kBands), light_sh(kBands * kBands);
  sh::rotate_zonal(kBands, F, glm::dvec3(z.axis), lobe_sh.data());
  Random random(5);
  for (double a : {0.02, 0.2, 1.0}) {
    sh::cap_zonal(kBands, sh::cap_from_half_angle(a), light);
    double largest = 0, worst = 0;
    for (int i = 0; i < 50; ++i) {
      const vec3 w = glm::normalize(i % 2 ? random.hemisphere() : z.axis + 0.2f * random.hemisphere());
      sh::rotate_zonal(kBands, light, glm::dvec3(w), light_sh.data());
      double full = 0;
      for (int k = 0; k < kBands * kBands; ++k) full += lobe_sh[k] * light_sh[k];
      largest = std::max(largest, std::abs(full));
      worst = std::max(worst,
                       std::abs(shader::zonal_lobe_cap(lobe, cap_of(a), glm::dot(w, z.axis), kBands) - full));
    }
    EXPECT_LT(worst, 1e-5 * largest) << "a = " << a;
  }
}

}  // namespace
}  // namespace zonal::test
