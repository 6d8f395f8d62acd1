#pragma once
/// Scores of pictures, apart from rendering them: a new metric re-scores what is there.

#include <nlohmann/json.hpp>
#include <string>

#include "sweep/cell_store.h"
#include "sweep/sweep_file.h"

namespace zonal {

/// Every metric there is by name, linear ones first: {"rmse": 0.1, ..., "rmse_display": ...,
/// "reference_limited": false, "reference_floor": 0.002}. Numbers JSON cannot hold are null; PSNR of equal
/// pictures is "inf".
nlohmann::json score_image(const std::string& image, const std::string& reference);

/// Scores of all finished cells that have none yet, in parallel, kept beside their pictures. Returns how many
/// were made.
int score_cells(const SweepPlan& plan, const CellStore& store);

/// The scores of a cell: {"matching": {...}, "full": {...}, "curve": [{"passes", "seconds", "scores"}]};
/// empty when it has no picture.
nlohmann::json cell_scores(const CellStore& store, const std::string& key);

}  // namespace zonal
