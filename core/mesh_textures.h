#pragma once
/// The textures an imported file asks for: gathered first, then each one decoded once, all in parallel.
///
///     TextureRequests requests(scene, "room/room.glb");
///     const Texture* wood = requests.ask("wood.png", Texture::Encoding::srgb, "floor");   // valid, but
///     blank result.textures = requests.load();                                                  // now
///     filled

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/texture.h"

struct aiScene;

namespace zonal {

class TextureRequests {
 public:
  TextureRequests(const aiScene& scene, std::string file);
  /// `path` as the file spells it: relative to the file, or naming an embedded picture. `material` is for
  /// errors.
  const Texture* ask(const std::string& path, Texture::Encoding encoding, const std::string& material);
  /// Throws SceneError for the first, in order of asking, that is missing or broken.
  std::vector<std::unique_ptr<Texture>> load();

 private:
  struct Request {
    std::string path, material;
    Texture::Encoding encoding;
    std::string error;
  };
  Texture read(const Request& request) const;

  const aiScene& scene_;
  std::string file_;
  std::map<std::pair<std::string, Texture::Encoding>, size_t> index_;
  std::vector<Request> requests_;
  std::vector<std::unique_ptr<Texture>> textures_;
};

}  // namespace zonal
