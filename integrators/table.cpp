#include "integrators/table.h"

#include <array>

#include "core/error.h"
#include "integrators/debug/debug.h"
#include "integrators/hvl/hvl.h"
#include "integrators/path/path.h"
#include "integrators/sh_direct/sh_direct.h"
#include "integrators/vpl/vpl.h"
#include "integrators/vsgl/vsgl.h"
#include "integrators/vsl/vsl.h"

namespace zonal {
namespace {

template <class Params, class Method>
std::unique_ptr<Integrator> make(const nlohmann::json& settings, const std::string& where, nlohmann::json* values) {
  const auto params = read_params<Params>(settings, where);
  if (values) *values = write_params(params);
  return std::make_unique<Method>(params);
}

template <DebugQuantity quantity>
std::unique_ptr<Integrator> make_debug(const nlohmann::json& settings, const std::string& where,
                                       nlohmann::json* values) {
  read_params<DebugParams>(settings, where);
  if (values) *values = nlohmann::json::object();
  return std::make_unique<DebugIntegrator>(quantity);
}

// name, summary, transport, debug, parameters, maker
const std::array kTable = {
    IntegratorRow{"path", "path tracing with next-event estimation and MIS: the reference", "all bounces, full occlusion",
                  false, list_params<PathParams>, make<PathParams, PathIntegrator>},
    IntegratorRow{"vpl", "instant radiosity: virtual point lights", "direct and `bounces` bounces, `occlusion` as set",
                  false, list_params<VplParams>, make<VplParams, VplIntegrator>},
    IntegratorRow{"vsl", "virtual spherical lights: no spots, some noise", "direct and `bounces` bounces, `occlusion` as set",
                  false, list_params<VslParams>, make<VslParams, VslIntegrator>},
    IntegratorRow{"hvl", "harmonic virtual lights: spheres and BRDFs on spherical harmonics",
                  "direct and `bounces` bounces, `occlusion` as set", false, list_params<HvlParams>,
                  make<HvlParams, HvlIntegrator>},
    IntegratorRow{"vsgl", "virtual spherical Gaussian lights, two for each block of the map",
                  "direct and `bounces` bounces, `occlusion` as set", false, list_params<VsglParams>,
                  make<VsglParams, VsglIntegrator>},
    IntegratorRow{"sh_direct", "direct light of many area lights on spherical harmonics, without noise",
                  "direct, `occlusion` as set", false, list_params<ShDirectParams>,
                  make<ShDirectParams, ShDirectIntegrator>},
    IntegratorRow{"normal", "shading normals as colours", "none", true, list_params<DebugParams>,
                  make_debug<DebugQuantity::normal>},
    IntegratorRow{"albedo", "surface albedo", "none", true, list_params<DebugParams>, make_debug<DebugQuantity::albedo>},
    IntegratorRow{"depth", "distance from the camera, near is white", "none", true, list_params<DebugParams>,
                  make_debug<DebugQuantity::depth>},
};

}  // namespace

bool IntegratorRow::has(const std::string& parameter) const {
  for (const ParamInfo& p : params())
    if (p.name == parameter) return true;
  return false;
}

std::span<const IntegratorRow> integrator_table() { return kTable; }

const IntegratorRow& find_integrator(const std::string& name, const std::string& where) {
  std::vector<std::string> names;
  for (const IntegratorRow& row : kTable) {
    if (row.name == name) return row;
    names.push_back(row.name);
  }
  throw SceneError(where + ": unknown integrator \"" + name + "\"" + did_you_mean(name, names));
}

}  // namespace zonal
