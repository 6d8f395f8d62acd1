#pragma once
/// Materials of an imported file, with the textures they use: read once a file and encoding, decoded in
/// parallel. docs/mesh_import.md has the mapping.

#include <memory>
#include <string>
#include <vector>

#include "core/mesh_import.h"

struct aiScene;

namespace zonal {

/// Converts the materials whose numbers are in `wanted` (in that order) into `result`. Those named in
/// `overridden` get no textures.
void import_materials(const aiScene& scene, const std::string& file, const std::vector<unsigned>& wanted,
                      const std::vector<std::string>& overridden, ImportedFile& result);

/// The material's name as scene files spell it.
std::string material_name(const aiScene& scene, unsigned index);

}  // namespace zonal
