#include "core/texture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/cut_png.h"
#include "core/error.h"
#include "core/image.h"

namespace zonal {

namespace {

/// A byte as the linear value it stands for: the first half is linear, the second sRGB.
struct ByteTable {
  std::array<float, 512> value;
  ByteTable() {
    for (int i = 0; i < 256; ++i) {
      const float x = float(i) / 255;
      value[i] = x;
      // IEC 61966-2-1.
      value[256 + i] = x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
    }
  }
};
const ByteTable kBytes;

/// Larger pictures are a mistake or an attack, not a texture.
constexpr int64_t kMostTexels = int64_t(1) << 28;

/// Wraps into [0, 1); what is no number becomes 0.
float repeat(float x) {
  x -= std::floor(x);
  return x >= 0 && x < 1 ? x : 0.0f;
}

}  // namespace

/// Fills a Texture from an opened picture.
struct TextureReader {
  static Texture read(std::unique_ptr<OIIO::ImageInput> input, const std::string& name,
                      Texture::Encoding encoding);
  /// `name` is for errors, `file` tells the format; read from `memory` unless it is null.
  static Texture open(const std::string& file, const std::string& name, OIIO::Filesystem::IOProxy* memory,
                      Texture::Encoding encoding) {
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;  // the colour beside a cut-away texel is kept, not blackened
    if (memory) config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &memory);
    auto input = OIIO::ImageInput::open(file, &config);
    const std::string error = OIIO::geterror();  // fetched in any case, or OpenImageIO prints it at exit
    if (!input) throw SceneError(fmt::format("{}: cannot be read as a picture: {}", name, one_line(error)));
    return read(std::move(input), name, encoding);
  }
  static std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text.empty() ? "unknown reason" : text;
  }
};

Texture TextureReader::read(std::unique_ptr<OIIO::ImageInput> input, const std::string& name,
                            Texture::Encoding encoding) {
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 ||
      int64_t(spec.width) * spec.height > kMostTexels) {
    throw SceneError(fmt::format("{}: found a picture of {} x {} texels, expected at most 2^28 in all", name,
                                 spec.width, spec.height));
  }
  Texture texture;
  texture.width_ = spec.width, texture.height_ = spec.height;
  const int channels = std::min(spec.nchannels, 4);
  const size_t values = size_t(spec.width) * spec.height * channels;
  const auto read_as = [&](OIIO::TypeDesc type, void* pixels) {
    if (!input->read_image(0, 0, 0, channels, type, pixels)) {
      throw SceneError(fmt::format("{}: cannot be read as a picture: {}", name, one_line(input->geterror())));
    }
  };
  if (spec.format == OIIO::TypeDesc::UINT8) {
    std::vector<uint8_t> pixels(values);
    read_as(OIIO::TypeDesc::UINT8, pixels.data());
    texture.srgb_ = encoding == Texture::Encoding::srgb;
    texture.fill8(pixels, channels);
  } else {
    std::vector<float> pixels(values);
    read_as(OIIO::TypeDesc::FLOAT, pixels.data());
    // Integers of more bits are encoded like bytes are; floating point is linear.
    texture.fill_float(pixels, channels,
                       !spec.format.is_floating_point() && encoding == Texture::Encoding::srgb);
  }
  texture.find_alpha();
  return texture;
}

Texture Texture::load(const std::string& file, Encoding encoding) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) throw SceneError(file + ": no such picture file");
  std::ifstream in(file, std::ios::binary);
  refuse_cut_png(in, file);
  return TextureReader::open(file, file, nullptr, encoding);
}

Texture Texture::decode(std::span<const std::byte> bytes, const std::string& name, Encoding encoding) {
  const auto starts = [&](std::initializer_list<int> magic) {
    return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin(),
                                                      [](int m, std::byte b) { return m == int(b); });
  };
  // OpenImageIO picks the reader by the file's name; the name of an embedded picture says nothing.
  const char* pretended = starts({0x89, 'P', 'N', 'G'}) ? "embedded.png" : "embedded.jpg";
  if (!starts({0x89, 'P', 'N', 'G'}) && !starts({0xff, 0xd8})) {
    throw SceneError(name + ": the embedded picture is neither PNG nor JPEG");
  }
  std::istringstream in(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  refuse_cut_png(in, name);
  OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
  return TextureReader::open(pretended, name, &memory, encoding);
}

