/// RGL materials against what is independent of them: Mitsuba 3's values, the format's definition as slow
/// integrals in double, the analytic surface that a file was made from, quadrature, and Pearson's chi-square
/// test. What needs the real files runs where ZONAL_DATA is set.

#include "materials/rgl.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "tests/bsdf_cases.h"
#include "tests/bsdf_quadrature.h"
#include "tests/measured_files.h"
#include "tests/paths.h"
#include "tests/slow_rgl.h"

namespace zonal {
namespace {

using namespace test;

RglSpec isotropic_spec() {
  return {.surface = {0.3, 0.3}};
}
RglSpec anisotropic_spec(int reduction) {
  return {.surface = {0.2, 0.5},
          .azimuths = 16 / reduction + 1,
          .reduction = reduction,
          .elevations = 7,
          .facets = 25,
          .side = 13};
}

struct Sample {
  std::string name;
  std::unique_ptr<RglBrdf> brdf;
};
/// The real files, and a made one of each kind; read once for all tests.
const std::vector<Sample>& everything() {
  static std::vector<Sample> all;
  if (!all.empty()) return all;
  const auto make = [&](const std::string& name, const RglSpec& spec) {
    all.push_back({name, std::make_unique<RglBrdf>(TensorFile(name, rgl_tensors(spec).bytes()))});
  };
  make("isotropic", isotropic_spec());
  make("anisotropic", anisotropic_spec(1));
  make("anisotropic, a quarter", anisotropic_spec(4));
  for (const std::string& file : published_rgl_files())
    all.push_back({std::filesystem::path(file).stem().string(), std::make_unique<RglBrdf>(TensorFile(file))});
  return all;
}

/// How closely quadrature must look at the mirror direction: GGX's alpha at this height of D.
double lobe_width(const RglBrdf& brdf) {
  const vec3 w(0.6f, 0, 0.8f), mirror(-0.6f, 0, 0.8f);
  return std::clamp(1 / std::sqrt(40.0 * double(max_component(brdf.evaluate(w, mirror)) + 1)), 0.005, 0.3);
}

double data_density(const RglBrdf& brdf, vec3 w_out, vec3 w_in) {
  const double cosine = double(w_in.z) * RglBrdf::kCosineShare / kPiDouble;
  return (brdf.pdf(w_out, w_in) - cosine) / (1 - double(RglBrdf::kCosineShare));
}

// ---- values ----------------------------------------------------------------------------------------------

TEST(Rgl, equals_the_definition_in_double) {
  std::vector<std::pair<std::string, std::string>> files = {
      {"isotropic", rgl_tensors(isotropic_spec()).bytes()},
      {"anisotropic", rgl_tensors(anisotropic_spec(1)).bytes()}};
  for (const auto& [name, bytes] : files) {
    const TensorFile file(name, bytes);
    const RglBrdf brdf(file);
    const SlowRgl slow(file);
    Random random(1);
    for (int i = 0; i < 100; ++i) {
      const vec3 w_out = random.hemisphere(), w_in = random.hemisphere();
      if (w_out.z < 0.02f || w_in.z < 0.02f) continue;
      const SlowRgl::Value truth = slow(glm::normalize(Vec(w_out)), glm::normalize(Vec(w_in)));
      const vec3 f = brdf.evaluate(w_out, w_in);
      // Some ten roundings of 6e-8, times the number of cells by which a place is multiplied, 32.
      for (int k = 0; k < 3; ++k)
        ASSERT_NEAR(f[k] * w_in.z, truth.f_cos[k], 2e-5 * glm::length(truth.f_cos)) << name << i;
      ASSERT_NEAR(data_density(brdf, w_out, w_in), truth.density, 5e-5 * truth.density + 1e-6) << name << i;
    }
  }
}

TEST(Rgl, a_file_made_from_a_surface_is_that_surface) {
  // The grids are coarse: a few percent of the mean, 22 degrees between azimuths being the worst of it.
  // Exchanged directions or a wrong cosine, factor or azimuth would show as tens of percent.
  for (const int reduction : {0, 1, 2, 4}) {
    const RglSpec spec = reduction ? anisotropic_spec(reduction) : isotropic_spec();
    const RglBrdf brdf(TensorFile("made", rgl_tensors(spec).bytes()));
    EXPECT_EQ(brdf.isotropic(), reduction == 0);
    Random random(2);
    double error = 0, sum = 0;
    for (int i = 0; i < 20000; ++i) {
      const vec3 w_out = random.hemisphere(), w_in = random.hemisphere();
      if (w_out.z < 0.2f || w_in.z < 0.1f) continue;
      const Vec truth = spec.surface.f(Vec(w_out), Vec(w_in));
      const Vec f = Vec(brdf.evaluate(w_out, w_in));
      for (int k = 0; k < 3; ++k) error += std::abs(f[k] - truth[k]) * w_in.z, sum += truth[k] * w_in.z;
    }
    EXPECT_LT(error / sum, reduction ? 0.06 : 0.03) << reduction;
  }
}

TEST(Rgl, stored_quarters_and_halves_are_mirrored) {
  const RglBrdf half(TensorFile("half", rgl_tensors(anisotropic_spec(2)).bytes()));
  const RglBrdf quarter(TensorFile("quarter", rgl_tensors(anisotropic_spec(4)).bytes()));
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const vec3 o = random.hemisphere(), w = random.hemisphere();
    if (o.z < 0.05f) continue;
    for (const vec3 sign : {vec3(-1, -1, 1), vec3(-1, 1, 1), vec3(1, -1, 1)}) {
      EXPECT_EQ(quarter.evaluate(o * sign, w * sign), quarter.evaluate(o, w));
      EXPECT_EQ(quarter.pdf(o * sign, w * sign), quarter.pdf(o, w));
    }
    EXPECT_EQ(half.evaluate(o * vec3(-1, -1, 1), w * vec3(-1, -1, 1)), half.evaluate(o, w));
  }
}

TEST(Rgl, agrees_with_mitsuba) {
  if (published_rgl_files().empty()) GTEST_SKIP() << kNoPublishedFiles;
  const auto golden =
      nlohmann::json::parse(std::ifstream(test::source_dir() + "/tests/golden/rgl_mitsuba.json"));
  std::map<std::string, std::unique_ptr<RglBrdf>> brdfs;
  for (const std::string& file : published_rgl_files())
    brdfs[std::filesystem::path(file).filename().string()] = std::make_unique<RglBrdf>(TensorFile(file));
  const auto vec = [](const nlohmann::json& a) {
    return vec3(a[0].get<float>(), a[1].get<float>(), a[2].get<float>());
  };
  int values = 0, samples = 0;
  double worst = 0;
  for (const auto& row : golden["value_rows"]) {
    const auto brdf = brdfs.find(row[0].get<std::string>());
    if (brdf == brdfs.end()) continue;
    const vec3 w_out = vec(row[1]), w_in = vec(row[2]), truth = glm::max(vec(row[3]), vec3(0));
    const vec3 ours = brdf->second->evaluate(w_out, w_in) * w_in.z;
    // Relative to the largest channel: where a colour is out of gamut, a channel is the difference of
    // cancelling samples.
    const float tolerance = 1e-4f * max_component(truth) + 1e-7f;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(ours[k], truth[k], tolerance) << row.dump();
      worst = std::max(worst, double(std::abs(ours[k] - truth[k])) / (max_component(truth) + 1e-3));
    }
    const double density = row[4].get<double>();
    EXPECT_NEAR(data_density(*brdf->second, w_out, w_in), density, 1e-4 * density + 1e-6) << row.dump();
    ++values;
  }
  for (const auto& row : golden["sample_rows"]) {
    const auto brdf = brdfs.find(row[0].get<std::string>());
    if (brdf == brdfs.end()) continue;
    const vec3 w_out = vec(row[1]), truth = vec(row[3]);
    // Mitsuba's first random number is our second.
    const vec3 ours =
        brdf->second->sample_direction(w_out, 0.99f, {row[2][1].get<float>(), row[2][0].get<float>()});
    EXPECT_LT(glm::distance(ours, truth), 1e-4f) << row.dump();
    ++samples;
  }
  RecordProperty("values", values), RecordProperty("samples", samples);
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GE(values, 20);
  EXPECT_GE(samples, 3);
}

