#pragma once
/// All that a sweep found, as one JSON value: what the report shows and the tables print. docs/sweeps.md has
/// its members.

#include <nlohmann/json.hpp>

#include "sweep/cell_store.h"

namespace zonal {

nlohmann::json sweep_results(const SweepPlan& plan, const CellStore& store);

/// Metrics of the results: {"name", "values", "better", "unit", "formula"}.
nlohmann::json result_metrics(const SweepPlan& plan);

}  // namespace zonal
