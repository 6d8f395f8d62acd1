// `zonal flight`: a scene's frames one after the other, as a viewer would see them: how long each takes, and
// how much the error against a path-traced sequence flickers.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/backend.h"
#include "apps/commands.h"
#include "core/error.h"
#include "core/image.h"
#include "core/machine.h"
#include "core/scene_loader.h"
#include "core/temporal_error.h"
#include "integrators/table.h"

namespace zonal {
namespace {

struct Options {
  std::string scene, integrator = "path", frames, size, stats, output, backend = "cpu";
  std::vector<std::string> settings, reference_settings;
  int passes = 1, threads = 0, reference_passes = 0;
  uint64_t seed = 0;
};

void parse_frames(const std::string& text, int* first, int* last) {
  char extra;
  if (std::sscanf(text.c_str(), "%d:%d%c", first, last, &extra) != 2 || *last < *first)
    throw SceneError(fmt::format("--frames: found \"{}\", expected FIRST:LAST, as in 0:59", text));
}

/// Of sorted values: the smallest that `share` of them do not exceed.
double percentile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<size_t>(std::ceil(share * double(sorted.size())));
  return sorted[std::clamp<size_t>(rank, 1, sorted.size()) - 1];
}

/// A path-traced picture of the frame.
Image reference_of(const Scene& scene, const Options& options, uint64_t seed) {
  nlohmann::json settings = nlohmann::json::object();
  apply_settings(options.reference_settings, &settings);
  const auto path = find_integrator("path", "flight").make(settings, "--reference-set", nullptr);
  Film film(scene.camera().width, scene.camera().height);
  render(scene, *path, film, {.passes = options.reference_passes},
         // Rays go where the frames' own go.
         {.seed = seed,
          .threads = options.threads,
          .pixels = options.passes > 1 ? RenderOptions::Pixels::jitter : RenderOptions::Pixels::center,
          .stop = &stop_asked()});
  return film.radiance();
}

int flight_command(const Options& options) {
  const auto backend = make_backend(options.backend);
  backend->warm_up = true;
  int first = 0, last = 0;
  parse_frames(options.frames, &first, &last);
  LoadOptions load;
  if (!options.size.empty()) parse_size(options.size, &load.width, &load.height);
  if (!options.stats.empty()) check_writable_text(options.stats);
  const IntegratorRow& row = find_integrator(options.integrator, "--integrator");
  nlohmann::json settings = nlohmann::json::object(), parameters;
  apply_settings(options.settings, &settings);

  catch_interrupts();
  TemporalError temporal;
  std::vector<double> times;
  for (load.frame = first; load.frame <= last && !stop_asked(); ++load.frame) {
    const Scene scene = load_scene(options.scene, load);
    const auto integrator = row.make(settings, "integrator \"" + row.name + "\"", &parameters);
    Film film(scene.camera().width, scene.camera().height);
    const RenderReport report =
        backend->render(scene, *integrator, row.name, film, {.passes = options.passes},
                        {.seed = options.seed, .threads = options.threads, .stop = &stop_asked()}, {}, {});
    if (stop_asked()) break;
    times.push_back(1e3 * (report.begin_pass_seconds + report.radiance_seconds));
    if (!options.output.empty())
      write_image(fmt::format("{}-{:05}.png", options.output, load.frame),
                  {.layers = {{"", film.radiance()}}}, scene.camera().exposure);
    if (options.reference_passes == 0) continue;
    // Two seeds a frame, none of them the method's.
    const uint64_t seed = options.seed + 1000003 * (2 * uint64_t(load.frame - first) + 1);
    temporal.add(film.radiance(), reference_of(scene, options, seed),
                 reference_of(scene, options, seed + 1000003));
  }
  if (times.empty()) {
    fmt::print(stderr, "interrupted before the first frame: nothing written\n");
    return kInterrupted;
  }

  const std::vector<double> course = times;
  std::sort(times.begin(), times.end());
  nlohmann::json stats = {{"scene", options.scene},
                          {"integrator", row.name},
                          {"parameters", parameters},
                          {"backend", options.backend},
                          {"cpu", cpu_name()},
                          {"gpu", backend->gpu()},
                          {"seed", options.seed},
                          {"passes", options.passes},
                          {"frames", {first, first + int(times.size()) - 1}},
                          {"milliseconds", course},
                          {"version", ZONAL_VERSION}};
  std::string line = fmt::format("{} frames, {} on {}: ", times.size(), row.name, options.backend);
  for (const int p : {50, 95, 99}) {
    const double value = percentile(times, 0.01 * p);
    stats["percentiles"][fmt::format("p{}", p)] = value;
    line += fmt::format("p{} {:.3g} ms, ", p, value);
  }
  stats["percentiles"]["max"] = times.back();
  line += fmt::format("max {:.3g} ms", times.back());
  if (temporal.frames() > 0) {
    stats["error_of_mean"] = temporal.error(), stats["flicker_of_mean"] = temporal.flicker();
    stats["reference_passes"] = 2 * options.reference_passes;
    stats["reference_settings"] = options.reference_settings;
    line += fmt::format("; error {:.3g}, flicker {:.3g} of the mean", temporal.error(), temporal.flicker());
  }
  fmt::print("{}\n", line);
  if (!options.stats.empty()) write_text(options.stats, stats.dump(2) + "\n");
  return stop_asked() ? kInterrupted : kDone;
}

}  // namespace

void add_flight(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("flight", "a scene's frames: their times, and how much the error flickers");
  command->add_option("scene", options->scene, "scene file (JSON) with keyframes")->required();
  command->add_option("--frames", options->frames, "FIRST:LAST")->required();
  command->add_option("--integrator", options->integrator, "lighting method; see zonal list");
  command->add_option("--set", options->settings, "key=value: a parameter of the method")
      ->allow_extra_args(false);
  command->add_option("--backend", options->backend, "cpu or gl: who shades");
  command->add_option("--passes", options->passes, "passes a frame")->check(CLI::Range(1, 1 << 24));
  command
      ->add_option("--reference-passes", options->reference_passes,
                   "of path, for each of two references a frame; 0: no error is measured")
      ->check(CLI::Range(0, 1 << 24));
  command
      ->add_option("--reference-set", options->reference_settings,
                   "key=value: a parameter of the reference's path")
      ->allow_extra_args(false);
  command->add_option("--size", options->size, "WIDTHxHEIGHT in pixels");
  command->add_option("--threads", options->threads, "threads; 0: all")->check(CLI::Range(0, 4096));
  command->add_option("--seed", options->seed, "random seed");
  command->add_option("-o,--output", options->output, "also write PREFIX-00000.png, ...");
  command->add_option("--stats", options->stats, "JSON file for settings, times and errors");
  command->callback([=] { *exit_code = flight_command(*options); });
}

}  // namespace zonal
