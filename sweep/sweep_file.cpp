#include "sweep/sweep_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "core/backend.h"
#include "core/error.h"
#include "core/json_fields.h"
#include "core/metrics.h"
#include "core/scene_loader.h"
#include "core/strict_json.h"
#include "integrators/table.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string value_text(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// An array, or one value standing for an array of one.
std::vector<json> list_of(const json& value) {
  if (value.is_array()) return value.get<std::vector<json>>();
  return {value};
}

void parse_size(const std::string& text, const std::string& where, SweepScene* scene) {
  int w = 0, h = 0, used = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &w, &h, &used) != 2 || used != static_cast<int>(text.size()) ||
      w < 1 || h < 1 || w > 32768 || h > 32768)
    throw SceneError(fmt::format("{}: found {}, expected WIDTHxHEIGHT in pixels, such as \"320x180\"", where,
                                 in_quotes(text)));
  scene->width = w, scene->height = h;
}

/// Every combination of the listed values; `lists` gets the keys of the lists.
std::vector<json> combinations(const json& set, json* lists = nullptr) {
  std::vector<json> all{json::object()};
  for (const auto& [key, value] : set.items()) {
    std::vector<json> next;
    for (const json& one : all) {
      for (const json& choice : list_of(value)) {
        next.push_back(one);
        next.back()[key] = choice;
      }
    }
    if (lists && value.is_array()) (*lists)[key] = true;
    all = std::move(next);
  }
  return all;
}

void read_scenes(SweepPlan& plan, Fields& fields, const std::string& size) {
  const json& list = fields.require("scenes", "a list of scene files");
  const auto values = read_array(list, fields.at("scenes"), "scenes");
  if (values.empty()) fields.fail("scenes", "found an empty list, expected at least one scene");
  std::vector<json> materials{json::object()};
  if (const json* replacements = fields.find("materials")) {
    materials.clear();
    if (replacements->is_array() && replacements->empty())
      fields.fail("materials", "found an empty list, expected at least one {\"name\": replacement}");
    for (const json& one : list_of(*replacements)) {
      if (!one.is_object())
        fields.fail("materials", "found " + describe(one) + ", expected {\"name\": replacement}");
      const std::vector<json> all = combinations(one);
      if (all.empty()) fields.fail("materials", "found an empty list, expected at least one replacement");
      materials.insert(materials.end(), all.begin(), all.end());
    }
  }
  std::set<std::string> ids;
  for (size_t i = 0; i < values.size(); ++i) {
    const std::string where = where_of(fields.at("scenes"), i);
    SweepScene scene;
    std::string name, own_size = size;
    if (values[i].is_string()) {
      name = values[i].get<std::string>();
    } else {
      Fields inner(values[i], where);
      name = inner.text("file");
      scene.frame = inner.integer("frame", 0, {-1e9, 1e9});
      scene.id = inner.text("id", "");
      own_size = inner.text("size", size);
      inner.finish();
    }
    constexpr std::string_view kData = "${ZONAL_DATA}";
    if (name.rfind(kData, 0) == 0) {
      const char* data = std::getenv("ZONAL_DATA");
      if (!data)
        throw SceneError(where + ": " + in_quotes(name) + " needs the environment variable ZONAL_DATA");
      name.replace(0, kData.size(), data);
    }
    const fs::path path = fs::path(plan.file).parent_path() / name;
    if (!fs::is_regular_file(path))
      throw SceneError(fmt::format("{}: no such scene file: {}", where, path.string()));
    scene.file = path.lexically_normal().string();
    const json content = json::parse(read_text_file(scene.file, "a scene"), nullptr, false);
    if (content.is_object() && content.contains("integrator") && content["integrator"].is_object())
      scene.integrator = content["integrator"];  // a broken scene complains when it is rendered
    if (scene.id.empty())
      scene.id = path.stem().string() + (scene.frame ? fmt::format("-{}", scene.frame) : "");
    if (!own_size.empty()) parse_size(own_size, where, &scene);
    for (const json& replaced : materials) {
      SweepScene with = scene;
      with.materials = replaced;
      for (const auto& [key, value] : replaced.items())
        with.id += fmt::format(", {} = {}", key, value_text(value));
      if (!ids.insert(with.id).second)
        throw SceneError(fmt::format("{}: found the scene {} again, expected an \"id\" of its own", where,
                                     in_quotes(with.id)));
      try {
        check_scene(with.file, {.frame = with.frame, .materials = replaced});
      } catch (const SceneError& error) {
        throw SceneError(
            fmt::format("{}: {}", replaced.empty() ? where : fields.at("materials"), error.what()));
      }
      plan.scenes.push_back(std::move(with));
    }
  }
}

