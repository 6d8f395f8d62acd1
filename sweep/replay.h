#pragma once
/// Renders finished cells again from their recorded passes and parameters, without a clock: the same bits
/// must come out, also where the cell itself was timed.

#include "sweep/runner.h"

namespace zonal {

struct ReplaySummary {
  int same = 0, different = 0;
  std::vector<std::string> names;  ///< of the different ones, and why
  bool interrupted = false;
};

/// Of the finished cells whose name contains `options.only`. Throws SceneError when there are none.
ReplaySummary replay_cells(const SweepPlan& plan, const CellStore& store, const RunnerOptions& options);

}  // namespace zonal
