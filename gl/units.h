#pragma once
/// Which texture unit holds what, for host code: the shaders name the same numbers in their layouts.

namespace zonal::gl::units {

// gl/scene.glsl
inline constexpr unsigned kVertices = 0, kTriangles = 1, kShapes = 2, kSpheres = 3, kMaterials = 4,
                          kTexels = 5, kTextures = 6;
inline constexpr unsigned kCoats = 7;       // gl/coats.glsl
inline constexpr unsigned kVisibility = 8;  // gl/points.comp
inline constexpr unsigned kPoints = 9;      // gl/point.glsl
inline constexpr unsigned kLights = 10;     // gl/lights.glsl
inline constexpr unsigned kMethod = 11;     // from here on a method's own

}  // namespace zonal::gl::units
