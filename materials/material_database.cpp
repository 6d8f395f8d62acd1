#include "materials/material_database.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/json_fields.h"
#include "core/strict_json.h"
#include "materials/measured_brdf.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kFormat = 1;
constexpr const char* kIndex = "index.json";

json to_json(const DatabaseEntry& e) {
  return {{"name", e.name},
          {"source", e.source},
          {"file", e.name + ".shmat"},
          {"key", e.key},
          {"format", e.format},
          {"bands", e.bands},
          {"mirrored", e.mirrored},
          {"azimuths", e.azimuths},
          {"albedo", {e.albedo.x, e.albedo.y, e.albedo.z}},
          {"bytes", e.bytes},
          {"least_share", e.least_share},
          {"notes", e.notes}};
}

DatabaseEntry read_entry(const json& value, const std::string& where, const std::string& folder) {
  Fields fields(value, where);
  DatabaseEntry e;
  e.name = fields.text("name"), e.source = fields.text("source"), e.key = fields.text("key");
  e.sh_file = folder + "/" + fields.text("file");
  e.format = fields.text("format", "");
  e.bands = fields.integer("bands", 0, {0, ShMaterial::kMaxBands});
  e.mirrored = fields.flag("mirrored", true);
  e.azimuths = fields.integer("azimuths", 1, {1, 100000});
  e.albedo = fields.vector("albedo", vec3(0));
  e.bytes = static_cast<size_t>(fields.integer("bytes", 0, {0, 2147483647}));
  e.least_share = fields.number("least_share", 0.0f, {0, 2});
  if (const json* notes = fields.find("notes"))
    for (const json& note : *notes) e.notes.push_back(read_text(note, fields.at("notes")));
  fields.finish();
  return e;
}

/// Names a file's content and everything that decides its projection.
std::string projection_key(const std::string& file, const FolderOptions& options) {
  Hash hash;
  hash.add(read_text_file(file, "a measured material"));
  const ShProjectionOptions& p = options.projection;
  hash.add(fmt::format("{} {} {} {} {} {} {} {} {}", kProjectionVersion, p.nodes, p.bands, p.share, p.most_bands,
                       p.azimuths, p.window, p.window_size, options.half));
  return hash.text();
}

std::vector<std::string> measured_files(const std::string& folder) {
  if (!fs::is_directory(folder)) throw SceneError(folder + ": no such folder");
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() &&
        (entry.path().extension() == ".bsdf" || entry.path().extension() == ".binary"))
      files.push_back(entry.path().string());
  if (files.empty())
    throw SceneError(folder + ": found no measured material, expected .bsdf (RGL) or .binary (MERL) files");
  std::sort(files.begin(), files.end());
  return files;
}

void write_index(const std::string& database, std::vector<DatabaseEntry> entries) {
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  json list = json::array();
  for (const DatabaseEntry& entry : entries) list.push_back(to_json(entry));
  const std::string text = json{{"format", kFormat}, {"materials", list}}.dump(1) + "\n";
  write_atomically(database + "/" + kIndex, text.data(), text.size());
}

}  // namespace

MaterialDatabase MaterialDatabase::open(const std::string& folder) {
  const std::string file = folder + "/" + kIndex;
  if (!fs::is_directory(folder))
    throw SceneError(folder + ": no such material database (zonal material project makes one)");
  const json root = parse_json(read_text_file(file, "a material database's index"), file);
  Fields fields(root, file);
  const int format = fields.integer("format", 0);
  if (format != kFormat) fields.fail("format", fmt::format("found {}, expected {}", format, kFormat));
  MaterialDatabase database;
  const json& list = fields.require("materials", "a list of materials");
  const auto values = read_array(list, fields.at("materials"), "materials");
  for (size_t i = 0; i < values.size(); ++i)
    database.entries_.push_back(read_entry(values[i], where_of(fields.at("materials"), i), folder));
  return database;
}

const DatabaseEntry* MaterialDatabase::find(const std::string& name) const {
  for (const DatabaseEntry& entry : entries_)
    if (entry.name == name) return &entry;
  return nullptr;
}

std::vector<std::string> MaterialDatabase::names() const {
  std::vector<std::string> names;
  for (const DatabaseEntry& entry : entries_) names.push_back(entry.name);
  return names;
}

std::string material_name(const std::string& file, const std::string& folder) {
  // By their words alone: links stay inside the folder, as the user sees them.
  std::string name = fs::absolute(file)
                         .lexically_normal()
                         .lexically_relative(fs::absolute(folder).lexically_normal())
                         .replace_extension()
                         .generic_string();
  constexpr std::string_view kSuffix = "_rgb";
  if (name.size() > kSuffix.size() && name.ends_with(kSuffix)) name.resize(name.size() - kSuffix.size());
  return name;
}

DatabaseEntry describe_projection(const ShMaterial& material) {
  DatabaseEntry e;
  e.name = material.name(), e.source = material.source();
  e.bands = material.max_bands(), e.mirrored = material.mirrored(), e.azimuths = material.azimuths();
  e.albedo = material.albedo(), e.bytes = material.bytes().size();
  e.least_share = 1;
  for (int a = 0; a < e.azimuths; ++a)
    for (int k = 0; k < ShMaterial::kElevations; ++k)
      e.least_share = std::min(e.least_share, material.row_share(ShTable::brdf_cosine, a, k));
  return e;
}

FolderReport project_folder(const std::string& folder, const std::string& database,
                            const FolderOptions& options, const Stop& stop,
                            const std::function<void(const std::string&, double)>& progress) {
  const std::vector<std::string> files = measured_files(folder);
  std::error_code error;
  fs::create_directories(database, error);
  if (error) throw SceneError(fmt::format("{}: could not be made: {}", database, error.message()));
  check_can_write(database + "/" + kIndex);
  std::vector<DatabaseEntry> entries;
  if (fs::exists(database + "/" + kIndex)) entries = MaterialDatabase::open(database).entries();

  FolderReport report;
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string name = material_name(files[i], folder);
    const auto tell = [&](double share) {
      if (progress) progress(name, (double(i) + share) / double(files.size()));
    };
    if (stop()) {
      report.interrupted = true;
      break;
    }
    try {
      const std::string key = projection_key(files[i], options);
      const auto old =
          std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.name == name; });
      if (old != entries.end() && old->key == key && fs::exists(old->sh_file)) {
        ++report.kept;
        continue;
      }
      tell(0);
      const std::unique_ptr<MeasuredBrdf> brdf = load_measured(files[i]);
      Bsdf bsdf;
      bsdf.kind = BsdfKind::measured, bsdf.measured = brdf.get();
      ShProjection projection = project_material(bsdf, options.projection, stop, tell);
      if (projection.empty()) {
        report.interrupted = true;
        break;
      }
      projection.name = name, projection.source = fs::path(files[i]).filename().string();
      const std::string file = database + "/" + name + ".shmat";
      fs::create_directories(fs::path(file).parent_path());
      const std::vector<std::byte> bytes = write_shmat(projection, {.half = options.half});
      write_atomically(file, bytes.data(), bytes.size());
      DatabaseEntry entry = describe_projection(ShMaterial::open(file));
      entry.name = name, entry.source = fs::absolute(files[i]).lexically_normal().string();
      entry.sh_file = file, entry.key = key, entry.format = brdf->format(), entry.notes = brdf->notes;
      if (old != entries.end()) entries.erase(old);
      entries.push_back(entry);
      write_index(database, entries);
      ++report.projected;
    } catch (const SceneError& failure) {
      // One broken file does not keep the others out.
      report.failed.push_back(failure.what());
    }
  }
  return report;
}

}  // namespace zonal
