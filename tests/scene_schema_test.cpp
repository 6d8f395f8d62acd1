// The published schema and the loader know the same keys. The loader is asked through its own errors: an
// unknown key is answered by the list of all known ones.

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/error.h"
#include "core/scene_loader.h"
#include "lights/light.h"
#include "materials/material.h"
#include "tests/paths.h"

namespace zonal {
namespace {

using nlohmann::json;
using Keys = std::set<std::string>;

json read_json(const std::string& path) {
  return json::parse(std::ifstream(test::source_dir() + "/" + path));
}

const json& schema() {
  static const json value = read_json("scenes/scene.schema.json");
  return value;
}

Keys keys_of(const json& object) {
  Keys keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

/// Properties the schema gives to one or more of its definitions; "" is the root.
Keys schema_keys(const std::vector<std::string>& definitions) {
  Keys keys;
  for (const std::string& name : definitions) {
    const json& definition = name.empty() ? schema() : schema()["$defs"].at(name);
    EXPECT_EQ(definition.at("additionalProperties"), false) << name;
    keys.merge(keys_of(definition.at("properties")));
  }
  return keys;
}

const char* kUnknown = "@@@@@@@@";

/// The keys the loader lists when the object at `pointer` of a scene with these keys has one it does not
/// know.
Keys loader_keys(json scene, const std::string& pointer) {
  if (!scene.contains("camera")) scene["camera"] = {{"position", {0, 0, 5}}, {"look_at", {0, 0, 0}}};
  scene[json::json_pointer(pointer)][kUnknown] = 1;
  try {
    parse_scene(scene.dump(), test::source_dir() + "/tests/scene_files/probe.json");
    ADD_FAILURE() << pointer << ": an unknown key was accepted";
  } catch (const SceneError& error) {
    const std::string text = error.what(), head = "(there is: ";
    const size_t from = text.find(head);
    if (text.find(kUnknown) == std::string::npos || from == std::string::npos) {
      ADD_FAILURE() << text;
      return {};
    }
    std::istringstream list(text.substr(from + head.size(), text.size() - 1 - from - head.size()));
    Keys keys;
    for (std::string key; std::getline(list >> std::ws, key, ',');) keys.insert(key);
    return keys;
  }
  return {};
}

void expect_same(const std::vector<std::string>& definitions, const json& scene, const std::string& pointer) {
  EXPECT_EQ(loader_keys(scene, pointer), schema_keys(definitions)) << definitions[0];
}

json one(const char* list, const char* element) {
  return {{list, {json::parse(element)}}};
}

TEST(schema, root_and_camera) {
  expect_same({""}, json::object(), "");
  expect_same({"camera"}, json::object(), "/camera");
  expect_same({"camera"},
              {{"camera", {{"from", 0}}}, {"objects", {{{"type", "mesh"}, {"file", "sail.gltf"}}}}},
              "/camera");
}

TEST(schema, materials) {
  for (const MaterialKind& kind : material_kinds()) {
    if (!schema()["$defs"].contains("material_" + kind.name)) {
      ADD_FAILURE() << "the schema has no material " << kind.name;
      continue;
    }
    json scene = {{"materials", {{{"name", "m"}, {"type", kind.name}}}}};
    // Its file is required, and read only once the rest of the scene has been found right: any existing one
    // will do.
    if (kind.name == "measured") scene["materials"][0]["file"] = "flat.png";
    expect_same({"material_" + kind.name}, scene, "/materials/0");
  }
}

TEST(schema, textures) {
  const json color = one("materials", R"({"name": "m", "type": "lambert", "albedo": {"file": "flat.png"}})");
  expect_same({"color_texture"}, color, "/materials/0/albedo");
  const json number =
      one("materials", R"({"name": "m", "type": "coated", "roughness": {"file": "flat.png"}})");
  expect_same({"number_texture"}, number, "/materials/0/roughness");
  const json normal =
      one("materials", R"({"name": "m", "type": "lambert", "normal_map": {"file": "flat.png"}})");
  expect_same({"normal_texture"}, normal, "/materials/0/normal_map");
  const json mask = one("materials", R"({"name": "m", "type": "lambert", "mask": {"file": "flat.png"}})");
  expect_same({"mask_texture"}, mask, "/materials/0/mask");
}

TEST(schema, objects) {
  const std::map<std::string, const char*> examples{
      {"sphere", R"({"type": "sphere"})"},
      {"quad", R"({"type": "quad", "corner": [0,0,0], "edges": [[1,0,0],[0,1,0]]})"},
      {"box", R"({"type": "box", "low": [0,0,0], "high": [1,1,1]})"},
      {"triangle", R"({"type": "triangle", "vertices": [[0,0,0],[1,0,0],[0,1,0]]})"},
      {"mesh", R"({"type": "mesh", "file": "sail.gltf"})"}};
  for (const auto& [kind, example] : examples)
    expect_same({"object_" + kind}, one("objects", example), "/objects/0");
  expect_same({"transform_parts", "transform_matrix"},
              one("objects", R"({"type": "sphere", "transform": {}})"), "/objects/0/transform");
  expect_same({"emission"}, one("objects", R"({"type": "sphere", "emission": {"radiance": 1}})"),
              "/objects/0/emission");
}

TEST(schema, lights) {
  const std::map<std::string, const char*> examples{
      {"point", R"({"type": "point", "position": [0,0,0], "power": 1})"},
      {"spot", R"({"type": "spot", "position": [0,0,0], "direction": [0,1,0], "power": 1})"},
      {"directional", R"({"type": "directional", "direction": [0,1,0], "irradiance": 1})"},
      {"environment", R"({"type": "environment", "file": "sky.hdr"})"},
      {"sphere", R"({"type": "sphere", "center": [0,0,0], "radius": 1, "power": 1})"},
      {"quad", R"({"type": "quad", "corner": [0,0,0], "edges": [[1,0,0],[0,1,0]], "power": 1})"},
      {"triangle", R"({"type": "triangle", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "power": 1})"},
      {"disk", R"({"type": "disk", "center": [0,0,0], "normal": [0,1,0], "radius": 1, "power": 1})"},
      {"polygon", R"({"type": "polygon", "vertices": [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], "power": 1})"},
      {"textured", R"({"type": "textured", "corner": [0,0,0], "edges": [[1,0,0],[0,1,0]], "file": "sky.hdr"})"}};
  for (const auto& [kind, example] : examples)
    expect_same({"light_" + kind}, one("lights", example), "/lights/0");
}

TEST(schema, keyframes) {
  const json scene = json::parse(R"({
      "objects": [{"type": "sphere", "name": "a"}],
      "lights": [{"type": "point", "name": "b", "position": [0,0,0], "power": 1}],
      "keyframes": {"camera": [{"frame": 0}], "objects": {"a": [{"frame": 0, "transform": {}}]},
                    "lights": {"b": [{"frame": 0}]}}})");
  expect_same({"keyframes"}, scene, "/keyframes");
  expect_same({"keyframe_camera"}, scene, "/keyframes/camera/0");
  expect_same({"keyframe_object"}, scene, "/keyframes/objects/a/0");
  expect_same({"keyframe_light"}, scene, "/keyframes/lights/b/0");
}

/// Every schema in a tree that describes a value must say what it means: editors show it.
void expect_descriptions(const json& definition, const std::string& name) {
  for (const auto& [key, property] : definition.at("properties").items()) {
    const bool points = property.contains("$ref");
    EXPECT_TRUE(points || property.contains("description")) << name << "." << key << " has no description";
  }
}

TEST(schema, every_key_is_described) {
  expect_descriptions(schema(), "root");
  for (const auto& [name, definition] : schema()["$defs"].items()) {
    EXPECT_TRUE(definition.contains("description")) << name;
    if (definition.contains("properties")) expect_descriptions(definition, name);
  }
}

/// All keys of the definitions, wherever: what a scene that shows everything must use.
TEST(schema, the_example_of_all_keys_has_them_all) {
  Keys used;
  const std::function<void(const json&)> collect = [&](const json& value) {
    if (value.is_object())
      for (const auto& [key, child] : value.items()) used.insert(key), collect(child);
    if (value.is_array())
      for (const json& child : value) collect(child);
  };
  collect(read_json("tests/scene_files/everything.json"));
  for (const auto& [name, definition] : schema()["$defs"].items()) {
    if (!definition.contains("properties")) continue;
    for (const std::string& key : keys_of(definition["properties"])) {
      if (key == "from" || key == "object") continue;  // instead of "position" and "look_at"
      if (key == "entry") continue;                    // instead of "file"
      EXPECT_TRUE(used.contains(key)) << name << "." << key;
    }
  }
}

}  // namespace
}  // namespace zonal
