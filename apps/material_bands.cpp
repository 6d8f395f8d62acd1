// `zonal material bands`: how many bands hold how much of a material's energy (the table of Mézières 2022,
// appendix B).

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <numbers>

#include "apps/commands.h"
#include "apps/material_source.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "materials/material_database.h"
#include "materials/sh_projector.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;

constexpr int kMostBands = 100;  // the study's end
constexpr std::array kShares{0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95};

struct Options {
  std::vector<std::string> files;
  std::string csv;
  bool without_cosine = false;
};

std::string count_text(int bands) {
  return bands > 0 ? std::to_string(bands) : fmt::format(">{}", kMostBands);
}

void print_block(const char* basis, const std::array<std::vector<int>, 9>& rows) {
  fmt::print("  {:<24}", basis);
  for (const double share : kShares) fmt::print("{:>6.0f} %", 100 * share);
  fmt::print("\n");
  for (size_t row = 0; row < rows.size(); ++row) {
    fmt::print("  {:>20} deg", 10 * row);
    for (const int bands : rows[row]) fmt::print("{:>8}", count_text(bands));
    fmt::print("\n");
  }
}

int bands_command(const Options& options) {
  std::string csv = "material,table,basis,elevation_degrees,share,bands\n";
  if (!options.csv.empty()) check_can_write(options.csv);
  const int table = options.without_cosine ? 0 : 1;
  for (const std::string& file : options.files) {
    const MaterialSource source = read_material_source(file);
    std::array<std::vector<int>, 9> spherical, hemispherical;
    for (int row = 0; row < 9; ++row) {
      const BandStudy study = study_bands(source.bsdf, 10 * row * std::numbers::pi / 180, kMostBands);
      for (const double share : kShares) {
        spherical[row].push_back(BandStudy::bands(study.spherical[table], share));
        hemispherical[row].push_back(BandStudy::bands(study.hemispherical[table], share));
        for (const auto& [basis, rows] :
             {std::pair("spherical", &spherical), std::pair("hemispherical", &hemispherical)})
          csv += fmt::format("{},{},{},{},{},{}\n", source.name, table ? "F'" : "F", basis, 10 * row, share,
                             count_text((*rows)[row].back()));
      }
    }
    fmt::print("{}: bands that hold a share of the energy of {}\n", source.name,
               table ? "F' (with the cosine)" : "F");
    print_block("spherical", spherical);
    print_block("hemispherical", hemispherical);
  }
  if (!options.csv.empty()) {
    write_atomically(options.csv, csv.data(), csv.size());
    fmt::print("{}\n", options.csv);
  }
  return kDone;
}

}  // namespace

MaterialSource read_material_source(const std::string& file) {
  MaterialSource source;
  if (!fs::exists(file)) throw SceneError(file + ": no such file");
  source.brdf = load_measured(file);
  source.bsdf.kind = BsdfKind::measured, source.bsdf.measured = source.brdf.get();
  source.name = fs::path(material_name(file, fs::absolute(file).parent_path().string())).filename().string();
  return source;
}

void add_material_bands(CLI::App& material, int* exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      material.add_subcommand("bands", "bands against share of the energy and elevation, both bases");
  command->add_option("files", options->files, "RGL .bsdf or MERL .binary files")->required();
  command->add_flag("--without-cosine", options->without_cosine, "of the BRDF F instead of F' = F cos");
  command->add_option("--csv", options->csv, "also write the tables there");
  command->callback([=] { *exit_code = bands_command(*options); });
}

}  // namespace zonal
