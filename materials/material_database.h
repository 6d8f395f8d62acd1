#pragma once
/// A folder of measured materials projected once: one .shmat a material and an index that names them.
///
///     project_folder("materials", "db", {}, {});                       // resumes: what is current stays
///     const MaterialDatabase database = MaterialDatabase::open("db");
///     const DatabaseEntry* paper = database.find("rgl/paper_white");    // null when there is none
///
/// A material's name is its file's path inside the projected folder, without extension and without RGL's
/// "_rgb".

#include <functional>
#include <string>
#include <vector>

#include "core/stop.h"
#include "core/vec.h"
#include "materials/sh_projector.h"

namespace zonal {

struct DatabaseEntry {
  std::string name;
  std::string source;    ///< the measured file, which path and vpl evaluate
  std::string sh_file;   ///< its projection
  std::string key;       ///< names the source's content and the settings
  std::string format;    ///< "RGL", "MERL"
  int bands = 0;         ///< the most of any row
  bool mirrored = true;  ///< half of the coefficients are zero
  int azimuths = 1;
  vec3 albedo{0};
  size_t bytes = 0;       ///< of the projection
  float least_share = 0;  ///< of the energy of F' that a row's bands hold, smallest of all rows
  std::vector<std::string> notes;
};

class MaterialDatabase {
 public:
  /// Throws SceneError: folder or index missing, damaged, of a later version.
  static MaterialDatabase open(const std::string& folder);
  const std::vector<DatabaseEntry>& entries() const& { return entries_; }
  std::vector<DatabaseEntry> entries() && { return std::move(entries_); }  ///< of a database that goes away
  const DatabaseEntry* find(const std::string& name) const;
  std::vector<std::string> names() const;

 private:
  std::vector<DatabaseEntry> entries_;
};

struct FolderOptions {
  ShProjectionOptions projection;
  bool half = true;
};

/// "DIR/rgl/paper_white_rgb.bsdf" -> "rgl/paper_white"
std::string material_name(const std::string& file, const std::string& folder);

/// What a .shmat says of itself, as an entry. `source` is the measured file.
DatabaseEntry describe_projection(const ShMaterial& material);

struct FolderReport {
  int projected = 0, kept = 0;
  std::vector<std::string> failed;  ///< one line each: file and reason
  bool interrupted = false;
};

/// Projects every .bsdf and .binary file below `folder`. The index is written anew after each material, so
/// that an interrupted call loses one. Throws SceneError when there is no such file or the database cannot be
/// written.
FolderReport project_folder(
    const std::string& folder, const std::string& database, const FolderOptions& options, const Stop& stop,
    const std::function<void(const std::string& name, double fraction)>& progress = {});

}  // namespace zonal
