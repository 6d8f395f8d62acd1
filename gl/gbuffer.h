#pragma once
/// What a camera sees of a scene, pixel by pixel, on the GPU: the points that methods shade.
///
///     GBuffer points(text, width, height);
///     points.draw(buffers, camera, vec2(0.5f));
///     points.bind();                            // for shaders that include gl/point.glsl

#include "core/scene.h"
#include "gl/triangles.h"

namespace zonal::gl {

class GBuffer {
 public:
  GBuffer(const ShaderText& text, int width, int height);
  ~GBuffer();
  GBuffer(const GBuffer&) = delete;
  GBuffer& operator=(const GBuffer&) = delete;

  /// `inside`: where in each pixel its ray goes, [0, 1)^2.
  void draw(const SceneBuffers& scene, const Camera& camera, vec2 inside, float scene_radius);
  void bind() const;
  int width() const { return points_.width(); }
  int height() const { return points_.height(); }

  /// One pixel as the CPU knows it.
  struct Pixel {
    vec3 emitted{0}, albedo{0}, normal{0};
    float depth = 0;  ///< 0: the sky
    uint32_t shape = kNone, primitive = kNone;
  };
  /// Row by row from the top.
  std::vector<Pixel> read() const;

 private:
  TrianglePass triangles_;
  Program resolve_;
  Texture2D seen_, depth_, points_;
  unsigned framebuffer_ = 0;
};

}  // namespace zonal::gl