CellBudget read_budget(const json& value, const std::string& where) {
  static const std::array<std::string, 4> kKinds{"passes", "seconds", "equal_time", "equal_error"};
  Fields fields(value, where);
  CellBudget budget;
  int found = 0;
  for (int kind = 0; kind < 4; ++kind) {
    if (!fields.has(kKinds[kind])) continue;
    ++found;
    budget.kind = static_cast<CellBudget::Kind>(kind);
    budget.value = kind == 0 ? fields.integer("passes", 16, {1, 1 << 24})
                             : fields.number(kKinds[kind], {.low = 0, .high = 1e9, .open_low = true});
  }
  if (found != 1)
    throw SceneError(
        fmt::format("{}: found {} of passes, seconds, equal_time and equal_error, expected exactly one",
                    where, found ? "several" : "none"));
  if (budget.kind == CellBudget::equal_error) budget.metric = fields.text("metric", "rmse");
  if (budget.kind >= CellBudget::equal_time) {
    budget.search = fields.text("search", "");
    budget.most_runs = fields.integer("most_runs", 6, {1, 100});
  }
  fields.finish();
  return budget;
}

/// What a method is scored against. Of one whose transport is direct light alone, `occlusion` is that of the
/// camera's surface.
json reference_of(const IntegratorRow& row, const json& parameters) {
  if (!row.transport.starts_with("direct,")) return matching_reference(parameters);
  json settings{{"max_bounces", 0}};
  if (parameters.value("occlusion", "") == "none") settings["direct_occlusion"] = "none";
  return settings;
}

void read_methods(SweepPlan& plan, Fields& fields) {
  const json& list = fields.require("methods", "a list of methods");
  const auto values = read_array(list, fields.at("methods"), "methods");
  if (values.empty()) fields.fail("methods", "found an empty list, expected at least one method");
  std::set<std::string> ids;
  for (size_t i = 0; i < values.size(); ++i) {
    const std::string where = where_of(fields.at("methods"), i);
    json set = json::object();
    std::string integrator, label;
    if (values[i].is_string()) {
      integrator = values[i].get<std::string>();
    } else {
      Fields inner(values[i], where);
      integrator = inner.text("integrator");
      label = inner.text("label", "");
      if (const json* given = inner.find("set")) set = *given;
      if (!set.is_object())
        inner.fail("set", "found " + describe(set) + ", expected an object of parameters");
      inner.finish();
    }
    for (const auto& [key, value] : set.items())
      if (value.is_array() && value.empty())
        throw SceneError(where_of(where_of(where, "set"), key) +
                         ": found an empty list, expected at least one value");
    const IntegratorRow& row = find_integrator(integrator, where);
    json listed = json::object();
    for (const json& chosen : combinations(set, &listed)) {
      SweepMethod method;
      method.integrator = integrator, method.label = label.empty() ? integrator : label, method.set = chosen;
      for (const auto& [key, unused] : listed.items()) method.varied[key] = chosen[key];
      method.id = method.label;
      for (const auto& [key, value] : method.varied.items())
        method.id += fmt::format(" {}={}", key, value_text(value));
      row.make(chosen, where_of(where, "set"), &method.parameters);
      method.reference = reference_of(row, method.parameters);
      if (!ids.insert(method.id).second)
        throw SceneError(fmt::format("{}: found {} again, expected a \"label\" that tells it apart", where,
                                     in_quotes(method.id)));
      plan.methods.push_back(std::move(method));
    }
  }
}

void read_seeds(SweepPlan& plan, Fields& fields) {
  const json* value = fields.find("seeds");
  if (value && value->is_array()) {
    for (size_t i = 0; i < value->size(); ++i)
      plan.seeds.push_back(read_integer((*value)[i], where_of(fields.at("seeds"), i), {0, 2147483647}));
  } else {
    const int count = value ? read_integer(*value, fields.at("seeds"), {0, 10000}) : 5;
    for (int i = 0; i < count; ++i) plan.seeds.push_back(i);
  }
  if (plan.seeds.empty()) fields.fail("seeds", "found none, expected a number of seeds or a list of them");
}

void read_metrics(SweepPlan& plan, Fields& fields) {
  std::vector<std::string> names;
  for (const MetricInfo& info : metric_infos()) names.push_back(info.name);
  const auto check = [&](const std::string& name, const std::string& where) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw SceneError(
          fmt::format("{}: unknown metric {}{}", where, in_quotes(name), did_you_mean(name, names)));
  };
  plan.metrics = {"rmse", "relmse", "ssim", "psnr"};
  if (const json* value = fields.find("metrics")) {
    plan.metrics.clear();
    const auto values = read_array(*value, fields.at("metrics"), "metrics");
    for (size_t i = 0; i < values.size(); ++i) {
      plan.metrics.push_back(read_text(values[i], where_of(fields.at("metrics"), i)));
      check(plan.metrics.back(), where_of(fields.at("metrics"), i));
    }
  }
  for (const CellBudget& budget : plan.budgets)
    if (budget.kind == CellBudget::equal_error) check(budget.metric, fields.at("budget"));
}

void read_reference(SweepPlan& plan, Fields& fields) {
  const json* value = fields.find("reference");
  if (!value) return;
  Fields inner(*value, fields.at("reference"));
  if (inner.has("passes") && inner.has("seconds"))
    inner.fail("seconds", "found beside \"passes\", expected one of them");
  plan.reference_passes = inner.integer("passes", plan.reference_passes, {2, 1 << 24});
  plan.reference_seconds = inner.number("seconds", 0.0f, {0, 1e9});
  plan.full_reference = inner.flag("full_too", false);
  inner.finish();
}

