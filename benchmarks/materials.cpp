// How long a material takes to project, and a table to read; how exact projections of measured files are.
//
//     build/bench_materials [FILE ...]            seconds are medians of five, file reading excluded
//     build/bench_materials accuracy FILE ...     20 bands of F' against a dense grid (some 20 s a file)

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "materials/material.h"
#include "materials/measured_brdf.h"
#include "materials/sh_projector.h"
#include "tests/dense_projection.h"

namespace zonal {
namespace {

constexpr int kChecked[] = {0, 1, 4, 8, 13, 14, 17, 25, 40, 55, 65, 75, 80, 84, 85, 88, 90};  ///< elevations

double median_seconds(const auto& work) {
  std::vector<double> seconds;
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[2];
}

void run(const std::string& name, const Bsdf& bsdf) {
  ShProjection projection;
  const double twenty = median_seconds([&] { projection = project_material(bsdf, {.bands = 20}); });
  const size_t evaluations = projection.evaluations;
  const double automatic = median_seconds([&] { projection = project_material(bsdf); });
  const std::vector<std::byte> file = write_shmat(projection);
  const ShMaterial table = ShMaterial::from_bytes(file, name);
  const double bytes = double(file.size());

  constexpr int kReads = 20000, kBands = 9;
  std::vector<float> out(3 * size_t(sh_count(kBands, table.mirrored())));
  float kept = 0;
  const double reading = median_seconds([&] {
    for (int i = 0; i < kReads; ++i) {
      const float z = (float(i) + 0.5f) / kReads, s = std::sqrt(1 - z * z);
      table.look_up(ShTable::brdf_cosine, {0.6f * s, 0.8f * s, z}, kBands, int(out.size() / 3), out.data());
      kept += out[0];
    }
  });
  std::printf("%-28s %8.2f %11.2f %11.1f %9.2f %7d %9.0f %9.0f%s\n", name.c_str(), twenty,
              double(evaluations) * 1e-6, double(evaluations) / twenty * 1e-6, automatic, table.max_bands(),
              bytes * 1e-3, reading / kReads * 1e9, kept < 0 ? "!" : "");
}

/// Largest difference of F' from the grid's over all directions and channels, a share of the peak.
void accuracy(const std::string& file) {
  constexpr int kBands = 20, kSteps = 1800, kCount = sh_count(kBands, true);
  const std::unique_ptr<MeasuredBrdf> brdf = load_measured(file);
  const ShProjection projection =
      project_material({.kind = BsdfKind::measured, .measured = brdf.get()}, {.bands = kBands});
  std::printf("%-24s", std::filesystem::path(file).stem().string().c_str());
  if (!projection.mirrored || projection.azimuths > 1) {
    std::printf(" not symmetric about the plane of w_out: the grid is for those that are\n");
    return;
  }
  for (const int elevation : kChecked) {
    const double theta = ShMaterial::degrees(elevation) * test::kPiD / 180;
    const test::DenseProjection dense = test::dense_projection(*brdf, theta, kBands, kSteps);
    const ShRow& row = projection.rows[1][size_t(elevation)];
    double worst = 0;
    for (int c = 0; c < 3; ++c)
      worst =
          std::max(worst, test::difference(kBands, true, row.coefficients.data() + c * kCount, dense.c[c]));
    std::printf(" %7.1e", worst);
    std::fflush(stdout);
  }
  std::printf("\n");
}

int main(int count, char** arguments) {
  if (count > 1 && std::string_view(arguments[1]) == "accuracy") {
    std::printf("%-24s", "");
    for (const int elevation : kChecked) std::printf(" %7g", ShMaterial::degrees(elevation));
    std::printf("\n");
    for (int i = 2; i < count; ++i) accuracy(arguments[i]);
    return 0;
  }
  std::printf(
      "Both tables of one material, all threads. Read: both rows around w_out, 9 bands of F', one thread.\n");
  std::printf("%-28s %8s %11s %11s %9s %7s %9s %9s\n", "", "20 bands", "evaluations", "evaluations",
              "95 % of", "most", "half file", "read");
  std::printf("%-28s %8s %11s %11s %9s %7s %9s %9s\n", "", "s", "million", "million/s", "energy s", "bands",
              "kB", "ns");
  LambertMaterial lambert;
  run("lambert", lambert.at(vec2(0)));
  for (const float roughness : {0.7f, 0.4f, 0.2f}) {
    ConductorMaterial conductor;
    conductor.roughness.value = roughness;
    char name[64];
    std::snprintf(name, sizeof name, "conductor, roughness %.1f", double(roughness));
    run(name, conductor.at(vec2(0)));
  }
  for (int i = 1; i < count; ++i) {
    const std::unique_ptr<MeasuredBrdf> brdf = load_measured(arguments[i]);
    run(std::filesystem::path(arguments[i]).stem().string(),
        {.kind = BsdfKind::measured, .measured = brdf.get()});
  }
  return 0;
}

}  // namespace
}  // namespace zonal

int main(int count, char** arguments) {
  try {
    return zonal::main(count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_materials: %s\n", error.what());
    return 2;
  }
}
