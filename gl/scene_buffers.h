#pragma once
/// A scene's copy on the GPU: geometry, materials, textures, as gl/scene.glsl reads them.
///
///     SceneBuffers buffers(scene);       // throws SceneError naming what the GPU side cannot show
///     buffers.bind();

#include "core/scene.h"
#include "gl/objects.h"
#include "gl/pack_brdf.h"
#include "gl/program.h"

namespace zonal::gl {

class SceneBuffers {
 public:
  explicit SceneBuffers(const Scene& scene);
  /// To the units gl/scene.glsl names.
  void bind() const;
  int triangles() const { return triangle_count_; }
  int spheres() const { return sphere_count_; }
  /// Grows while lights are packed: bind again afterwards.
  CoatTables& coats() { return coats_; }
  void upload_coats();

 private:
  struct Staging;
  void add_geometry(const Scene&, Staging&);
  void add_material(const Material&, Staging&);

  int triangle_count_ = 0, sphere_count_ = 0;
  CoatTables coats_;
  size_t uploaded_coats_ = 0;
  TextureBuffer vertices_, triangles_, shapes_, spheres_, materials_, texels_, textures_, coat_texels_;
};

}  // namespace zonal::gl
