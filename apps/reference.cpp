// `zonal reference`: a scene file in, a cached reference out; nothing to do when it is there already.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "apps/commands.h"
#include "core/error.h"
#include "core/progress.h"
#include "core/reference.h"
#include "core/scene_loader.h"

namespace zonal {
namespace {

constexpr int kDefaultPasses = 256;

struct Options {
  ReferenceRequest request;
  std::vector<std::string> settings, materials;
  std::string size, output;
  int threads = 0;
  bool quiet = false;
};

int reference_command(const Options& options) {
  ReferenceRequest request = options.request;
  if (request.passes > 0 && request.seconds > 0)
    throw SceneError("--passes and --time: expected only one of them");
  if (request.passes == 0 && request.seconds == 0) request.passes = kDefaultPasses;
  apply_settings(options.settings, &request.settings);
  request.materials = material_replacements(options.materials);
  if (!options.size.empty()) parse_size(options.size, &request.width, &request.height);
  const std::string output =
      options.output.empty() ? std::filesystem::path(request.scene_file).stem().string() + "_reference.exr"
                             : options.output;
  check_writable(output);
  if (std::filesystem::path(output).extension() != ".exr") {
    throw SceneError(fmt::format("{}: expected .exr: a reference has layers and radiance", output));
  }
  check_writable_text(record_file(output));
  if (std::filesystem::exists(request.scene_file) && reference_is_current(output, request)) {
    if (!options.quiet) fmt::print("{}: up to date\n", output);
    return kDone;
  }

  const LoadOptions load{.frame = request.frame,
                         .width = request.width,
                         .height = request.height,
                         .materials = request.materials};
  const Scene scene = load_scene(request.scene_file, load);
  catch_interrupts();
  ProgressPrinter progress(fmt::format("reference of {}, {}", scene.name(), request.integrator),
                           options.quiet);
  const auto reference = make_reference(scene, request,
                                        {.threads = options.threads,
                                         .stop = &stop_asked(),
                                         .on_progress = [&](const Progress& p) { progress.update(p); }});
  progress.finish();
  if (!reference) {
    fmt::print(stderr, "interrupted: no reference written\n");
    return kInterrupted;
  }
  write_reference(output, request, *reference);
  if (const auto bad = reference->record["bad_samples"].get<size_t>()) {
    fmt::print(stderr, "warning: {} samples were not finite or negative and count as black\n", bad);
  }
  if (!options.quiet) {
    const nlohmann::json& seconds = reference->record["seconds"];
    fmt::print("{}: {}, 2 x {} passes in {:.2f} s\n", output, request.integrator,
               reference->record["passes"][0].get<int>(),
               seconds["begin_pass"].get<double>() + seconds["radiance"].get<double>());
  }
  return kDone;
}

}  // namespace

void add_reference(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("reference", "a converged picture in two halves, cached beside its record");
  command->add_option("scene", options->request.scene_file, "scene file (JSON)")->required();
  command->add_option("--integrator", options->request.integrator, "lighting method; see zonal list");
  command->add_option("--set", options->settings, "key=value: a parameter of the method")
      ->allow_extra_args(false);
  command->add_option("--passes", options->request.passes, "passes of both halves together")
      ->check(CLI::Range(2, 1 << 24));
  command->add_option("--time", options->request.seconds, "seconds of both halves together")
      ->check(CLI::Range(1e-3, 1e9));
  command->add_option("--size", options->size, "WIDTHxHEIGHT in pixels");
  command->add_option("--threads", options->threads, "threads; 0: all")->check(CLI::Range(0, 4096));
  command->add_option("--seed", options->request.seed, "random seed");
  add_material_option(*command, &options->materials);
  add_pixels_option(*command, &options->request.pixels);
  command->add_option("--frame", options->request.frame, "frame of a scene with keyframes");
  command->add_option("-o,--output", options->output,
                      "reference to write (.exr); its record lies beside it (.json)");
  command->add_flag("--quiet", options->quiet, "print errors and warnings only");
  command->callback([=] { *exit_code = reference_command(*options); });
}

}  // namespace zonal
