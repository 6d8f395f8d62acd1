#include "core/transform.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/json_fields.h"
#include "core/loading.h"

namespace zonal {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::dvec4;

/// Right-handed rotation about axis 0, 1 or 2 by an angle in degrees; exact at multiples of 90.
dmat4 rotation(int axis, double degrees) {
  const double turns = std::remainder(degrees, 360.0);
  double c = std::cos(turns * (M_PI / 180)), s = std::sin(turns * (M_PI / 180));
  if (std::remainder(turns, 90.0) == 0) c = std::round(c), s = std::round(s);
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  dmat4 m(1);
  m[a][a] = c, m[a][b] = s;  // column a: where the axis after the rotation axis goes
  m[b][a] = -s, m[b][b] = c;
  return m;
}

/// Volume of the unit cube's image over the product of its edges: 0 when it is flat, 1 when edges stay
/// orthogonal.
double fullness(const dmat3& m) {
  const double edges = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
  return edges > 0 ? std::abs(glm::determinant(m)) / edges : 0;
}

}  // namespace

mat4 Transform::matrix() const {
  if (given) return *given;
  dmat4 m(1);
  for (int i = 0; i < 3; ++i) m[i][i] = scale[i];
  m = rotation(2, rotate.z) * rotation(1, rotate.y) * rotation(0, rotate.x) * m;
  m[3] = dvec4(dvec3(translate), 1);
  return mat4(m);
}

void check_transform(const mat4& m, const std::string& where) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      if (!(std::abs(m[column][row]) <= kFarthest))
        throw SceneError(fmt::format("{}: found {}, expected numbers in [-{:g}, {:g}]", where, m[column][row],
                                     kFarthest, kFarthest));
  // Below 1e-6 what is left of the flattened direction is rounding error in float.
  if (!(fullness(dmat3(m)) > 1e-6))
    throw SceneError(where +
                     ": found a transform that flattens the object (scale 0, or linearly dependent rows), "
                     "expected one that can be inverted");
}

Transform read_transform(const nlohmann::json& value, const std::string& where) {
  Fields fields(value, where);
  Transform result;
  const nlohmann::json* matrix = fields.find("matrix");
  const nlohmann::json* scale = fields.find("scale");
  const Range places{-kFarthest, kFarthest};
  if (const auto* v = fields.find("translate"))
    result.translate = read_vector(*v, fields.at("translate"), places);
  if (const auto* v = fields.find("rotate")) result.rotate = read_vector(*v, fields.at("rotate"), places);
  if (scale && scale->is_number())
    result.scale = vec3(read_number(*scale, fields.at("scale"), places));
  else if (scale && !scale->is_array())
    fields.fail("scale", "found " + describe(*scale) + ", expected a number or three numbers [x, y, z]");
  else if (scale)
    result.scale = read_vector(*scale, fields.at("scale"), places);
  fields.finish();

  if (matrix) {
    if (value.size() > 1) fields.fail("matrix", "found beside other keys, expected \"matrix\" alone");
    const auto numbers = read_array(*matrix, fields.at("matrix"), "16 numbers, row by row");
    if (numbers.size() != 16)
      fields.fail("matrix", fmt::format("found {} numbers, expected 16, row by row", numbers.size()));
    mat4 m(1);
    for (size_t i = 0; i < 16; ++i)  // the file goes row by row, GLM column by column
      m[static_cast<int>(i % 4)][static_cast<int>(i / 4)] =
          read_number(numbers[i], where_of(fields.at("matrix"), i), places);
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
      fields.fail("matrix", fmt::format("found the last row [{}, {}, {}, {}], expected [0, 0, 0, 1]", m[0][3],
                                        m[1][3], m[2][3], m[3][3]));
    result.given = m;
  }
  check_transform(result.matrix(), where);
  return result;
}

bool mirrors(const mat4& m) {
  return glm::determinant(dmat3(m)) < 0;
}

std::optional<float> uniform_scale(const mat4& m) {
  const dmat3 linear(m);
  const double x = glm::length(linear[0]), y = glm::length(linear[1]), z = glm::length(linear[2]);
  // 1e-5: a rotation written with six digits is still one.
  const bool equal = std::abs(x - y) <= 1e-5 * x && std::abs(x - z) <= 1e-5 * x;
  if (!equal || fullness(linear) < 1 - 1e-5) return std::nullopt;
  return static_cast<float>(std::cbrt(x * y * z));
}

void place(MeshData& mesh, const mat4& m) {
  // Normals are planes, not arrows: they go with the inverse transpose.
  const mat3 normals(glm::transpose(glm::inverse(dmat3(m))));
  for (vec3& p : mesh.positions) p = vec3(m * vec4(p, 1));
  for (vec3& n : mesh.normals)
    if (const vec3 turned = normals * n; glm::dot(turned, turned) > 0) n = glm::normalize(turned);
  if (mirrors(m))
    for (uvec3& t : mesh.triangles) std::swap(t.y, t.z);
}

}  // namespace zonal
