// `vsgl` as a method: blocks fitted to the map against closed forms, what they bring to a point against sums
// over their texels, and pictures where renderers break.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "core/error.h"
#include "integrators/vpl/vpl.h"
#include "integrators/vsgl/vsgl.h"
#include "integrators/vsgl/vsgl_receivers.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"
#include "tests/support.h"

namespace zonal {
namespace kernel {
#include "integrators/vsgl/spherical_gaussian.glsl"
#include "integrators/vsgl/vsgl.glsl"
}  // namespace kernel
namespace {

using glm::dvec3;
constexpr VsglGeneration kGenerations[] = {VsglGeneration::y2015, VsglGeneration::y2024};

Bsdf lambert(vec3 albedo) {
  Bsdf b;
  b.kind = BsdfKind::lambert, b.diffuse = albedo;
  return b;
}
Bsdf coated(float alpha, vec3 albedo = vec3(0.5f)) {
  Bsdf b;
  b.kind = BsdfKind::coated, b.diffuse = albedo, b.specular = vec3(1), b.eta = vec3(1.5f);
  b.alpha_x = b.alpha_y = alpha, b.coat = &SpecularAlbedo::dielectric(1.5f);
  return b;
}
Bsdf gold(float alpha_x, float alpha_y) {
  Bsdf b;
  b.kind = BsdfKind::conductor, b.specular = vec3(1), b.eta = vec3(0.2f, 0.4f, 1.4f),
  b.k = vec3(3.5f, 2.4f, 1.8f);
  b.alpha_x = alpha_x, b.alpha_y = alpha_y;
  return b;
}

VirtualLight texel(vec3 position, vec3 normal, vec3 w_in, vec3 power, const Bsdf& bsdf) {
  VirtualLight v;
  v.position = position, v.normal = normal, v.frame = Frame(normal), v.w_in = w_in, v.power = power,
  v.bsdf = bsdf;
  return v;
}
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
    if (alpha < 0.02f) EXPECT_NEAR(second.sharpness / first.sharpness, 1, 3 * alpha) << alpha;
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

// ---- Pictures
// -----------------------------------------------------------------------------------------------------------

/// A closed room with a spot light; `material` for the walls.
std::string room(const std::string& material, const std::string& camera = R"("position": [0, 1, 1.9])") {
  return R"({"camera": {)" + camera + R"(, "look_at": [0, 0.9, -2], "vertical_fov": 50},
    "materials": [{"name": "wall", )" +
         material + R"(}, {"name": "grey", "type": "lambert", "albedo": 0.5}],
    "objects": [{"name": "room", "type": "box", "low": [-1, 0, -2], "high": [1, 2, 2], "material": "wall"},
                {"name": "ball", "type": "sphere", "center": [0.4, 0.3, -0.8], "radius": 0.3, "material": "grey"}],
    "lights": [{"type": "spot", "position": [-0.3, 1.5, 0.5], "look_at": [0.9, 0.4, -1], "intensity": 9,
                "inner": 25, "outer": 40}]})";
}
const char* kWhite = R"("type": "lambert", "albedo": 1)";
const char* kGlossy = R"("type": "coated", "albedo": 0.4, "roughness": 0.4)";

VsglParams with(VsglGeneration generation, Occlusion occlusion) {
  VsglParams p;
  p.lights = 40, p.direct = ManyLightsParams::Direct::none;
  p.generation = generation, p.occlusion = occlusion;
  return p;
}

TEST(Vsgl, the_lobes_together_send_what_the_lights_of_the_other_methods_send) {
  // White Lambert walls send all the flux of the block's light. Sums of up to 196 floats: 196 x 6e-8 at
  // worst.
  int white = 0;
  const Scene scene = test::scene_from(room(kWhite));
  VirtualLightOptions options{.lights = 40, .block_texels = 14, .keep_texels = true};
  const VirtualLightSet set = make_virtual_lights(scene, options, Stop{});
  const auto blocks = fit_blocks(set, VsglGeneration::y2024, scene.bounds().radius);
  ASSERT_GT(blocks.size(), 20u);
  for (size_t i = 0; i < blocks.size(); ++i) {
    dvec3 arrived(0), reflected(0);
    for (uint32_t t = 0; t < set.lights[i].texel_count; ++t) {
      const VirtualLight& texel = set.texels[set.lights[i].first_texel + t];
      arrived += dvec3(texel.power), reflected += dvec3(texel.power * texel.bsdf.diffuse);
    }
    EXPECT_NEAR(arrived.y / set.lights[i].power.y, 1, 1e-4) << i;
    EXPECT_NEAR((blocks[i][0].flux.y + blocks[i][1].flux.y) / reflected.y, 1, 2e-5) << i;
    white += arrived.y == reflected.y;
  }
  EXPECT_GT(white, 20);  // these send all that the light of the other methods receives
}

TEST(Vsgl, the_vector_loops_compute_what_the_kernel_says) {
  for (const char* material :
       {kWhite, kGlossy, R"("type": "conductor", "metal": "gold", "roughness": 0.5, "anisotropy": 0.6)",
        R"("type": "metallic_roughness", "roughness": 0.3, "metallic": 0.5)",
        R"("type": "blinn_phong", "exponent": 40, "specular": 0.3)"}) {
    const Scene scene = test::scene_from(room(material));
    for (VsglGeneration generation : kGenerations) {
      VsglIntegrator method(with(generation, Occlusion::none));
      Film film(16, 16);
      render(scene, method, film, {.passes = 1}, {.seed = 4});
      const Image image = film.radiance();

      Tile tile;
      std::array<Sampler, kTilePixels> samplers;
      Camera camera = scene.camera();
      camera.width = camera.height = 16;
      trace_tile(scene, camera, ivec2(8, 0), 4, 0, false, &tile, samplers.data());
      for (int i = 0; i < tile.count; i += 7) {
        const Surface& s = tile.surfaces[i];
        const Bsdf& b = tile.bsdfs[i];
        const vec3 v = s.shading.to_local(s.w_out);
        const BsdfContext view = prepare(b, v);
        const bool second = generation == VsglGeneration::y2024;
        const float least = second ? 0x1p-41f : 0x1p-28f;
        vec3 sum(0);
        for (const VsglBlock& block : method.blocks()) {
          for (const VsglLobe& lobe : block) {
            vec3 axis;
            float scale;
            const float K = kernel::vsgl_radiance(
                {lobe.position, lobe.variance, lobe.flux, lobe.sharpness, lobe.axis}, lobe.coefficient,
                s.position, least, sqr(1e-6f * scene.bounds().radius), axis, scale);
            const vec3 a = s.shading.to_local(axis);
            const float S = second ? kernel::sg_cosine_2024(a.z, K) : kernel::sg_cosine_2015(a.z, K);
            vec3 reflected =
                b.diffuse * S * std::max(fit_coat(b, view).at(kernel::vsgl_base_cosine(a.z, K)), 0.0f);
            if (vsgl_has_specular(b)) {
              const vec2 alpha2 = vsgl_squared_widths(b);
              vec3 peak;
              const float value =
                  second ? kernel::vsgl_specular_2024(kernel::vsgl_filtered_receiver(v, alpha2), a, K, peak)
                         : kernel::vsgl_specular_2015(kernel::vsgl_asg_receiver(v, alpha2), a, K, peak);
              const float c = kernel::vsgl_half_cosine(v, peak);
              const vec3 F = b.kind == BsdfKind::conductor ? b.specular * fresnel_conductor(c, b.eta, b.k)
                             : b.kind == BsdfKind::coated  ? b.specular * fresnel_dielectric(c, b.eta.x)
                             : b.kind == BsdfKind::metallic_roughness ? fresnel_schlick(c, b.specular)
                                                                      : b.specular;
              reflected += F * value;
            }
            sum += lobe.flux * scale * reflected;
          }
        }
        const vec3 found = image.rgb(tile.pixels[i].x, tile.pixels[i].y);
        // Eighty terms, exponents of up to 20 rounded to 1e-7 of themselves in either exp.
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(found[c], sum[c], 2e-5 * sum[c] + 1e-12) << material << " " << i;
      }
    }
  }
}

double mean_luminance(const Image& image) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += luminance(image.rgb(x, y));
  return sum / (image.width * image.height);
}

