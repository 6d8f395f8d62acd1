#include "core/scene_loader.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/loading.h"
#include "core/strict_json.h"

namespace zonal {
namespace {

using nlohmann::json;

/// Libraries may complain in several lines; an error is one.
std::string one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = static_cast<unsigned char>(c) < 32 || c == 127;
    if (!blank)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

void read_settings(Fields& fields, SceneSettings& settings) {
  if (const json* integrator = fields.find("integrator")) {
    Fields inner(*integrator, fields.at("integrator"));
    inner.text("type");  // its other keys belong to the method, which reads them itself
    settings.integrator_json = integrator->dump(-1, ' ', false, json::error_handler_t::replace);
  }
  settings.passes = fields.integer("passes", 0, {1, 1e9});
}

/// Where projected materials are: the scene's word, else the environment's.
void find_database(Loading& loading, const std::string& text, const std::string& where) {
  const char* environment = std::getenv("ZONAL_MATERIALS");
  if (!text.empty()) {
    loading.database_folder =
        std::filesystem::path(loading.resolve(text + "/index.json", where)).parent_path().string();
    loading.database_where = where;
  } else if (environment && *environment) {
    loading.database_folder = environment, loading.database_where = loading.file + ": ZONAL_MATERIALS";
  }
}

/// What is no mistake but may surprise.
void add_notes(Loading& loading) {
  for (size_t i = 0; i < loading.material_names.size(); ++i)
    if (!loading.material_used[i])
      loading.parts.notes.push_back(fmt::format("{}: the material {} is not used",
                                                where_of(where_of(loading.file, "materials"), i),
                                                in_quotes(loading.material_names[i])));
  if (loading.parts.lights.empty())
    loading.parts.notes.push_back(loading.file + ": there are no lights: the picture will be black");
}

/// Nothing where `only_check`: what is in other files is not read then.
std::optional<Scene> parse(const std::string& text, const std::string& file, const LoadOptions& options,
                           SceneSettings& settings, bool only_check = false) {
  json root = parse_json(text, file);
  apply_keyframes(root, options.frame, file);
  replace_materials(root, options.materials, file);

  Fields fields(root, file);
  Loading loading;
  loading.file = file;
  loading.folder = std::filesystem::path(file).parent_path().string();
  const json none = json::array();
  const auto list = [&](const char* key) -> const json& {
    const json* found = fields.find(key);
    return found ? *found : none;
  };
  fields.text("$schema", "");
  loading.parts.name = fields.text("name", std::filesystem::path(file).stem().string());
  const json& camera = fields.require("camera", "a camera {\"position\", \"look_at\", ...}");
  read_settings(fields, settings);
  const json &materials = list("materials"), &objects = list("objects"), &lights = list("lights");
  fields.find("keyframes");
  const std::string database = fields.text("material_database", "");
  fields.finish();
  find_database(loading, database, fields.at("material_database"));

  // What the file itself says comes first: its mistakes are found before any large file is read.
  read_materials(loading, materials, fields.at("materials"));
  read_objects(loading, objects, fields.at("objects"));
  read_lights(loading, lights, fields.at("lights"));
  const bool own_camera = !camera.is_object() || !camera.contains("from");
  if (own_camera) loading.parts.camera = read_camera(loading, camera, fields.at("camera"), options);
  if (only_check) return {};
  loading.textures.load_all(loading.parts.textures);
  loading.measured.load_all();
  import_meshes(loading);
  if (!own_camera) loading.parts.camera = read_camera(loading, camera, fields.at("camera"), options);
  add_notes(loading);

  try {
    return Scene(std::move(loading.parts));
  } catch (const SceneError& error) {
    throw SceneError(file + ": " + error.what());
  }
}

}  // namespace

vec3 read_point(Fields& fields, std::string_view key) {
  return read_vector(fields.require(key, "three numbers [x, y, z]"), fields.at(key), kPlace);
}

vec3 read_point(Fields& fields, std::string_view key, vec3 otherwise) {
  const json* found = fields.find(key);
  return found ? read_vector(*found, fields.at(key), kPlace) : otherwise;
}

vec3 read_direction(Fields& fields, std::string_view key) {
  const glm::dvec3 v(read_point(fields, key));
  if (glm::dot(v, v) == 0) fields.fail(key, "found [0, 0, 0], expected a direction");
  return vec3(glm::normalize(v));
}

Scene parse_scene(const std::string& text, const std::string& file, const LoadOptions& options,
                  SceneSettings* settings) {
  SceneSettings read;
  try {
    std::optional<Scene> scene = parse(text, file, options, read);
    if (settings) *settings = std::move(read);
    return std::move(*scene);
  } catch (const SceneError& error) {
    throw SceneError(one_line(error.what()));
  }
}

Scene load_scene(const std::string& file, const LoadOptions& options, SceneSettings* settings) {
  return parse_scene(read_text_file(file, "a scene"), file, options, settings);
}

void check_scene(const std::string& file, const LoadOptions& options) {
  SceneSettings unused;
  try {
    parse(read_text_file(file, "a scene"), file, options, unused, true);
  } catch (const SceneError& error) {
    throw SceneError(one_line(error.what()));
  }
}

}  // namespace zonal
