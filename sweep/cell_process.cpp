#include "sweep/cell_process.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <sstream>

namespace zonal {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;

std::string value_text(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

void add(Arguments* to, const Arguments& more) {
  to->insert(to->end(), more.begin(), more.end());
}

void add_settings(Arguments* to, const json& settings) {
  for (const auto& [name, value] : settings.items()) add(to, {"--set", name + "=" + value_text(value)});
}

void add_scene(Arguments* to, const SweepPlan& plan, const SweepScene& scene, int width, int height) {
  if (scene.frame) add(to, {"--frame", std::to_string(scene.frame)});
  if (width) add(to, {"--size", fmt::format("{}x{}", width, height)});
  if (plan.threads) add(to, {"--threads", std::to_string(plan.threads)});
  for (const auto& [name, value] : scene.materials.items())
    add(to, {"--material", name + "=" + value_text(value)});
}

}  // namespace

Arguments render_command(const std::string& program, const SweepPlan& plan, const Cell& cell,
                         const CellRender& what) {
  const SweepScene& scene = plan.scenes[cell.scene];
  Arguments command{program, "render", scene.file, "--integrator", plan.methods[cell.method].integrator,
                    "--pin", "--quiet"};
  add_settings(&command, what.settings);
  Arguments again;
  std::istringstream words(what.repeat);
  for (std::string word; words >> word;) again.push_back(word);
  if (!again.empty()) {
    add(&command, again);
  } else {
    add(&command, {"--seed", std::to_string(cell.seed)});
    if (what.seconds > 0)
      add(&command, {"--time", fmt::format("{:g}", what.seconds)});
    else
      add(&command, {"--passes", std::to_string(what.passes)});
  }
  // What makes a picture again says where rays start only where that is not the rule.
  if (what.repeat.find("--pixels") == std::string::npos)
    add(&command, {"--pixels", pixels_name(plan.pixels)});
  add(&command, {"-o", what.image.empty() ? "none" : what.image});
  if (!what.stats.empty()) add(&command, {"--stats", what.stats});
  if (!what.snapshots.empty()) add(&command, {"--snapshots", what.snapshots});
  if (cell.backend != "cpu") add(&command, {"--backend", cell.backend});
  add_scene(&command, plan, scene, what.width ? what.width : scene.width,
            what.width ? what.height : scene.height);
  return command;
}

Arguments reference_command(const std::string& program, const SweepPlan& plan, int scene,
                            const ReferenceRequest& request, const std::string& file) {
  Arguments command{program,
                    "reference",
                    request.scene_file,
                    "--integrator",
                    request.integrator,
                    "--pixels",
                    pixels_name(request.pixels),
                    "--seed",
                    std::to_string(request.seed),
                    "-o",
                    file,
                    "--quiet"};
  if (request.passes)
    add(&command, {"--passes", std::to_string(request.passes)});
  else
    add(&command, {"--time", fmt::format("{:g}", request.seconds)});
  add_settings(&command, request.settings);
  add_scene(&command, plan, plan.scenes[scene], request.width, request.height);
  return command;
}

double clocked(const json& stats) {
  return stats["seconds"]["begin_pass"].get<double>() + stats["seconds"]["radiance"].get<double>();
}

bool tells_of_full_disk(const std::string& reason) {
  for (const int error : {ENOSPC, EDQUOT, EFBIG})
    if (reason.find(std::strerror(error)) != std::string::npos) return true;
  return false;
}

}  // namespace zonal
