#include "core/flat_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/error.h"

namespace zonal {

using glm::dvec2;
using glm::dvec3;

MeshData disk_mesh(vec3 center, vec3 normal, float radius) {
  const double step = 2 * M_PI / kDiskSides;
  // A regular polygon of circumradius R has the area n/2 R^2 sin(2 pi/n).
  const double reach = radius * std::sqrt(step / std::sin(step));
  const Frame frame(normal);
  MeshData mesh;
  mesh.positions.push_back(center);
  for (uint32_t i = 0; i < kDiskSides; ++i) {
    const dvec3 out =
        dvec3(frame.x) * std::cos(step * (i + 0.5)) + dvec3(frame.y) * std::sin(step * (i + 0.5));
    mesh.positions.push_back(vec3(dvec3(center) + reach * out));
    mesh.triangles.push_back({0, i + 1, (i + 1) % kDiskSides + 1});
  }
  return mesh;
}

namespace {

constexpr double kOffPlane = 1e-4;  ///< of the polygon's size

/// The normal of the largest triangle at the first corner: there is one even where a polygon that crosses
/// itself has no area in all.
dvec3 plane_of(std::span<const vec3> corners) {
  dvec3 best(0);
  for (size_t i = 1; i < corners.size(); ++i)
    for (size_t k = i + 1; k < corners.size(); ++k) {
      const dvec3 n =
          glm::cross(dvec3(corners[i]) - dvec3(corners[0]), dvec3(corners[k]) - dvec3(corners[0]));
      if (glm::dot(n, n) > glm::dot(best, best)) best = n;
    }
  return best;
}

/// Twice the signed area of a triangle; > 0: counter-clockwise.
double turn(dvec2 a, dvec2 b, dvec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether c, known to be in line with a and b, lies between them, ends included.
bool between(dvec2 a, dvec2 b, dvec2 c) {
  return glm::dot(c - a, c - b) <= 0;
}

bool meet(dvec2 a, dvec2 b, dvec2 c, dvec2 d) {
  const double abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
  if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) && ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0)))
    return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
         (cdb == 0 && between(c, d, b));
}

void refuse_crossings(const std::vector<dvec2>& p) {
  const size_t n = p.size();
  for (size_t i = 0; i < n; ++i) {
    const size_t j = (i + 1) % n, k = (i + 2) % n;
    // Neighbours share a corner: they meet elsewhere only where the second runs back over the first.
    if (turn(p[i], p[j], p[k]) == 0 && glm::dot(p[i] - p[j], p[k] - p[j]) > 0)
      throw SceneError(
          fmt::format("found the edge after corner {} running back over the one before, expected edges "
                      "that meet at their ends alone",
                      j));
    for (size_t m = i + 2; m < n; ++m)
      if ((m + 1) % n != i && meet(p[i], p[j], p[m], p[(m + 1) % n]))
        throw SceneError(
            fmt::format("found the edges after corners {} and {} meeting, expected a polygon that does "
                        "not cross or touch itself",
                        i, m));
  }
}

/// Ear clipping (Meisters 1975) of a counter-clockwise polygon.
std::vector<uvec3> cut_in_triangles(const std::vector<dvec2>& p) {
  std::vector<uint32_t> left(p.size());
  std::iota(left.begin(), left.end(), 0u);
  std::vector<uvec3> triangles;
  while (left.size() > 3) {
    const size_t n = left.size();
    const auto is_ear = [&](size_t i) {
      const dvec2 a = p[left[(i + n - 1) % n]], b = p[left[i]], c = p[left[(i + 1) % n]];
      if (!(turn(a, b, c) > 0)) return false;
      for (size_t k = 2; k + 1 < n; ++k) {
        const dvec2 q = p[left[(i + k) % n]];
        if (turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0) return false;
      }
      return true;
    };
    size_t ear = 0;
    while (ear < n && !is_ear(ear)) ++ear;
    // A simple polygon always has two; rounding may hide them where it nearly touches itself.
    if (ear == n)
      throw SceneError("found edges that nearly touch, expected a polygon that keeps clear of itself");
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + std::ptrdiff_t(ear));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace

MeshData polygon_mesh(std::span<const vec3> corners) {
  vec3 low = corners[0], high = corners[0];
  for (const vec3 p : corners) low = glm::min(low, p), high = glm::max(high, p);
  const double size = glm::length(dvec3(high) - dvec3(low));
  for (size_t i = 0; i < corners.size(); ++i)
    if (corners[i] == corners[(i + 1) % corners.size()])
      throw SceneError(fmt::format("found corner {} where corner {} is, expected another place",
                                   (i + 1) % corners.size(), i));
  const dvec3 area = plane_of(corners);
  const double length = glm::length(area);
  if (!(length > 1e-12 * size * size))
    throw SceneError("found corners in one line, expected a polygon with an area");
  const dvec3 normal = area / length;
  // What floats far from the origin can say.
  const float farthest = std::max(max_component(glm::abs(low)), max_component(glm::abs(high)));
  const double allowed = kOffPlane * size + 4e-7 * farthest;
  for (size_t i = 0; i < corners.size(); ++i)
    if (const double off = std::abs(glm::dot(dvec3(corners[i]) - dvec3(corners[0]), normal)); off > allowed)
      throw SceneError(fmt::format(
          "found corner {} {:.3g} m off the plane of the others, expected a flat polygon", i, off));

  // Seen along the axis nearest to the normal, so that coordinates stay as they were given.
  const dvec3 n = glm::abs(normal);
  const int drop = n.x > n.y && n.x > n.z ? 0 : n.y > n.z ? 1 : 2;
  std::vector<dvec2> flat;
  for (const vec3 p : corners) flat.emplace_back(p[(drop + 1) % 3], p[(drop + 2) % 3]);
  refuse_crossings(flat);
  double twice_area = 0;
  for (size_t i = 0; i < flat.size(); ++i) twice_area += turn(flat[0], flat[i], flat[(i + 1) % flat.size()]);
  if (twice_area < 0)
    for (dvec2& p : flat) p.x = -p.x;
  MeshData mesh;
  mesh.positions.assign(corners.begin(), corners.end());
  mesh.triangles = cut_in_triangles(flat);
  return mesh;
}

}  // namespace zonal
