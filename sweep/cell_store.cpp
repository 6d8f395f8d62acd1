#include "sweep/cell_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/json_fields.h"

namespace zonal {

namespace fs = std::filesystem;
using nlohmann::json;

std::optional<json> read_record(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return {};
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  json record = json::parse(text, nullptr, false);
  if (record.is_discarded()) return {};
  return record;
}

void write_record(const std::string& file, const json& record) {
  const std::string text = record.dump(1) + "\n";
  write_atomically(file, text.data(), text.size());
}

CellStore::CellStore(const std::string& folder, const SweepPlan& plan) : folder_(folder) {
  std::error_code error;
  const std::string identity = folder + "/sweep.json";
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw SceneError(folder + ": found a file, expected a folder");
  if (fs::is_directory(folder) && !fs::is_empty(folder, error) && !fs::exists(identity))
    throw SceneError(folder + ": found a folder of other things, expected an empty one or a sweep's");
  for (const char* part : {"", "/cells", "/searches", "/references", "/images", "/charts"}) {
    fs::create_directories(folder + part, error);
    if (error) throw SceneError(fmt::format("{}: could not be made: {}", folder + part, error.message()));
  }
  lock_ = open((folder + "/.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    if (lock_ >= 0) close(lock_);
    throw SceneError(folder + ": another zonal sweep is at work there");
  }
  if (const auto record = read_record(identity)) {
    const std::string name = record->value("name", "");
    if (name != plan.name) {
      close(lock_);
      throw SceneError(fmt::format("{}: holds the sweep {}, not {}: give another folder with -o", folder,
                                   in_quotes(name), in_quotes(plan.name)));
    }
  }
  write_record(identity, {{"name", plan.name}, {"file", plan.file}});
}

CellStore::~CellStore() {
  close(lock_);
}

std::optional<json> CellStore::cell(const std::string& key) const {
  return read_record(cell_folder(key) + "/cell.json");
}

std::optional<json> CellStore::search(const std::string& key) const {
  return read_record(folder_ + "/searches/" + key + ".json");
}

void CellStore::write_cell(const std::string& key, const json& record) const {
  write_record(cell_folder(key) + "/cell.json", record);
}

void CellStore::write_search(const std::string& key, const json& record) const {
  write_record(folder_ + "/searches/" + key + ".json", record);
}

std::string cell_key(const SweepPlan& plan, const Cell& cell, const json& settings,
                     const CellBudget& budget) {
  const SweepScene& scene = plan.scenes[cell.scene];
  const SweepMethod& method = plan.methods[cell.method];
  Hash hash;
  hash.add(reference_key({.scene_file = scene.file,
                          .integrator = method.integrator,
                          .settings = settings,
                          .width = scene.width,
                          .height = scene.height,
                          .frame = scene.frame,
                          .seed = cell.seed,
                          .materials = scene.materials,
                          .pixels = plan.pixels}));
  const std::string spent =
      budget.kind == CellBudget::passes ? fmt::format("{:.0f} passes", budget.value) : budget.text();
  hash.add(fmt::format("{} {} {} {} {} {}", ZONAL_VERSION, cell.backend, spent,
                       static_cast<int>(plan.pixels), plan.threads, plan.runs));
  return hash.text();
}

}  // namespace zonal
