#pragma once
/// What the tests of materials on spherical harmonics share: a cache of their own, and coefficients by
/// quadrature in double.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "materials/sh_materials.h"
#include "sh/basis.h"
#include "tests/bsdf_cases.h"
#include "tests/bsdf_quadrature.h"

namespace zonal::test {

namespace fs = std::filesystem;

/// A cache of the test's own, empty at first.
struct OwnCache : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) /
                    ("zonal_cache_" + std::to_string(getpid()) + "_" +
                     std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  OwnCache() {
    fs::remove_all(folder);
    setenv("ZONAL_CACHE", folder.c_str(), 1);
  }
  ~OwnCache() override {
    unsetenv("ZONAL_CACHE");
    fs::remove_all(folder);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    if (fs::exists(folder)) {
      for (const auto& entry : fs::directory_iterator(folder)) found.push_back(entry.path());
    }
    return found;
  }
};

using List = std::vector<std::unique_ptr<Material>>;
template <class Kind>
List list_of(Kind kind) {
  List list;
  list.push_back(std::make_unique<Kind>(std::move(kind)));
  return list;
}

/// [channel][coefficient], the layout with m >= 0 alone or with all.
using Coefficients = std::vector<std::vector<double>>;

/// Integrals of F or F' times each basis function, in the view frame.
inline Coefficients by_quadrature(const Case& c, ShTable table, vec3 w_out, int bands, bool mirrored) {
  const BsdfContext view = prepare(c.bsdf, w_out);
  const ViewFrame frame(w_out);
  Coefficients out(3, std::vector<double>(size_t(sh_count(bands, mirrored))));
  std::vector<double> Y(size_t(sh::count(bands)));
  SphericalGrid(w_out, c.width).integrate([&](vec3 w, double weight) {
    if (w.z <= 0) return;
    const vec3 f = evaluate(c.bsdf, view, w) * (table == ShTable::brdf_cosine ? w.z : 1.0f);
    sh::evaluate(bands, glm::normalize(glm::dvec3(frame.to_view(w))), Y.data());
    for (int l = 0; l < bands; ++l) {
      for (int m = mirrored ? 0 : -l; m <= l; ++m) {
        const double y = Y[size_t(sh::index(l, m))] * weight;
        for (int k = 0; k < 3; ++k) out[size_t(k)][size_t(sh_index(l, m, mirrored))] += y * f[k];
      }
    }
  });
  return out;
}

inline Coefficients looked_up(const ShMaterials& materials, const Bsdf& bsdf, ShTable table, vec3 w_out,
                              int bands) {
  const int stride = sh_count(bands, materials.mirrored(0)) + 5;
  std::vector<float> rgb(3 * size_t(stride), NAN);
  materials.look_up(0, bsdf, table, w_out, bands, stride, rgb.data());
  Coefficients out;
  for (int k = 0; k < 3; ++k) out.emplace_back(rgb.begin() + k * stride, rgb.begin() + (k + 1) * stride - 5);
  return out;
}

/// Norm of the difference over that of the truth, three channels together.
inline double relative_error(const Coefficients& got, const Coefficients& truth) {
  double difference = 0, energy = 0;
  for (size_t k = 0; k < 3; ++k) {
    for (size_t i = 0; i < truth[k].size(); ++i) {
      difference += std::pow(got[k][i] - truth[k][i], 2), energy += truth[k][i] * truth[k][i];
    }
  }
  return std::sqrt(difference / energy);
}

}  // namespace zonal::test