TEST(Vsgl, is_as_bright_as_vpl_on_the_same_lights) {
  // Both methods' transport is the same without occlusion. Lobes of 2 or 2.29 for Lambert's, whose light
  // reaches below their horizon, and clouds for squares: within an eighth in a room that nothing is near
  // (measured 0.91 to 0.98).
  for (const char* material : {R"("type": "lambert", "albedo": 0.6)", kGlossy}) {
    const Scene scene = test::scene_from(room(material, R"("position": [0, 1.2, 0.5])"));
    VirtualLightOptions options{.lights = 300, .seed = 3, .block_texels = 6, .keep_texels = true};
    const VirtualLightSet set = make_virtual_lights(scene, options, Stop{});
    VplParams point_params;
    point_params.direct = ManyLightsParams::Direct::none, point_params.occlusion = Occlusion::none;
    point_params.clamp = 0.05f;
    VplIntegrator points(point_params);
    points.gather_from(set);
    Film film(24, 24);
    render(scene, points, film, {.passes = 1}, {});
    const double truth = mean_luminance(film.radiance());
    for (VsglGeneration generation : kGenerations) {
      VsglIntegrator lobes(with(generation, Occlusion::none));
      lobes.gather_from(set);
      Film found(24, 24);
      render(scene, lobes, found, {.passes = 1}, {});
      EXPECT_NEAR(mean_luminance(found.radiance()) / truth, 1, 0.125) << material;
    }
  }
}

