#pragma once
/// What one cell of a plan amounts to: its name, the settings it runs with, the references it is scored
/// against.
///
///     const std::optional<CellWork> work = cell_work(plan, store, cell);   // empty until its search is done

#include <optional>
#include <string>
#include <vector>

#include "sweep/cell_store.h"

namespace zonal {

/// "atrium | hvl bands=5 | equal time 0.5 s | seed 3"
std::string cell_name(const SweepPlan& plan, const Cell& cell);

/// What a cell runs with: the file's settings and, for equal budgets, the count that was found.
struct CellWork {
  std::string key;
  nlohmann::json settings;
  int passes = 0;
  double seconds = 0;
  nlohmann::json search;  ///< null unless the budget is an equal one
};
/// Empty while the cell's search has not been done, or found nothing.
std::optional<CellWork> cell_work(const SweepPlan& plan, const CellStore& store, const Cell& cell);
/// Key of the search that a cell's group shares.
std::string search_key(const SweepPlan& plan, const Cell& cell);

/// The references a cell is scored against: what its method solves, and, where the plan asks for it,
/// everything.
std::vector<ReferenceRequest> cell_references(const SweepPlan& plan, const Cell& cell);

/// Why a reference could not be made; empty when it could, or was not tried.
std::optional<std::string> reference_failure(const CellStore& store, const std::string& key);

/// Where that reason is kept.
std::string failure_file(const CellStore& store, const std::string& key);

}  // namespace zonal
