#include "sweep/estimate.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "core/error.h"
#include "core/scene.h"
#include "sweep/cell_process.h"
#include "sweep/cell_work.h"
#include "sweep/process.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Seconds of one process and of each of its passes at the scene's size.
struct Cost {
  double process = 0, pass = 0;
};

/// The scene's size in pixels: the sweep's, else what its file says, else the default of scene files.
std::pair<int, int> size_of(const SweepScene& scene) {
  if (scene.width) return {scene.width, scene.height};
  const json file = read_record(scene.file).value_or(json());
  const auto place = json::json_pointer("/camera/resolution");
  if (file.is_object() && file.contains(place) && file[place].is_array() && file[place].size() == 2 &&
      file[place][0].is_number() && file[place][1].is_number())
    return {file[place][0], file[place][1]};
  const Camera camera;
  return {camera.width, camera.height};
}

class Probes {
 public:
  Probes(const SweepPlan& plan, const std::string& program, const std::atomic<bool>* stop)
      : plan_(plan), program_(program), stop_(stop) {
    std::string name = (fs::temp_directory_path() / "zonal-estimate-XXXXXX").string();
    if (!mkdtemp(name.data())) throw SceneError(name + ": could not be made");
    folder_ = name;
  }
  ~Probes() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  Probes(const Probes&) = delete;
  Probes& operator=(const Probes&) = delete;

  /// begin_pass costs the same at any size, radiance grows with the pixels. Measured once each.
  std::optional<Cost> cost(const Cell& cell, const SweepMethod& method) {
    const std::string key = fmt::format("{} {} {}", cell.scene, method.integrator, method.parameters.dump());
    const auto found = costs_.find(key);
    return found != costs_.end() ? found->second : costs_[key] = measure(cell, method);
  }

 private:
  std::optional<Cost> measure(const Cell& cell, const SweepMethod& method) {
    SweepPlan plan = plan_;
    plan.methods[cell.method] = method;
    const SweepScene& scene = plan.scenes[cell.scene];
    constexpr double kShrink = 4;  // each side
    CellRender what{
        .settings = method_settings(scene, method), .passes = 1, .stats = folder_ + "/stats.json"};
    const auto [width, height] = size_of(scene);
    what.width = std::max(16, static_cast<int>(std::lround(width / kShrink)));
    what.height = std::max(9, static_cast<int>(std::lround(height / kShrink)));
    const ProcessResult result = run_process(render_command(program_, plan, cell, what), stop_);
    const auto stats = result.ok() ? read_record(what.stats) : std::nullopt;
    if (!stats) return {};
    const double begin = (*stats)["seconds"]["begin_pass"], radiance = (*stats)["seconds"]["radiance"];
    const double pixels = double(width) * height / (double(what.width) * what.height);
    return Cost{std::max(0.0, result.seconds - begin - radiance), begin + radiance * pixels};
  }

  const SweepPlan& plan_;
  std::string program_, folder_;
  const std::atomic<bool>* stop_;
  std::map<std::string, std::optional<Cost>> costs_;
};

}  // namespace

Estimate estimate_time(const SweepPlan& plan, const std::string& program, const std::atomic<bool>* stop) {
  Probes probes(plan, program, stop);
  Estimate estimate;
  std::map<std::string, double> references;
  for (const Cell& cell : plan.cells) {
    if (stop && stop->load()) break;
    const CellBudget& budget = plan.budgets[cell.budget];
    const auto cost = probes.cost(cell, plan.methods[cell.method]);
    for (const ReferenceRequest& request : cell_references(plan, cell)) {
      if (!references.try_emplace(reference_key(request), 0).second) continue;
      SweepMethod path = plan.methods[cell.method];
      path.integrator = request.integrator, path.set = path.parameters = request.settings;
      const auto one = probes.cost(cell, path);
      estimate.seconds += (one ? one->process : 0) + request.seconds + (one ? request.passes * one->pass : 0);
    }
    if (!cost || budget.kind == CellBudget::equal_error) {
      ++estimate.untold;
      continue;
    }
    if (budget.kind == CellBudget::passes)
      estimate.seconds += plan.runs * (cost->process + budget.value * cost->pass);
    else if (budget.kind == CellBudget::seconds)
      estimate.seconds += cost->process + budget.value;
    else
      estimate.seconds +=
          (plan.runs + double(budget.most_runs) / plan.seeds.size()) * (cost->process + budget.value);
  }
  return estimate;
}

}  // namespace zonal
