// "lights" without a surface: points, spots, suns and skies.

#include <fmt/format.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/loading.h"
#include "lights/shaped_lights.h"

namespace zonal {

namespace {

using nlohmann::json;

constexpr float kRadians = kPi / 180.0f;

/// "intensity", or "power" over the flux of the light at intensity 1.
template <class SomeLight>
void read_intensity(Fields& fields, SomeLight& light) {
  if (first_of(fields, "intensity", "power")) {
    light.intensity = fields.color("intensity", vec3(0), kLight);
    return;
  }
  light.intensity = vec3(1);
  const float flux = light.power().x;
  light.intensity = fields.color("power", vec3(0), kLight) / flux;
  if (!is_finite(light.intensity))
    fields.fail("power", "found more than so narrow a cone can hold, expected less");
}

std::unique_ptr<Light> point(Loading&, Fields& fields) {
  auto light = std::make_unique<PointLight>();
  light->position = read_point(fields, "position");
  read_intensity(fields, *light);
  return light;
}

std::unique_ptr<Light> spot(Loading&, Fields& fields) {
  auto light = std::make_unique<SpotLight>();
  light->position = read_point(fields, "position");
  if (first_of(fields, "direction", "look_at")) {
    light->direction = read_direction(fields, "direction");
  } else {
    const glm::dvec3 way = glm::dvec3(read_point(fields, "look_at")) - glm::dvec3(light->position);
    if (glm::dot(way, way) == 0)
      fields.fail("look_at", "found the light's own position, expected another point");
    light->direction = vec3(glm::normalize(way));
  }
  // pbrt's defaults: 30 degrees with an edge of 5.
  const float outer =
      fields.number("outer", 30.0f, {.low = 0, .high = 90, .open_low = true, .open_high = true});
  const float inner = fields.number("inner", std::fmax(0.0f, outer - 5.0f), {0, 90});
  if (inner > outer)
    fields.fail("inner", fmt::format("found {}, expected at most \"outer\", which is {}", inner, outer));
  light->cone = {inner * kRadians, outer * kRadians};
  read_intensity(fields, *light);
  return light;
}

std::unique_ptr<Light> directional(Loading&, Fields& fields) {
  auto light = std::make_unique<DirectionalLight>();
  light->direction = read_direction(fields, "direction");
  fields.require("irradiance", "a colour (W/m2)");
  light->irradiance = fields.color("irradiance", vec3(0), kLight);
  return light;
}

std::unique_ptr<Light> environment(Loading& loading, Fields& fields) {
  if (loading.parts.environment != kNone)
    throw SceneError(fields.where() + ": found a second environment, expected at most one");
  loading.parts.environment = static_cast<uint32_t>(loading.parts.lights.size());
  const bool constant = first_of(fields, "radiance", "file");
  const vec3 radiance = fields.color("radiance", vec3(0), kLight);
  const std::string file = fields.text("file", "");
  const bool scaled = fields.has("scale"), turned = fields.has("rotation");
  const vec3 scale = fields.color("scale", vec3(1), kLight);
  const float rotation = fields.number("rotation", 0.0f, kPlace) * kRadians;
  if (!constant) {
    RadiancePicture picture = read_radiance(loading, file, fields.at("file"), scale);
    return std::make_unique<PictureLight>(picture.width, picture.height, std::move(picture.texels), rotation);
  }
  if (scaled || turned)
    fields.fail(scaled ? "scale" : "rotation", "found beside \"radiance\", expected it only with \"file\"");
  return std::make_unique<PictureLight>(1, 1, std::vector<vec3>{radiance}, 0.0f);
}

const std::array<std::string, 10> kKinds{"point", "spot",     "directional", "environment", "sphere",
                                         "quad",  "triangle", "disk",        "polygon",     "textured"};
/// Kinds without a surface; those with one are in load_area_lights.cpp.
const std::map<std::string, std::unique_ptr<Light> (*)(Loading&, Fields&)> kReaders{
    {"point", point}, {"spot", spot}, {"directional", directional}, {"environment", environment}};

}  // namespace

bool first_of(Fields& fields, const char* first, const char* second) {
  const bool has_first = fields.find(first), has_second = fields.find(second);
  if (has_first && has_second)
    fields.fail(second, fmt::format("found beside \"{}\", expected one of the two", first));
  if (!has_first && !has_second) fields.require(first, fmt::format("it or \"{}\"", second));
  return has_first;
}

void read_lights(Loading& loading, const json& list, const std::string& where) {
  const auto values = read_array(list, where, "lights");
  std::set<std::string> names;
  for (size_t i = 0; i < values.size(); ++i) {
    Fields fields(values[i], where_of(where, i));
    const std::string& kind = kKinds[static_cast<size_t>(fields.choice("type", kKinds))];
    const std::string name = fields.text("name", fmt::format("lights/{}", i));
    if (!names.insert(name).second)
      fields.fail("name", fmt::format("found {} again, expected another name: keyframes find lights by it",
                                      in_quotes(name)));
    const auto reader = kReaders.find(kind);
    if (reader == kReaders.end()) {
      read_area_light(loading, fields, kind, name);
      continue;
    }
    std::unique_ptr<Light> light = reader->second(loading, fields);
    fields.finish();
    light->name = name;
    loading.parts.lights.push_back(std::move(light));
  }
}

}  // namespace zonal
