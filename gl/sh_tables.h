#pragma once
/// A scene's materials on spherical harmonics as gl/sh_tables.glsl reads them: the .shmat files'
/// words, as they lie.

#include "gl/objects.h"
#include "materials/sh_materials.h"

namespace zonal::gl {

/// The tables of zonal lobes as gl/zonal_lobes.glsl reads them.
TextureBuffer zonal_lobe_texels();

class ShTables {
 public:
  ShTables() = default;
  /// Of materials 0 to `count` - 1.
  ShTables(const ShMaterials& materials, uint32_t count);
  void bind(unsigned words, unsigned records) const { words_.bind(words), records_.bind(records); }

 private:
  TextureBuffer words_, records_;
};

}  // namespace zonal::gl
