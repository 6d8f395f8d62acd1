#include "sweep/score.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>

#include "core/image.h"
#include "core/metrics.h"
#include "sweep/runner.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Scores made by another set of metrics are made again.
constexpr int kScoresVersion = 1;

json number(double x) {
  if (std::isinf(x)) return x > 0 ? json("inf") : json("-inf");
  return std::isnan(x) ? json(nullptr) : json(x);
}

const Image* layer(const ImageFile& file, const char* name) {
  const auto found = file.layers.find(name);
  return found == file.layers.end() ? nullptr : &found->second;
}

float exposure_of(const ImageFile& image) {
  const auto found = image.metadata.find("exposure");
  return found == image.metadata.end() ? 1.0f : std::stof(found->second);
}

/// "snapshot-00004.exr" -> 4
int passes_of(const fs::path& snapshot) {
  return std::atoi(snapshot.stem().string().substr(9).c_str());
}

json curve_of(const std::string& folder, const std::string& reference) {
  json curve = json::array();
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path file = entry.path();
    if (file.extension() != ".exr" || file.stem().string().rfind("snapshot-", 0) != 0) continue;
    const ImageFile image = read_image(file.string());
    const auto seconds = image.metadata.find("seconds");
    curve.push_back(
        {{"passes", passes_of(file)},
         {"seconds", seconds == image.metadata.end() ? json(nullptr) : json(std::stod(seconds->second))},
         {"scores", score_image(file.string(), reference)}});
  }
  std::sort(curve.begin(), curve.end(),
            [](const json& a, const json& b) { return a["passes"] < b["passes"]; });
  return curve;
}

}  // namespace

json score_image(const std::string& image_file, const std::string& reference_file) {
  const ImageFile image = read_image(image_file), reference = read_image(reference_file);
  const Image &x = image.layers.at(""), &r = reference.layers.at("");
  const LinearMetrics linear =
      linear_metrics(x, r, layer(reference, "A"), layer(reference, "B"), layer(reference, "variance"));
  const float exposure = exposure_of(reference);
  const DisplayMetrics display = display_metrics(to_display(x, exposure), to_display(r, exposure));
  json scores = {{"rmse", number(linear.rmse)},           {"mae", number(linear.mae)},
                 {"relmse", number(linear.relmse)},       {"relmse_trimmed", number(linear.relmse_trimmed)},
                 {"smape", number(linear.smape)},         {"bias", number(linear.bias)},
                 {"fireflies", number(linear.fireflies)}, {"nan", linear.nan},
                 {"rmse_display", number(display.rmse)},  {"mae_display", number(display.mae)},
                 {"psnr", number(display.psnr)},          {"ssim", number(display.ssim)}};
  if (linear.mse_unbiased) {
    scores["rmse_unbiased"] = number(std::sqrt(std::max(0.0, *linear.mse_unbiased)));
    scores["reference_floor"] = number(*linear.reference_floor);
    scores["reference_limited"] = linear.reference_limited();
  }
  return scores;
}

json cell_scores(const CellStore& store, const std::string& key) {
  const auto record = read_record(store.cell_folder(key) + "/scores.json");
  return record && record->value("version", 0) == kScoresVersion ? *record : json::object();
}

int score_cells(const SweepPlan& plan, const CellStore& store) {
  std::atomic<int> made = 0;
  oneapi::tbb::parallel_for(size_t(0), plan.cells.size(), [&](size_t i) {
    const auto work = cell_work(plan, store, plan.cells[i]);
    if (!work) return;
    const auto record = store.cell(work->key);
    if (!record || (*record)["status"] != "done") return;
    const std::vector<ReferenceRequest> references = cell_references(plan, plan.cells[i]);
    std::vector<std::string> keys;
    for (const ReferenceRequest& request : references) keys.push_back(reference_key(request));
    const json have = cell_scores(store, work->key);
    if (have.value("references", json()) == json(keys)) return;
    const std::string folder = store.cell_folder(work->key);
    json scores{{"version", kScoresVersion}, {"references", keys}};
    scores["matching"] = score_image(folder + "/image.exr", store.reference_file(keys[0]));
    if (keys.size() > 1) scores["full"] = score_image(folder + "/image.exr", store.reference_file(keys[1]));
    scores["curve"] = curve_of(folder, store.reference_file(keys[0]));
    write_record(folder + "/scores.json", scores);
    ++made;
  });
  return made;
}

}  // namespace zonal