TEST(Rgl, many_at_once_equal_one_by_one) {
  for (const Sample& sample : everything()) {
    Random random(4);
    std::vector<vec3> w_in(2000), f(2000);
    for (vec3& w : w_in) w = random.hemisphere();
    w_in[7] = vec3(0, 0, -1), w_in[8] = vec3(1, 0, 0);
    for (const int n : {100, 2000}) {  // below and above the number from which slices are mixed first
      const vec3 w_out = random.hemisphere();
      sample.brdf->evaluate(w_out, n, w_in.data(), f.data());
      for (int i = 0; i < n; ++i) {
        const vec3 one = sample.brdf->evaluate(w_out, w_in[size_t(i)]);
        ASSERT_LT(max_component(glm::abs(f[size_t(i)] - one)), 1e-4f * max_component(one) + 1e-6f)
            << sample.name;
      }
    }
  }
}

TEST(Rgl, an_isotropic_surface_may_be_turned) {
  for (const Sample& sample : everything()) {
    if (!sample.brdf->isotropic()) continue;
    Random random(5);
    for (int i = 0; i < 300; ++i) {
      const vec3 o = random.hemisphere(), w = random.hemisphere();
      if (o.z < 0.02f) continue;
      const float a = 6.2f * random.unit(), c = std::cos(a), s = std::sin(a);
      const auto turn = [&](vec3 v) { return vec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z); };
      const vec3 f = sample.brdf->evaluate(o, w), g = sample.brdf->evaluate(turn(o), turn(w));
      // An angle's rounding, 3e-7, over the 1/127 of a cell, over the 8e-3 of the narrowest lobe.
      ASSERT_LT(max_component(glm::abs(f - g)), 2e-3f * max_component(f) + 1e-5f) << sample.name << " " << i;
    }
  }
}

