#include "core/reference.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>

#include "core/error.h"
#include "core/hash.h"
#include "core/machine.h"
#include "integrators/table.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Lists every file that a string of the scene file names: meshes, textures, skies. Textures that a mesh file
/// names in turn are not looked for.
void list_named_files(const nlohmann::json& value, const fs::path& folder, std::vector<fs::path>* files) {
  if (value.is_structured()) {
    for (const auto& element : value) list_named_files(element, folder, files);
  } else if (value.is_string()) {
    constexpr const char* kVariable = "${ZONAL_DATA}";
    std::string name = value.get<std::string>();
    const char* data = std::getenv("ZONAL_DATA");
    if (name.rfind(kVariable, 0) == 0 && data) name.replace(0, std::string(kVariable).size(), data);
    std::error_code error;
    const fs::path file = folder / name;
    if (!name.empty() && fs::is_regular_file(file, error)) files->push_back(file);
  }
}

/// Size and time of files: other ones, other content.
std::string stamp_of(const std::vector<fs::path>& files) {
  std::string stamp;
  std::error_code error;
  for (const fs::path& file : files)
    stamp += fmt::format("{} {} ", fs::file_size(file, error),
                         fs::last_write_time(file, error).time_since_epoch().count());
  return stamp;
}

/// Hash of the scene file's content and that of the files it names. A sweep asks again and again: what has
/// not changed is not read twice.
Hash scene_hash(const std::string& scene_file) {
  struct Known {
    std::vector<fs::path> files;
    std::string stamp;
    Hash hash;
  };
  static std::mutex mutex;
  static std::map<std::string, Known> all;
  const std::lock_guard lock(mutex);
  const auto found = all.find(scene_file);
  if (found != all.end() && stamp_of(found->second.files) == found->second.stamp) return found->second.hash;
  Known known{.files = {scene_file}, .stamp = {}, .hash = {}};
  // Stamps before contents: what changes meanwhile is read again the next time.
  known.stamp = stamp_of(known.files);
  const std::string text = content_of(scene_file);
  const nlohmann::json scene = nlohmann::json::parse(text, nullptr, false);
  if (!scene.is_discarded()) list_named_files(scene, fs::path(scene_file).parent_path(), &known.files);
  known.stamp += stamp_of({known.files.begin() + 1, known.files.end()});
  known.hash.add(text);
  for (size_t i = 1; i < known.files.size(); ++i) known.hash.add(content_of(known.files[i]));
  return (all[scene_file] = known).hash;
}

/// One half of the work, told as a part of the whole.
std::function<void(const Progress&)> half_progress(const ReferenceOptions& options, int half,
                                                   const RenderReport& first) {
  if (!options.on_progress) return {};
  return [&options, half, before = first](Progress p) {
    p.fraction = 0.5 * (p.fraction + half);
    p.pass += before.passes;
    p.seconds += before.begin_pass_seconds + before.radiance_seconds;
    options.on_progress(p);
  };
}

/// a and b averaged, value by value.
Image mean_of(const Image& a, const Image& b, float factor = 0.5f) {
  Image mean(a.width, a.height, a.channels);
  for (size_t i = 0; i < a.pixels.size(); ++i) mean.pixels[i] = factor * (a.pixels[i] + b.pixels[i]);
  return mean;
}

nlohmann::json seconds_json(const RenderReport reports[2]) {
  return {{"begin_pass", reports[0].begin_pass_seconds + reports[1].begin_pass_seconds},
          {"radiance", reports[0].radiance_seconds + reports[1].radiance_seconds}};
}

}  // namespace

uint64_t half_seed(uint64_t seed, int half) {
  // SplitMix64 (Steele, Lea and Flood 2014), cut to 48 bits: JSON readers hold whole numbers up to 2^53.
  uint64_t z = 2 * seed + half + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (z ^ (z >> 31)) >> 16;
}

std::string reference_key(const ReferenceRequest& request) {
  Hash hash = scene_hash(request.scene_file);
  hash.add(request.integrator);
  hash.add(request.settings.dump());
  hash.add(fmt::format("passes {} seconds {} size {}x{} frame {} seed {}", request.passes, request.seconds,
                       request.width, request.height, request.frame, request.seed));
  if (!request.materials.empty()) hash.add(request.materials.dump());
  hash.add(request.pixels == RenderOptions::Pixels::center ? "pixel centres" : "jittered pixels");
  return hash.text();
}

std::string record_file(const std::string& exr) {
  return fs::path(exr).replace_extension(".json").string();
}

