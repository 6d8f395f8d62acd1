#pragma once
/// A picture looked up by texture coordinates: bilinear, repeating, decoded to linear values.
///
///     Texture albedo = Texture::load("wood.png", Texture::Encoding::srgb);   // colours
///     Texture bumps  = Texture::load("wood_n.png", Texture::Encoding::linear); // normals, roughness, masks

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/huge_pages.h"
#include "core/vec.h"

namespace zonal {

class Texture {
 public:
  enum class Encoding { srgb, linear };

  /// Reads any format OpenImageIO knows. Throws SceneError naming the file and what is wrong with it. Grey files fill
  /// r, g and b; a file without alpha has alpha 1. HDR files are linear whatever `encoding` says.
  static Texture load(const std::string& file, Encoding encoding);
  /// The same from a picture file already in memory (embedded in a GLB, say); `name` is for errors.
  static Texture decode(std::span<const std::byte> bytes, const std::string& name, Encoding encoding);
  /// One-texel or hand-made texture, row-major from the top, linear.
  Texture(int width, int height, std::vector<vec4> texels);

  /// u right, v UP (OBJ's and Blender's convention; importers flip where a format says otherwise).
  vec4 sample(vec2 uv) const;
  vec3 rgb(vec2 uv) const { return vec3(sample(uv)); }
  /// Asks the cache for what `sample(uv)` will read: a picture is far larger than any cache.
  void prefetch(vec2 uv) const;
  /// Nearest alpha, for masks: cheap and without blending across the edge.
  float alpha(vec2 uv) const;
  bool has_alpha() const { return has_alpha_; }  ///< some texel's alpha is below 1
  int width() const { return width_; }
  int height() const { return height_; }
  size_t bytes() const;
  /// Average of the decoded texels.
  vec4 mean() const;

 private:
  Texture() = default;
  vec4 texel(int x, int y) const;
  /// Where rgba8_ keeps a texel: a square is one cache line, so that four neighbours touch 1.6 lines rather than 2.1.
  size_t place(int x, int y) const { return (size_t(y >> 2) * squares_ + (x >> 2)) * 16 + (y & 3) * 4 + (x & 3); }
  void fill8(std::span<const uint8_t> pixels, int channels);
  void fill_float(std::span<const float> pixels, int channels, bool decode_srgb);
  void find_alpha();
  friend struct TextureReader;
  int width_ = 0, height_ = 0;
  bool has_alpha_ = false, srgb_ = false;
  std::vector<uint32_t, HugePages<uint32_t>> rgba8_;  ///< 8-bit files stay 8-bit, in squares of 4 x 4; decoded by table
  size_t squares_ = 0;           ///< in a row of squares
  std::vector<vec4, HugePages<vec4>> rgba32f_;    ///< everything else
};

}  // namespace zonal
