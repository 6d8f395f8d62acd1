#include "core/basic_shapes.h"

namespace zonal {
namespace {

void add_quad(MeshData& mesh, vec3 corner, vec3 u, vec3 v) {
  const uint32_t first = static_cast<uint32_t>(mesh.positions.size());
  for (const vec2 uv : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) {
    mesh.positions.push_back(corner + u * uv.x + v * uv.y);
    mesh.uvs.push_back(uv);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

}  // namespace

MeshData quad_mesh(vec3 corner, vec3 u, vec3 v) {
  MeshData mesh;
  add_quad(mesh, corner, u, v);
  return mesh;
}

MeshData box_mesh(vec3 low, vec3 high) {
  const vec3 size = high - low;
  const vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  MeshData mesh;
  // Seen from outside, the sides have v up; top and bottom have u along +x. u x v points outwards.
  add_quad(mesh, low + x + z, -z, y);  // +x
  add_quad(mesh, low, z, y);           // -x
  add_quad(mesh, low + y + z, x, -z);  // +y
  add_quad(mesh, low, x, z);           // -y
  add_quad(mesh, low + z, x, y);       // +z
  add_quad(mesh, low + x, -x, y);      // -z
  return mesh;
}

MeshData triangle_mesh(vec3 a, vec3 b, vec3 c) {
  MeshData mesh;
  mesh.positions = {a, b, c};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

double surface_area(const MeshData& mesh) {
  double area = 0;
  for (const uvec3 t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area;
}

}  // namespace zonal
