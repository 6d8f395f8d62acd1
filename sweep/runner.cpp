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
#include "core/image.h"
#include "core/progress.h"
#include "core/stop.h"
#include "sweep/cell_process.h"
#include "sweep/process.h"
#include "sweep/score.h"
#include "sweep/search.h"
#include "sweep/statistics.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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
    // A cell's runs are spread over the sweep, a round of all cells for each: what slows the machine down for
    // a while slows one run of each down, not all runs of one. Each round is shuffled, the same way each time
    // the sweep is resumed.
    std::mt19937 random(12345);
    for (const Cell* cell : cells_) run_cell(*cell, -1);  // runs none: sees which are finished
    cells_start_ = Clock::now();
    for (round_ = 0; round_ < plan_.runs; ++round_) {
      std::shuffle(cells_.begin(), cells_.end(), random);
      for (place_ = 0; place_ < cells_.size() && !stopped(); ++place_) {
        run_cell(*cells_[place_], round_);
        if (round_ > 0 || place_ >= 10) baseline();
      }
    }
    summary_.left = static_cast<int>(cells_.size() - ended_.size());
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

  void make_folder(const std::string& folder) const {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
      refuse_full_disk(error.message());
      throw SceneError(fmt::format("{}: could not be made: {}", folder, error.message()));
    }
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
      if (stopped()) return;
      std::error_code error;
      fs::remove(failure_file(store_, key), error);
      if (reference_is_current(file, request)) continue;
      say(fmt::format("reference {} of {}", i, wanted.size()));
      const ProcessResult result =
          run_process(reference_command(options_.program, plan_, scene, request, file), options_.stop);
      summary_.child_seconds += result.seconds;
      if (result.ok() || result.interrupted) continue;
      refuse_full_disk(result.reason());
      // Its cells become rows that say so; the next call tries again.
      write_record(failure_file(store_, key), {{"reason", "the reference failed: " + result.reason()}});
    }
  }

  // ---- one rendering process ---------------------------------------------------------------------------

  /// The process's --stats, or the reason there are none.
  std::optional<json> render(const Cell& cell, CellRender what, const std::string& stats, std::string* reason,
                             bool of_a_cell = true) {
    what.stats = stats;
    const ProcessResult result =
        run_process(render_command(options_.program, plan_, cell, what), options_.stop);
    if (of_a_cell) summary_.child_seconds += result.seconds;
    if (result.interrupted) return {};
    if (!result.ok()) {
      *reason = result.reason();
      refuse_full_disk(*reason);
      return {};
    }
    auto record = read_record(stats);
    if (!record) *reason = "the process left no statistics";
    return record;
  }

  /// A cell is not to blame for it: nothing is recorded, and the sweep ends.
  void refuse_full_disk(const std::string& reason) const {
    if (tells_of_full_disk(reason))
      throw SceneError(
          fmt::format("{}: no room is left ({}); what is finished is kept, and the same command goes on",
                      store_.folder(), reason));
  }

  /// The first process of a method pays for cold caches and for materials projected once: its time, that of a
  /// small picture, is thrown away.
  void warm_up(const Cell& cell, const json& settings, const std::string& folder) {
    if (!warm_.insert({cell.scene, cell.method}).second) return;
    std::string unused;
    render(cell, {.settings = settings, .passes = 1, .width = 32, .height = 18}, folder + "/warm-up.json",
           &unused, false);
    std::error_code error;
    fs::remove(folder + "/warm-up.json", error);
  }

  // ---- searches ----------------------------------------------------------------------------------------

  void search(const Cell& cell) {
    const CellBudget& budget = plan_.budgets[cell.budget];
    if (budget.kind < CellBudget::equal_time) return;
    const std::string key = search_key(plan_, cell);
    if (const auto found = store_.search(key))
      if (!options_.retry || (*found)["count"].get<int>() > 0) return;
    say("searching: " + cell_name(plan_, cell));
    const SweepMethod& method = plan_.methods[cell.method];
    const std::string parameter = search_parameter(method, budget);
    const std::string folder = store_.cell_folder(key);
    make_folder(folder);
    std::string reason;
    const bool by_time = budget.kind == CellBudget::equal_time;
    const json settings = method_settings(plan_.scenes[cell.scene], method);
    warm_up(cell, settings, folder);
    std::optional<Scorer> scorer;
    const auto measure = [&](int count) {
      CellRender what{.settings = settings, .passes = 1};
      if (parameter == "passes")
        what.passes = count;
      else
        what.settings[parameter] = count;
      if (!by_time) what.image = folder + "/search.exr";
      const auto stats = render(cell, what, folder + "/search.json", &reason);
      if (!stats) return std::nan("");
      if (by_time) return clocked(*stats);
      if (!scorer)
        scorer.emplace(store_.reference_file(reference_key(cell_references(plan_, cell)[0])),
                       budget.metric == "flip_hdr");
      const json score = scorer->score(read_image(what.image).layers.at(""))[budget.metric];
      return score.is_number() ? score.get<double>() : std::nan("");
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

  /// A budget in seconds is its own time; fixed work is timed several times.
  int runs_wanted(const Cell& cell) const {
    return plan_.budgets[cell.budget].kind == CellBudget::seconds ? 1 : plan_.runs;
  }

  int runs_left() const {
    int left = 0;
    for (size_t i = 0; i < cells_.size(); ++i)
      if (!ended_.count(cells_[i])) left += std::max(0, runs_wanted(*cells_[i]) - round_ - (i < place_));
    return left;
  }

  /// Run number `round` of the cell, where it is not there yet.
  void run_cell(const Cell& cell, int round) {
    if (ended_.count(&cell)) return;
    const auto end = [&](int& count) {
      ended_.insert(&cell);
      ++count;
    };
    const std::optional<CellWork> work = has_references(cell) ? cell_work(plan_, store_, cell) : std::nullopt;
    if (!work) return end(summary_.failed);
    auto record = store_.cell(work->key);
    if (record && (*record)["status"] == "failed") {
      if (!options_.retry) return end(summary_.failed);
      record.reset();
    }
    if (!record) record = {{"key", work->key}, {"status", "done"}, {"reason", ""}, {"search", work->search}};
    std::vector<double> runs = record->value("runs", std::vector<double>());
    if (static_cast<int>(runs.size()) <= round) {
      if (!run_once(cell, *work, *record, runs)) return;
      store_.write_cell(work->key, *record);
      if ((*record)["status"] == "failed") return end(summary_.failed);
      ++runs_made_, touched_.insert(&cell);
    }
    if (static_cast<int>(runs.size()) >= runs_wanted(cell))
      end(touched_.count(&cell) ? summary_.done : summary_.kept);
  }

  /// Renders the cell and adds its time, or the reason why there is none; false when stopped meanwhile. The
  /// first run's picture and statistics are the cell's.
  bool run_once(const Cell& cell, const CellWork& work, json& record, std::vector<double>& runs) {
    say(cell_name(plan_, cell));
    const std::string folder = store_.cell_folder(work.key);
    make_folder(folder);
    // Loading is not part of a budget in seconds.
    if (work.seconds == 0) warm_up(cell, work.settings, folder);
    const bool first = runs.empty();
    CellRender what{.settings = work.settings, .passes = work.passes, .seconds = work.seconds};
    if (first) what.image = folder + "/image.exr";
    if (first && plan_.curve) what.snapshots = folder + "/snapshot";
    std::string reason;
    const auto stats = render(cell, what, folder + "/stats.json", &reason);
    if (stopped()) return false;
    if (stats) {
      runs.push_back(clocked(*stats));
      if (first) record["stats"] = *stats;
      record["time"] = median(runs);
    } else {
      record["status"] = "failed", record["reason"] = reason;
    }
    record["runs"] = runs;
    return true;
  }

  /// The cheapest of the first ten cells again, for at most a hundredth of the time: what has become of the
  /// machine's speed.
  void baseline() {
    if (stopped()) return;
    if (!baseline_) choose_baseline();
    if (!baseline_ || seconds_since(last_baseline_) < 100 * baseline_seconds_) return;
    last_baseline_ = Clock::now();
    const auto work = cell_work(plan_, store_, *baseline_);
    std::string reason;
    const auto stats = render(*baseline_, {.settings = work->settings, .passes = work->passes},
                              store_.folder() + "/baseline-stats.json", &reason, false);
    baseline_seconds_ = seconds_since(last_baseline_);
    std::error_code error;
    fs::remove(store_.folder() + "/baseline-stats.json", error);
    if (!stats) return;
    json drift = read_record(store_.folder() + "/drift.json").value_or(json::array());
    drift.push_back({{"after", runs_made_},
                     {"ratio", clocked(*stats) / (*store_.cell(work->key))["time"].get<double>()}});
    write_record(store_.folder() + "/drift.json", drift);
  }

  void choose_baseline() {
    double least = 0;
    for (size_t i = 0; i < cells_.size() && i < 10; ++i) {
      const auto work = cell_work(plan_, store_, *cells_[i]);
      const auto record = work && work->seconds == 0 ? store_.cell(work->key) : std::nullopt;
      if (!record || !record->contains("time")) continue;
      const double time = (*record)["time"];
      if (!baseline_ || time < least) baseline_ = cells_[i], least = time;
    }
    baseline_seconds_ = least;
  }

  // ---- what the user sees --------------------------------------------------------------------------------

  void say(const std::string& what) {
    if (options_.quiet) return;
    int all = 0;
    for (const Cell* cell : cells_) all += runs_wanted(*cell);
    const int left = runs_left();
    std::string time;
    if (runs_made_ > 0)
      time = fmt::format(", about {} left", duration_text(seconds_since(cells_start_) / runs_made_ * left));
    clear_line();
    fmt::print(stderr, "{}/{} runs{}: {}{}", all - left, all, time, what, terminal_ ? "" : "\n");
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
  int round_ = 0;
  size_t place_ = 0;  ///< in cells_
  int runs_made_ = 0;
  std::set<const Cell*> touched_, ended_;  ///< run here; done, kept or failed
  std::set<std::pair<int, int>> warm_;
  const Cell* baseline_ = nullptr;
  double baseline_seconds_ = 0;  ///< of its process
  Clock::time_point last_baseline_ = Clock::now();
  RunSummary summary_;
};

}  // namespace

RunSummary run_cells(const SweepPlan& plan, const CellStore& store, const RunnerOptions& options) {
  return Runner(plan, store, options).run();
}

}  // namespace zonal