Texture::Texture(int width, int height, std::vector<vec4> texels)
    : width_(width), height_(height), rgba32f_(texels.begin(), texels.end()) {
  assert(width > 0 && height > 0 && rgba32f_.size() == size_t(width) * height);
  find_alpha();
}

void Texture::fill8(std::span<const uint8_t> pixels, int channels) {
  const bool grey = channels < 3, alpha = channels == 2 || channels == 4;
  squares_ = size_t(width_ + 3) / 4;
  // What pads the last squares is never looked up; opaque, so that it does not count as alpha either.
  rgba8_.assign(squares_ * (size_t(height_ + 3) / 4) * 16, 0xffffffffu);
  const uint8_t* p = pixels.data();
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x, p += channels) {
      const uint32_t r = p[0], g = grey ? r : p[1], b = grey ? r : p[2];
      const uint32_t a = alpha ? p[channels - 1] : 255;
      rgba8_[place(x, y)] = r | g << 8 | b << 16 | a << 24;
    }
  }
}

void Texture::fill_float(std::span<const float> p, int channels, bool decode_srgb) {
  const bool grey = channels < 3, alpha = channels == 2 || channels == 4;
  rgba32f_.resize(p.size() / channels);
  for (size_t i = 0, k = 0; i < rgba32f_.size(); ++i, k += channels) {
    vec4 t(p[k], grey ? p[k] : p[k + 1], grey ? p[k] : p[k + 2], alpha ? p[k + channels - 1] : 1.0f);
    for (int c = 0; decode_srgb && c < 3; ++c) t[c] = srgb_decode(t[c]);
    rgba32f_[i] = t;
  }
}

void Texture::find_alpha() {
  has_alpha_ = std::any_of(rgba8_.begin(), rgba8_.end(), [](uint32_t t) { return t < 0xff000000u; }) ||
               std::any_of(rgba32f_.begin(), rgba32f_.end(), [](const vec4& t) { return t.w < 1; });
}

vec4 Texture::texel(int x, int y) const {
  if (rgba8_.empty()) return rgba32f_[size_t(y) * width_ + x];
  const uint32_t t = rgba8_[place(x, y)];
  const float* rgb = kBytes.value.data() + (srgb_ ? 256 : 0);
  return {rgb[t & 255], rgb[(t >> 8) & 255], rgb[(t >> 16) & 255], kBytes.value[t >> 24]};
}

vec4 Texture::sample(vec2 uv) const {
  // Texel centres lie at half steps; v points up, rows go down.
  const float x = repeat(uv.x) * width_ - 0.5f, y = (1 - repeat(uv.y)) * height_ - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const float fx = x - left, fy = y - top;
  int x0 = int(left), y0 = int(top);
  // x is in [-1/2, width - 1/2), so one step of wrapping is enough.
  if (x0 < 0) x0 = width_ - 1;
  if (y0 < 0) y0 = height_ - 1;
  const int x1 = x0 + 1 < width_ ? x0 + 1 : 0, y1 = y0 + 1 < height_ ? y0 + 1 : 0;
  const vec4 upper = (1 - fx) * texel(x0, y0) + fx * texel(x1, y0);
  const vec4 lower = (1 - fx) * texel(x0, y1) + fx * texel(x1, y1);
  return (1 - fy) * upper + fy * lower;
}

void Texture::prefetch(vec2 uv) const {
  const int x = std::min(int(repeat(uv.x) * width_), width_ - 1);
  const int y = std::min(int((1 - repeat(uv.y)) * height_), height_ - 1);
  __builtin_prefetch(rgba8_.empty() ? static_cast<const void*>(&rgba32f_[size_t(y) * width_ + x])
                                    : static_cast<const void*>(&rgba8_[place(x, y)]));
}

float Texture::alpha(vec2 uv) const {
  const int x = std::min(int(repeat(uv.x) * width_), width_ - 1);
  const int y = std::min(int((1 - repeat(uv.y)) * height_), height_ - 1);
  return rgba8_.empty() ? rgba32f_[size_t(y) * width_ + x].w : kBytes.value[rgba8_[place(x, y)] >> 24];
}

size_t Texture::bytes() const {
  return rgba8_.size() * sizeof(uint32_t) + rgba32f_.size() * sizeof(vec4);
}

vec4 Texture::mean() const {
  glm::dvec4 sum(0);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) sum += glm::dvec4(texel(x, y));
  }
  return vec4(sum / (double(width_) * height_));
}

}  // namespace zonal
