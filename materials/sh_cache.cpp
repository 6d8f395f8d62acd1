#include "materials/sh_cache.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <string_view>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "materials/measured_brdf.h"

namespace zonal {
namespace {

/// What it reflects between some directions: tells tables of an older version's models and readers apart.
std::string samples(const Bsdf& bsdf) {
  Hash hash;
  for (int i = 0; i < 6; ++i) {
    const float z = 0.15f + 0.16f * float(i), s = std::sqrt(1 - z * z), turn = 0.7f * float(i);
    const BsdfContext view = prepare(bsdf, vec3(-s, 0, z));
    const vec3 f = evaluate(bsdf, view, vec3(s * std::cos(turn), s * std::sin(turn), z));
    hash.add(std::string_view(reinterpret_cast<const char*>(&f), sizeof f));
  }
  return hash.text();
}

std::string text(vec3 v) {
  return fmt::format("{:a} {:a} {:a}", v.x, v.y, v.z);
}

/// Hash of a file's bytes; empty when it cannot be read.
std::string content_hash(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return "";
  Hash hash;
  std::string block(size_t{1} << 20, '\0');
  while (in.read(block.data(), std::streamsize(block.size())) || in.gcount() > 0) {
    hash.add(std::string_view(block.data(), size_t(in.gcount())));
  }
  return hash.text();
}

struct Memory {
  std::mutex mutex;
  std::map<std::string, std::weak_ptr<const ShMaterial>> tables;
};
Memory& memory() {
  static Memory memory;
  return memory;
}

/// The stored table, or null where there is none that holds what the key says.
std::shared_ptr<const ShMaterial> read(const std::string& file, const std::string& key) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return nullptr;
  try {
    auto table = std::make_shared<const ShMaterial>(ShMaterial::open(file));
    return table->source() == key ? table : nullptr;
  } catch (const SceneError&) {
    return nullptr;
  }
}

void write(const std::string& folder, const std::string& file, std::span<const std::byte> bytes) {
  try {
    std::filesystem::create_directories(folder);
    write_atomically(file, bytes.data(), bytes.size());
  } catch (const std::exception&) {
    // A full disk or a read-only home costs the next start its time, nothing else.
  }
}

}  // namespace

std::string cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value ? value : "");
  };
  if (const std::string own = variable("ZONAL_CACHE"); !own.empty()) return own;
  if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return xdg + "/zonal";
  if (const std::string home = variable("HOME"); !home.empty()) return home + "/.cache/zonal";
  return "";
}

std::string projection_key(const Bsdf& b, const ShProjectionOptions& o) {
  std::string what;
  if (b.kind == BsdfKind::measured) {
    const std::string hash = content_hash(b.measured->file);
    if (hash.empty()) return "";
    what = "measured " + hash;
  } else {
    what = fmt::format("kind {} diffuse {} specular {} eta {} k {} alpha {:a} {:a} exponent {:a}",
                       int(b.kind), text(b.diffuse), text(b.specular), text(b.eta), text(b.k), b.alpha_x,
                       b.alpha_y, b.exponent);
  }
  what += " reflecting " + samples(b);
  return fmt::format("projection {}: {}; bands {} share {:a} most {} azimuths {} window {} {:a}",
                     kProjectionVersion, what, o.bands, o.share, o.most_bands, o.azimuths, o.window,
                     o.window_size);
}

std::shared_ptr<const ShMaterial> cached_projection(const Bsdf& bsdf, const ShProjectionOptions& options,
                                                    const Stop& stop,
                                                    const std::function<void(double)>& progress) {
  const std::string key = projection_key(bsdf, options);
  const std::string folder = key.empty() ? "" : cache_folder();
  Hash hash;
  hash.add(key);
  const std::string file = folder.empty() ? "" : folder + "/" + hash.text() + ".shmat";
  const auto remember = [&](std::shared_ptr<const ShMaterial> table) {
    if (key.empty()) return table;
    const std::lock_guard lock(memory().mutex);
    memory().tables[key] = table;
    return table;
  };

  if (!key.empty()) {
    const std::lock_guard lock(memory().mutex);
    if (auto held = memory().tables[key].lock()) return held;
  }
  if (!file.empty()) {
    if (auto stored = read(file, key)) return remember(stored);
  }
  ShProjection projection = project_material(bsdf, options, stop, progress);
  if (projection.empty()) return nullptr;
  projection.name = bsdf.kind == BsdfKind::measured ? bsdf.measured->file : "cached";
  projection.source = key.empty() ? projection.name : key;
  auto table = std::make_shared<const ShMaterial>(
      ShMaterial::from_bytes(write_shmat(projection, {.half = false}), projection.name));
  if (!file.empty()) write(folder, file, table->bytes());
  return remember(table);
}

}  // namespace zonal
