#pragma once
/// Draws all of a scene's triangles, cut-away parts left out, as seen through a matrix: for the camera's view
/// and for shadow maps. Depth is largest nearest.

#include "gl/scene_buffers.h"

namespace zonal::gl {

class TrianglePass {
 public:
  explicit TrianglePass(const ShaderText& text);
  ~TrianglePass();
  TrianglePass(const TrianglePass&) = delete;
  TrianglePass& operator=(const TrianglePass&) = delete;
  /// Clears the framebuffer's depth, and its one colour to 0, then draws; where there is a colour it receives
  /// each triangle's number and one.
  void draw(const SceneBuffers& scene, unsigned framebuffer, int width, int height, const mat4& to_clip);

 private:
  Program program_;
  unsigned vertex_array_ = 0;
};

}  // namespace zonal::gl
