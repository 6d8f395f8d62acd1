#pragma once
/// Reads a scene file (scenes/scene.schema.json describes it) into a Scene.
///
///     Scene scene = load_scene("scenes/atrium/atrium.json", {.frame = 10});

#include <string>

#include <nlohmann/json.hpp>

#include "core/scene.h"

namespace zonal {

struct LoadOptions {
  int frame = 0;               ///< for files with keyframes
  int width = 0, height = 0;   ///< > 0: replaces the file's resolution
  /// Other definitions of materials, by name: an entry of the material database, or an object as in "materials".
  nlohmann::json materials = nlohmann::json::object();
};

/// What the file says beside the scene itself.
struct SceneSettings {
  std::string integrator_json = "{}";  ///< the file's "integrator" object, as text; "{}" when absent
  int passes = 0;                       ///< the file's "passes", 0 when absent
};

/// Loads completely or throws SceneError with one line: file, place, found, expected.
Scene load_scene(const std::string& file, const LoadOptions& options = {}, SceneSettings* settings = nullptr);
/// The same from text already in memory; `file` names it in errors and anchors relative paths.
Scene parse_scene(const std::string& text, const std::string& file, const LoadOptions& options = {},
                  SceneSettings* settings = nullptr);
/// Throws what load_scene would for what the file itself says; reads no mesh, texture or measured file.
void check_scene(const std::string& file, const LoadOptions& options = {});

}  // namespace zonal
