#include "gl/objects.h"

#include <epoxy/gl.h>

#include <utility>

namespace zonal::gl {

Buffer::Buffer(std::span<const std::byte> bytes) : bytes_(bytes.size()) {
  glCreateBuffers(1, &id_);
  // A buffer of no bytes is an error; one that nothing reads is not.
  const std::byte nothing[16] = {};
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(bytes.empty() ? sizeof nothing : bytes.size()),
                       bytes.empty() ? nothing : bytes.data(), 0);
}
Buffer::Buffer(size_t bytes) : bytes_(bytes) {
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(bytes), nullptr, 0);
}
Buffer::~Buffer() {
  if (id_) glDeleteBuffers(1, &id_);
}
Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(id_, other.id_), std::swap(bytes_, other.bytes_);
  return *this;
}
void Buffer::bind_storage(unsigned binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}
void Buffer::read(std::span<std::byte> out) const {
  glGetNamedBufferSubData(id_, 0, static_cast<GLsizeiptr>(out.size()), out.data());
}

TextureBuffer::TextureBuffer(Buffer buffer, unsigned format) : buffer_(std::move(buffer)) {
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &id_);
  glTextureBuffer(id_, format, buffer_.id());
}
TextureBuffer::TextureBuffer(std::span<const vec4> texels) : TextureBuffer(Buffer(texels), GL_RGBA32F) {}
TextureBuffer::TextureBuffer(std::span<const uint32_t> words) : TextureBuffer(Buffer(words), GL_R32UI) {}
TextureBuffer::TextureBuffer(size_t texels) : TextureBuffer(Buffer(texels * sizeof(vec4)), GL_RGBA32F) {}
TextureBuffer::~TextureBuffer() {
  if (id_) glDeleteTextures(1, &id_);
}
TextureBuffer& TextureBuffer::operator=(TextureBuffer&& other) noexcept {
  std::swap(buffer_, other.buffer_), std::swap(id_, other.id_);
  return *this;
}
void TextureBuffer::clear() const {
  const float nothing = 0;
  glClearNamedBufferData(buffer_.id(), GL_R32F, GL_RED, GL_FLOAT, &nothing);
}
void TextureBuffer::bind(unsigned unit) const {
  glBindTextureUnit(unit, id_);
}
size_t TextureBuffer::limit() {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  return static_cast<size_t>(most);
}

Texture2D::Texture2D(unsigned format, int width, int height, int layers)
    : format_(format), width_(width), height_(height), layers_(layers) {
  if (layers == 0) {
    glCreateTextures(GL_TEXTURE_2D, 1, &id_);
    glTextureStorage2D(id_, 1, format, width, height);
  } else {
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id_);
    glTextureStorage3D(id_, 1, format, width, height, layers);
  }
  glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}
Texture2D::~Texture2D() {
  if (id_) glDeleteTextures(1, &id_);
}
Texture2D& Texture2D::operator=(Texture2D&& other) noexcept {
  std::swap(id_, other.id_), std::swap(format_, other.format_), std::swap(width_, other.width_);
  std::swap(height_, other.height_), std::swap(layers_, other.layers_);
  return *this;
}
void Texture2D::bind(unsigned unit) const {
  glBindTextureUnit(unit, id_);
}
void Texture2D::bind_image(unsigned unit) const {
  glBindImageTexture(unit, id_, 0, layers_ > 0 ? GL_TRUE : GL_FALSE, 0, GL_READ_WRITE, format_);
}
std::vector<vec4> Texture2D::read_rgba(int layer) const {
  std::vector<vec4> texels(static_cast<size_t>(width_) * height_);
  glGetTextureSubImage(id_, 0, 0, 0, layer, width_, height_, 1, GL_RGBA, GL_FLOAT,
                       static_cast<GLsizei>(texels.size() * sizeof(vec4)), texels.data());
  return texels;
}

}  // namespace zonal::gl
