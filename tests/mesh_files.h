#pragma once
/// Tiny mesh files written by the tests: text, a PNG, and a glTF whose buffer and picture travel inside or
/// beside it.

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/vec.h"

namespace zonal::test {

/// A folder of one test's own, gone at the end.
class Folder {
 public:
  Folder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string("zonal_") + info->test_suite_name() + "_" + info->name());
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string path(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  /// 8-bit PNG, rows from the top.
  std::string png(const std::string& name, int width, int height, int channels,
                  const std::vector<uint8_t>& pixels) const {
    auto out = OIIO::ImageOutput::create(path(name));
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
    spec["oiio:UnassociatedAlpha"] = 1;
    EXPECT_TRUE(out && out->open(path(name), spec) && out->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    out->close();
    return path(name);
  }
  std::string read(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::filesystem::path path_;
};

inline std::string base64(const std::string& bytes) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[(word >> (18 - 6 * k)) & 63] : '=';
  }
  return out;
}

template <class T>
void append_bytes(std::string& to, const std::vector<T>& values) {
  to.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// One triangle with uvs and a material, under a node that scales by 2 and moves by (1, 2, 3); a camera;
/// three lights; a picture, red above blue.
struct GltfScene {
  std::string buffer;  ///< positions (36), uvs (24), indices (6, padded to 8), then the picture
  std::string json;

  /// `picture` holds PNG bytes; `buffer_uri` and `image` are JSON text ("" leaves the buffer to a GLB).
  GltfScene(const std::string& picture, bool embed_picture, const std::string& material) {
    append_bytes(buffer, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    append_bytes(buffer, std::vector<float>{0, 0, 1, 0, 0, 1});  // glTF's v grows downwards
    append_bytes(buffer, std::vector<uint16_t>{0, 1, 2, 0});
    if (embed_picture) buffer += picture;
    material_ = material;
    picture_bytes_ = picture.size(), embed_ = embed_picture;
  }

  std::string text(const std::string& buffer_uri, const std::string& image_uri) const {
    const std::string uri = buffer_uri.empty() ? "" : "\"uri\":\"" + buffer_uri + "\",";
    const std::string image =
        embed_ ? R"({"bufferView":3,"mimeType":"image/png"})" : "{\"uri\":\"" + image_uri + "\"}";
    const std::string picture_view =
        embed_ ? R"(,{"buffer":0,"byteOffset":68,"byteLength":)" + std::to_string(picture_bytes_) + "}" : "";
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2,3,4]}],
"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[
  {"type":"point","color":[1,0.5,0.25],"intensity":8},
  {"type":"spot","intensity":2,"spot":{"innerConeAngle":0.2,"outerConeAngle":0.6}},
  {"type":"directional","color":[1,1,1],"intensity":3}]}},
"cameras":[{"type":"perspective","perspective":{"yfov":0.7,"aspectRatio":1.5,"znear":0.1}}],
"nodes":[{"name":"leaf","mesh":0,"translation":[1,2,3],"scale":[2,2,2]},
 {"name":"eye","camera":0,"translation":[0,1,5],"rotation":[0,0.70710678,0,0.70710678]},
 {"name":"bulb","translation":[4,5,6],"extensions":{"KHR_lights_punctual":{"light":0}}},
 {"name":"torch","translation":[0,3,0],"rotation":[-0.70710678,0,0,0.70710678],
  "extensions":{"KHR_lights_punctual":{"light":1}}},
 {"name":"sun","rotation":[-0.70710678,0,0,0.70710678],"extensions":{"KHR_lights_punctual":{"light":2}}}],
"meshes":[{"name":"blade","primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],
"materials":[)" +
           material_ + R"(],
"textures":[{"source":0}],"images":[)" +
           image + R"(],
"accessors":[
 {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
 {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
 {"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
 {"buffer":0,"byteOffset":60,"byteLength":6})" +
           picture_view + R"(],
"buffers":[{)" +
           uri + R"("byteLength":)" + std::to_string(buffer.size()) + "}]}";
  }

  std::string gltf(const std::string& image_uri) const {
    return text("data:application/octet-stream;base64," + base64(buffer), image_uri);
  }

  std::string glb() const {
    std::string chunk = text("", ""), binary = buffer;
    while (chunk.size() % 4) chunk += ' ';
    while (binary.size() % 4) binary += '\0';
    std::string out;
    const auto word = [&](uint32_t w) { append_bytes(out, std::vector<uint32_t>{w}); };
    word(0x46546c67), word(2), word(uint32_t(12 + 8 + chunk.size() + 8 + binary.size()));  // "glTF"
    word(uint32_t(chunk.size())), word(0x4e4f534a);                                        // "JSON"
    out += chunk;
    word(uint32_t(binary.size())), word(0x004e4942);  // "BIN"
    return out + binary;
  }

 private:
  std::string material_;
  size_t picture_bytes_ = 0;
  bool embed_ = false;
};

}  // namespace zonal::test
