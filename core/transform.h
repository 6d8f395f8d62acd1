#pragma once
/// An object's place in the world as the scene file says it: scale, then rotate about x, y and z, then
/// translate; or any affine matrix.
///
///     Transform t = read_transform(json, "box.json: /objects/0/transform");
///     place(mesh, t.matrix());

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/scene.h"

namespace zonal {

struct Transform {
  vec3 translate{0};  ///< metres
  vec3 rotate{0};     ///< degrees about the world's x, then y, then z
  vec3 scale{1};
  std::optional<mat4> given;  ///< "matrix": replaces the three

  mat4 matrix() const;
};

/// Throws SceneError; the result is affine and can be inverted.
Transform read_transform(const nlohmann::json& value, const std::string& where);
/// Throws SceneError when the matrix flattens space or leaves the range of float.
void check_transform(const mat4& m, const std::string& where);

/// Whether left and right are exchanged: then windings must be turned around to keep their outside.
bool mirrors(const mat4& m);
/// The factor of a transform that keeps spheres spheres; nothing when it makes ellipsoids of them.
std::optional<float> uniform_scale(const mat4& m);
/// Moves the mesh; its outside stays outside under a mirror.
void place(MeshData& mesh, const mat4& m);

}  // namespace zonal
