#pragma once
/// Tables in MERL's layout for tests, and a folder that disappears.

#include <unistd.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "materials/merl.h"
#include "materials/merl_writer.h"
#include "tests/bsdf_cases.h"

namespace zonal::test {

/// A folder of its own for a test, removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static int count = 0;
    const std::string name = "zonal_merl_" + std::to_string(getpid()) + "_" + std::to_string(count++);
    path_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline MerlFunction constant(glm::dvec3 f) {
  return [f](const glm::dvec3&, const glm::dvec3&) { return f; };
}

/// Independent numbers in [0, 1): neither smooth nor symmetric, so that nothing is right by accident.
inline std::vector<float> random_cells(uint32_t seed) {
  Random random(seed);
  std::vector<float> cells(3 * kMerlCells);
  for (float& c : cells) c = random.unit();
  return cells;
}

/// Metal of constant colour: GGX alone, without a diffuse part.
inline Bsdf ggx(float roughness) {
  return metallic_roughness(vec3(0.9f, 0.7f, 0.5f), 1, roughness).bsdf;
}

}  // namespace zonal::test
