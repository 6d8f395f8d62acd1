#pragma once
/// Every method there is: one row a method. The tests, `zonal list`, the documentation and the sweeps iterate over it.

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "core/integrator.h"
#include "core/params.h"

namespace zonal {

struct IntegratorRow {
  std::string name, summary;
  std::string transport;  ///< which light paths it solves, for choosing the reference it is scored against
  bool debug = false;     ///< shows a quantity rather than light: not compared with a reference
  std::vector<ParamInfo> (*params)();
  /// `settings` is the method's JSON object; `where` names it in errors. Throws SceneError. `values` receives every
  /// parameter's value, defaults included.
  std::unique_ptr<Integrator> (*make)(const nlohmann::json& settings, const std::string& where,
                                      nlohmann::json* values);
  /// Whether it has a parameter of this name.
  bool has(const std::string& parameter) const;
};

std::span<const IntegratorRow> integrator_table();
/// Throws SceneError naming what there is when `name` is unknown.
const IntegratorRow& find_integrator(const std::string& name, const std::string& where);

}  // namespace zonal
