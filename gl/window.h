#pragma once
/// The window of `zonal view`: GLFW and Dear ImGui around a Viewer.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace zonal::gl {

struct WindowOptions {
  std::string scene, method = "hvl";
  nlohmann::json settings = nlohmann::json::object();
  int width = 1280, height = 720;
  std::string shader_folder;  ///< shaders are read from here and again when they change
  std::vector<std::string>
      script;  ///< lines of Viewer::act, one a frame; then the window closes. Empty: stays open
};

/// Returns when the window is closed. Throws SceneError: no display, OpenGL too old, a scene that cannot be
/// shown, a line of the script that went wrong.
void run_window(const WindowOptions& options);

}  // namespace zonal::gl
