#include "core/smooth_normals.h"

#include <bit>
#include <unordered_map>

#include "core/sampling.h"

namespace zonal {

namespace {

constexpr float kCreaseCosine = 0.5f;  ///< cos 60 degrees
/// A vertex with more triangles than this (the tip of a fan) averages the first ones only: the work is their
/// square.
constexpr size_t kMostNeighbours = 256;

struct HashPosition {
  size_t operator()(vec3 p) const {
    // + 0 so that -0 and 0, which are equal, hash alike.
    const auto bits = [](float x) { return std::bit_cast<uint32_t>(x + 0.0f); };
    return hash32(bits(p.x), bits(p.y), bits(p.z));
  }
};

float angle_between(vec3 a, vec3 b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

void make_smooth_normals(MeshData& mesh) {
  const size_t corners = 3 * mesh.triangles.size();
  std::vector<vec3> face_normals(mesh.triangles.size());
  std::vector<vec3> weighted(corners);  // face normal times the corner's angle
  std::unordered_map<vec3, std::vector<uint32_t>, HashPosition> around;
  around.reserve(mesh.positions.size());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const uvec3 t = mesh.triangles[i];
    const vec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    const glm::dvec3 cross =
        glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
    const double length = glm::length(cross);
    face_normals[i] = length > 0 ? vec3(cross / length) : vec3(0);
    for (int k = 0; k < 3; ++k) {
      weighted[3 * i + k] = face_normals[i] * angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
      around[p[k]].push_back(uint32_t(3 * i + k));
    }
  }
  MeshData out;
  out.name = std::move(mesh.name);
  out.positions.resize(corners), out.normals.resize(corners), out.triangles.resize(mesh.triangles.size());
  if (!mesh.uvs.empty()) out.uvs.resize(corners);
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    out.triangles[i] = {3 * i, 3 * i + 1, 3 * i + 2};
    for (int k = 0; k < 3; ++k) {
      const uint32_t vertex = mesh.triangles[i][k], corner = 3 * i + k;
      const std::vector<uint32_t>& neighbours = around[mesh.positions[vertex]];
      vec3 sum(0);
      for (size_t n = 0; n < std::min(neighbours.size(), kMostNeighbours); ++n) {
        if (glm::dot(face_normals[neighbours[n] / 3], face_normals[i]) > kCreaseCosine)
          sum += weighted[neighbours[n]];
      }
      const float length = glm::length(sum);
      out.positions[corner] = mesh.positions[vertex];
      out.normals[corner] = length > 0 ? sum / length : face_normals[i];
      if (!mesh.uvs.empty()) out.uvs[corner] = mesh.uvs[vertex];
    }
  }
  mesh = std::move(out);
}

}  // namespace zonal
