#include "sweep/picture_script.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

namespace zonal {
namespace {

std::string base64(const std::vector<uint32_t>& words) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = reinterpret_cast<const unsigned char*>(words.data());
  const size_t size = words.size() * 4;
  std::string text;
  text.reserve(size * 4 / 3 + 4);
  for (size_t i = 0; i < size; i += 3) {
    const size_t left = std::min<size_t>(3, size - i);
    const uint32_t three =
        bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += kDigits[three >> 18], text += kDigits[three >> 12 & 63];
    text += left > 1 ? kDigits[three >> 6 & 63] : '=', text += left > 2 ? kDigits[three & 63] : '=';
  }
  return text;
}

}  // namespace

uint32_t pack_rgb9e5(vec3 color) {
  static_assert(std::endian::native == std::endian::little);
  constexpr float kLargest = 65408.0f;  // 511/512 2^16
  const auto clean = [](float x) {
    return x > 0 ? std::fmin(x, kLargest) : 0.0f;
  };  // NaN fails the comparison
  const float r = clean(color.x), g = clean(color.y), b = clean(color.z);
  const float most = std::fmax(r, std::fmax(g, b));
  int exponent = most > 0 ? std::max(-16, std::ilogb(most)) + 16 : 0;
  float scale = std::exp2(float(exponent - 24));
  if (std::lround(most / scale) == 512) ++exponent, scale *= 2;
  const auto mantissa = [&](float x) { return static_cast<uint32_t>(std::lround(x / scale)); };
  return mantissa(r) | mantissa(g) << 9 | mantissa(b) << 18 | static_cast<uint32_t>(exponent) << 27;
}

std::string picture_script(const std::string& id, const Image& image, float exposure) {
  std::vector<uint32_t> words(static_cast<size_t>(image.width) * image.height);
  std::vector<size_t> bad;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const size_t i = static_cast<size_t>(y) * image.width + x;
      words[i] = pack_rgb9e5(image.rgb(x, y));
      if (!is_finite(image.rgb(x, y))) bad.push_back(i);
    }
  }
  return fmt::format("zonal_image({}, {{width: {}, height: {}, exposure: {}, nan: [{}], data: \"{}\"}});\n",
                     nlohmann::json(id).dump(), image.width, image.height, exposure, fmt::join(bad, ","),
                     base64(words));
}

}  // namespace zonal
