#include "sweep/results.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <map>

#include "core/machine.h"
#include "core/metrics.h"
#include "sweep/cell_process.h"
#include "sweep/cell_work.h"
#include "sweep/digest.h"
#include "sweep/statistics.h"

namespace zonal {
namespace {

using nlohmann::json;

json cell_json(const SweepPlan& plan, const CellStore& store, const Cell& cell) {
  const SweepMethod& method = plan.methods[cell.method];
  const CellBudget& budget = plan.budgets[cell.budget];
  json out = {{"scene", plan.scenes[cell.scene].id},
              {"method", method.id},
              {"backend", cell.backend},
              {"seed", cell.seed},
              {"group", cell.group},
              {"budget", budget.text()},
              {"varied", method.varied},
              {"parameters", method.parameters},
              {"status", "missing"},
              {"reason", "not run yet"},
              {"image", nullptr},
              {"scores", json::object()},
              {"time", nullptr},
              {"search", nullptr}};
  out["id"] = cell_key(plan, cell, method.parameters, budget);
  out["reference"] = reference_key(cell_references(plan, cell)[0]);
  for (const ReferenceRequest& request : cell_references(plan, cell))
    if (const auto failure = reference_failure(store, reference_key(request))) {
      out["status"] = "failed", out["reason"] = *failure;
      return out;
    }
  const auto work = cell_work(plan, store, cell);
  if (!work) {
    const auto search = store.search(search_key(plan, cell));
    if (search)
      out["status"] = "failed", out["reason"] = "the search found nothing: " + search->value("reason", "");
    return out;
  }
  out["id"] = work->key;
  if (!work->search.is_null()) {
    const json& s = work->search;
    out["search"] = {{"kind", s["kind"]},   {"parameter", s["parameter"]}, {"target", s["target"]},
                     {"count", s["count"]}, {"reached", s["reached"]},     {"runs", s["runs"].size()}};
    out["varied"][s["parameter"].get<std::string>()] = s["count"];
  }
  const auto record = store.cell(work->key);
  if (!record) return out;
  out["status"] = (*record)["status"], out["reason"] = (*record)["reason"];
  if (out["status"] != "done") return out;
  const json scores = cell_scores(store, work->key);
  if (scores.contains("reason")) {
    out["status"] = "failed", out["reason"] = scores["reason"];
    return out;
  }
  const json& stats = (*record)["stats"];
  out["parameters"] = stats["parameters"], out["passes"] = stats["passes"], out["seconds"] = stats["seconds"];
  out["counters"] = stats["counters"], out["repeat"] = stats["repeat"],
  out["peak_memory_bytes"] = stats["peak_memory_bytes"];
  out["runs"] = (*record)["runs"], out["time"] = (*record)["time"];
  out["image"] = "images/" + work->key + ".js";
  if (!work->search.is_null() && !work->search["within_tolerance"].get<bool>()) {
    out["status"] = "not_reached";
    out["reason"] = fmt::format("nearest: {} {}", work->search["count"].get<int>(),
                                work->search["parameter"].get<std::string>());
  }
  if (scores.contains("matching")) out["scores"] = scores["matching"];
  if (scores.contains("full")) out["scores_full"] = scores["full"];
  if (scores.contains("curve") && !scores["curve"].empty()) out["curve"] = scores["curve"];
  out["reference_limited"] = out["scores"].value("reference_limited", false);
  return out;
}

/// The seeds' times, which stand apart in the shuffled order and so hold the machine's drift; of fewer than
/// three seeds, which tell no scatter, those of all runs.
std::vector<double> times_of(const std::vector<const json*>& cells) {
  std::vector<double> times;
  for (const json* cell : cells) {
    if (cells.size() >= 3)
      times.push_back((*cell)["time"]);
    else
      for (const json& run : (*cell)["runs"]) times.push_back(run);
  }
  return times;
}

/// The fastest run of each seed: the work is the same each time, and what else the machine does only adds to
/// it. Of fewer than three seeds, all runs.
std::vector<double> undisturbed(const std::vector<const json*>& cells) {
  if (cells.size() < 3) return times_of(cells);
  std::vector<double> times;
  for (const json* cell : cells) {
    const auto runs = (*cell)["runs"].get<std::vector<double>>();
    times.push_back(*std::min_element(runs.begin(), runs.end()));
  }
  return times;
}

/// Each group's time over that of the first method on the same scene, budget and backend.
void add_time_ratios(const std::vector<json>& cells, std::vector<json>* groups) {
  std::vector<std::vector<const json*>> timed(groups->size());
  for (const json& cell : cells)
    if (!cell["time"].is_null()) timed[cell["group"].get<size_t>()].push_back(&cell);
  for (size_t g = 0; g < groups->size(); ++g) {
    json& group = (*groups)[g];
    group["time_ratio"] = nullptr;
    for (size_t first = 0; first < g && !timed[g].empty(); ++first) {
      const json& other = (*groups)[first];
      if (timed[first].empty() || other["scene"] != group["scene"] || other["budget"] != group["budget"] ||
          other["backend"] != group["backend"])
        continue;
      const Interval ratio = ratio_interval(undisturbed(timed[g]), undisturbed(timed[first]));
      group["time_ratio"] = {
          {"mean", ratio.mean}, {"low", ratio.low}, {"high", ratio.high}, {"to", other["method"]}};
      break;
    }
  }
}

json group_json(const SweepPlan& plan, const CellStore& store, const std::vector<const json*>& cells) {
  const json& first = *cells[0];
  json group = {{"id", first["group"]},      {"scene", first["scene"]},
                {"method", first["method"]}, {"backend", first["backend"]},
                {"budget", first["budget"]}, {"varied", first["varied"]},
                {"cells", json::array()},    {"failed", 0},
                {"time", nullptr},           {"scores", json::object()},
                {"noise", nullptr},          {"bias", nullptr},
                {"reference_limited", false}};
  std::vector<const json*> done;
  for (const json* cell : cells) {
    group["cells"].push_back((*cell)["id"]);
    if ((*cell)["status"] == "failed") group["failed"] = group["failed"].get<int>() + 1;
    if ((*cell)["time"].is_null()) continue;
    done.push_back(cell);
  }
  if (done.empty()) return group;
  const std::vector<double> times = times_of(done);
  const Interval time = student_interval(times);
  group["time"] = {{"mean", time.mean},
                   {"median", median(times)},
                   {"low", time.low},
                   {"high", time.high},
                   {"samples", times.size()}};
  for (const json* cell : done)
    group["time"]["runs"] = group["time"].value("runs", 0) + (*cell)["runs"].size();
  for (const json& metric : result_metrics(plan)) {
    const std::string name = metric["name"];
    std::vector<double> values;
    for (const json* cell : done)
      if ((*cell)["scores"].contains(name) && (*cell)["scores"][name].is_number())
        values.push_back((*cell)["scores"][name]);
    if (values.empty()) continue;
    const Interval interval = student_interval(values);
    const bool lower = metric["better"] == "lower";
    group["scores"][name] = {{"mean", interval.mean},
                             {"low", interval.low},
                             {"high", interval.high},
                             {"worst", lower ? *std::max_element(values.begin(), values.end())
                                             : *std::min_element(values.begin(), values.end())},
                             {"seeds", values.size()}};
  }
  group["reference_limited"] = std::all_of(
      done.begin(), done.end(), [](const json* cell) { return cell->value("reference_limited", false); });
  const json split = group_split(store, (*done[0])["id"]);
  if (split.contains("noise")) group["noise"] = split["noise"], group["bias"] = split["bias"];
  return group;
}

/// A reference's settings of `path` in words.
std::string transport_text(const json& settings) {
  const int most = settings.value("max_bounces", -1), fewest = settings.value("min_bounces", 0);
  std::string text = most < 0    ? "all bounces"
                     : most == 0 ? "direct light"
                                 : fmt::format("up to {} {}", most, most == 1 ? "bounce" : "bounces");
  if (fewest == 1 && most != 0) text += ", no direct light";
  if (fewest > 1) text += fmt::format(", from bounce {} on", fewest);
  if (settings.value("occlusion", "") == "none") text += ", nothing blocks indirect light";
  if (settings.value("direct_occlusion", "") == "none") text += ", nothing blocks direct light";
  return text;
}

json references_json(const SweepPlan& plan, const CellStore& store, const json& cells) {
  std::map<std::string, json> found;
  for (size_t i = 0; i < plan.cells.size(); ++i) {
    const auto requests = cell_references(plan, plan.cells[i]);
    for (size_t k = 0; k < requests.size(); ++k) {
      const std::string key = reference_key(requests[k]);
      if (found.count(key)) continue;
      const auto record = read_record(record_file(store.reference_file(key)));
      if (!record) continue;
      json floor = json::object();
      for (const json& cell : cells)
        if (cell["reference"] == key && cell["scores"].contains("reference_floor"))
          floor["rmse"] = cell["scores"]["reference_floor"];
      found[key] = {{"id", key},
                    {"scene", plan.scenes[plan.cells[i].scene].id},
                    {"integrator", requests[k].integrator},
                    {"transport", transport_text(requests[k].settings)},
                    {"parameters", requests[k].settings},
                    {"passes", (*record)["passes"][0].get<int>() + (*record)["passes"][1].get<int>()},
                    {"seeds", (*record)["seeds"]},
                    {"seconds", clocked(*record)},
                    {"record", *record},
                    {"floor", floor},
                    {"image", "images/" + key + ".js"}};
    }
  }
  json list = json::array();
  for (auto& [key, value] : found) list.push_back(std::move(value));
  return list;
}

/// A scene's name as one of a file: without what a path or an address might read otherwise.
std::string file_name(std::string id, size_t index) {
  bool changed = false;
  for (char& c : id)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && c != '.')
      c = '-', changed = true;
  return changed ? fmt::format("{}-{}", index, id) : id;
}

json scenes_json(const SweepPlan& plan, const CellStore& store) {
  json list = json::array();
  for (size_t s = 0; s < plan.scenes.size(); ++s) {
    json scene = {{"id", plan.scenes[s].id},
                  {"name", plan.scenes[s].id},
                  {"file", plan.scenes[s].file},
                  {"frame", plan.scenes[s].frame},
                  {"width", plan.scenes[s].width},
                  {"height", plan.scenes[s].height},
                  {"exposure", 1.0},
                  {"chart", fmt::format("charts/{}.svg", file_name(plan.scenes[s].id, s))}};
    for (const Cell& cell : plan.cells) {
      if (cell.scene != static_cast<int>(s)) continue;
      const auto record =
          read_record(record_file(store.reference_file(reference_key(cell_references(plan, cell)[0]))));
      if (!record) continue;
      scene["width"] = (*record)["resolution"][0], scene["height"] = (*record)["resolution"][1];
      scene["exposure"] = (*record)["exposure"];
      break;
    }
    list.push_back(scene);
  }
  return list;
}

}  // namespace

