// What the four many-light methods share: BRDFs in arrays, the order of points, shadow rays, splitting over
// passes.
#include "integrators/many_lights.h"

#include <gtest/gtest.h>

#include "core/sampling.h"
#include "integrators/bsdf_arrays.h"
#include "integrators/vpl/vpl.h"
#include "tests/support.h"

namespace zonal {
namespace {

/// One material of every kind that reflects, rough and smooth.
std::vector<std::unique_ptr<Material>> materials() {
  std::vector<std::unique_ptr<Material>> all;
  for (const float roughness : {0.01f, 0.2f, 0.7f, 1.0f}) {
    auto metal = std::make_unique<ConductorMaterial>();
    metal->roughness.value = roughness, metal->anisotropy = 0.4f;
    auto coated = std::make_unique<CoatedMaterial>();
    coated->roughness.value = roughness, coated->albedo.value = vec3(0.7f, 0.2f, 0.4f);
    auto stretched = std::make_unique<CoatedMaterial>();
    stretched->roughness.value = roughness, stretched->anisotropy = -0.5f;
    auto gltf = std::make_unique<MetallicRoughnessMaterial>();
    gltf->roughness.value = roughness, gltf->metallic.value = 0.3f;
    all.push_back(std::move(metal)), all.push_back(std::move(coated));
    all.push_back(std::move(stretched)), all.push_back(std::move(gltf));
  }
  all.push_back(std::make_unique<LambertMaterial>());
  all.push_back(std::make_unique<BlinnPhongMaterial>());
  return all;
}

vec3 random_direction(uint32_t key) {
  const float u = unit_float(hash32(key, 1)), v = unit_float(hash32(key, 2));
  vec3 w = uniform_sphere({u, v});
  w.z = std::fabs(w.z) + 1e-4f;
  return glm::normalize(w);
}

class BrdfsInArrays : public testing::TestWithParam<Lobes> {};

TEST_P(BrdfsInArrays, have_the_values_of_one_at_a_time) {
  const auto all = materials();
  constexpr int kCount = 200;
  std::vector<Bsdf> bsdfs;
  std::vector<BsdfContext> views;
  BsdfArrays arrays(kCount);
  for (int i = 0; i < kCount; ++i) {
    bsdfs.push_back(all[hash32(i) % all.size()]->at({}));
    const bool light = i % 3 == 0;
    vec3 out = random_direction(7 * i);
    if (i % 17 == 0) out.z = -out.z;  // seen from below: black
    views.push_back(prepare(bsdfs.back(), out, light ? PathEnd::light : PathEnd::camera));
    arrays.set(i, bsdfs.back(), views.back(), GetParam());
  }
  arrays.finish();

  std::array<std::vector<float>, 3> w, f, one;
  std::vector<float> density(kCount);
  for (int c = 0; c < 3; ++c) f[c].resize(kCount), one[c].resize(kCount);
  for (int i = 0; i < kCount; ++i) {
    // Half of the directions near the mirror's, where lobes are high; some from below.
    vec3 in = random_direction(11 * i + 3);
    const vec3 o = views[i].w_out;
    if (i % 2) in = glm::normalize(vec3(-o.x, -o.y, o.z) + 0.02f * in);
    if (i % 13 == 0) in.z = -in.z;
    for (int c = 0; c < 3; ++c) w[c].push_back(in[c]);
  }
  const int first = 5, end = kCount - 3;  // a part, off the vectors' places
  arrays.evaluate_with_pdf(first, end, &w[0][first], &w[1][first], &w[2][first], f[0].data(), f[1].data(),
                           f[2].data(), density.data());
  for (int i = first; i < end; ++i) {
    const vec3 in(w[0][i], w[1][i], w[2][i]);
    const vec3 truth = evaluate(bsdfs[i], views[i], in, GetParam());
    // The narrowest lobe (alpha 1e-4) falls by a factor of e within 1e-4 of the half vector, whose components
    // are rounded to 6e-8 in either code: 1e-3 and some; the others agree far better.
    const float share = bsdfs[i].alpha_x < 0.01f ? 5e-3f : 2e-5f;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(f[c][i - first], truth[c], share * truth[c] + 1e-7f) << "entry " << i << " channel " << c;
    if (GetParam() == Lobes::all) {
      const float p = pdf(bsdfs[i], views[i], in);
      EXPECT_NEAR(density[i - first], p, share * p + 1e-7f) << "entry " << i;
    }
  }
  for (int i = 0; i < kCount; i += 23) {
    arrays.evaluate_one(i, kCount, w[0].data(), w[1].data(), w[2].data(), one[0].data(), one[1].data(),
                        one[2].data());
    for (int k = 0; k < kCount; ++k) {
      const vec3 truth = evaluate(bsdfs[i], views[i], {w[0][k], w[1][k], w[2][k]}, GetParam());
      const float share = bsdfs[i].alpha_x < 0.01f ? 5e-3f : 2e-5f;
      EXPECT_NEAR(one[1][k], truth.y, share * truth.y + 1e-7f) << "entry " << i << " direction " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lobes, BrdfsInArrays, testing::Values(Lobes::all, Lobes::diffuse, Lobes::specular),
                         [](const auto& info) {
                           return info.param == Lobes::all       ? "all"
                                  : info.param == Lobes::diffuse ? "diffuse"
                                                                 : "specular";
                         });

}  // namespace
}  // namespace zonal
