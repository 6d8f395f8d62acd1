#pragma once
/// The subcommands of `zonal`: each adds itself to the command line and, when chosen, parses, calls a
/// library, prints.
///
///     void add_compare(CLI::App& app, int* exit_code) {
///       auto options = std::make_shared<CompareOptions>();
///       CLI::App* command = app.add_subcommand("compare", "metrics of one pair of pictures");
///       command->add_option("image", options->image)->required();
///       command->callback([=] { *exit_code = compare(*options); });
///     }
///
/// Exit codes: 0 done; 1 a check failed; 2 bad input or usage; 130 interrupted. A callback throws SceneError
/// for bad input; main.cpp prints it as one line and returns 2.

#include <CLI/CLI.hpp>
#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/render.h"

namespace zonal {

inline constexpr int kDone = 0, kCheckFailed = 1, kBadInput = 2, kInterrupted = 130;

void add_render(CLI::App& app, int* exit_code);
void add_compare(CLI::App& app, int* exit_code);
void add_list(CLI::App& app, int* exit_code);
void add_material(CLI::App& app, int* exit_code);
void add_reference(CLI::App& app, int* exit_code);
void add_sweep(CLI::App& app, int* exit_code);
void add_verify(CLI::App& app, int* exit_code);
void add_flight(CLI::App& app, int* exit_code);
void add_view(CLI::App& app, int* exit_code);

/// Below `zonal material`.
void add_material_bands(CLI::App& material, int* exit_code);
void add_material_merl(CLI::App& material, int* exit_code);
void add_material_show(CLI::App& material, int* exit_code);

/// Set by the first Ctrl-C (or SIGTERM) after `catch_interrupts`; the second ends the program at once.
std::atomic<bool>& stop_asked();
void catch_interrupts();

/// `--set key=value` entries laid over `settings`: value is JSON where it parses as such (400, 0.5, true),
/// else text. Throws SceneError when there is no '='.
void apply_settings(const std::vector<std::string>& entries, nlohmann::json* settings);

/// `--material name=entry` entries as LoadOptions::materials: the entry is a name of the database, or JSON.
nlohmann::json material_replacements(const std::vector<std::string>& entries);
void add_material_option(CLI::App& command, std::vector<std::string>* entries);

/// `--pixels automatic|center|jitter`.
void add_pixels_option(CLI::App& command, RenderOptions::Pixels* pixels);

/// "640x360" to width and height, both in 1..32768. Throws SceneError otherwise.
void parse_size(const std::string& text, int* width, int* height);

}  // namespace zonal
