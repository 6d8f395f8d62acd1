#pragma once
/// Cameras and punctual lights of an imported file (glTF), moved by their nodes.

#include <string>

#include "core/mesh_import.h"

struct aiScene;

namespace zonal {

void import_cameras(const aiScene& scene, const mat4& to_world, ImportedFile& result);
/// KHR_lights_punctual: candela are read as W/sr and lux as W/m^2, one to one.
void import_lights(const aiScene& scene, const std::string& file, const mat4& to_world, ImportedFile& result);

}  // namespace zonal
