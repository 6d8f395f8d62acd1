#include "sweep/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "core/error.h"
#include "core/image.h"
#include "sweep/cell_process.h"
#include "sweep/process.h"

namespace zonal {
namespace {

/// The radiance bit for bit, NaNs too.
bool same_bits(const std::string& file_a, const std::string& file_b) {
  const ImageFile a = read_image(file_a), b = read_image(file_b);
  const std::vector<float>&x = a.layers.at("").pixels, &y = b.layers.at("").pixels;
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
}

}  // namespace

ReplaySummary replay_cells(const SweepPlan& plan, const CellStore& store, const RunnerOptions& options) {
  ReplaySummary summary;
  const std::string again = store.folder() + "/replay.exr";
  for (const Cell& cell : plan.cells) {
    const std::string name = cell_name(plan, cell);
    if (name.find(options.only) == std::string::npos) continue;
    const auto work = cell_work(plan, store, cell);
    const auto record = work ? store.cell(work->key) : std::nullopt;
    if (!record || (*record)["status"] != "done") continue;
    const ProcessResult result = run_process(
        render_command(options.program, plan, cell,
                       {.settings = work->settings, .repeat = (*record)["stats"]["repeat"], .image = again}),
        options.stop);
    summary.interrupted = result.interrupted;
    if (result.interrupted) break;
    const bool same = result.ok() && same_bits(again, store.cell_folder(work->key) + "/image.exr");
    ++(same ? summary.same : summary.different);
    if (!same) summary.names.push_back(name + (result.ok() ? "" : ": " + result.reason()));
    if (!options.quiet) fmt::print("{}: {}\n", name, same ? "the same" : "DIFFERENT");
  }
  std::error_code error;
  std::filesystem::remove(again, error);
  if (summary.same + summary.different == 0 && !summary.interrupted)
    throw SceneError(
        fmt::format("{}: no finished cell to replay{}", store.folder(),
                    options.only.empty() ? "" : fmt::format(" with \"{}\" in its name", options.only)));
  return summary;
}

}  // namespace zonal
