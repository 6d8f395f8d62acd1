// "objects": spheres, quads, boxes and triangles become shapes here; mesh files wait in Loading::imports.

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "core/basic_shapes.h"
#include "core/error.h"
#include "core/loading.h"

namespace zonal {
namespace {

using nlohmann::json;

const std::array<std::string, 5> kKinds{"sphere", "quad", "box", "triangle", "mesh"};
enum Kind { sphere, quad, box, triangle, mesh };

/// What all kinds of objects may say.
struct Common {
  std::string name;
  mat4 transform{1};
  std::optional<uint32_t> material;
  std::optional<Emission> emission;
};

std::optional<uint32_t> read_material_name(Loading& loading, Fields& fields) {
  if (!fields.find("material")) return std::nullopt;
  const std::string name = fields.text("material");
  if (const uint32_t index = loading.find_material(name); index != kNone) return index;
  if (const MaterialDatabase* database = loading.database()) {
    std::vector<std::string> names = loading.material_names;
    for (const std::string& entry : database->names()) names.push_back(entry);
    fields.fail("material",
                fmt::format("found {}, expected the name of a material of the scene or its database{}",
                            in_quotes(name), did_you_mean(name, names)));
  }
  const std::string known = loading.material_names.empty() ? " (\"materials\" defines none)"
                                                           : did_you_mean(name, loading.material_names);
  fields.fail("material", fmt::format("found {}, expected the name of a material{}", in_quotes(name), known));
}

Common read_common(Loading& loading, Fields& fields, size_t index) {
  Common common;
  common.name = fields.text("name", fmt::format("objects/{}", index));
  if (const json* transform = fields.find("transform"))
    common.transform = read_transform(*transform, fields.at("transform")).matrix();
  common.material = read_material_name(loading, fields);
  if (const json* emission = fields.find("emission")) {
    Fields inner(*emission, fields.at("emission"));
    common.emission = read_emission(inner);
    inner.finish();
  }
  return common;
}

void read_sphere(Fields& fields, const Common& common, ShapeData& shape) {
  const vec3 center = read_point(fields, "center", vec3(0));
  const float radius = fields.number("radius", 1.0f, kLength);
  const std::optional<float> scale = uniform_scale(common.transform);
  if (!scale)
    fields.fail("transform",
                "found a scale that differs by direction, expected one number for a sphere: an "
                "ellipsoid has to be a mesh");
  shape.center = vec3(common.transform * vec4(center, 1));
  shape.radius = radius * *scale;
  if (!kLength.contains(shape.radius) || !(shape.radius > 0))
    fields.fail("radius", fmt::format("found {} after the transform, expected a number {}", shape.radius,
                                      kLength.text()));
}

MeshData read_box(Fields& fields) {
  const vec3 low = read_point(fields, "low"), high = read_point(fields, "high");
  for (int axis = 0; axis < 3; ++axis)
    if (!(low[axis] < high[axis]))
      fields.fail("high", fmt::format("found {} = {}, expected more than the {} of \"low\"", "xyz"[axis],
                                      high[axis], low[axis]));
  return box_mesh(low, high);
}

void read_mesh(Loading& loading, Fields& fields, Common common) {
  PendingImport import;
  const std::string text = fields.text("file");
  import.options.metres_per_unit =
      fields.number("metres_per_unit", 1.0f, {.low = 0, .high = 1e6, .open_low = true});
  import.options.lights = fields.flag("lights", true);
  import.options.smooth_normals = fields.flag("smooth_normals", true);
  if (const json* list = fields.find("exclude")) {
    const auto names = read_array(*list, fields.at("exclude"), "names");
    for (size_t i = 0; i < names.size(); ++i)
      import.options.exclude.push_back(read_text(names[i], where_of(fields.at("exclude"), i)));
  }
  import.file = loading.resolve(text, fields.at("file"));
  import.where = fields.at("file");
  import.name = std::move(common.name);
  import.options.transform = common.transform;
  import.material = common.material;
  import.emission = std::move(common.emission);
  loading.imports.push_back(std::move(import));
}

}  // namespace

std::vector<vec3> read_points(Fields& fields, size_t fewest, size_t most) {
  const std::string expected = fewest == most ? "three points" : fmt::format("{} to {} points", fewest, most);
  const json& value = fields.require("vertices", expected + " [[x, y, z], ...]");
  const std::string where = fields.at("vertices");
  const auto points = read_array(value, where, expected);
  if (points.size() < fewest || points.size() > most)
    fields.fail("vertices", "found " + describe(value) + ", expected " + expected);
  std::vector<vec3> result;
  for (size_t i = 0; i < points.size(); ++i)
    result.push_back(read_vector(points[i], where_of(where, i), kPlace));
  return result;
}

MeshData read_triangle(Fields& fields) {
  const std::vector<vec3> p = read_points(fields, 3, 3);
  return triangle_mesh(p[0], p[1], p[2]);
}

MeshData read_quad(Fields& fields) {
  const vec3 corner = read_point(fields, "corner");
  const json& value = fields.require("edges", "two vectors [[x, y, z], [x, y, z]]");
  const std::string where = fields.at("edges");
  const auto edges = read_array(value, where, "two vectors");
  if (edges.size() != 2) fields.fail("edges", "found " + describe(value) + ", expected two vectors");
  return quad_mesh(corner, read_vector(edges[0], where_of(where, size_t(0)), kPlace),
                   read_vector(edges[1], where_of(where, size_t(1)), kPlace));
}

void read_objects(Loading& loading, const json& list, const std::string& where) {
  const auto values = read_array(list, where, "objects");
  std::set<std::string> names;
  for (size_t i = 0; i < values.size(); ++i) {
    Fields fields(values[i], where_of(where, i));
    const int kind = fields.choice("type", kKinds);
    Common common = read_common(loading, fields, i);
    if (!names.insert(common.name).second)
      fields.fail(
          "name",
          fmt::format("found {} again, expected another name: keyframes and cameras find objects by it",
                      in_quotes(common.name)));
    if (kind == mesh) {
      read_mesh(loading, fields, std::move(common));
      fields.finish();
      continue;
    }

    ShapeData shape;
    if (kind == sphere) read_sphere(fields, common, shape);
    if (kind == quad) shape.mesh = read_quad(fields);
    if (kind == box) shape.mesh = read_box(fields);
    if (kind == triangle) shape.mesh = read_triangle(fields);
    fields.finish();
    place(shape.mesh, common.transform);
    for (const vec3 p : shape.mesh.positions)
      for (int axis = 0; axis < 3; ++axis)
        if (!kPlace.contains(p[axis]))
          fields.fail("transform", fmt::format("found a vertex moved to {}, expected coordinates {}", p[axis],
                                               kPlace.text()));
    shape.name = shape.mesh.name = common.name;
    shape.material = common.material ? *common.material : loading.grey();
    add_shape(loading, std::move(shape), common.emission);
  }
}

}  // namespace zonal
