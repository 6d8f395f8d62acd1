#pragma once
/// The output folder of a sweep: what is finished stays, whatever ends the sweep.
///
///     CellStore store("out/glossy", plan);
///     if (!store.finished(key)) store.write_cell(key, record);   // the record is written last, atomically
///
///     out/glossy/sweep.json            which sweep this folder holds
///     out/glossy/cells/KEY/cell.json   one finished cell; image.exr, its snapshots and scores beside it
///     out/glossy/searches/KEY.json     what an equal-time or equal-error search found
///     out/glossy/references/KEY.exr

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "sweep/sweep_file.h"

namespace zonal {

class CellStore {
 public:
  /// Makes the folder, or opens one that holds this sweep. Throws SceneError when it holds another one, when
  /// another process is writing to it, or when it cannot be written.
  CellStore(const std::string& folder, const SweepPlan& plan);
  ~CellStore();
  CellStore(const CellStore&) = delete;

  const std::string& folder() const { return folder_; }
  std::string cell_folder(const std::string& key) const { return folder_ + "/cells/" + key; }
  std::string reference_file(const std::string& key) const { return folder_ + "/references/" + key + ".exr"; }

  /// Record of a finished cell or search; empty when there is none, or none that can be read.
  std::optional<nlohmann::json> cell(const std::string& key) const;
  std::optional<nlohmann::json> search(const std::string& key) const;
  void write_cell(const std::string& key, const nlohmann::json& record) const;
  void write_search(const std::string& key, const nlohmann::json& record) const;

 private:
  std::string folder_;
  int lock_ = -1;
};

/// Names everything that determines the pixels of a cell: the scene's content, method, parameters, seed,
/// size, budget, program version. One changed byte is another key.
std::string cell_key(const SweepPlan& plan, const Cell& cell, const nlohmann::json& settings,
                     const CellBudget& budget);

/// Whole file as JSON, or nothing.
std::optional<nlohmann::json> read_record(const std::string& file);
void write_record(const std::string& file, const nlohmann::json& record);

}  // namespace zonal
