#pragma once
/// Runs the cells of a sweep, each as a process of its own, until all are done or someone stops it.
///
///     CellStore store(folder, plan);
///     const RunSummary summary = run_cells(plan, store, {.program = own_program()});
///
/// Order: references, equal-time and equal-error searches, then each cell's first run, then each one's second,
/// and so on, every round shuffled; a warm-up before the first cell of each method, and a baseline cell between
/// whiles that tells whether the machine has become slower.

#include <atomic>
#include <string>

#include "sweep/cell_work.h"

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

RunSummary run_cells(const SweepPlan& plan, const CellStore& store, const RunnerOptions& options);

}  // namespace zonal
