#include "sweep/results.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>

#include "core/image.h"
#include "core/machine.h"
#include "core/metrics.h"
#include "sweep/runner.h"
#include "sweep/score.h"
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
  const json scores = cell_scores(store, work->key);
  if (scores.contains("matching")) out["scores"] = scores["matching"];
  if (scores.contains("full")) out["scores_full"] = scores["full"];
  if (scores.contains("curve") && !scores["curve"].empty()) out["curve"] = scores["curve"];
  out["reference_limited"] = out["scores"].value("reference_limited", false);
  return out;
}

/// How the error splits over seeds: noise is what the seeds differ by, bias what their mean is off by.
void split_error(const CellStore& store, const std::vector<const json*>& cells, json* group) {
  if (cells.size() < 2) return;
  std::vector<Image> images;
  for (const json* cell : cells)
    images.push_back(read_image(store.cell_folder((*cell)["id"]) + "/image.exr").layers.at(""));
  const ImageFile reference = read_image(store.reference_file((*cells[0])["reference"]));
  const Image& r = reference.layers.at("");
  const double n = static_cast<double>(images.size());
  double scatter = 0, error = 0;
  size_t counted = 0;
  for (size_t i = 0; i < r.pixels.size(); ++i) {
    double mean = 0, squares = 0;
    for (const Image& image : images) mean += image.pixels[i] / n;
    for (const Image& image : images) squares += (image.pixels[i] - mean) * (image.pixels[i] - mean);
    if (!std::isfinite(mean + r.pixels[i])) continue;
    scatter += squares / (n - 1);
    error += (mean - r.pixels[i]) * (mean - r.pixels[i]);
    ++counted;
  }
  if (counted == 0) return;
  const double variance = scatter / counted;
  const double floor = (*cells[0])["scores"].value("reference_floor", 0.0);
  (*group)["noise"] = std::sqrt(variance);
  // The mean of n seeds still holds a share of the noise, and the reference some of its own.
  (*group)["bias"] = std::sqrt(std::max(0.0, error / counted - variance / n - floor * floor));
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
  std::vector<double> times;
  for (const json* cell : cells) {
    group["cells"].push_back((*cell)["id"]);
    if ((*cell)["status"] == "failed") group["failed"] = group["failed"].get<int>() + 1;
    if ((*cell)["time"].is_null()) continue;
    done.push_back(cell);
    for (const json& run : (*cell)["runs"]) times.push_back(run);
  }
  if (done.empty()) return group;
  const Interval time = student_interval(times);
  group["time"] = {{"mean", time.mean},
                   {"median", median(times)},
                   {"low", time.low},
                   {"high", time.high},
                   {"runs", times.size()}};
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
  split_error(store, done, &group);
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
                    {"passes", record->value("passes", json())},
                    {"seconds", record->value("seconds", json())},
                    {"record", *record},
                    {"floor", floor},
                    {"image", "images/" + key + ".js"}};
    }
  }
  json list = json::array();
  for (auto& [key, value] : found) list.push_back(std::move(value));
  return list;
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
                  {"exposure", 1.0}};
    for (const Cell& cell : plan.cells) {
      if (cell.scene != static_cast<int>(s)) continue;
      const std::string file = store.reference_file(reference_key(cell_references(plan, cell)[0]));
      if (!read_record(record_file(file))) continue;
      const ImageFile reference = read_image(file);
      scene["width"] = reference.layers.at("").width, scene["height"] = reference.layers.at("").height;
      const auto exposure = reference.metadata.find("exposure");
      if (exposure != reference.metadata.end()) scene["exposure"] = std::stod(exposure->second);
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
    const bool higher = info.name == "psnr" || info.name == "ssim";
    list.push_back({{"name", name},
                    {"values", info.values},
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
  oneapi::tbb::parallel_for(0, plan.groups, [&](int g) { groups[g] = group_json(plan, store, members[g]); });
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
