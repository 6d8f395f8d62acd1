#pragma once
/// Reads a sweep file (scenes/sweeps/sweep.schema.json describes it) and lays out its cells: scenes x
/// materials x methods x parameters x budgets x backends x seeds.
///
///     const SweepPlan plan = read_sweep("scenes/sweeps/glossy_indirect.json");
///     for (const Cell& cell : plan.cells) ...

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/reference.h"

namespace zonal {

/// What a cell may spend, or shall reach.
struct CellBudget {
  enum Kind { passes, seconds, equal_time, equal_error } kind = passes;
  double value = 16;            ///< passes; seconds; seconds; the metric's value
  std::string metric = "rmse";  ///< equal_error: which
  std::string search;           ///< equal_*: the count searched, a parameter or "passes"
  int most_runs = 6;            ///< equal_*: of the search
  std::string text() const;     ///< "4 passes", "0.5 s", "rmse 0.05"
};

struct SweepScene {
  std::string id, file;
  int frame = 0;
  int width = 0, height = 0;                            ///< 0: the scene's own
  nlohmann::json materials = nlohmann::json::object();  ///< name in the scene -> what replaces it
  /// What the scene file says of its own method; a sweep sets all of it anew, so that a method means the same
  /// in every scene.
  nlohmann::json integrator = nlohmann::json::object();
};

/// A method with one choice of every listed parameter.
struct SweepMethod {
  std::string id;  ///< unique: label and the listed parameters' values
  std::string label, integrator;
  nlohmann::json set = nlohmann::json::object();     ///< what the file sets
  nlohmann::json varied = nlohmann::json::object();  ///< of it, what the file lists
  nlohmann::json parameters;                         ///< every parameter's value
  nlohmann::json reference;  ///< settings of `path` for the transport this method solves
};

struct Cell {
  int scene = 0, method = 0, budget = 0, group = 0;  ///< indices; cells of a group differ in their seed alone
  std::string backend = "cpu";
  uint64_t seed = 0;
};

struct SweepPlan {
  std::string file, text;  ///< the sweep file and what it says
  std::string name, title, description;
  std::vector<SweepScene> scenes;
  std::vector<SweepMethod> methods;
  std::vector<CellBudget> budgets;
  std::vector<uint64_t> seeds;
  std::vector<Cell> cells;  ///< in the file's order
  int groups = 0;
  int runs = 3;     ///< timed runs of a cell; 1 where the budget is in seconds
  int threads = 0;  ///< 0: all
  bool curve = false;
  RenderOptions::Pixels pixels = RenderOptions::Pixels::automatic;
  double reference_seconds = 0;  ///< a reference's time; else its passes
  int reference_passes = 256;
  bool full_reference = false;  ///< score against all bounces with occlusion too
  std::vector<std::string> metrics;
};

/// Throws SceneError: file, key, what was found, what was expected, the nearest name.
SweepPlan read_sweep(const std::string& file);

/// What a method is told in a scene: the sweep file's settings and, where the scene file has some for this
/// method, the value the sweep takes instead.
nlohmann::json method_settings(const SweepScene& scene, const SweepMethod& method);

/// The count that an equal budget changes: what the file says where the method has it, else `lights`, else
/// "passes".
std::string search_parameter(const SweepMethod& method, const CellBudget& budget);

/// Settings of `path` that solve what a method with these parameters solves: its bounces, with or without
/// direct light and occlusion (DESIGN: a method is scored against the transport it solves).
nlohmann::json matching_reference(const nlohmann::json& parameters);

}  // namespace zonal
