#include "core/mesh_textures.h"

#include <assimp/scene.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "core/image.h"

namespace zonal {

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// "a%20b" to "a b": glTF names files by URI.
std::string percent_decoded(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    const int high = i + 2 < text.size() && text[i] == '%' ? hex_digit(text[i + 1]) : -1;
    const int low = high < 0 ? -1 : hex_digit(text[i + 2]);
    out += low < 0 ? text[i] : char(high * 16 + low);
    if (low >= 0) i += 2;
  }
  return out;
}

/// An embedded picture that Assimp hands over as bare texels (8 bits, ARGB).
Texture from_texels(const aiTexture& picture, Texture::Encoding encoding) {
  std::vector<vec4> texels(size_t(picture.mWidth) * picture.mHeight);
  for (size_t i = 0; i < texels.size(); ++i) {
    const aiTexel& t = picture.pcData[i];
    vec4 value(t.r / 255.0f, t.g / 255.0f, t.b / 255.0f, t.a / 255.0f);
    for (int c = 0; c < 3 && encoding == Texture::Encoding::srgb; ++c) value[c] = srgb_decode(value[c]);
    texels[i] = value;
  }
  return Texture(int(picture.mWidth), int(picture.mHeight), std::move(texels));
}

}  // namespace

TextureRequests::TextureRequests(const aiScene& scene, std::string file)
    : scene_(scene), file_(std::move(file)) {}

const Texture* TextureRequests::ask(const std::string& path, Texture::Encoding encoding,
                                    const std::string& material) {
  const auto [place, is_new] = index_.try_emplace({path, encoding}, requests_.size());
  if (is_new) {
    requests_.push_back({path, material, encoding, {}});
    textures_.push_back(std::make_unique<Texture>(1, 1, std::vector<vec4>{vec4(1)}));
  }
  return textures_[place->second].get();
}

Texture TextureRequests::read(const Request& request) const {
  if (const aiTexture* embedded = scene_.GetEmbeddedTexture(request.path.c_str())) {
    if (embedded->mHeight == 0) {
      const auto* bytes = reinterpret_cast<const std::byte*>(embedded->pcData);
      return Texture::decode({bytes, embedded->mWidth}, "texture \"" + request.path + "\"", request.encoding);
    }
    if (embedded->mWidth > 0) return from_texels(*embedded, request.encoding);
  }
  namespace fs = std::filesystem;
  std::string path = request.path;
  std::replace(path.begin(), path.end(), '\\', '/');  // written on Windows
  const fs::path folder = fs::path(file_).parent_path();
  fs::path found = folder / path;
  std::error_code ignored;
  if (!fs::is_regular_file(found, ignored)) {
    const fs::path decoded = folder / percent_decoded(path);
    if (fs::is_regular_file(decoded, ignored)) found = decoded;
  }
  if (!fs::is_regular_file(found, ignored)) {
    throw SceneError(fmt::format("texture \"{}\" is missing (looked for {})", request.path, found.string()));
  }
  return Texture::load(found.string(), request.encoding);
}

std::vector<std::unique_ptr<Texture>> TextureRequests::load() {
  tbb::parallel_for(size_t(0), requests_.size(), [&](size_t i) {
    try {
      *textures_[i] = read(requests_[i]);
    } catch (const std::exception& e) {
      requests_[i].error = e.what();
    }
  });
  for (const Request& r : requests_) {
    if (!r.error.empty())
      throw SceneError(fmt::format("{}: material \"{}\": {}", file_, r.material, r.error));
  }
  return std::move(textures_);
}

}  // namespace zonal
