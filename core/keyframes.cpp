// "keyframes": what the camera, objects and lights say at one frame. Each key is a track of its own: linear
// between the keyframes that give it, held before the first and after the last. The values found are put in
// the place of the ones the camera, object or light gives itself; after that, nothing knows of frames.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/loading.h"

namespace zonal {
namespace {

using nlohmann::json;

struct Key {
  int frame;
  std::vector<double> numbers;
};
using Tracks = std::map<std::string, std::vector<Key>>;

constexpr Range kFrames{-1e9, 1e9};
constexpr Range kFovRange{.low = 0, .high = 180, .open_low = true, .open_high = true};

std::vector<double> numbers_of(vec3 v) {
  return {v.x, v.y, v.z};
}

std::vector<double> at_frame(const std::vector<Key>& track, int frame) {
  const auto after = std::upper_bound(track.begin(), track.end(), frame,
                                      [](int wanted, const Key& key) { return wanted < key.frame; });
  if (after == track.begin()) return track.front().numbers;
  const Key& a = *(after - 1);
  if (after == track.end()) return a.numbers;
  const double t = (static_cast<double>(frame) - a.frame) / (static_cast<double>(after->frame) - a.frame);
  std::vector<double> result(a.numbers.size());
  for (size_t i = 0; i < result.size(); ++i)
    result[i] = a.numbers[i] + t * (after->numbers[i] - a.numbers[i]);
  return result;
}

void read_points(Fields& fields, Tracks& tracks, int frame, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const json* v = fields.find(key))
      tracks[key].push_back({frame, numbers_of(read_vector(*v, fields.at(key), kPlace))});
}

void read_colors(Fields& fields, Tracks& tracks, int frame, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const json* v = fields.find(key))
      tracks[key].push_back({frame, numbers_of(read_color(*v, fields.at(key), kLight))});
}

void read_scalars(Fields& fields, Tracks& tracks, int frame, std::initializer_list<const char*> keys,
                  Range range) {
  for (const char* key : keys)
    if (fields.find(key)) tracks[key].push_back({frame, {fields.number(key, range)}});
}

void camera_keys(Fields& fields, Tracks& tracks, int frame) {
  read_points(fields, tracks, frame, {"position", "look_at", "up"});
  read_scalars(fields, tracks, frame, {"vertical_fov"}, kFovRange);
  read_scalars(fields, tracks, frame, {"exposure"}, {.low = 0, .high = kBrightest, .open_low = true});
}

void light_keys(Fields& fields, Tracks& tracks, int frame) {
  read_points(fields, tracks, frame, {"position", "direction", "look_at", "center", "normal", "corner"});
  read_colors(fields, tracks, frame, {"intensity", "power", "radiance", "irradiance", "scale"});
  read_scalars(fields, tracks, frame, {"inner", "outer", "rotation"}, kPlace);
  read_scalars(fields, tracks, frame, {"radius"}, kLength);
}

/// A keyframe's transform is whole: what it leaves out is "not moved", not "as before".
void object_keys(Fields& fields, Tracks& tracks, int frame) {
  const Transform t = read_transform(fields.require("transform", "a transform"), fields.at("transform"));
  if (t.given) {
    std::vector<double> rows;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) rows.push_back((*t.given)[column][row]);
    tracks["matrix"].push_back({frame, rows});
  } else {
    tracks["translate"].push_back({frame, numbers_of(t.translate)});
    tracks["rotate"].push_back({frame, numbers_of(t.rotate)});
    tracks["scale"].push_back({frame, numbers_of(t.scale)});
  }
  if (tracks.size() == 4)
    fields.fail("transform", "found parts here and a matrix elsewhere, expected one kind for all keyframes");
}

using KeyReader = void (*)(Fields&, Tracks&, int);

/// The keyframes' values at `frame`, as the JSON the camera, object or light would have had.
json values_at(const json& list, const std::string& where, int frame, KeyReader read_keys) {
  const auto keyframes = read_array(list, where, "keyframes");
  Tracks tracks;
  int previous = 0;
  for (size_t i = 0; i < keyframes.size(); ++i) {
    Fields fields(keyframes[i], where_of(where, i));
    fields.require("frame", "a whole number");
    const int at = fields.integer("frame", 0, kFrames);
    if (i > 0 && at <= previous)
      fields.fail("frame", fmt::format("found {} after {}, expected frames in rising order", at, previous));
    previous = at;
    read_keys(fields, tracks, at);
    fields.finish();
  }

  json result = json::object();
  for (const auto& [key, track] : tracks) {
    const std::vector<double> numbers = at_frame(track, frame);
    result[key] = numbers.size() == 1 ? json(numbers[0]) : json(numbers);
  }
  return result;
}

