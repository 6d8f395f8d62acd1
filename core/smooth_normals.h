#pragma once
/// Vertex normals for meshes that come without: smooth where faces meet gently, sharp where they meet at an
/// angle.

#include "core/scene.h"

namespace zonal {

/// Gives every triangle corners of its own, whose normals average the triangles around the vertex that turn
/// away by less than 60 degrees, weighted by their angle there (Thuermer and Wuethrich 1998). Vertices at the
/// same place count as one. Indices must be in range.
void make_smooth_normals(MeshData& mesh);

}  // namespace zonal
