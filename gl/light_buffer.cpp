#include "gl/light_buffer.h"

#include <algorithm>

namespace zonal::gl {

LightBuffer::LightBuffer(const std::vector<vec4>& texels, int stride, size_t most_texels) {
  const size_t limit = most_texels > 0 ? most_texels : TextureBuffer::limit();
  const int most = static_cast<int>(std::max<size_t>(limit / stride, 1));
  const int lights = static_cast<int>(texels.size()) / stride;
  for (int first = 0; first < lights; first += most) {
    const int count = std::min(most, lights - first);
    const std::span<const vec4> part(&texels[size_t(first) * stride], size_t(count) * stride);
    chunks_.push_back({first, count, TextureBuffer(part)});
  }
}

namespace {

std::vector<vec4> pack(const LightArrays& lights, Lobes lobes, CoatTables& coats) {
  constexpr int kTexels = LightBuffer::kTexels;
  std::vector<vec4> texels(static_cast<size_t>(lights.count) * kTexels);
  for (int j = 0; j < lights.count; ++j) {
    vec4* t = &texels[static_cast<size_t>(j) * kTexels];
    const Frame frame = lights.frame(j);
    t[0] = vec4(lights.position(j), lights.radius[j]);
    t[1] = vec4(lights.normal(j), is_constant(lights.bsdf[j], lobes) ? 1.0f : 0.0f);
    t[2] = vec4(lights.power(j), 0.0f);
    t[3] = vec4(frame.x, 0.0f), t[4] = vec4(frame.y, 0.0f), t[5] = vec4(frame.z, 0.0f);
    pack_brdf(lights.bsdf[j], lights.view[j], lobes, coats, t + 6);
  }
  return texels;
}

}  // namespace

LightBuffer::LightBuffer(const LightArrays& lights, Lobes lobes, CoatTables& coats, size_t most_texels)
    : LightBuffer(pack(lights, lobes, coats), kTexels, most_texels) {}

}  // namespace zonal::gl
