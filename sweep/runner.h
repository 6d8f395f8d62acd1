#pragma once
/// Runs the cells of a sweep, each as a process of its own, until all are done or someone stops it.
///
///     CellStore store(folder, plan);
///     const RunSummary summary = run_cells(plan, store, {.program = own_program()});
///
/// Order: references, equal-time and equal-error searches, then the cells, shuffled; a warm-up before the
/// first cell of each method, and a baseline cell between whiles that tells whether the machine has become
/// slower.

#include <atomic>
#include <string>

#include "sweep/cell_store.h"

namespace zonal {

struct RunnerOptions {
  std::string program;  ///< the zonal command
  std::string only;     ///< run cells whose name contains this; empty: all
  bool retry = false;   ///< run failed cells again
  bool quiet = false;
  const std::atomic<bool>* stop = nullptr;
};

struct RunSummary {
  int done = 0, kept = 0, failed = 0, left = 0;
  double seconds = 0;        ///< wall clock of all of it
  double child_seconds = 0;  ///< of it, inside the processes of references, searches and cells
  bool interrupted = false;
};

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

RunSummary run_cells(const SweepPlan& plan, const CellStore& store, const RunnerOptions& options);

}  // namespace zonal
