#include "sweep/digest.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>

#include "core/atomic_file.h"
#include "core/error.h"
#include "sweep/cell_process.h"
#include "sweep/cell_work.h"
#include "sweep/picture_script.h"
#include "sweep/score.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Scores made by another set of metrics are made again.
constexpr int kVersion = 2;

/// A finished cell and what is asked of it.
struct Item {
  std::string key;
  json record;
  std::vector<std::string> references;  ///< keys: matching, and full where the plan asks for it
};
/// Cells of one group, which share their references.
using Group = std::vector<Item>;

std::string picture_file(const CellStore& store, const std::string& id) {
  return store.folder() + "/images/" + id + ".js";
}

void write_picture(const CellStore& store, const std::string& id, const Image& image, float exposure) {
  const std::string text = picture_script(id, image, exposure);
  write_atomically(picture_file(store, id), text.data(), text.size());
}

/// A picture is as old as the EXR it was made of, or younger.
bool picture_is_current(const CellStore& store, const std::string& id, const std::string& exr) {
  std::error_code error;
  const auto made = fs::last_write_time(picture_file(store, id), error);
  return !error && made >= fs::last_write_time(exr, error);
}

bool wants_flip_hdr(const SweepPlan& plan) {
  return std::find(plan.metrics.begin(), plan.metrics.end(), "flip_hdr") != plan.metrics.end();
}

std::string exr_file(const CellStore& store, const std::string& key) {
  return store.cell_folder(key) + "/image.exr";
}

bool is_current(const SweepPlan& plan, const CellStore& store, const Item& item) {
  const json have = cell_scores(store, item.key);
  return have.value("references", json()) == json(item.references) && !have.contains("reason") &&
         have.value("curve_too", false) == plan.curve &&
         have.value("flip_hdr", false) >= wants_flip_hdr(plan) &&
         picture_is_current(store, item.key, exr_file(store, item.key));
}

json members_of(const Group& group) {
  json keys = json::array();
  for (const Item& item : group) keys.push_back(item.key);
  return keys;
}

/// "snapshot-00004.exr" -> 4
int passes_of(const fs::path& snapshot) {
  return std::atoi(snapshot.stem().string().substr(9).c_str());
}

/// Scores after 1, 2, 4, ... passes and after the last one.
json curve_of(const CellStore& store, const Item& item, const Scorer& scorer, const json& last) {
  json curve = json::array();
  const json& stats = item.record["stats"];
  for (const auto& entry : fs::directory_iterator(store.cell_folder(item.key))) {
    const fs::path file = entry.path();
    if (file.extension() != ".exr" || file.stem().string().rfind("snapshot-", 0) != 0) continue;
    if (passes_of(file) == stats["passes"].get<int>()) continue;
    const ImageFile image = read_image(file.string());
    const auto seconds = image.metadata.find("seconds");
    curve.push_back(
        {{"passes", passes_of(file)},
         {"seconds", seconds == image.metadata.end() ? json(nullptr) : json(std::stod(seconds->second))},
         {"scores", scorer.score(image.layers.at(""))}});
  }
  curve.push_back({{"passes", stats["passes"]}, {"seconds", clocked(stats)}, {"scores", last}});
  std::sort(curve.begin(), curve.end(),
            [](const json& a, const json& b) { return a["passes"] < b["passes"]; });
  return curve;
}

/// How the error splits over seeds: noise is what the seeds differ by, bias what their mean is off by.
json split_error(const std::vector<Image>& images, const Image& r, double floor) {
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
  if (counted == 0) return json::object();
  const double variance = scatter / counted;
  // The mean of n seeds still holds a share of the noise, and the reference some of its own.
  return {{"noise", std::sqrt(variance)},
          {"bias", std::sqrt(std::max(0.0, error / counted - variance / n - floor * floor))}};
}