/// A count to search that no method has is a mistake.
void check_search(const SweepPlan& plan, const CellBudget& budget, const std::string& where) {
  if (budget.kind < CellBudget::equal_time || budget.search.empty() || budget.search == "passes") return;
  for (const SweepMethod& method : plan.methods)
    if (method.parameters.contains(budget.search) && method.parameters[budget.search].is_number_integer())
      return;
  throw SceneError(fmt::format("{}: found {}, expected \"passes\" or a whole-number parameter of a method",
                               where, in_quotes(budget.search)));
}

}  // namespace

std::string CellBudget::text() const {
  switch (kind) {
    case passes:
      return fmt::format("{:.0f} {}", value, value == 1 ? "pass" : "passes");
    case seconds:
      return fmt::format("{:g} s", value);
    case equal_time:
      return fmt::format("equal time {:g} s", value);
    case equal_error:
      return fmt::format("{} {:g}", metric, value);
  }
  return {};
}

json method_settings(const SweepScene& scene, const SweepMethod& method) {
  json settings = method.set;
  if (scene.integrator.value("type", "path") == method.integrator)
    for (const auto& [key, value] : scene.integrator.items())
      if (!settings.contains(key) && method.parameters.contains(key)) settings[key] = method.parameters[key];
  return settings;
}

std::string search_parameter(const SweepMethod& method, const CellBudget& budget) {
  if (method.parameters.contains(budget.search)) return budget.search;
  return budget.search.empty() && method.parameters.contains("lights") ? "lights" : "passes";
}

json matching_reference(const json& parameters) {
  json settings = json::object();
  // `path` and its like say what they solve in the same words.
  for (const char* key : {"min_bounces", "max_bounces", "direct_occlusion"})
    if (parameters.contains(key)) settings[key] = parameters[key];
  if (parameters.contains("bounces")) settings["max_bounces"] = parameters["bounces"];
  if (parameters.value("direct", "") == "none") settings["min_bounces"] = 1;
  if (parameters.value("occlusion", "") == "none") settings["occlusion"] = "none";
  // What `path` does anyway is left out, so that equal transports share one reference.
  json defaults;
  find_integrator("path", "").make(json::object(), "", &defaults);
  for (const auto& [key, value] : defaults.items())
    if (settings.contains(key) && settings[key] == value) settings.erase(key);
  return settings;
}

SweepPlan read_sweep(const std::string& file) {
  SweepPlan plan;
  plan.file = file, plan.text = read_text_file(file, "a sweep");
  const json root = parse_json(plan.text, file);
  Fields fields(root, file);
  fields.text("$schema", "");
  plan.name = fields.text("name", fs::path(file).stem().string());
  plan.title = fields.text("title", plan.name), plan.description = fields.text("description", "");
  read_scenes(plan, fields, fields.text("size", ""));
  read_methods(plan, fields);
  const json* budget = fields.find("budget");
  const std::vector<json> budgets = budget ? list_of(*budget) : std::vector<json>{{{"passes", 16}}};
  if (budgets.empty()) fields.fail("budget", "found an empty list, expected at least one budget");
  for (size_t i = 0; i < budgets.size(); ++i) {
    plan.budgets.push_back(read_budget(
        budgets[i], budget && budget->is_array() ? where_of(fields.at("budget"), i) : fields.at("budget")));
    check_search(plan, plan.budgets.back(), fields.at("budget"));
  }
  read_seeds(plan, fields);
  read_metrics(plan, fields);
  read_reference(plan, fields);
  std::vector<std::string> backends{"cpu"};
  if (const json* given = fields.find("backends")) {
    backends.clear();
    for (const json& one : list_of(*given))
      backends.push_back(check_backend(read_text(one, fields.at("backends")), fields.at("backends")));
    if (backends.empty()) fields.fail("backends", "found an empty list, expected at least one backend");
  }
  plan.runs = fields.integer("runs", plan.runs, {1, 1000});
  plan.threads = fields.integer("threads", 0, {0, 4096});
  plan.curve = fields.flag("curve", false);
  static const std::array<std::string, 3> kPixels{"automatic", "center", "jitter"};
  plan.pixels = static_cast<RenderOptions::Pixels>(fields.choice("pixels", 0, kPixels));
  fields.finish();

  for (size_t s = 0; s < plan.scenes.size(); ++s)
    for (size_t m = 0; m < plan.methods.size(); ++m)
      for (size_t b = 0; b < plan.budgets.size(); ++b)
        for (const std::string& backend : backends) {
          for (const uint64_t seed : plan.seeds)
            plan.cells.push_back(
                {static_cast<int>(s), static_cast<int>(m), static_cast<int>(b), plan.groups, backend, seed});
          ++plan.groups;
        }
  return plan;
}

}  // namespace zonal
