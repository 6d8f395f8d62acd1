// Mesh files named by "objects": their shapes, materials, lights and cameras join the scene's.

#include <fmt/format.h>

#include <algorithm>

#include "core/basic_shapes.h"
#include "core/error.h"
#include "core/loading.h"

namespace zonal {
namespace {

/// Where each of the file's materials ends up, and whether it is still the file's own.
struct MaterialMap {
  std::vector<uint32_t> index;
  std::vector<bool> own;
};

MaterialMap take_materials(Loading& loading, const PendingImport& pending, ImportedFile& file) {
  MaterialMap map;
  for (std::unique_ptr<Material>& material : file.materials) {
    // An object's "material" replaces all; else a material of the scene replaces the one of its name.
    uint32_t index = pending.material.value_or(kNone);
    const auto named =
        std::find(loading.material_names.begin(), loading.material_names.end(), material->name);
    if (index == kNone && named != loading.material_names.end()) {
      index = static_cast<uint32_t>(named - loading.material_names.begin());
      loading.material_used[index] = true;
    }
    map.own.push_back(index == kNone);
    if (index == kNone) {
      index = static_cast<uint32_t>(loading.parts.materials.size());
      loading.parts.materials.push_back(std::move(material));
    }
    map.index.push_back(index);
  }
  return map;
}

void import_one(Loading& loading, PendingImport& pending) {
  pending.options.overridden_materials =
      pending.material ? std::vector<std::string>{"*"} : loading.material_names;
  ImportedFile file = import_mesh(pending.file, pending.options);
  const MaterialMap materials = take_materials(loading, pending, file);

  // The object's own emission covers every triangle; a given power is shared by area.
  std::optional<Emission> whole = pending.emission;
  if (whole && whole->power) {
    double area = 0;
    for (const ShapeData& shape : file.shapes) area += surface_area(shape.mesh);
    whole->radiance = whole->radiance_from(area);
    whole->power.reset();
  }

  for (ShapeData& shape : file.shapes) {
    const uint32_t imported = shape.material;
    std::optional<Emission> emission = whole;
    const bool known = imported < materials.index.size();
    // A material that was replaced takes its glow with it.
    if (!whole && known && materials.own[imported] && !is_black(file.emission[imported]))
      emission =
          Emission{file.emission[imported], std::nullopt, file.emission_two_sided[imported], pending.where};
    shape.material = known ? materials.index[imported] : pending.material.value_or(kNone);
    if (shape.material == kNone) shape.material = loading.grey();
    add_shape(loading, std::move(shape), emission);
  }

  for (auto& texture : file.textures) loading.parts.textures.push_back(std::move(texture));
  for (auto& light : file.lights) loading.parts.lights.push_back(std::move(light));
  for (std::string& note : file.notes) loading.parts.notes.push_back(std::move(note));
  loading.imported_cameras.push_back({pending.name, std::move(file.cameras), std::move(file.camera_names)});
}

}  // namespace

void import_meshes(Loading& loading) {
  for (PendingImport& pending : loading.imports) {
    try {
      import_one(loading, pending);
    } catch (const SceneError& error) {
      throw SceneError(pending.where + ": " + error.what());
    }
  }
}

}  // namespace zonal