json result_metrics(const SweepPlan& plan) {
  json list = json::array();
  std::vector<std::string> seen;
  // The metrics the sweep file names come first, in its order.
  const auto add = [&](const MetricInfo& info) {
    const std::string name = info.values == "display" && (info.name == "rmse" || info.name == "mae")
                                 ? info.name + "_display"
                                 : info.name;
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) return;
    seen.push_back(name);
    // Too costly to be made unasked.
    if (name == "flip_hdr" && std::find(plan.metrics.begin(), plan.metrics.end(), name) == plan.metrics.end())
      return;
    const bool higher = info.name == "psnr" || info.name == "ssim";
    list.push_back(
        {{"name", name},
         {"values", info.values},
         {"named", std::find(plan.metrics.begin(), plan.metrics.end(), name) != plan.metrics.end()},
         {"better", higher ? "higher" : "lower"},
         {"unit", info.unit},
         {"formula", info.summary}});
  };
  for (const std::string& name : plan.metrics)
    for (const MetricInfo& info : metric_infos())
      if (info.name == name) {
        add(info);
        break;
      }
  for (const MetricInfo& info : metric_infos()) add(info);
  return list;
}

json sweep_results(const SweepPlan& plan, const CellStore& store) {
  std::vector<json> cells(plan.cells.size());
  for (size_t i = 0; i < cells.size(); ++i) cells[i] = cell_json(plan, store, plan.cells[i]);
  std::vector<std::vector<const json*>> members(plan.groups);
  for (const json& cell : cells) members[cell["group"].get<int>()].push_back(&cell);
  std::vector<json> groups(plan.groups);
  for (int g = 0; g < plan.groups; ++g) groups[g] = group_json(plan, store, members[g]);
  add_time_ratios(cells, &groups);
  json methods = json::array();
  for (const SweepMethod& method : plan.methods)
    methods.push_back({{"id", method.id},
                       {"label", method.id},
                       {"integrator", method.integrator},
                       {"family", method.label}});
  return {{"format", 1},
          {"program", {{"version", ZONAL_VERSION}, {"compiler", compiler_name()}}},
          {"machine",
           {{"cpu", cpu_name()},
            {"threads", plan.threads ? plan.threads : hardware_threads()},
            {"gpu", nullptr}}},
          {"created", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"sweep",
           {{"name", plan.name},
            {"title", plan.title},
            {"description", plan.description},
            {"file", plan.file},
            {"text", plan.text}}},
          {"metrics", result_metrics(plan)},
          {"scenes", scenes_json(plan, store)},
          {"references", references_json(plan, store, cells)},
          {"methods", methods},
          {"cells", cells},
          {"groups", groups},
          {"drift", read_record(store.folder() + "/drift.json").value_or(json::array())}};
}

}  // namespace zonal
