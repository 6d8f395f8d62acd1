#pragma once
/// Assimp's vectors and matrices as ours.

#include <assimp/types.h>

#include "core/vec.h"

namespace zonal {

/// Assimp's matrices are row-major, GLM's column-major.
inline mat4 to_mat4(const aiMatrix4x4& m) {
  return mat4(m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4);
}
inline vec3 to_vec3(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

}  // namespace zonal
