#pragma once
/// Quads, boxes and triangles of the scene file as meshes: flat normals, counter-clockwise seen from outside,
/// texture coordinates from 0 to 1 over each face.

#include "core/scene.h"

namespace zonal {

/// corner, corner + u, corner + u + v, corner + v; the front shows along u x v.
MeshData quad_mesh(vec3 corner, vec3 u, vec3 v);
/// Twelve triangles facing outwards; every face has its own four vertices and texture coordinates.
MeshData box_mesh(vec3 low, vec3 high);
MeshData triangle_mesh(vec3 a, vec3 b, vec3 c);
/// Square metres.
double surface_area(const MeshData& mesh);

}  // namespace zonal