TEST(Rgl, is_finite_everywhere) {
  std::vector<vec3> hard = {vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 0, -1), vec3(-1, -0.0f, 0)};
  for (const float z : {1e-30f, 2e-8f, 1e-4f, 0.5f, 0.99999994f})
    for (const float a : {0.0f, 1.0f, 3.1415925f, -3.1415925f, -1.5707963f})
      hard.push_back({safe_sqrt(1 - z * z) * std::cos(a), safe_sqrt(1 - z * z) * std::sin(a), z});
  for (const Sample& sample : everything()) {
    for (const vec3 o : hard) {
      for (const vec3 w : hard) {
        vec3 f;
        float pdf;
        sample.brdf->evaluate_with_pdf(o, w, &f, &pdf);
        ASSERT_TRUE(is_finite(f) && std::isfinite(pdf)) << sample.name;
        ASSERT_TRUE(f.x >= 0 && f.y >= 0 && f.z >= 0 && pdf >= 0) << sample.name;
        const bool above = o.z > 0 && w.z > 0;
        ASSERT_EQ(above, pdf > 0) << sample.name;
        ASSERT_TRUE(above || is_black(f)) << sample.name;
      }
      for (const float u : {0.0f, 0.3f, 0.99999994f}) {
        const vec3 w = sample.brdf->sample_direction(o, 0.5f, {u, 1 - u});
        ASSERT_TRUE(is_finite(w)) << sample.name;
      }
    }
  }
}

// ---- sampling --------------------------------------------------------------------------------------------

