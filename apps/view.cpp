// `zonal view`: a window to fly through a scene in, with every method the GPU has.

#include <algorithm>
#include <fstream>

#include "apps/commands.h"
#include "core/error.h"
#include "core/scene_loader.h"
#ifdef ZONAL_HAS_VIEW
#include "gl/twin.h"
#include "gl/window.h"
#endif

namespace zonal {
namespace {

struct Options {
  std::string scene, integrator, size, shaders, script;
  std::vector<std::string> settings;
};

#ifdef ZONAL_HAS_VIEW
int view_command(const Options& options) {
  gl::WindowOptions window{.scene = options.scene, .shader_folder = options.shaders};
  SceneSettings file;
  load_scene(options.scene, {}, &file);
  // The scene's method where the GPU has it, hvl elsewhere.
  nlohmann::json from_file = nlohmann::json::parse(file.integrator_json);
  const std::string named = from_file.value("type", "");
  const auto& twins = gl::twin_names();
  if (!options.integrator.empty())
    window.method = options.integrator;
  else if (std::find(twins.begin(), twins.end(), named) != twins.end())
    window.method = named;
  if (window.method == named) window.settings = from_file;
  apply_settings(options.settings, &window.settings);
  if (!options.size.empty()) parse_size(options.size, &window.width, &window.height);
  if (!options.script.empty()) {
    std::ifstream script(options.script);
    if (!script) throw SceneError("--play: cannot read \"" + options.script + "\"");
    for (std::string line; std::getline(script, line);)
      if (!line.empty() && line[0] != '#') window.script.push_back(line);
    if (window.script.empty())
      throw SceneError("--play: \"" + options.script + "\" has no line, expected at least one");
  }
  gl::run_window(window);
  return kDone;
}
#else
int view_command(const Options&) {
  throw SceneError("zonal view: this build has no window (it needs libepoxy, EGL, GLFW and Dear ImGui)");
}
#endif

}  // namespace

void add_view(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("view", "the real-time window: fly through a scene, change method and settings");
  command->add_option("scene", options->scene, "scene file (JSON)")->required();
  command->add_option("--integrator", options->integrator, "lighting method; see zonal list");
  command->add_option("--set", options->settings, "key=value: a parameter of the method")
      ->allow_extra_args(false);
  command->add_option("--size", options->size, "WIDTHxHEIGHT of the window in pixels");
  command->add_option("--shaders", options->shaders,
                      "the project's folder: shaders are read there, and again when they change");
  command->add_option("--play", options->script, "a file of inputs, one a line and frame; see docs/gl.md");
  command->callback([=] { *exit_code = view_command(*options); });
}

}  // namespace zonal
