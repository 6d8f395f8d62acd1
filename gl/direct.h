#pragma once
/// Direct light of point, spot and directional lights with shadow maps, one light after the other so that one
/// set of maps serves them all. Triangles are in the maps; spheres block by their equation.
///
///     DirectLight direct(text, scene);          // throws SceneError naming a light it cannot show
///     direct.add(buffers, points, sum);

#include "gl/gbuffer.h"

namespace zonal::gl {

class DirectLight {
 public:
  static constexpr int kMapSize = 1024;  ///< texels, each side of each face

  DirectLight(const ShaderText& text, const Scene& scene);
  ~DirectLight();
  DirectLight(const DirectLight&) = delete;
  DirectLight& operator=(const DirectLight&) = delete;
  /// Adds each point's reflection (W m^-2 sr^-1) of every light to `sum`.
  void add(const SceneBuffers& buffers, const GBuffer& points, const Texture2D& sum);

 private:
  const Scene& scene_;
  TrianglePass triangles_;
  Program shade_;
  Texture2D maps_;
  unsigned framebuffers_[6] = {}, sampler_ = 0;
};

}  // namespace zonal::gl
