// Lights with a surface, and the "emission" of objects. They are visible: each becomes a shape with a black
// material.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/basic_shapes.h"
#include "core/error.h"
#include "core/flat_shapes.h"
#include "core/image.h"
#include "core/loading.h"
#include "lights/shaped_lights.h"

namespace zonal {

namespace {

constexpr size_t kMostCorners = 4096;

std::vector<MeshLight::Triangle> triangles_of(const MeshData& mesh) {
  std::vector<MeshLight::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const uvec3 t : mesh.triangles)
    triangles.push_back({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
  return triangles;
}

/// A shape and the light it is.
void add_glowing(Loading& loading, ShapeData shape, std::unique_ptr<Light> light) {
  light->name = shape.name;
  shape.light = static_cast<uint32_t>(loading.parts.lights.size());
  loading.parts.lights.push_back(std::move(light));
  loading.parts.shapes.push_back(std::move(shape));
}

MeshData read_polygon(Fields& fields) {
  const std::vector<vec3> corners = read_points(fields, 3, kMostCorners);
  try {
    return polygon_mesh(corners);
  } catch (const SceneError& error) {
    fields.fail("vertices", error.what());
  }
}

void add_disk(Loading& loading, Fields& fields, ShapeData shape) {
  const vec3 center = read_point(fields, "center"), normal = read_direction(fields, "normal");
  const float radius = fields.number("radius", kLength);
  const Emission emission = read_emission(fields);
  fields.finish();
  shape.mesh = disk_mesh(center, normal, radius);
  const vec3 radiance = emission.radiance_from(kPi * double(radius) * radius);
  auto light = std::make_unique<DiskLight>(triangles_of(shape.mesh), radiance, emission.two_sided, center,
                                           normal, radius);
  add_glowing(loading, std::move(shape), std::move(light));
}

void add_textured(Loading& loading, Fields& fields, ShapeData shape) {
  const std::string file = fields.text("file");
  const vec3 scale = fields.color("scale", vec3(1), kLight);
  const bool two_sided = fields.flag("two_sided", false);
  fields.finish();
  RadiancePicture picture = read_radiance(loading, file, fields.at("file"), scale);
  // Corners 0, 1 and 3 of a quad are its corner and the ends of its edges.
  const auto& p = shape.mesh.positions;
  auto light = std::make_unique<TexturedLight>(p[0], p[1] - p[0], p[3] - p[0], picture.width, picture.height,
                                               std::move(picture.texels), two_sided);
  add_glowing(loading, std::move(shape), std::move(light));
}

void refuse_flat(Fields& fields, const MeshData& mesh, const char* key) {
  if (surface_area(mesh) == 0) fields.fail(key, "found a light without area, expected some");
}

}  // namespace

void read_area_light(Loading& loading, Fields& fields, const std::string& kind, const std::string& name) {
  ShapeData shape;
  shape.name = shape.mesh.name = name;
  shape.material = loading.black();
  if (kind == "disk") return add_disk(loading, fields, std::move(shape));
  if (kind == "sphere") {
    shape.center = read_point(fields, "center");
    shape.radius = fields.number("radius", kLength);
  } else if (kind == "polygon") {
    shape.mesh = read_polygon(fields);
  } else if (kind == "triangle") {
    shape.mesh = read_triangle(fields);
    refuse_flat(fields, shape.mesh, "vertices");
  } else {
    shape.mesh = read_quad(fields);
    refuse_flat(fields, shape.mesh, "edges");
    if (kind == "textured") return add_textured(loading, fields, std::move(shape));
  }
  shape.mesh.name = name;
  const Emission emission = read_emission(fields);
  fields.finish();
  add_shape(loading, std::move(shape), emission);
}

RadiancePicture read_radiance(Loading& loading, const std::string& text, const std::string& where,
                              vec3 scale) {
  const std::string file = loading.resolve(text, where);
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
  return {image.width, image.height, std::move(texels)};
}

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
  if (!emission) {
    loading.parts.shapes.push_back(std::move(shape));
    return;
  }
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
    light = std::make_unique<TriangleLight>(
        triangles_of(shape.mesh), emission->radiance_from(surface_area(shape.mesh)), emission->two_sided);
  }
  add_glowing(loading, std::move(shape), std::move(light));
}

}  // namespace zonal
