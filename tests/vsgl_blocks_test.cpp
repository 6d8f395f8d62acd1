// Blocks of the map as spherical Gaussian lights: their fit against closed forms, what they bring to a point
// against sums over their texels.
#include <gtest/gtest.h>

#include "materials/microfacet.h"
#include "tests/vsgl_support.h"

namespace zonal {
namespace {

using namespace test;
using glm::dvec3;

/// A set of one light whose block is `texels`.
VirtualLightSet one_block(std::vector<VirtualLight> texels) {
  VirtualLightSet set;
  VirtualLight light = texels[texels.size() / 2];
  light.power = vec3(0);
  for (const VirtualLight& t : texels) light.power += t.power;
  light.shadow_point = light.position + 1e-4f * light.normal;
  light.texel_count = static_cast<uint32_t>(texels.size());
  set.lights = {light};
  set.texels = std::move(texels);
  return set;
}
VsglLobe lobe_of(std::vector<VirtualLight> texels, int which,
                 VsglGeneration generation = VsglGeneration::y2024) {
  return fit_blocks(one_block(std::move(texels)), generation, 10)[0][which];
}

TEST(VsglBlocks, a_square_of_texels_has_the_variance_of_the_square) {
  // n x n patches of a square of side 2 tile it: variance 4/12 along each axis. Far from the origin, where
  // squares of coordinates in float have no digits left for it.
  for (int n : {1, 2, 14}) {
    std::vector<VirtualLight> texels;
    for (int i = 0; i < n * n; ++i) {
      const vec3 p(1000 + (i % n + 0.5f) * 2 / n, -500, 2000 + (i / n + 0.5f) * 2 / n);
      texels.push_back(texel(p, vec3(0, 1, 0), vec3(0, 1, 0), vec3(1, 2, 3), lambert(vec3(0.5f))));
      texels.back().footprint = 4.0f / float(n * n);
    }
    const VsglLobe lobe = lobe_of(texels, 0);
    EXPECT_NEAR(lobe.variance, 4.0 / 12, 1e-3) << n;  // positions are rounded to 1e-4
    EXPECT_NEAR(lobe.position.x, 1001, 2e-4);
    EXPECT_NEAR(lobe.position.z, 2001, 2e-4);
    EXPECT_NEAR(lobe.flux.z, 3 * 0.5 * n * n, 3e-5 * lobe.flux.z);
    EXPECT_NEAR(lobe.sharpness, 2.292504, 1e-5);  // all alike: the lobe of one
  }
}

TEST(VsglBlocks, two_walls_blunt_the_lobe_and_weights_draw_it) {
  // Two normals 2 b apart: the mean direction has the length cos b times that of one lobe. Both analytic in
  // Banerjee's form.
  const double a = 0.5749255543539332;
  for (double b : {0.0, 0.02, 0.3, 1.2}) {
    const vec3 n1(float(std::sin(b)), 0, float(std::cos(b))), n2(-n1.x, 0, n1.z);
    const vec3 w(0, 0, 1);
    const VsglLobe lobe = lobe_of({texel(vec3(0), n1, w, vec3(1), lambert(vec3(1))),
                                   texel(vec3(0, 2, 0), n2, w, vec3(1), lambert(vec3(1)))},
                                  0);
    const double r = a * std::cos(b);
    EXPECT_NEAR(lobe.sharpness, r * (3 - r * r) / (1 - r * r), 1e-5) << b;
    EXPECT_NEAR(lobe.axis.z, 1, 1e-6) << b;
    EXPECT_NEAR(lobe.variance, 0.5, 1e-5) << b;  // total variance 1, halved
    EXPECT_NEAR(lobe.position.y, 1, 1e-6);
  }
  // Three times the flux pulls the mean three quarters of the way.
  const VsglLobe drawn =
      lobe_of({texel(vec3(0), vec3(0, 0, 1), vec3(0, 0, 1), vec3(1, 0, 2), lambert(vec3(1))),
               texel(vec3(4, 0, 0), vec3(0, 0, 1), vec3(0, 0, 1), vec3(9, 0, 0), lambert(vec3(1)))},
              0);
  EXPECT_NEAR(drawn.position.x, 3, 1e-6);
  EXPECT_NEAR(drawn.flux.x, 10, 1e-5);
  EXPECT_NEAR(drawn.flux.z, 2, 1e-6);
}

TEST(VsglBlocks, sharp_lobes_keep_their_sharpness) {
  // In float the length of a mean direction cannot tell lobes beyond 1e7 apart; its difference from 1 can.
  for (float alpha : {0.3f, 0.01f, 1e-3f, 1e-4f}) {
    const vec3 w_in = glm::normalize(vec3(0.5f, 0.2f, 0.8f));
    std::vector<VirtualLight> texels(9, texel(vec3(0), vec3(0, 0, 1), w_in, vec3(1), gold(alpha, alpha)));
    const VsglLobe first = lobe_of(texels, 1, VsglGeneration::y2015);
    const double expected = (2.0 / (double(alpha) * alpha) - 2) / (4 * double(w_in.z));
    EXPECT_NEAR(first.sharpness / expected, 1, 1e-4) << alpha;
    EXPECT_NEAR(glm::dot(first.axis, vec3(-w_in.x, -w_in.y, w_in.z)), 1, 2e-7);
    // About the dominant normal the lobe turns towards the light, the more the rougher; smooth surfaces
    // agree.
    const VsglLobe second = lobe_of(texels, 1, VsglGeneration::y2024);
    EXPECT_GE(second.axis.z, first.axis.z - 1e-6f) << alpha;
    if (alpha < 0.02f) {
      EXPECT_NEAR(second.sharpness / first.sharpness, 1, 3 * alpha) << alpha;
    }
  }
}

/// The share of light from w_in that a surface's specular lobe reflects: quadrature of the BRDF in the code,
/// whose sampling density takes out the lobe (midpoints of the unit square).
vec3 specular_albedo(const Bsdf& b, vec3 w_in) {
  const BsdfContext view = prepare(b, w_in);
  glm::dvec3 sum(0);
  const int n = 128;
  for (int i = 0; i < n * n; ++i) {
    const vec2 u((i % n + 0.5f) / n, (i / n + 0.5f) / n);
    const vec3 h = sample_visible_normal(w_in, b.alpha_x, b.alpha_y, u);
    const vec3 w = 2.0f * glm::dot(w_in, h) * h - w_in;
    if (!(w.z > 0)) continue;
    const float density =
        ggx_reflection_pdf(ggx_distribution(h, b.alpha_x, b.alpha_y), w_in.z, view.stretch_out);
    sum += dvec3(evaluate(b, view, w, Lobes::specular)) * double(w.z / density);
  }
  return vec3(sum / double(n * n));
}

TEST(VsglBlocks, the_specular_flux_is_what_the_surface_reflects_or_close) {
  // Of a coat the table says what it reflects (its own error is 1e-3). Of a metal Fresnel's factor and the
  // masking at the lobe's axis stand for their means over the lobe, which are lower: up to 14 % at alpha
  // 0.25, 60 degrees (README).
  for (float alpha : {0.02f, 0.09f, 0.25f}) {
    for (double theta : {0.0, 0.5, 1.05}) {
      const vec3 w_in(float(std::sin(theta)), 0, float(std::cos(theta)));
      for (VsglGeneration generation : kGenerations) {
        const auto flux = [&](const Bsdf& b) {
          return texel_lobes(texel(vec3(0), vec3(0, 0, 1), w_in, vec3(1), b), generation).flux[1].x;
        };
        const double coat = flux(coated(alpha)) / specular_albedo(coated(alpha), w_in).x;
        EXPECT_NEAR(coat, 1, 1e-2) << "alpha " << alpha << " theta " << theta;
        const double metal = flux(gold(alpha, alpha)) / specular_albedo(gold(alpha, alpha), w_in).x;
        EXPECT_GT(metal, 1 - 2e-3) << "alpha " << alpha << " theta " << theta;
        EXPECT_LT(metal, 1 + 0.56 * alpha) << "alpha " << alpha << " theta " << theta;
      }
    }
  }
}

TEST(VsglBlocks, what_a_base_under_a_coat_sends_is_exact) {
  // Kelemen and Szirmay-Kalos: of light from w_in, rho (1 - E(w_in)) leaves; quadrature over cosines and
  // azimuth-free.
  for (float alpha : {0.05f, 0.4f}) {
    const Bsdf b = coated(alpha, vec3(0.8f));
    for (float z : {1.0f, 0.5f, 0.1f}) {
      const vec3 w_in(std::sqrt(1 - z * z), 0, z);
      const BsdfContext view = prepare(b, w_in);
      double sum = 0;
      for (int i = 0; i < 4000; ++i) {
        const float c = (i + 0.5f) / 4000;
        sum +=
            evaluate(b, view, vec3(0, std::sqrt(1 - c * c), c), Lobes::diffuse).x * 2 * 3.14159265 * c / 4000;
      }
      const VsglTexel t = texel_lobes(texel(vec3(0), vec3(0, 0, 1), w_in, vec3(1), b), VsglGeneration::y2024);
      EXPECT_NEAR(t.flux[0].x / sum, 1, 2e-3) << alpha << " " << z;  // the table's own error is 1e-3
    }
  }
}

TEST(VsglBlocks, far_away_a_texel_is_its_point_light) {
  // Flux times the normalised lobe over the squared distance, from any direction.
  const VsglLobe lobe =
      lobe_of({texel(vec3(1, 2, 3), vec3(0, 0, 1), vec3(0, 0, 1), vec3(5), lambert(vec3(1)))}, 0);
  const kernel::VsglLight light{lobe.position, lobe.variance, lobe.flux, lobe.sharpness, lobe.axis};
  const double k = lobe.sharpness;
  for (float distance : {0.01f, 1.0f, 100.0f}) {
    for (const dvec3 w : {dvec3(0, 0, 1), dvec3(0.6, 0, 0.8), dvec3(0, -0.96, -0.28)}) {
      for (float least_share : {0x1p-28f, 0x1p-41f}) {
        const vec3 point = light.position + distance * vec3(w);
        vec3 axis;
        float scale;
        const float K =
            kernel::vsgl_radiance(light, lobe.coefficient, point, least_share, 1e-12f, axis, scale);
        const double vmf = std::exp(k * (w.z - 1)) * k / (6.283185307 * -std::expm1(-2 * k));
        const double irradiance = double(scale) * kernel::sg_integral(K);
        // Distances of 0.01 from a point at 3 are rounded to 2e-5; the cloud's floor is a millionth.
        EXPECT_NEAR(irradiance / (vmf / (double(distance) * distance)), 1, distance < 0.1 ? 2e-4 : 1e-5)
            << distance << " " << w.x << " " << w.z;
        EXPECT_NEAR(glm::dot(dvec3(axis), -w), 1, 1e-6);
      }
    }
  }
}

TEST(VsglBlocks, at_some_distance_a_block_sends_what_its_texels_send) {
  // A lit square of side 2, seen from 3 and 6 sides away by a surface facing it: one closed form against the
  // sum over 20 x 20 texels of flux vMF(w) cos / r^2.
  std::vector<VirtualLight> texels;
  for (int i = 0; i < 400; ++i)
    texels.push_back(texel(vec3((i % 20 + 0.5f) * 0.1f - 1, (i / 20 + 0.5f) * 0.1f - 1, 0), vec3(0, 0, 1),
                           vec3(0, 0, 1), vec3(1), lambert(vec3(1))));
  const VsglLobe lobe = lobe_of(texels, 0);
  const kernel::VsglLight light{lobe.position, lobe.variance, lobe.flux, lobe.sharpness, lobe.axis};
  const double k = lobe.sharpness;
  for (const dvec3 x : {dvec3(0, 0, 6), dvec3(3, 0, 5), dvec3(0, 0, 12), dvec3(8, 3, 8)}) {
    const dvec3 n = glm::normalize(-x);
    double sum = 0;
    for (const VirtualLight& t : texels) {
      const dvec3 d = dvec3(t.position) - x;
      const double r2 = glm::dot(d, d);
      const dvec3 w = d / std::sqrt(r2);
      sum += std::exp(k * (-w.z - 1)) * k / (6.283185307 * -std::expm1(-2 * k)) * glm::dot(n, w) / r2;
    }
    vec3 axis;
    float scale;
    const float K = kernel::vsgl_radiance(light, lobe.coefficient, vec3(x), 0x1p-41f, 1e-12f, axis, scale);
    const double irradiance =
        lobe.flux.x * scale * 3.14159265358979 * kernel::sg_cosine_2024(float(glm::dot(n, dvec3(axis))), K);
    // The Gaussian cloud spreads in all directions, the square does not: second order in size over distance.
    EXPECT_NEAR(irradiance / sum, 1, 3 * 0.333 / glm::dot(x, x)) << x.x << " " << x.z;
  }
}

TEST(VsglReceivers, the_fit_of_a_coats_loss_follows_its_table) {
  for (float alpha : {0.01f, 0.09f, 0.36f, 1.0f}) {
    const Bsdf b = coated(alpha);
    for (float z : {1.0f, 0.6f, 0.2f}) {
      const BsdfContext view = prepare(b, vec3(std::sqrt(1 - z * z), 0, z));
      const VsglCoat coat = fit_coat(b, view);
      for (float c = 0.05f; c <= 1; c += 0.05f) {
        const vec3 w(0, std::sqrt(1 - c * c), c);
        const float truth = evaluate(b, view, w, Lobes::diffuse).x / 0.5f * kPi;
        EXPECT_NEAR(coat.at(c), truth, 0.025 * kPi * view.normalization) << alpha << " " << z << " " << c;
      }
    }
  }
}

}  // namespace
}  // namespace zonal
