// `zonal render`: a scene file in, a picture out.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "apps/backend.h"
#include "apps/commands.h"
#include "core/error.h"
#include "core/image.h"
#include "core/machine.h"
#include "core/progress.h"
#include "core/render.h"
#include "core/scene_loader.h"
#include "integrators/table.h"

namespace zonal {
namespace {

struct Options {
  std::string scene, integrator, size, stats, snapshots, backend = "cpu";
  std::vector<std::string> outputs, settings, materials;
  int passes = 0, threads = 0, frame = 0;
  double seconds = 0;
  uint64_t seed = 0;
  bool quiet = false, pin = false;
  RenderOptions::Pixels pixels = RenderOptions::Pixels::automatic;
};

constexpr int kDefaultPasses = 16;

/// The method's settings: the scene file's, when they are for this method, under those of the command line.
nlohmann::json method_settings(const Options& options, const SceneSettings& file, std::string* name) {
  nlohmann::json from_file = nlohmann::json::parse(file.integrator_json);
  const std::string file_name = from_file.value("type", "path");
  *name = options.integrator.empty() ? file_name : options.integrator;
  nlohmann::json settings = *name == file_name ? from_file : nlohmann::json::object();
  apply_settings(options.settings, &settings);
  return settings;
}

nlohmann::json counters_json(const RenderReport& report) {
  nlohmann::json counters = {{"camera_rays", report.counters.camera_rays},
                             {"bounce_rays", report.counters.bounce_rays},
                             {"shadow_rays", report.counters.shadow_rays},
                             {"light_evaluations", report.counters.light_evaluations}};
  for (const auto& [name, number] : report.pass.numbers) counters[name] = number;
  if (report.counters.total_energy > 0)
    counters["clamped_energy_share"] = report.counters.clamped_energy / report.counters.total_energy;
  if (report.counters.skipped_pairs > 0) {
    counters["skipped_pairs"] = report.counters.skipped_pairs;
    counters["skipped_share_at_most"] = report.counters.skipped_bound / report.counters.skipped_total;
  }
  return counters;
}

/// How to have the same picture again, bit for bit, without a clock.
std::string repeat_line(const Options& options, const RenderReport& report) {
  std::string line = fmt::format("--passes {}", report.passes);
  if (options.pixels != RenderOptions::Pixels::automatic)
    line += fmt::format(" --pixels {}", pixels_name(options.pixels));
  else if (report.passes == 1 && options.seconds > 0)
    line += " --pixels jitter";
  const auto lights = report.pass.numbers.find("pass_lights");
  if (lights != report.pass.numbers.end()) line += fmt::format(" --set pass_lights={:.0f}", lights->second);
  return line + fmt::format(" --seed {}", options.seed);
}

int render_command(const Options& options) {
  const std::unique_ptr<Backend> backend = make_backend(options.backend);
  if (options.passes > 0 && options.seconds > 0) throw SceneError("--passes and --time: expected only one of them");
  LoadOptions load{.frame = options.frame, .materials = material_replacements(options.materials)};
  if (!options.size.empty()) parse_size(options.size, &load.width, &load.height);
  std::vector<std::string> outputs = options.outputs;
  if (outputs.empty()) outputs = {std::filesystem::path(options.scene).stem().string() + ".exr"};
  if (outputs == std::vector<std::string>{"none"}) outputs.clear();
  for (const std::string& file : outputs) check_writable(file);
  if (!options.stats.empty()) check_writable_text(options.stats);

  const auto load_start = Clock::now();
  SceneSettings file;
  const Scene scene = load_scene(options.scene, load, &file);
  std::string name;
  const nlohmann::json settings = method_settings(options, file, &name);
  const IntegratorRow& row = find_integrator(name, "--integrator");
  nlohmann::json parameters;
  const auto integrator = row.make(settings, "integrator \"" + name + "\"", &parameters);
  const double load_seconds = seconds_since(load_start);
  if (!options.quiet)
    for (const std::string& note : scene.notes()) fmt::print(stderr, "note: {}\n", note);

  catch_interrupts();
  Budget budget{.passes = options.passes, .seconds = options.seconds};
  if (budget.passes == 0 && budget.seconds == 0) budget.passes = file.passes > 0 ? file.passes : kDefaultPasses;
  const RenderOptions render_options{.seed = options.seed, .threads = options.threads,
                                     .pixels = options.pixels, .stop = &stop_asked(), .pin = options.pin};
  Film film(scene.camera().width, scene.camera().height);
  ProgressPrinter progress(fmt::format("{} {}", scene.name(), name), options.quiet);
  // After 1, 2, 4, ... passes, outside the clock: the whole course of the error from one run.
  const auto snapshot = [&](const Film& so_far, double seconds) {
    if (options.snapshots.empty() || (so_far.passes() & (so_far.passes() - 1)) != 0) return;
    ImageFile picture{.layers = {{"", so_far.radiance()}}};
    picture.metadata["seconds"] = fmt::format("{:.9g}", seconds);
    picture.metadata["exposure"] = fmt::format("{:.9g}", scene.camera().exposure);
    write_image(fmt::format("{}-{:05}.exr", options.snapshots, so_far.passes()), picture, 1);
  };
  const RenderReport report = backend->render(scene, *integrator, name, film, budget, render_options, snapshot,
                                     [&](const Progress& p) { progress.update(p); });
  progress.finish();
  for (const std::string& warning : report.pass.warnings) fmt::print(stderr, "warning: {}\n", warning);
  if (film.bad_samples() > 0)
    fmt::print(stderr, "warning: {} samples were not finite or negative and count as black\n", film.bad_samples());
  if (report.passes == 0) {
    fmt::print(stderr, "interrupted before the first pass: nothing written\n");
    return kInterrupted;
  }

  // Everything that made the picture goes with it.
  nlohmann::json stats = {
      {"scene", options.scene}, {"integrator", name}, {"parameters", parameters}, {"seed", options.seed},
      {"frame", options.frame}, {"passes", report.passes}, {"resolution", {film.width(), film.height()}},
      {"threads", options.threads > 0 ? options.threads : hardware_threads()},
      {"version", ZONAL_VERSION}, {"compiler", compiler_name()}, {"cpu", cpu_name()}, {"gpu", backend->gpu().empty() ? nlohmann::json() : nlohmann::json(backend->gpu())},
      {"backend", options.backend},
      {"interrupted", report.interrupted}, {"bad_samples", film.bad_samples()},
      {"counters", counters_json(report)}, {"repeat", repeat_line(options, report)}};
  stats["seconds"] = {{"load", load_seconds}, {"begin_pass", report.begin_pass_seconds},
                      {"radiance", report.radiance_seconds}};
  ImageFile picture = film.resolve();
  for (const char* key : {"scene", "integrator", "version"}) picture.metadata[key] = stats[key].get<std::string>();
  for (const char* key : {"parameters", "seed", "frame", "passes", "seconds"}) picture.metadata[key] = stats[key].dump();
  picture.metadata["exposure"] = fmt::format("{:.9g}", scene.camera().exposure);
  const auto output_start = Clock::now();
  for (const std::string& file : outputs) write_image(file, picture, scene.camera().exposure);
  const std::string output = fmt::format("{}", fmt::join(outputs, ", "));
  stats["seconds"]["output"] = seconds_since(output_start);
  stats["peak_memory_bytes"] = peak_memory_bytes();
  if (!options.stats.empty()) write_text(options.stats, stats.dump(2) + "\n");

  if (!options.quiet) {
    fmt::print("{}: {}, {} {} in {:.2f} s (begin_pass {:.2f} s, radiance {:.2f} s; loading {:.2f} s and output apart)\n",
               output, name, report.passes, report.passes == 1 ? "pass" : "passes",
               report.begin_pass_seconds + report.radiance_seconds, report.begin_pass_seconds, report.radiance_seconds,
               load_seconds);
    if (options.seconds > 0) fmt::print("the same picture again: {}\n", repeat_line(options, report));
    if (stats["counters"].contains("clamped_energy_share"))
      fmt::print("the clamp removed {:.2f} % of the indirect light\n",
                 100 * stats["counters"]["clamped_energy_share"].get<double>());
  }
  if (report.interrupted) {
    fmt::print(stderr, "interrupted: {} holds {}\n", output,
               report.partial ? "a part of the first pass, the rest is black"
                              : fmt::format("{} finished passes", report.passes));
    return kInterrupted;
  }
  return kDone;
}

}  // namespace

void add_render(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "a scene file in, a picture out");
  command->add_option("scene", options->scene, "scene file (JSON)")->required();
  command->add_option("--integrator", options->integrator, "lighting method; see zonal list");
  command->add_option("--set", options->settings, "key=value: a parameter of the method")->allow_extra_args(false);
  command->add_option("--passes", options->passes, "number of passes")->check(CLI::Range(1, 1 << 24));
  command->add_option("--time", options->seconds, "seconds of rendering")->check(CLI::Range(1e-3, 1e9));
  command->add_option("--size", options->size, "WIDTHxHEIGHT in pixels");
  command->add_option("--threads", options->threads, "threads; 0: all")->check(CLI::Range(0, 4096));
  command->add_option("--seed", options->seed, "random seed");
  command->add_option("--frame", options->frame, "frame of a scene with keyframes");
  add_material_option(*command, &options->materials);
  command->add_option("--backend", options->backend, "cpu or gl: who shades");
  command->add_option("-o,--output", options->outputs, "picture to write (.exr or .png); may be given again; none: no picture")
      ->allow_extra_args(false);
  command->add_option("--stats", options->stats, "JSON file for settings, times and counters");
  command->add_option("--snapshots", options->snapshots,
                      "also write PREFIX-00001.exr, -00002, -00004, ... after so many passes, outside the clock");
  command->add_flag("--pin", options->pin, "keep each thread on one core: steadier times");
  add_pixels_option(*command, &options->pixels);
  command->add_flag("--quiet", options->quiet, "print errors and warnings only");
  command->callback([=] { *exit_code = render_command(*options); });
}

}  // namespace zonal