void digest_group(const SweepPlan& plan, const CellStore& store, const Group& group, const Scorer& scorer,
                  const Scorer* full, std::atomic<int>* made) {
  std::vector<Image> images;
  double floor = 0;
  for (const Item& item : group) {
    json scores{{"version", kVersion},
                {"references", item.references},
                {"curve_too", plan.curve},
                {"flip_hdr", wants_flip_hdr(plan)}};
    try {
      Image image = read_image(exr_file(store, item.key)).layers.at("");
      scores["matching"] = scorer.score(image);
      if (full) scores["full"] = full->score(image);
      if (plan.curve) scores["curve"] = curve_of(store, item, scorer, scores["matching"]);
      floor = scores["matching"].value("reference_floor", 0.0);
      write_picture(store, item.key, image, scorer.exposure());
      images.push_back(std::move(image));
    } catch (const SceneError& error) {
      if (tells_of_full_disk(error.what())) throw;
      scores["reason"] = std::string("could not be scored: ") + error.what();
    }
    write_record(store.cell_folder(item.key) + "/scores.json", scores);
    ++*made;
  }
  json split = images.size() == group.size() && images.size() > 1
                   ? split_error(images, scorer.reference(), floor)
                   : json::object();
  split["members"] = members_of(group);
  write_record(store.cell_folder(group[0].key) + "/group.json", split);
}

/// Finished cells by group.
std::vector<Group> groups_of(const SweepPlan& plan, const CellStore& store) {
  std::vector<Group> groups(plan.groups);
  for (const Cell& cell : plan.cells) {
    const auto work = cell_work(plan, store, cell);
    const auto record = work ? store.cell(work->key) : std::nullopt;
    if (!record || (*record)["status"] != "done") continue;
    Item item{.key = work->key, .record = *record, .references = {}};
    for (const ReferenceRequest& request : cell_references(plan, cell))
      item.references.push_back(reference_key(request));
    groups[cell.group].push_back(std::move(item));
  }
  return groups;
}

}  // namespace

json cell_scores(const CellStore& store, const std::string& key) {
  const auto record = read_record(store.cell_folder(key) + "/scores.json");
  return record && record->value("version", 0) == kVersion ? *record : json::object();
}

json group_split(const CellStore& store, const std::string& first_key) {
  return read_record(store.cell_folder(first_key) + "/group.json").value_or(json::object());
}

int digest_cells(const SweepPlan& plan, const CellStore& store) {
  const std::vector<Group> groups = groups_of(plan, store);
  // One reference at a time is held in memory; its groups are digested side by side.
  std::map<std::vector<std::string>, std::vector<const Group*>> waiting;
  for (const Group& group : groups) {
    if (group.empty()) continue;
    const bool current = group_split(store, group[0].key).value("members", json()) == members_of(group) &&
                         std::all_of(group.begin(), group.end(),
                                     [&](const Item& item) { return is_current(plan, store, item); });
    const std::string& matching = group[0].references[0];
    if (!current || !picture_is_current(store, matching, store.reference_file(matching)))
      waiting[group[0].references].push_back(&group);
  }
  std::atomic<int> made = 0;
  for (const auto& [keys, members] : waiting) {
    std::unique_ptr<Scorer> scorer, full;
    try {
      scorer = std::make_unique<Scorer>(store.reference_file(keys[0]), wants_flip_hdr(plan));
      if (keys.size() > 1)
        full = std::make_unique<Scorer>(store.reference_file(keys[1]), wants_flip_hdr(plan));
    } catch (const SceneError& error) {
      write_record(failure_file(store, keys[0]), {{"reason", std::string("the reference: ") + error.what()}});
      continue;
    }
    write_picture(store, keys[0], scorer->reference(), scorer->exposure());
    if (full) write_picture(store, keys[1], full->reference(), full->exposure());
    oneapi::tbb::parallel_for(size_t(0), members.size(), [&](size_t i) {
      digest_group(plan, store, *members[i], *scorer, full.get(), &made);
    });
  }
  return made;
}

}  // namespace zonal