TEST(Vsgl, a_flat_floor_lights_itself_by_a_known_share) {
  // A plane sends nothing to itself; spherical Gaussians about its normal have no horizon and do. README
  // states what share of the direct light that is at albedo 0.5: the sharper lobe of 2024 keeps it near 2 %.
  const Scene scene = test::scene_from(R"({
    "camera": {"position": [0, 3, 0.01], "look_at": [0, 0, 0], "vertical_fov": 40},
    "materials": [{"name": "a", "type": "lambert", "albedo": 0.5}],
    "objects": [{"name": "o", "type": "quad", "corner": [-9, 0, 9], "edges": [[18, 0, 0], [0, 0, -18]],
                 "material": "a"}],
    "lights": [{"type": "spot", "position": [0, 4, 0], "look_at": [0, 0, 0], "intensity": 10, "inner": 39,
                "outer": 40}]})");
  const double direct = mean_luminance(test::render_with(
      scene, "path", {.settings = R"({"max_bounces": 0})", .passes = 1, .width = 24, .height = 24}));
  double share[2];
  for (int g = 0; g < 2; ++g) {
    VsglParams params = with(kGenerations[g], Occlusion::none);
    params.lights = 400, params.block_texels = 4;
    VsglIntegrator method(params);
    Film film(24, 24);
    render(scene, method, film, {.passes = 1}, {});
    share[g] = mean_luminance(film.radiance()) / direct;
  }
  EXPECT_NEAR(share[0], 0.072, 0.015);
  EXPECT_NEAR(share[1], 0.021, 0.005);
}

TEST(Vsgl, turning_and_scaling_the_scene_with_its_lights_changes_nothing) {
  // Lengths 7 times as long: the same flux spreads over 49 times the area.
  const float scale = 7;
  const mat4 turn = glm::rotate(mat4(1), 1.1f, glm::normalize(vec3(1, 2, -0.5f)));
  const auto move = [&](vec3 p) { return vec3(turn * vec4(p * scale, 1)) + vec3(3, -2, 5); };
  const auto rotate = [&](vec3 w) { return glm::normalize(vec3(turn * vec4(w, 0))); };
  const auto scene_of = [&](bool moved) {
    SceneParts parts;
    auto wall = std::make_unique<CoatedMaterial>();
    wall->roughness.value = 0.4f, wall->anisotropy = 0;
    parts.materials.push_back(std::move(wall));
    ShapeData shape;
    const vec3 corners[] = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1},       {-1, 0, 1},
                            {-1, 2, -1}, {1, 2, -1}, {0, 0.9f, -0.5f}};
    for (vec3 p : corners) shape.mesh.positions.push_back(moved ? move(p) : p);
    shape.mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {0, 1, 6}};
    shape.material = 0;
    parts.shapes.push_back(std::move(shape));
    auto spot = std::make_unique<SpotLight>();
    const vec3 from(0.3f, 1.5f, 0.9f), to = glm::normalize(vec3(-0.2f, -1, -0.6f));
    spot->position = moved ? move(from) : from, spot->direction = moved ? rotate(to) : to;
    spot->intensity = vec3(4, 3, 2), spot->cone = {0.3f, 0.7f};
    parts.lights.push_back(std::move(spot));
    Camera c;
    c.position = vec3(0.2f, 1.2f, 2.5f), c.vertical_fov = 0.8f;
    if (moved) {
      c.position = move(c.position);
      c.right = rotate(c.right), c.up = rotate(c.up), c.forward = rotate(c.forward);
    }
    parts.camera = c;
    return Scene(std::move(parts));
  };
  const Scene still = scene_of(false), moved = scene_of(true);
  VirtualLightOptions options{.lights = 60, .seed = 9, .block_texels = 5, .keep_texels = true};
  const VirtualLightSet set = make_virtual_lights(still, options, Stop{});
  VirtualLightSet turned = set;
  for (auto* lights : {&turned.lights, &turned.texels}) {
    for (VirtualLight& v : *lights) {
      v.position = move(v.position), v.shadow_point = move(v.shadow_point);
      v.normal = rotate(v.normal), v.w_in = rotate(v.w_in);
      v.frame.x = rotate(v.frame.x), v.frame.y = rotate(v.frame.y), v.frame.z = rotate(v.frame.z);
      v.footprint *= scale * scale, v.primary_distance *= scale;
    }
  }
  for (VsglGeneration generation : kGenerations) {
    const auto picture = [&](const Scene& scene, const VirtualLightSet& lights) {
      VsglIntegrator method(with(generation, Occlusion::none));
      method.gather_from(lights);
      Film film(20, 20);
      render(scene, method, film, {.passes = 1}, {});
      return film.radiance();
    };
    const Image a = picture(still, set), b = picture(moved, turned);
    const double mean = mean_luminance(a);
    ASSERT_GT(mean, 0);
    for (size_t i = 0; i < a.pixels.size(); ++i)
      EXPECT_NEAR(b.pixels[i] * scale * scale, a.pixels[i], 1e-4 * (a.pixels[i] + mean)) << i;
  }
}

