// `zonal material`: measured materials on spherical harmonics: project, show, bands, merl.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "apps/commands.h"
#include "apps/material_source.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/progress.h"
#include "materials/material_database.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string source, output;
  FolderOptions folder;
  bool full_floats = false, quiet = false;
};

void print_projection(const std::string& file, const DatabaseEntry& e, double seconds) {
  fmt::print(
      "{}: {} bands at most, {} coefficients, {}, {:.1f} kB, least share of the energy of F' {:.1f} %{}\n",
      file, e.bands, e.mirrored ? "half of the" : "all",
      e.azimuths == 1 ? "isotropic" : fmt::format("{} azimuths", e.azimuths), e.bytes * 1e-3,
      100 * e.least_share, seconds > 0 ? fmt::format(", {:.2f} s", seconds) : "");
}

int project_file(const Options& options) {
  const std::string output =
      options.output.empty()
          ? fs::path(material_name(options.source, fs::path(options.source).parent_path().string() + "/."))
                    .filename()
                    .string() +
                ".shmat"
          : options.output;
  if (fs::path(output).extension() != ".shmat")
    throw SceneError(
        output + ": expected a file whose name ends in .shmat (a folder is what a folder is projected to)");
  check_can_write(output);
  const MaterialSource source = read_material_source(options.source);
  catch_interrupts();
  ProgressPrinter progress("projecting " + source.name, options.quiet);
  const auto start = Clock::now();
  const Stop stop(&stop_asked(), Clock::time_point::max());
  ShProjection projection =
      project_material(source.bsdf, options.folder.projection, stop, [&](double fraction) {
        progress.update({.pass = -1, .fraction = fraction, .seconds = seconds_since(start)});
      });
  progress.finish();
  if (projection.empty()) {
    fmt::print(stderr, "interrupted: nothing written\n");
    return kInterrupted;
  }
  const double seconds = seconds_since(start);
  projection.name = source.name, projection.source = fs::path(options.source).filename().string();
  const std::vector<std::byte> bytes = write_shmat(projection, {.half = options.folder.half});
  write_atomically(output, bytes.data(), bytes.size());
  if (!options.quiet) print_projection(output, describe_projection(ShMaterial::open(output)), seconds);
  return kDone;
}

int project_all(const Options& options) {
  const std::string database = options.output.empty() ? "materials.db" : options.output;
  catch_interrupts();
  ProgressPrinter progress("projecting " + options.source, options.quiet);
  const auto start = Clock::now();
  const FolderReport report =
      project_folder(options.source, database, options.folder, Stop(&stop_asked(), Clock::time_point::max()),
                     [&](const std::string&, double fraction) {
                       progress.update({.pass = -1, .fraction = fraction, .seconds = seconds_since(start)});
                     });
  progress.finish();
  for (const std::string& failure : report.failed) fmt::print(stderr, "zonal: {}\n", failure);
  if (!options.quiet) {
    if (report.projected + report.kept > 0)
      for (const DatabaseEntry& entry : MaterialDatabase::open(database).entries())
        print_projection(entry.name, entry, 0);
    fmt::print("{}: {} projected, {} kept, {} failed in {:.1f} s\n", database, report.projected, report.kept,
               report.failed.size(), seconds_since(start));
  }
  if (report.interrupted) {
    fmt::print(stderr, "interrupted: what is finished is kept; the same command goes on\n");
    return kInterrupted;
  }
  return report.failed.empty() ? kDone : kBadInput;
}

}  // namespace

void add_material(CLI::App& app, int* exit_code) {
  CLI::App* material =
      app.add_subcommand("material", "materials on spherical harmonics: project, show, bands, merl");
  material->require_subcommand(1);
  auto options = std::make_shared<Options>();
  CLI::App* project =
      material->add_subcommand("project", "project a measured file, or a folder of them into a database");
  ShProjectionOptions& p = options->folder.projection;
  project->add_option("source", options->source, "RGL .bsdf or MERL .binary file, or a folder")->required();
  project->add_option("--bands", p.bands, "bands of every row; 0: as many as hold --share")
      ->check(CLI::Range(0, 100));
  project->add_option("--share", p.share, "share of the energy a row keeps")
      ->check(CLI::Range(0.01f, 0.99999f));
  project->add_option("--most-bands", p.most_bands, "of a row, with --share")->check(CLI::Range(1, 100));
  project
      ->add_option("--azimuths", p.azimuths, "rows around the normal; 0: 1 for isotropic materials, else 90")
      ->check(CLI::Range(0, 360));
  project->add_option("--window", p.window, "none, hann, lanczos, hamming or auto")
      ->check(CLI::IsMember({"none", "hann", "lanczos", "hamming", "auto"}));
  project->add_option("--window-size", p.window_size, "bands; 0: the row's")
      ->check(CLI::Range(0.0f, 1000.0f));
  project
      ->add_option("--nodes", p.nodes,
                   "about how many directions a row is evaluated at; 0: as many as its accuracy needs")
      ->check(CLI::Range(0, 10000000));
  project->add_flag("--float", options->full_floats, "32-bit coefficients instead of 16-bit");
  project->add_option("-o,--output", options->output,
                      "file (.shmat), or the database's folder (default: materials.db)");
  project->add_flag("--quiet", options->quiet, "print errors only");
  project->callback([=] {
    options->folder.half = !options->full_floats;
    *exit_code = fs::is_directory(options->source) ? project_all(*options) : project_file(*options);
  });
  add_material_show(*material, exit_code);
  add_material_bands(*material, exit_code);
  add_material_merl(*material, exit_code);
}

}  // namespace zonal