std::optional<Reference> make_reference(const Scene& scene, const ReferenceRequest& request,
                                        const ReferenceOptions& options) {
  const IntegratorRow& row = find_integrator(request.integrator, "--integrator");
  const int width = request.width > 0 ? request.width : scene.camera().width;
  const int height = request.height > 0 ? request.height : scene.camera().height;
  Film films[2] = {{width, height}, {width, height}};
  RenderReport reports[2];
  nlohmann::json parameters;
  for (int half = 0; half < 2; ++half) {
    // The first half spends its share of the time, the second repeats its number of passes.
    Budget budget{.passes = (request.passes + 1) / 2, .seconds = 0.5 * request.seconds};
    if (half == 1) budget = {.passes = reports[0].passes};
    // A method may keep state between passes, so each half has its own.
    const auto integrator =
        row.make(request.settings, fmt::format("integrator \"{}\"", request.integrator), &parameters);
    const RenderOptions render_options{.seed = half_seed(request.seed, half),
                                       .threads = options.threads,
                                       .pixels = request.pixels,
                                       .stop = options.stop};
    reports[half] = render(scene, *integrator, films[half], budget, render_options, {},
                           half_progress(options, half, reports[0]));
    if (reports[half].interrupted || reports[half].partial) return std::nullopt;
  }

  const ImageFile a = films[0].resolve(), b = films[1].resolve();
  Reference reference;
  for (const auto& [name, layer] : a.layers) reference.image.layers[name] = mean_of(layer, b.layers.at(name));
  reference.image.layers["A"] = a.layers.at("");
  reference.image.layers["B"] = b.layers.at("");
  // Var((A+B)/2) = (Var A + Var B) / 4. Stratified passes scatter more than their mean, so this errs on the
  // high side.
  reference.image.layers["variance"] =
      mean_of(films[0].variance_of_mean(), films[1].variance_of_mean(), 0.25f);

  nlohmann::json& record = reference.record;
  record["scene"] = request.scene_file;
  record["integrator"] = request.integrator;
  record["transport"] = row.transport;
  record["parameters"] = parameters;
  record["passes"] = {reports[0].passes, reports[1].passes};
  record["seed"] = request.seed;
  record["pixels"] = request.pixels == RenderOptions::Pixels::center ? "center" : "jitter";
  record["seeds"] = {half_seed(request.seed, 0), half_seed(request.seed, 1)};
  record["resolution"] = {width, height};
  record["frame"] = request.frame;
  record["exposure"] = scene.camera().exposure;
  record["seconds"] = seconds_json(reports);
  record["bad_samples"] = films[0].bad_samples() + films[1].bad_samples();
  record["version"] = ZONAL_VERSION;
  record["compiler"] = compiler_name();
  record["cpu"] = cpu_name();
  record["key"] = reference_key(request);
  for (const auto& [key, value] : record.items()) {
    reference.image.metadata[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  reference.image.metadata["exposure"] = fmt::format("{}", scene.camera().exposure);
  return reference;
}

bool reference_is_current(const std::string& exr, const ReferenceRequest& request) {
  std::error_code error;
  if (!fs::is_regular_file(exr, error) || !fs::is_regular_file(record_file(exr), error)) return false;
  const nlohmann::json record = nlohmann::json::parse(content_of(record_file(exr)), nullptr, false);
  if (!record.is_object() || !record.contains("key")) return false;
  const std::string key = reference_key(request);
  if (record["key"] != key) return false;
  try {  // a damaged picture is made again, not complained about
    const ImageFile image = read_image(exr);
    const auto found = image.metadata.find("key");
    const Image& mean = image.layers.at("");
    const bool right_size =
        request.width == 0 || (mean.width == request.width && mean.height == request.height);
    return found != image.metadata.end() && found->second == key && right_size && image.layers.count("A") &&
           image.layers.count("B");
  } catch (const SceneError&) {
    return false;
  }
}

void write_reference(const std::string& exr, const ReferenceRequest& request, const Reference& reference) {
  // The record last: without it, or with another key, the picture does not count as made.
  const auto exposure = reference.record.find("exposure");
  write_image(exr, reference.image, exposure == reference.record.end() ? 1.0f : exposure->get<float>());
  nlohmann::json record = reference.record;
  record["request"] = {
      {"settings", request.settings}, {"passes", request.passes}, {"seconds", request.seconds}};
  write_text(record_file(exr), record.dump(2) + "\n");
}

}  // namespace zonal