/// Renders and expects every sample to be finite and none negative before the film repairs anything.
void expect_sound(const Scene& scene, VsglParams params, const std::string& what, int width = 12) {
  VsglIntegrator method(params);
  Film film(width, 9);
  render(scene, method, film, {.passes = 1}, {.seed = 3});
  EXPECT_EQ(film.bad_samples(), 0u) << what;
}

TEST(Vsgl, leaves_no_nan_infinity_or_negative_radiance) {
  const std::string cameras[] = {R"("position": [0, 1, 1.9])",
                                 R"("position": [0, 0.00001, 1.9])"};  // along the floor
  for (VsglGeneration generation : kGenerations) {
    for (Occlusion occlusion : {Occlusion::none, Occlusion::center}) {
      VsglParams params = with(generation, occlusion);
      params.block_texels = 3;
      for (double roughness : {0.0, 0.01, 0.1, 0.5, 1.0}) {
        for (const char* type : {"coated", "metallic_roughness", "conductor"}) {
          const std::string material =
              "\"type\": \"" + std::string(type) + "\", \"roughness\": " + std::to_string(roughness);
          for (const std::string& camera : cameras) {
            const Scene scene = test::scene_from(room(material, camera));
            for (int lights : {1, 60}) {
              params.lights = lights;
              expect_sound(scene, params, material + " " + camera + " " + std::to_string(lights));
            }
          }
        }
      }
    }
  }
}

TEST(Vsgl, one_hundred_thousand_lights_stay_sound) {
  VsglParams params = with(VsglGeneration::y2024, Occlusion::none);
  params.lights = 100000, params.block_texels = 1;
  expect_sound(test::scene_from(room(kGlossy)), params, "100,000 lights", 5);
}

TEST(Vsgl, lights_on_the_shaded_point_and_behind_it_stay_sound) {
  // A camera ray meets the very texels of the lights, and lights stand under the floor.
  const Scene scene = test::scene_from(room(kGlossy));
  std::vector<VirtualLight> lights;
  for (float alpha : {1e-4f, 0.1f, 1.0f}) {
    Camera camera = scene.camera();
    camera.width = 12, camera.height = 9;
    for (int i = 0; i < 12 * 9; ++i) {
      const vec3 direction = camera.direction(vec2(i % 12 + 0.5f, i / 12 + 0.5f));
      const Hit hit = scene.intersect(camera.position, direction);
      ASSERT_TRUE(hit.found());
      const Surface s = scene.surface(hit, direction);
      VirtualLight v =
          texel(s.position, s.normal, s.w_out, vec3(1), i % 2 ? coated(alpha) : gold(alpha, alpha));
      v.shadow_point = offset_origin(s, s.normal);
      lights.push_back(v);
      v.position -= 0.2f * s.normal, v.normal = -s.normal, v.frame = Frame(-s.normal);
      v.w_in = -v.w_in;
      lights.push_back(v);
    }
  }
  VirtualLightSet set;
  set.lights = lights;
  for (VsglGeneration generation : kGenerations) {
    for (Occlusion occlusion : {Occlusion::none, Occlusion::center}) {
      VsglIntegrator method(with(generation, occlusion));
      method.gather_from(set);
      Film film(12, 9);
      render(scene, method, film, {.passes = 1}, {});
      EXPECT_EQ(film.bad_samples(), 0u);
      EXPECT_GT(mean_luminance(film.radiance()), 0);
    }
  }
}

TEST(Vsgl, refuses_paths_and_measured_materials_by_name) {
  try {
    find_integrator("vsgl", "").make(nlohmann::json::parse(R"({"distribution": "paths"})"), "x", nullptr);
    FAIL() << "paths were taken";
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("paths"), std::string::npos) << e.what();
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
  }
  SceneParts parts;
  auto measured = std::make_unique<MeasuredMaterial>();
  measured->name = "blue-fabric";
  parts.materials.push_back(std::move(measured));
  const Scene scene(std::move(parts));
  VsglIntegrator method(with(VsglGeneration::y2024, Occlusion::none));
  Film film(4, 4);
  try {
    render(scene, method, film, {.passes = 1}, {});
    FAIL() << "a measured material was taken";
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("blue-fabric"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace zonal
