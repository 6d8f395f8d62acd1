#include "sweep/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <random>
#include <set>

#include <unistd.h>

#include "core/error.h"
#include "core/progress.h"
#include "core/stop.h"
#include "sweep/process.h"
#include "sweep/score.h"
#include "sweep/search.h"
#include "sweep/statistics.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string value_text(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

const char* pixels_name(RenderOptions::Pixels pixels) {
  switch (pixels) {
    case RenderOptions::Pixels::center:
      return "center";
    case RenderOptions::Pixels::jitter:
      return "jitter";
    default:
      return "automatic";
  }
}

/// One process's worth of rendering.
struct Render {
  json settings;
  int passes = 0;
  double seconds = 0;
  std::string image, snapshots;  ///< empty: none wanted
};

class Runner {
 public:
  Runner(const SweepPlan& plan, const CellStore& store, const RunnerOptions& options)
      : plan_(plan), store_(store), options_(options) {}

  RunSummary run() {
    const auto start = Clock::now();
    choose();
    make_references();
    for (const Cell* cell : cells_)
      if (!stopped() && has_references(*cell)) search(*cell);
    // Shuffled, so that a machine that slows down slows all methods alike; the same order each time the sweep
    // is resumed.
    std::mt19937 random(12345);
    std::shuffle(cells_.begin(), cells_.end(), random);
    cells_start_ = Clock::now();
    for (size_t i = 0; i < cells_.size() && !stopped(); ++i) {
      run_cell(*cells_[i]);
      if (i % 10 == 9) baseline();
    }
    summary_.left = static_cast<int>(cells_.size()) - summary_.done - summary_.kept - summary_.failed;
    summary_.seconds = seconds_since(start);
    summary_.interrupted = stopped();
    clear_line();
    return summary_;
  }

 private:
  bool stopped() const { return options_.stop && options_.stop->load(); }

  void choose() {
    for (const Cell& cell : plan_.cells)
      if (options_.only.empty() || cell_name(plan_, cell).find(options_.only) != std::string::npos)
        cells_.push_back(&cell);
    if (cells_.empty())
      throw SceneError(
          fmt::format("--only: no cell's name contains \"{}\"; --dry-run prints the names", options_.only));
  }

  ProcessResult run(const std::vector<std::string>& command) {
    const ProcessResult result = run_process(command, options_.stop);
    summary_.child_seconds += result.seconds;
    return result;
  }

  std::vector<std::string> scene_arguments(const SweepScene& scene) const {
    std::vector<std::string> arguments;
    if (scene.frame) arguments.insert(arguments.end(), {"--frame", std::to_string(scene.frame)});
    if (scene.width)
      arguments.insert(arguments.end(), {"--size", fmt::format("{}x{}", scene.width, scene.height)});
    if (plan_.threads) arguments.insert(arguments.end(), {"--threads", std::to_string(plan_.threads)});
    for (const auto& [name, value] : scene.materials.items())
      arguments.insert(arguments.end(), {"--material", name + "=" + value_text(value)});
    return arguments;
  }

  // ---- references ------------------------------------------------------------------------------------

  void make_references() {
    std::map<std::string, std::pair<ReferenceRequest, int>> wanted;
    for (const Cell* cell : cells_)
      for (const ReferenceRequest& request : cell_references(plan_, *cell))
        wanted.try_emplace(reference_key(request), request, cell->scene);
    int i = 0;
    for (const auto& [key, entry] : wanted) {
      const auto& [request, scene] = entry;
      const std::string file = store_.reference_file(key);
      ++i;
      if (stopped() || reference_is_current(file, request)) continue;
      say(fmt::format("reference {} of {}", i, wanted.size()));
      std::vector<std::string> command{options_.program,
                                       "reference",
                                       request.scene_file,
                                       "--integrator",
                                       request.integrator,
                                       "--pixels",
                                       pixels_name(request.pixels),
                                       "-o",
                                       file,
                                       "--quiet"};
      if (request.passes)
        command.insert(command.end(), {"--passes", std::to_string(request.passes)});
      else
        command.insert(command.end(), {"--time", fmt::format("{:g}", request.seconds)});
      for (const auto& [name, value] : request.settings.items())
        command.insert(command.end(), {"--set", name + "=" + value_text(value)});
      const auto more = scene_arguments(plan_.scenes[scene]);
      command.insert(command.end(), more.begin(), more.end());
      const ProcessResult result = run(command);
      std::error_code error;
      fs::remove(failure_file(store_, key), error);
      // Its cells become rows that say so; the next call tries again.
      if (!result.ok() && !result.interrupted)
        write_record(failure_file(store_, key), {{"reason", "the reference failed: " + result.reason()}});
    }
  }

