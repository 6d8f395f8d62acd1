#pragma once
/// Mesh files (OBJ+MTL, PLY, glTF 2.0, GLB) through Assimp, turned into our own arrays, materials, cameras
/// and lights.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"

namespace zonal {

/// A file's content in world units of our scene (metres, y up), node transforms applied.
struct ImportedFile {
  std::vector<ShapeData> shapes;  ///< `material` indexes `materials`; `light` is kNone
  std::vector<std::unique_ptr<Material>> materials;
  std::vector<vec3> emission;  ///< per material: radiance its surfaces emit, 0 for most
  std::vector<bool> emission_two_sided;
  std::vector<std::unique_ptr<Texture>> textures;
  std::vector<std::unique_ptr<Light>> lights;  ///< punctual lights of glTF
  std::vector<Camera> cameras;
  std::vector<std::string> camera_names;
  std::vector<std::string> notes;
};

struct ImportOptions {
  float metres_per_unit = 1;
  mat4 transform{1};  ///< applied after metres_per_unit
  std::vector<std::string>
      exclude;  ///< object, group, node, mesh or material names to leave out; '*' at the end matches any tail
  /// Materials of these names ("*": all) will be replaced by the scene's: their textures need not be read.
  /// '*' means all of them. Names the file does not have are ignored: the scene loader passes all it knows.
  std::vector<std::string> overridden_materials;
  bool lights = true;          ///< import punctual lights
  bool smooth_normals = true;  ///< make up vertex normals where the file has none
};

/// Textures are decoded in parallel. Throws SceneError: missing file, what the importer says of a broken one,
/// missing texture, indices out of range, NaN vertices, an `exclude` name that matches nothing.
ImportedFile import_mesh(const std::string& file, const ImportOptions& options);

}  // namespace zonal
