#pragma once
/// What the pictures of a sweep amount to, apart from rendering them: each is read once, scored, and handed
/// to the report's page; what the seeds of a group say together is worked out beside it. A new metric digests
/// old pictures again.
///
///     digest_cells(plan, store);
///     const nlohmann::json scores = cell_scores(store, key);

#include <nlohmann/json.hpp>
#include <string>

#include "sweep/cell_store.h"

namespace zonal {

/// Digests all finished cells that are not digested yet, in parallel, one reference after the other. Returns
/// how many were. A picture that cannot be scored leaves its reason.
int digest_cells(const SweepPlan& plan, const CellStore& store);

/// {"matching": {...}, "full": {...}, "curve": [{"passes", "seconds", "scores"}]}, or {"reason"}; empty when
/// the cell has no picture.
nlohmann::json cell_scores(const CellStore& store, const std::string& key);

/// {"noise", "bias"} of the group whose first finished cell this is; empty for a single seed.
nlohmann::json group_split(const CellStore& store, const std::string& first_key);

}  // namespace zonal