  // ---- one rendering process ---------------------------------------------------------------------------

  /// The process's --stats, or the reason there are none.
  std::optional<json> render(const Cell& cell, const Render& what, const std::string& stats,
                             std::string* reason) {
    const SweepScene& scene = plan_.scenes[cell.scene];
    std::vector<std::string> command{options_.program,
                                     "render",
                                     scene.file,
                                     "--integrator",
                                     plan_.methods[cell.method].integrator,
                                     "--seed",
                                     std::to_string(cell.seed),
                                     "--pixels",
                                     pixels_name(plan_.pixels),
                                     "--stats",
                                     stats,
                                     "--pin",
                                     "--quiet"};
    if (what.seconds > 0)
      command.insert(command.end(), {"--time", fmt::format("{:g}", what.seconds)});
    else
      command.insert(command.end(), {"--passes", std::to_string(what.passes)});
    for (const auto& [name, value] : what.settings.items())
      command.insert(command.end(), {"--set", name + "=" + value_text(value)});
    command.insert(command.end(), {"-o", what.image.empty() ? "none" : what.image});
    if (!what.snapshots.empty()) command.insert(command.end(), {"--snapshots", what.snapshots});
    if (cell.backend != "cpu") command.insert(command.end(), {"--backend", cell.backend});
    const auto more = scene_arguments(scene);
    command.insert(command.end(), more.begin(), more.end());
    const ProcessResult result = run(command);
    if (result.interrupted) return {};
    if (!result.ok()) {
      *reason = result.reason();
      return {};
    }
    auto record = read_record(stats);
    if (!record) *reason = "the process left no statistics";
    return record;
  }

  static double clocked(const json& stats) {
    return stats["seconds"]["begin_pass"].get<double>() + stats["seconds"]["radiance"].get<double>();
  }

  /// The first process of a method pays for cold caches and for materials projected once: its time is thrown
  /// away.
  void warm_up(const Cell& cell, const CellWork& work, const std::string& folder) {
    if (!warm_.insert({cell.scene, cell.method}).second) return;
    std::string unused;
    render(cell, {.settings = work.settings, .passes = 1}, folder + "/warm-up.json", &unused);
    std::error_code error;
    fs::remove(folder + "/warm-up.json", error);
  }

  // ---- searches ----------------------------------------------------------------------------------------

  void search(const Cell& cell) {
    const CellBudget& budget = plan_.budgets[cell.budget];
    if (budget.kind < CellBudget::equal_time) return;
    const std::string key = search_key(plan_, cell);
    if (store_.search(key)) return;
    say("searching: " + cell_name(plan_, cell));
    const SweepMethod& method = plan_.methods[cell.method];
    const std::string parameter = search_parameter(method, budget);
    const std::string folder = store_.cell_folder(key);
    fs::create_directories(folder);
    std::string reason;
    const bool by_time = budget.kind == CellBudget::equal_time;
    CellWork first{.settings = method.set};
    warm_up(cell, first, folder);
    const auto measure = [&](int count) {
      Render what{.settings = method.set, .passes = 1};
      if (parameter == "passes")
        what.passes = count;
      else
        what.settings[parameter] = count;
      if (!by_time) what.image = folder + "/search.exr";
      const auto stats = render(cell, what, folder + "/search.json", &reason);
      if (!stats) return std::nan("");
      if (by_time) return clocked(*stats);
      return score_image(what.image,
                         store_.reference_file(reference_key(cell_references(plan_, cell)[0])))[budget.metric]
          .get<double>();
    };
    SearchOptions how{.most_runs = budget.most_runs};
    how.first = parameter == "passes" ? 4 : std::max(1, method.parameters[parameter].get<int>());
    how.slope = by_time ? 1 : -0.5;
    const SearchResult found = search_count(measure, budget.value, how);
    std::error_code error;
    fs::remove_all(folder, error);
    if (stopped()) return;
    json runs = json::array();
    for (const auto& one : found.runs) runs.push_back({{"count", one.count}, {"value", one.value}});
    store_.write_search(key, {{"kind", by_time ? "equal_time" : "equal_error"},
                              {"parameter", parameter},
                              {"target", budget.value},
                              {"count", found.count},
                              {"reached", found.value},
                              {"within_tolerance", found.reached},
                              {"runs", runs},
                              {"reason", reason}});
  }

