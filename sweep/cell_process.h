#pragma once
/// Command lines of a sweep's processes: `zonal render` for a cell, `zonal reference` for what it is scored
/// against.
///
///     run_process(render_command(own_program(), plan, cell, {.settings = work.settings, .passes = 4}),
///     &stop);

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sweep/sweep_file.h"

namespace zonal {

struct CellRender {
  nlohmann::json settings = nlohmann::json::object();
  int passes = 0;
  double seconds = 0;
  std::string repeat;                   ///< instead of the two: what --stats says makes the picture again
  std::string image, snapshots, stats;  ///< files; empty: none wanted
  int width = 0, height = 0;            ///< 0: the cell's own
};

std::vector<std::string> render_command(const std::string& program, const SweepPlan& plan, const Cell& cell,
                                        const CellRender& what);

/// Of a scene of the plan, into `file`.
std::vector<std::string> reference_command(const std::string& program, const SweepPlan& plan, int scene,
                                           const ReferenceRequest& request, const std::string& file);

/// Seconds that count: begin_pass and radiance of a process's --stats.
double clocked(const nlohmann::json& stats);

/// What a process that failed, or an error, says of a disk without room.
bool tells_of_full_disk(const std::string& reason);

}  // namespace zonal
