#pragma once
/// Flat lights of the scene file that are not a triangle or a parallelogram, as meshes: flat normals, no
/// texture coordinates.
///
///     shape.mesh = polygon_mesh(corners);      // throws SceneError: "found corner 3 0.1 m off the plane
///     ..."

#include <span>

#include "core/scene.h"

namespace zonal {

/// Sides of the regular polygon that stands for a disk. Its area is the disk's; its edges run from 0.08 % of
/// the radius inside the circle to 0.04 % outside of it.
inline constexpr int kDiskSides = 64;

/// Metres; `normal` unit: the front shows along it.
MeshData disk_mesh(vec3 center, vec3 normal, float radius);

/// A flat polygon that does not meet itself, counter-clockwise seen from the front, cut in corners.size() - 2
/// triangles. Throws SceneError, without a place, where a corner lies further off the plane of the others
/// than 1e-4 of the polygon's size, two corners coincide, edges meet elsewhere than at their ends, or there
/// is no area.
MeshData polygon_mesh(std::span<const vec3> corners);

}  // namespace zonal
