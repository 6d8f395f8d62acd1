#pragma once
/// Pictures on disk: EXR with named layers and PNG, metadata beside the pixels, never half a file.

#include <map>
#include <string>
#include <vector>

#include "core/vec.h"

namespace zonal {

/// Row-major from the top left, `channels` floats a pixel.
struct Image {
  int width = 0, height = 0, channels = 3;
  std::vector<float> pixels;

  Image() = default;
  Image(int w, int h, int c = 3) : width(w), height(h), channels(c), pixels(size_t(w) * h * c, 0.0f) {}
  float* at(int x, int y) { return &pixels[(size_t(y) * width + x) * channels]; }
  const float* at(int x, int y) const { return &pixels[(size_t(y) * width + x) * channels]; }
  vec3 rgb(int x, int y) const {
    const float* p = at(x, y);
    return channels < 3 ? vec3(p[0]) : vec3(p[0], p[1], p[2]);
  }
};

/// A picture with layers: "" is the radiance (channels R, G, B); others are "albedo", "normal", "depth", "A",
/// "B", "variance". Metadata are strings, written as EXR attributes / PNG text under "zonal:" names.
struct ImageFile {
  std::map<std::string, Image> layers;
  std::map<std::string, std::string> metadata;
  bool display_referred = false;  ///< a PNG: sRGB-encoded values in [0,1], not radiance
};

/// Linear to sRGB transfer of a value clamped to [0,1], and back.
float srgb_encode(float linear);
float srgb_decode(float encoded);

/// Throws SceneError with the file's name when it is missing or no image.
ImageFile read_image(const std::string& file);
/// By extension: .exr writes all layers in 32-bit float; .png writes the radiance times `exposure`, clamped,
/// sRGB, 8 bits. Written to a temporary name beside the target and renamed. Throws SceneError when it cannot.
void write_image(const std::string& file, const ImageFile& image, float exposure);
/// Throws SceneError when `file` could not be written there later (bad extension, missing folder, no
/// permission).
void check_writable(const std::string& file);
/// The same for a file that is no picture: any extension.
void check_writable_text(const std::string& file);
/// Writes text the same safe way.
void write_text(const std::string& file, const std::string& text);

}  // namespace zonal
