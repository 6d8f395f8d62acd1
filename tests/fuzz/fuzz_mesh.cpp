/// Any bytes as a mesh file: import and scene must work or throw SceneError, never crash or hang.
/// The first byte picks the format. Run: fuzz_mesh -max_len=65536 -timeout=20 -close_fd_mask=1 CORPUS

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "core/mesh_import.h"

namespace {

/// One file per process, overwritten each time and removed at the end.
struct Place {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("zonal_fuzz_mesh_" + std::to_string(getpid()));
  Place() { std::filesystem::create_directories(folder); }
  ~Place() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 1) return 0;
  static const Place place;
  static const char* const kNames[] = {"fuzz.obj", "fuzz.ply", "fuzz.gltf", "fuzz.glb"};
  const std::string file = (place.folder / kNames[data[0] % 4]).string();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), std::streamsize(size - 1));
  try {
    zonal::ImportedFile imported = zonal::import_mesh(file, {});
    zonal::SceneParts parts;
    parts.shapes = std::move(imported.shapes);
    parts.materials = std::move(imported.materials);
    parts.textures = std::move(imported.textures);
    parts.lights = std::move(imported.lights);
    const zonal::Scene scene(std::move(parts));
    const zonal::Hit hit = scene.intersect({0, 0, 5}, {0, 0, -1});
    if (hit.found()) scene.bsdf(scene.surface(hit, {0, 0, -1}));
  } catch (const zonal::SceneError&) {
  }
  std::filesystem::remove(file);
  return 0;
}
