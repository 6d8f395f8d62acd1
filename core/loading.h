#pragma once
/// What the loader's parts share while one scene file is being read. Internal to the loader:
/// core/scene_loader.h is the way in. The parts run in this order: keyframes, materials, objects, lights,
/// textures, imports, camera.

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/json_fields.h"
#include "core/mesh_import.h"
#include "core/scene.h"
#include "core/scene_loader.h"
#include "core/transform.h"
#include "materials/material_database.h"
#include "materials/material.h"

namespace zonal {

/// Coordinates and lengths stay below this many metres, so that areas and their products stay floats.
inline constexpr float kFarthest = 1e9f;
/// Radiance, intensity, irradiance and power stay below this for the same reason.
inline constexpr float kBrightest = 1e15f;
inline constexpr Range kPlace{-kFarthest, kFarthest};
inline constexpr Range kLength{.low = 0, .high = kFarthest, .open_low = true};
inline constexpr Range kLight{0, kBrightest};

/// Pictures asked for by materials. Each file and encoding is read once, all of them in parallel, at the end.
class TextureSlots {
 public:
  /// `slot` receives the texture; `channel`, when given, becomes alpha where the file has one, else red.
  void add(const std::string& file, Texture::Encoding encoding, const std::string& where,
           const Texture** slot, int* channel = nullptr);
  /// Throws SceneError naming the place that asked first.
  void load_all(std::vector<std::unique_ptr<Texture>>& textures);

 private:
  struct Request {
    std::string file, where;
    Texture::Encoding encoding;
    std::vector<const Texture**> slots;
    std::vector<int*> channels;
  };
  std::vector<Request> requests_;
  std::map<std::pair<std::string, Texture::Encoding>, size_t> index_;
};

/// Measured materials asked for: like pictures, each file is read once, after the scene file itself has been checked.
class MeasuredSlots {
 public:
  void add(const std::string& file, const std::string& where, MeasuredMaterial* slot);
  /// Throws SceneError naming the place that asked first.
  void load_all();

 private:
  struct Request {
    std::string where;
    std::vector<MeasuredMaterial*> slots;
  };
  std::map<std::string, Request> requests_;
};

/// "emission" of an object, or the same keys of a light.
struct Emission {
  vec3 radiance{0};           ///< W m^-2 sr^-1
  std::optional<vec3> power;  ///< W; replaces the radiance once the area is known
  bool two_sided = false;
  std::string where;
  /// For a surface that radiates L from `area` square metres: L = power / (pi area), half of that from two
  /// sides.
  vec3 radiance_from(double area) const;
};

/// A mesh file to be read once everything said in the scene file itself has been checked.
struct PendingImport {
  std::string name, file, where;
  ImportOptions options;
  std::optional<uint32_t> material;
  std::optional<Emission> emission;
};

struct ImportedCameras {
  std::string object;
  std::vector<Camera> cameras;
  std::vector<std::string> names;
};

struct Loading {
  std::string file;    ///< names the scene in errors
  std::string folder;  ///< anchors relative paths
  SceneParts parts;
  TextureSlots textures;
  MeasuredSlots measured;
  std::vector<PendingImport> imports;
  std::vector<ImportedCameras> imported_cameras;

  /// The projected materials of "material_database" or of the environment variable ZONAL_MATERIALS; opened when a
  /// material is looked for there first.
  const MaterialDatabase* database();
  std::string database_folder, database_where;  ///< folder "" = none

  std::vector<std::string> material_names;  ///< of the scene file; index = index into parts.materials
  std::vector<bool> material_used;
  uint32_t default_material = kNone, black_material = kNone;
  std::optional<MaterialDatabase> opened_database;
  std::map<std::string, uint32_t> from_database;  ///< entries in use: index into parts.materials

  /// The file a key names: relative to the scene, ${ZONAL_DATA} expanded, known to exist. Throws SceneError.
  std::string resolve(const std::string& text, const std::string& where) const;
  /// Index of the material an object names, of the scene or of the database, which counts as used from then on; kNone
  /// when there is none.
  uint32_t find_material(const std::string& name);
  /// Index of a material, made on first use: the grey everything has that names none, and the black of bare
  /// lights.
  uint32_t grey();
  uint32_t black();
};

/// "position"-like keys: metres within kFarthest.
vec3 read_point(Fields& fields, std::string_view key);
vec3 read_point(Fields& fields, std::string_view key, vec3 otherwise);
/// A unit vector from three numbers of any length but 0.
vec3 read_direction(Fields& fields, std::string_view key);

/// Replaces what moves by its value at `frame` and removes nothing else (core/keyframes.cpp).
void apply_keyframes(nlohmann::json& root, int frame, const std::string& file);

void read_materials(Loading& loading, const nlohmann::json& list, const std::string& where);
/// Puts other definitions in the place of named materials: {"bronze": "rgl/paper_white"} or {"bronze": {"type": ...}}.
void replace_materials(nlohmann::json& root, const nlohmann::json& replacements, const std::string& file);
void read_objects(Loading& loading, const nlohmann::json& list, const std::string& where);
void read_lights(Loading& loading, const nlohmann::json& list, const std::string& where);
void import_meshes(Loading& loading);
Camera read_camera(const Loading& loading, const nlohmann::json& value, const std::string& where,
                   const LoadOptions& options);

/// "vertices": three corners.
MeshData read_triangle(Fields& fields);
/// "corner" and the two "edges" that leave it.
MeshData read_quad(Fields& fields);
/// "vertices": so many points, counter-clockwise seen from the front.
std::vector<vec3> read_points(Fields& fields, size_t fewest, size_t most);
/// Which of two keys is there: exactly one must be. True: the first.
bool first_of(Fields& fields, const char* first, const char* second);
/// Exactly one of "radiance" and "power", and "two_sided".
Emission read_emission(Fields& fields);
/// A picture file as radiance: decoded where it is not linear, times `scale`.
struct RadiancePicture {
  int width, height;
  std::vector<vec3> texels;  ///< W m^-2 sr^-1, row-major from the top
};
RadiancePicture read_radiance(Loading& loading, const std::string& text, const std::string& where, vec3 scale);
/// A light of a kind that has a surface, with its shape.
void read_area_light(Loading& loading, Fields& fields, const std::string& kind, const std::string& name);
/// Adds the shape and, when it glows, its light. A mesh shape's light covers its triangles.
void add_shape(Loading& loading, ShapeData shape, const std::optional<Emission>& emission);

}  // namespace zonal