/// Puts moving values in the place of resting ones.
void merge(json& target, const json& values, const std::string& where) {
  // Of two ways to say the same thing, the moving one wins.
  const std::vector<std::vector<std::string>> exclusive{
      {"direction", "look_at"}, {"intensity", "power"}, {"radiance", "power"}};
  for (const auto& pair : exclusive)
    for (int i = 0; i < 2; ++i)
      if (values.contains(pair[i]) && !values.contains(pair[1 - i])) target.erase(pair[1 - i]);

  static const std::map<std::string, std::vector<std::string>> moving{
      {"point", {"position", "intensity", "power"}},
      {"spot", {"position", "direction", "look_at", "intensity", "power", "inner", "outer"}},
      {"directional", {"direction", "irradiance"}},
      {"environment", {"radiance", "scale", "rotation"}},
      {"sphere", {"center", "radius", "radiance", "power"}},
      {"quad", {"corner", "radiance", "power"}},
      {"triangle", {"radiance", "power"}},
      {"disk", {"center", "normal", "radius", "radiance", "power"}},
      {"polygon", {"radiance", "power"}},
      {"textured", {"corner", "scale"}}};
  const json type = target.contains("type") ? target["type"] : json();
  const auto kind = type.is_string() ? moving.find(type.get<std::string>()) : moving.end();
  for (const auto& [key, value] : values.items()) {
    if (kind != moving.end() &&
        std::find(kind->second.begin(), kind->second.end(), key) == kind->second.end())
      throw SceneError(fmt::format("{}: found {}, which a {} light does not move{}", where, in_quotes(key),
                                   kind->first, did_you_mean(key, kind->second)));
    target[key] = value;
  }
}

/// Applies {"name": [keyframes], ...} to the elements of `list` with those names.
template <class Apply>
void for_each_named(const json& named, const std::string& where, json* list, const char* what, Apply apply) {
  Fields checked(named, where);  // refuses what is not an object
  std::vector<std::string> names;
  if (list && list->is_array())
    for (const json& element : *list)
      if (element.is_object() && element.contains("name") && element["name"].is_string())
        names.push_back(element["name"].get<std::string>());
  for (const auto& [name, keyframes] : named.items()) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw SceneError(fmt::format("{}: found {}, expected the name of {}{}", where, in_quotes(name), what,
                                   did_you_mean(name, names)));
    for (json& element : *list)
      if (element.is_object() && element.contains("name") && element["name"] == name)
        apply(element, keyframes, where_of(where, name));
  }
}

json* child(json& root, const char* key) {
  const auto it = root.find(key);
  return it == root.end() ? nullptr : &*it;
}

}  // namespace

void apply_keyframes(json& root, int frame, const std::string& file) {
  if (!root.is_object() || !root.contains("keyframes")) return;
  const json keyframes = root["keyframes"];
  Fields fields(keyframes, where_of(file, "keyframes"));

  if (const json* camera = fields.find("camera")) {
    const json values = values_at(*camera, fields.at("camera"), frame, camera_keys);
    json* target = child(root, "camera");
    if (target && target->is_object()) merge(*target, values, fields.at("camera"));
  }
  if (const json* objects = fields.find("objects"))
    for_each_named(*objects, fields.at("objects"), child(root, "objects"), "an object",
                   [&](json& object, const json& list, const std::string& where) {
                     const json values = values_at(list, where, frame, object_keys);
                     if (!values.empty()) object["transform"] = values;
                   });
  if (const json* lights = fields.find("lights"))
    for_each_named(*lights, fields.at("lights"), child(root, "lights"), "a light",
                   [&](json& light, const json& list, const std::string& where) {
                     merge(light, values_at(list, where, frame, light_keys), where);
                   });
  fields.finish();
}

}  // namespace zonal
