#pragma once
/// Virtual lights on the GPU, as gl/lights.glsl reads them. More than one buffer holds are kept in chunks,
/// which a gather goes through one after the other.

#include "gl/objects.h"
#include "gl/pack_brdf.h"
#include "integrators/light_arrays.h"

namespace zonal::gl {

class LightBuffer {
 public:
  static constexpr int kTexels = 12;  ///< a light
  struct Chunk {
    int first = 0, count = 0;
    TextureBuffer texels;
  };

  LightBuffer() = default;
  /// `lobes`: which part of its surface's BRDF a light reflects by. `most_texels`: of one chunk; 0: what the
  /// driver takes.
  LightBuffer(const LightArrays& lights, Lobes lobes, CoatTables& coats, size_t most_texels = 0);
  /// Lights of another form: `stride` texels each.
  LightBuffer(const std::vector<vec4>& texels, int stride, size_t most_texels = 0);
  const std::vector<Chunk>& chunks() const { return chunks_; }

 private:
  std::vector<Chunk> chunks_;
};

}  // namespace zonal::gl
