// `zonal list`: every name there is, with parameters, defaults, ranges and units.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "apps/commands.h"
#include "core/error.h"
#include "core/metrics.h"
#include "integrators/table.h"
#include "lights/light.h"
#include "materials/material.h"
#include "materials/material_database.h"

namespace zonal {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> kTopics = {"integrators", "lights", "materials", "metrics"};

Json integrators() {
  Json list = Json::array();
  for (const IntegratorRow& row : integrator_table()) {
    Json parameters = Json::array();
    for (const ParamInfo& p : row.params()) {
      parameters.push_back({{"name", p.name},
                            {"default", p.default_value},
                            {"range", p.range},
                            {"unit", p.unit},
                            {"summary", p.help}});
    }
    list.push_back({{"name", row.name},
                    {"summary", row.summary},
                    {"transport", row.transport},
                    {"debug", row.debug},
                    {"parameters", parameters}});
  }
  return list;
}

template <class Kinds>
Json names_and_summaries(const Kinds& kinds) {
  Json list = Json::array();
  for (const auto& kind : kinds) list.push_back({{"name", kind.name}, {"summary", kind.summary}});
  return list;
}

Json metal_list() {
  Json list = Json::array();
  for (const Metal& metal : metals()) {
    list.push_back({{"name", metal.name},
                    {"eta", {metal.eta.x, metal.eta.y, metal.eta.z}},
                    {"k", {metal.k.x, metal.k.y, metal.k.z}}});
  }
  return list;
}

Json metric_list() {
  Json list = Json::array();
  for (const MetricInfo& m : metric_infos()) {
    list.push_back({{"name", m.name},
                    {"values", m.values},
                    {"range", m.range},
                    {"unit", m.unit},
                    {"summary", m.summary}});
  }
  return list;
}

Json database_list(const std::string& folder) {
  Json list = Json::array();
  for (const DatabaseEntry& e : MaterialDatabase::open(folder).entries()) {
    list.push_back({{"name", e.name},
                    {"source", e.source},
                    {"format", e.format},
                    {"bands", e.bands},
                    {"albedo", {e.albedo.x, e.albedo.y, e.albedo.z}},
                    {"bytes", e.bytes},
                    {"isotropic", e.azimuths == 1},
                    {"mirrored", e.mirrored},
                    {"notes", e.notes}});
  }
  return list;
}

/// The topics asked for; an empty topic means all.
Json collect(const std::string& topic, const std::string& database) {
  const auto wanted = [&](const char* name) { return topic.empty() || topic == name; };
  Json all = Json::object();
  if (wanted("integrators")) all["integrators"] = integrators();
  if (wanted("lights")) all["lights"] = names_and_summaries(light_kinds());
  if (wanted("materials"))
    all["materials"] = names_and_summaries(material_kinds()), all["metals"] = metal_list();
  if (wanted("materials") && !database.empty()) all["database"] = database_list(database);
  if (wanted("metrics")) all["metrics"] = metric_list();
  return all;
}

std::string text(const Json& object, const char* key) {
  return object.value(key, std::string());
}

void print_integrator(const Json& row) {
  const std::string transport = text(row, "transport");
  fmt::print("  {:<16}{}{}\n", text(row, "name"), text(row, "summary"),
             transport.empty() ? "" : fmt::format(" [{}]", transport));
  for (const Json& p : row["parameters"]) {
    std::string line = fmt::format("      {:<18}= {:<9}", text(p, "name"), text(p, "default"));
    for (const char* key : {"range", "unit"}) {
      if (!text(p, key).empty()) line += text(p, key) + ", ";
    }
    fmt::print("{}{}\n", line, text(p, "summary"));
  }
}

void print_metric(const Json& row) {
  const std::string unit = text(row, "unit");
  fmt::print("  {:<9}{:<16}{}{}\n", text(row, "values"), text(row, "name"), text(row, "summary"),
             unit.empty() ? "" : fmt::format(" [{}]", unit));
}

void print_all(const Json& all) {
  for (const auto& [topic, rows] : all.items()) {
    fmt::print("{}\n", topic);
    for (const Json& row : rows) {
      if (topic == "integrators") {
        print_integrator(row);
      } else if (topic == "metrics") {
        print_metric(row);
      } else if (topic == "database") {
        const Json& a = row["albedo"];
        fmt::print("  {:<28}{:>4} bands {:>9.1f} kB   albedo {:.3f} {:.3f} {:.3f}   {} {}\n",
                   text(row, "name"), row["bands"].get<int>(), row["bytes"].get<double>() * 1e-3,
                   a[0].get<double>(), a[1].get<double>(), a[2].get<double>(), text(row, "format"),
                   text(row, "source"));
      } else if (topic == "metals") {
        const Json &eta = row["eta"], &k = row["k"];
        fmt::print("  {:<20}eta {:.3f} {:.3f} {:.3f}   k {:.3f} {:.3f} {:.3f}\n", text(row, "name"),
                   eta[0].get<double>(), eta[1].get<double>(), eta[2].get<double>(), k[0].get<double>(),
                   k[1].get<double>(), k[2].get<double>());
      } else {
        fmt::print("  {:<20}{}\n", text(row, "name"), text(row, "summary"));
      }
    }
  }
}

}  // namespace

void add_list(CLI::App& app, int* exit_code) {
  struct Options {
    std::string topic, database;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("list", "every integrator, light, material and metric there is");
  command->add_option("topic", options->topic, "integrators, lights, materials or metrics; default: all");
  command->add_option("--database", options->database,
                      "material database to list too; default: ZONAL_MATERIALS");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([=] {
    if (!options->topic.empty() &&
        std::find(kTopics.begin(), kTopics.end(), options->topic) == kTopics.end()) {
      throw SceneError(
          fmt::format("list: unknown topic \"{}\"{}", options->topic, did_you_mean(options->topic, kTopics)));
    }
    const char* environment = std::getenv("ZONAL_MATERIALS");
    const std::string database = !options->database.empty() ? options->database
                                 : environment              ? environment
                                                            : "";
    const Json all = collect(options->topic, database);
    if (options->json) {
      fmt::print("{}\n", all.dump(2));
    } else {
      print_all(all);
    }
    *exit_code = kDone;
  });
}

}  // namespace zonal
