// Files a scene names: where they are, and its textures, each read once and all in parallel.

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cstdlib>
#include <filesystem>

#include "core/error.h"
#include "core/loading.h"

namespace zonal {
namespace {

constexpr size_t kLongestPath = 300;  // shown whole in errors

}  // namespace

std::string Loading::resolve(const std::string& text, const std::string& where) const {
  namespace fs = std::filesystem;
  if (text.empty()) throw SceneError(where + ": found an empty string, expected a file");

  std::string expanded = text;
  const std::string variable = "${ZONAL_DATA}";
  if (const size_t at = expanded.find("${"); at != std::string::npos) {
    if (at != 0 || expanded.compare(0, variable.size(), variable) != 0)
      throw SceneError(
          fmt::format("{}: found {}, expected no variable but ${{ZONAL_DATA}}, and that in front", where,
                      in_quotes(text, kLongestPath)));
    const char* data = std::getenv("ZONAL_DATA");
    if (!data || !*data)
      throw SceneError(
          fmt::format("{}: found {}, but the environment variable ZONAL_DATA is not set: set it to the "
                      "folder that holds the downloaded scenes (scenes/README.md says where to get them)",
                      where, in_quotes(text, kLongestPath)));
    expanded = data + expanded.substr(variable.size());
  }

  const fs::path path = fs::path(expanded).is_absolute() ? fs::path(expanded) : fs::path(folder) / expanded;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  const std::string name = in_quotes(path.lexically_normal().string(), kLongestPath);
  if (fs::is_directory(status))
    throw SceneError(fmt::format("{}: found the folder {}, expected a file", where, name));
  if (!fs::is_regular_file(status))
    throw SceneError(fmt::format("{}: there is no file {}, expected one", where, name));
  return path.lexically_normal().string();
}

void TextureSlots::add(const std::string& file, Texture::Encoding encoding, const std::string& where,
                       const Texture** slot, int* channel) {
  const auto [it, is_new] = index_.try_emplace({file, encoding}, requests_.size());
  if (is_new) requests_.push_back({file, where, encoding, {}, {}});
  requests_[it->second].slots.push_back(slot);
  if (channel) requests_[it->second].channels.push_back(channel);
}

void TextureSlots::load_all(std::vector<std::unique_ptr<Texture>>& textures) {
  std::vector<std::unique_ptr<Texture>> loaded(requests_.size());
  std::vector<std::string> errors(requests_.size());
  tbb::parallel_for(size_t(0), requests_.size(), [&](size_t i) {
    try {
      loaded[i] = std::make_unique<Texture>(Texture::load(requests_[i].file, requests_[i].encoding));
    } catch (const SceneError& error) {
      errors[i] = error.what();
    }
  });

  for (size_t i = 0; i < requests_.size(); ++i) {
    if (!errors[i].empty()) throw SceneError(requests_[i].where + ": " + errors[i]);
    for (const Texture** slot : requests_[i].slots) *slot = loaded[i].get();
    for (int* channel : requests_[i].channels) *channel = loaded[i]->has_alpha() ? 3 : 0;
    textures.push_back(std::move(loaded[i]));
  }
}

}  // namespace zonal