TEST(Rgl, sampling_follows_the_density) {
  // Fixed random numbers: the smallest p of about fifty tests would be below 1e-5 by chance once in 2000
  // choices of them.
  for (const Sample& sample : everything()) {
    const double width = lobe_width(*sample.brdf);
    for (const vec3 w_out : {vec3(0, 0, 1), direction(40, 50), direction(70, -160), direction(85, 10)}) {
      Random random(9);
      const ChiSquare result = chi_square(
          SphericalGrid(w_out, width), 20000,
          [&](vec3* w) {
            const float u = random.unit();
            *w = sample.brdf->sample_direction(w_out, u, random.square());
            return w->z > 0;
          },
          [&](vec3 w) { return double(sample.brdf->pdf(w_out, w)); });
      EXPECT_GT(result.p, 1e-5) << sample.name << " cos " << w_out.z << " mass " << result.mass << " cells "
                                << result.cells;
      // What is reflected below the horizon is no direction. More than 1 would be an error of the quadrature
      // across the kinks of the interpolation: below 1 %.
      EXPECT_LT(result.mass, 1.01) << sample.name;
      EXPECT_GT(result.mass, 0.5) << sample.name;
      EXPECT_GT(result.cells, 20) << sample.name;
    }
  }
}

TEST(Rgl, sampled_albedo_equals_quadrature) {
  for (const Sample& sample : everything()) {
    const double width = lobe_width(*sample.brdf);
    for (const vec3 w_out : {direction(10, 0), direction(60, 100), direction(80, -20)}) {
      Vec truth(0);
      SphericalGrid(w_out, width).integrate([&](vec3 w, double weight) {
        truth += Vec(sample.brdf->evaluate(w_out, w)) * (weight * w.z);
      });
      Random random(10);
      constexpr int kSamples = 20000;
      Vec sum(0), squares(0);
      for (int i = 0; i < kSamples; ++i) {
        const float u = random.unit();
        const vec3 w = sample.brdf->sample_direction(w_out, u, random.square());
        vec3 f;
        float pdf;
        sample.brdf->evaluate_with_pdf(w_out, w, &f, &pdf);
        const Vec x = pdf > 0 ? Vec(f) * double(w.z / pdf) : Vec(0);
        sum += x, squares += x * x;
      }
      const Vec mean = sum / double(kSamples),
                sigma =
                    glm::sqrt(glm::max(squares / double(kSamples) - mean * mean, Vec(0)) / double(kSamples));
      // Five standard errors, and half a percent of quadrature across kinks.
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(mean[k], truth[k], 5 * sigma[k] + 5e-3 * truth[k] + 1e-5)
            << sample.name << " cos " << w_out.z;
      EXPECT_LE(std::max({truth.x, truth.y, truth.z}), 1) << sample.name;
    }
  }
}

TEST(Rgl, the_largest_cosine_divided_by_costs_little_light) {
  // docs/materials.md gives at most 0.34 % of any direction's light. What is lost lies within half a degree
  // of the horizon: there the data times cos(89.5 degrees), less what is reflected now.
  const double limit = 89.5 * kPiDouble / 180, step = (kPiDouble / 2 - limit) / 8;
  if (published_rgl_files().empty()) GTEST_SKIP() << kNoPublishedFiles;
  for (const Sample& sample : everything()) {
    if (sample.brdf->description == "Analytic GGX")
      continue;  // steeper towards the horizon than what was measured
    for (const vec3 w_out : {direction(10, 0), direction(64, 0), direction(86, 0)}) {
      Vec all(0), lost(0);
      SphericalGrid(w_out, 0.05).integrate([&](vec3 w, double weight) {
        all += Vec(sample.brdf->evaluate(w_out, w)) * (weight * w.z);
      });
      for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 360; ++j) {
          const double t = limit + step * (i + 0.5), p = (j + 0.5) * kPiDouble / 180;
          const Vec w(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
          const Vec f(sample.brdf->evaluate(w_out, vec3(w)));
          lost += f * ((double(RglBrdf::kSmallestCosine) - w.z) * step * kPiDouble / 180 * std::sin(t));
        }
      const vec3 weights(0.2126f, 0.7152f, 0.0722f);
      EXPECT_LT(glm::dot(lost, Vec(weights)), 4e-3 * glm::dot(all, Vec(weights)))
          << sample.name << " cos " << w_out.z;
    }
  }
}

}  // namespace
}  // namespace zonal
