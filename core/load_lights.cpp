// "lights" and the "emission" of objects. Area lights are surfaces too: they become shapes with a black
// material.

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "core/basic_shapes.h"
#include "core/error.h"
#include "core/image.h"
#include "core/loading.h"
#include "lights/shaped_lights.h"

namespace zonal {

namespace {

using nlohmann::json;

constexpr float kRadians = kPi / 180.0f;

/// Which of two keys is there: exactly one must be.
bool first_of(Fields& fields, const char* first, const char* second) {
  const bool has_first = fields.find(first), has_second = fields.find(second);
  if (has_first && has_second)
    fields.fail(second, fmt::format("found beside \"{}\", expected one of the two", first));
  if (!has_first && !has_second) fields.require(first, fmt::format("it or \"{}\"", second));
  return has_first;
}

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

/// A latitude-longitude picture as radiance.
std::unique_ptr<Light> environment_picture(Loading& loading, Fields& fields, const std::string& text,
                                           vec3 scale, float rotation) {
  const std::string where = fields.at("file"), file = loading.resolve(text, where);
  ImageFile picture;
  try {
    picture = read_image(file);
  } catch (const SceneError& error) {
    throw SceneError(where + ": " + error.what());
  }
  const auto color = picture.layers.find("");
  if (color == picture.layers.end() || color->second.pixels.empty())
    throw SceneError(where + ": found a picture without colour channels, expected R, G and B");

  const Image& image = color->second;
  std::vector<vec3> texels;
  texels.reserve(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  size_t replaced = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      vec3 c = image.rgb(x, y);
      if (picture.display_referred) c = vec3(srgb_decode(c.x), srgb_decode(c.y), srgb_decode(c.z));
      c *= scale;
      const vec3 allowed = glm::clamp(c, vec3(0), vec3(kBrightest));
      const bool bad = !is_finite(c) || allowed != c;
      replaced += bad;
      texels.push_back(is_finite(c) ? allowed : vec3(0));
    }
  if (replaced > 0)
    loading.parts.notes.push_back(fmt::format(
        "{}: {} texels that are negative or not finite were replaced by the nearest allowed value", where,
        replaced));
  return std::make_unique<PictureLight>(image.width, image.height, std::move(texels), rotation);
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
  if (!constant) return environment_picture(loading, fields, file, scale, rotation);
  if (scaled || turned)
    fields.fail(scaled ? "scale" : "rotation", "found beside \"radiance\", expected it only with \"file\"");
  return std::make_unique<PictureLight>(1, 1, std::vector<vec3>{radiance}, 0.0f);
}

enum Kind {
  k_point,
  k_spot,
  k_directional,
  k_environment,
  k_sphere,
  k_quad,
  k_triangle,
  k_disk,
  k_polygon,
  k_textured
};
const std::array<std::string, 10> kKinds{"point", "spot",     "directional", "environment", "sphere",
                                         "quad",  "triangle", "disk",        "polygon",     "textured"};
/// In the order of kKinds; what follows are area lights, and after `triangle` what is reserved.
constexpr std::array<std::unique_ptr<Light> (*)(Loading&, Fields&), 4> kReaders{point, spot, directional,
                                                                                environment};

int read_kind(Fields& fields) {
  const std::span<const std::string> known(kKinds.data(), k_disk);
  if (const json* type = fields.find("type"); type && type->is_string())
    for (int reserved = k_disk; reserved <= k_textured; ++reserved)
      if (type->get_ref<const std::string&>() == kKinds[static_cast<size_t>(reserved)])
        fields.fail(
            "type",
            fmt::format("found \"{}\", which this version does not have yet, expected sphere, quad or "
                        "triangle (or a mesh with \"emission\")",
                        kKinds[static_cast<size_t>(reserved)]));
  return fields.choice("type", known);
}

void add_area_light(Loading& loading, Fields& fields, int kind, const std::string& name) {
  ShapeData shape;
  if (kind == k_sphere) {
    shape.center = read_point(fields, "center");
    shape.radius = fields.number("radius", kLength);
  } else {
    shape.mesh = kind == k_quad ? read_quad(fields) : read_triangle(fields);
    if (surface_area(shape.mesh) == 0)
      fields.fail(kind == k_quad ? "edges" : "vertices", "found a light without area, expected some");
  }
  const Emission emission = read_emission(fields);
  fields.finish();
  shape.name = shape.mesh.name = name;
  shape.material = loading.black();
  add_shape(loading, std::move(shape), emission);
}

}  // namespace

vec3 Emission::radiance_from(double area) const {
  if (!power) return radiance;
  // A surface of constant radiance L emits pi L a square metre and side.
  const vec3 result(glm::dvec3(*power) / (static_cast<double>(kPi) * area * (two_sided ? 2 : 1)));
  if (!is_finite(result))
    throw SceneError(where + ": found power on a surface without area, expected one with some");
  return result;
}

Emission read_emission(Fields& fields) {
  Emission emission;
  emission.where = fields.where();
  if (first_of(fields, "radiance", "power"))
    emission.radiance = fields.color("radiance", vec3(0), kLight);
  else
    emission.power = fields.color("power", vec3(0), kLight);
  emission.two_sided = fields.flag("two_sided", false);
  return emission;
}

void add_shape(Loading& loading, ShapeData shape, const std::optional<Emission>& emission) {
  if (emission) {
    std::unique_ptr<Light> light;
    if (shape.radius > 0) {
      auto ball = std::make_unique<SphereLight>();
      ball->center = shape.center;
      ball->radius = shape.radius;
      ball->two_sided = emission->two_sided;
      const double r = shape.radius;
      ball->emission = emission->radiance_from(4 * static_cast<double>(kPi) * r * r);
      light = std::move(ball);
    } else {
      std::vector<MeshLight::Triangle> triangles;
      triangles.reserve(shape.mesh.triangles.size());
      for (const uvec3 t : shape.mesh.triangles)
        triangles.push_back(
            {shape.mesh.positions[t.x], shape.mesh.positions[t.y], shape.mesh.positions[t.z]});
      light = std::make_unique<TriangleLight>(
          std::move(triangles), emission->radiance_from(surface_area(shape.mesh)), emission->two_sided);
    }
    light->name = shape.name;
    shape.light = static_cast<uint32_t>(loading.parts.lights.size());
    loading.parts.lights.push_back(std::move(light));
  }
  loading.parts.shapes.push_back(std::move(shape));
}

void read_lights(Loading& loading, const json& list, const std::string& where) {
  const auto values = read_array(list, where, "lights");
  std::set<std::string> names;
  for (size_t i = 0; i < values.size(); ++i) {
    Fields fields(values[i], where_of(where, i));
    const int kind = read_kind(fields);
    const std::string name = fields.text("name", fmt::format("lights/{}", i));
    if (!names.insert(name).second)
      fields.fail("name", fmt::format("found {} again, expected another name: keyframes find lights by it",
                                      in_quotes(name)));
    if (kind >= k_sphere) {
      add_area_light(loading, fields, kind, name);
      continue;
    }
    std::unique_ptr<Light> light = kReaders[static_cast<size_t>(kind)](loading, fields);
    fields.finish();
    light->name = name;
    loading.parts.lights.push_back(std::move(light));
  }
}

}  // namespace zonal
