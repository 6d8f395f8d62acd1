#pragma once
/// Buffers and textures that are freed with their owner. All of them need a current context, also at their
/// end.
///
///     Buffer words(std::span(bytes));                // filled once
///     words.bind_storage(0);
///     TextureBuffer lights(std::span(rows));          // the same read as texels: faster in inner loops

#include <cstddef>
#include <span>
#include <vector>

#include "core/vec.h"

namespace zonal::gl {

class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::span<const std::byte> bytes);
  template <class T>
  explicit Buffer(std::span<T> values) : Buffer(std::as_bytes(values)) {}
  /// Uninitialised.
  explicit Buffer(size_t bytes);
  ~Buffer();
  Buffer(Buffer&& other) noexcept { *this = std::move(other); }
  Buffer& operator=(Buffer&& other) noexcept;

  void bind_storage(unsigned binding) const;
  void read(std::span<std::byte> out) const;
  size_t bytes() const { return bytes_; }
  unsigned id() const { return id_; }

 private:
  unsigned id_ = 0;
  size_t bytes_ = 0;
};

/// A buffer read through a sampler: `samplerBuffer` of four floats a texel or `usamplerBuffer` of one word.
class TextureBuffer {
 public:
  TextureBuffer() = default;
  explicit TextureBuffer(std::span<const vec4> texels);
  explicit TextureBuffer(std::span<const uint32_t> words);
  /// Of four floats each, uninitialised, for shaders to write.
  explicit TextureBuffer(size_t texels);
  ~TextureBuffer();
  TextureBuffer(TextureBuffer&& other) noexcept { *this = std::move(other); }
  TextureBuffer& operator=(TextureBuffer&& other) noexcept;
  void bind(unsigned unit) const;
  void bind_storage(unsigned binding) const { buffer_.bind_storage(binding); }
  void clear() const;  ///< to zero
  size_t bytes() const { return buffer_.bytes(); }
  /// The most texels a texture buffer may have here.
  static size_t limit();

 private:
  TextureBuffer(Buffer buffer, unsigned format);
  Buffer buffer_;
  unsigned id_ = 0;
};

/// A picture or a stack of pictures, without mip levels.
class Texture2D {
 public:
  Texture2D() = default;
  /// `format`: a sized internal format such as GL_RGBA32F; layers == 0: no array.
  Texture2D(unsigned format, int width, int height, int layers = 0);
  ~Texture2D();
  Texture2D(Texture2D&& other) noexcept { *this = std::move(other); }
  Texture2D& operator=(Texture2D&& other) noexcept;

  void bind(unsigned unit) const;                    ///< to sample
  void bind_image(unsigned unit) const;              ///< to load and store, all layers
  std::vector<vec4> read_rgba(int layer = 0) const;  ///< row by row from the top, as shaders number them
  unsigned id() const { return id_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  unsigned id_ = 0, format_ = 0;
  int width_ = 0, height_ = 0, layers_ = 0;
};

}  // namespace zonal::gl