  // ---- cells -------------------------------------------------------------------------------------------

  bool has_references(const Cell& cell) const {
    for (const ReferenceRequest& request : cell_references(plan_, cell))
      if (reference_failure(store_, reference_key(request))) return false;
    return true;
  }

  void run_cell(const Cell& cell) {
    if (!has_references(cell)) {
      ++summary_.failed;
      return;
    }
    const std::optional<CellWork> work = cell_work(plan_, store_, cell);
    if (!work) {
      ++summary_.failed;
      return;
    }
    if (const auto record = store_.cell(work->key)) {
      const bool failed = (*record)["status"] == "failed";
      if (!failed || !options_.retry) {
        ++(failed ? summary_.failed : summary_.kept);
        return;
      }
    }
    say(cell_name(plan_, cell));
    const std::string folder = store_.cell_folder(work->key);
    fs::create_directories(folder);
    warm_up(cell, *work, folder);
    json record{{"key", work->key}, {"status", "done"}, {"reason", ""}, {"search", work->search}};
    Render what{.settings = work->settings, .passes = work->passes, .seconds = work->seconds};
    std::vector<double> runs;
    // A budget in seconds is its own time; fixed work is timed several times.
    const int wanted = work->seconds > 0 ? 1 : plan_.runs;
    for (int i = 0; i < wanted && !stopped(); ++i) {
      what.image = i == 0 ? folder + "/image.exr" : "";
      what.snapshots = i == 0 && plan_.curve ? folder + "/snapshot" : "";
      std::string reason;
      const auto stats = render(cell, what, folder + "/stats.json", &reason);
      if (stopped()) break;
      if (!stats) {
        record["status"] = "failed", record["reason"] = reason;
        break;
      }
      runs.push_back(clocked(*stats));
      if (i == 0) record["stats"] = *stats;
    }
    if (stopped()) return;
    record["runs"] = runs;
    if (record["status"] == "done") record["time"] = median(runs);
    store_.write_cell(work->key, record);
    ++(record["status"] == "done" ? summary_.done : summary_.failed);
  }

  /// The first cell again: what the machine's speed has become of.
  void baseline() {
    const auto work = cell_work(plan_, store_, *cells_[0]);
    if (!work || stopped()) return;
    std::string reason;
    const auto stats =
        render(*cells_[0], {.settings = work->settings, .passes = work->passes, .seconds = work->seconds},
               store_.folder() + "/baseline-stats.json", &reason);
    const auto first = store_.cell(work->key);
    if (!stats || !first || !first->contains("time") || work->seconds > 0) return;
    json drift = read_record(store_.folder() + "/drift.json").value_or(json::array());
    drift.push_back({{"after", summary_.done + summary_.kept},
                     {"ratio", clocked(*stats) / (*first)["time"].get<double>()}});
    write_record(store_.folder() + "/drift.json", drift);
  }

  // ---- what the user sees --------------------------------------------------------------------------------

  void say(const std::string& what) {
    if (options_.quiet) return;
    const int gone = summary_.done + summary_.kept + summary_.failed, all = static_cast<int>(cells_.size());
    std::string left;
    if (summary_.done > 0) {
      const double each = seconds_since(cells_start_) / summary_.done;
      left = fmt::format(", about {} left", duration_text(each * (all - gone)));
    }
    clear_line();
    fmt::print(stderr, "{}/{}{}: {}{}", gone, all, left, what, terminal_ ? "" : "\n");
    std::fflush(stderr);
  }
  void clear_line() {
    if (terminal_ && !options_.quiet) fmt::print(stderr, "\r\x1b[K");
  }

  const SweepPlan& plan_;
  const CellStore& store_;
  const RunnerOptions& options_;
  const bool terminal_ = isatty(2) != 0;
  Clock::time_point cells_start_ = Clock::now();
  std::vector<const Cell*> cells_;
  std::set<std::pair<int, int>> warm_;
  RunSummary summary_;
};

}  // namespace

RunSummary run_cells(const SweepPlan& plan, const CellStore& store, const RunnerOptions& options) {
  return Runner(plan, store, options).run();
}

}  // namespace zonal
