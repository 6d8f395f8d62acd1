#include "sweep/cell_work.h"

#include <fmt/format.h>

namespace zonal {

using nlohmann::json;

std::string failure_file(const CellStore& store, const std::string& key) {
  return store.folder() + "/references/" + key + ".failed.json";
}

std::optional<std::string> reference_failure(const CellStore& store, const std::string& key) {
  const auto record = read_record(failure_file(store, key));
  if (!record) return {};
  return record->value("reason", "the reference failed");
}

std::string cell_name(const SweepPlan& plan, const Cell& cell) {
  return fmt::format("{} | {} | {} | {}seed {}", plan.scenes[cell.scene].id, plan.methods[cell.method].id,
                     plan.budgets[cell.budget].text(), cell.backend == "cpu" ? "" : cell.backend + " | ",
                     cell.seed);
}

std::string search_key(const SweepPlan& plan, const Cell& cell) {
  Cell first = cell;
  first.seed = plan.seeds[0];
  return cell_key(plan, first, plan.methods[cell.method].parameters, plan.budgets[cell.budget]);
}

std::optional<CellWork> cell_work(const SweepPlan& plan, const CellStore& store, const Cell& cell) {
  const CellBudget& budget = plan.budgets[cell.budget];
  CellWork work{.settings = method_settings(plan.scenes[cell.scene], plan.methods[cell.method])};
  if (budget.kind == CellBudget::passes) work.passes = static_cast<int>(budget.value);
  if (budget.kind == CellBudget::seconds) work.seconds = budget.value;
  if (budget.kind >= CellBudget::equal_time) {
    const auto found = store.search(search_key(plan, cell));
    if (!found || (*found)["count"].get<int>() <= 0) return {};
    work.search = *found;
    const std::string parameter = (*found)["parameter"];
    work.passes = 1;
    if (parameter == "passes")
      work.passes = (*found)["count"];
    else
      work.settings[parameter] = (*found)["count"];
  }
  json parameters = plan.methods[cell.method].parameters;
  parameters.update(work.settings);
  work.key = cell_key(plan, cell, parameters, budget);
  return work;
}

std::vector<ReferenceRequest> cell_references(const SweepPlan& plan, const Cell& cell) {
  const SweepScene& scene = plan.scenes[cell.scene];
  const CellBudget& budget = plan.budgets[cell.budget];
  ReferenceRequest request{.scene_file = scene.file,
                           .settings = plan.methods[cell.method].reference,
                           .passes = plan.reference_passes,
                           .seconds = plan.reference_seconds,
                           .width = scene.width,
                           .height = scene.height,
                           .frame = scene.frame,
                           .seed = 1000};
  request.materials = scene.materials;
  if (plan.reference_seconds > 0) request.passes = 0;
  // A reference's rays start where the picture's do, so that edges are not measured as errors.
  const bool one_pass = (budget.kind == CellBudget::passes && budget.value == 1) ||
                        (budget.kind >= CellBudget::equal_time &&
                         search_parameter(plan.methods[cell.method], budget) != "passes");
  request.pixels = plan.pixels == RenderOptions::Pixels::automatic
                       ? (one_pass ? RenderOptions::Pixels::center : RenderOptions::Pixels::jitter)
                       : plan.pixels;
  std::vector<ReferenceRequest> all{request};
  if (plan.full_reference && !request.settings.empty()) {
    all.push_back(request);
    all.back().settings = json::object();
  }
  return all;
}

}  // namespace zonal
