// zonal material merl: full-size MERL files out of published fits and analytic models.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "apps/commands.h"
#include "core/error.h"
#include "core/json_fields.h"
#include "core/stop.h"
#include "materials/material.h"
#include "materials/merl.h"
#include "materials/merl_fits.h"

namespace zonal {
namespace {

struct MerlOptions {
  std::string source, material, output;
  bool quiet = false;
};

/// "ggx:roughness=0.3,f0=0.9" as a kind and its numbers.
struct Analytic {
  std::string text, kind;
  std::vector<std::pair<std::string, float>> numbers;

  explicit Analytic(const std::string& source) : text(source), kind(source.substr(0, source.find(':'))) {
    size_t at = kind.size();
    while (at < text.size()) {
      const size_t end = std::min(text.find(',', at + 1), text.size());
      const std::string entry = text.substr(at + 1, end - at - 1);
      const size_t equals = std::min(entry.find('='), entry.size());
      float value = 0;
      const char* last = entry.data() + entry.size();
      const auto [stop, error] =
          std::from_chars(entry.data() + std::min(equals + 1, entry.size()), last, value);
      if (error != std::errc() || stop != last || equals == 0) {
        throw SceneError(fmt::format("{}: found {}, expected key=number", text, in_quotes(entry)));
      }
      numbers.emplace_back(entry.substr(0, equals), value);
      at = end;
    }
  }
  /// Takes a number out of the list; what is left at the end nobody knows.
  float take(const std::string& key, float otherwise, float low, float high) {
    for (auto it = numbers.begin(); it != numbers.end(); ++it) {
      if (it->first != key) continue;
      const float value = it->second;
      if (!(value >= low && value <= high)) {
        throw SceneError(
            fmt::format("{}: {}: found {}, expected a number in [{}, {}]", text, key, value, low, high));
      }
      numbers.erase(it);
      return value;
    }
    return otherwise;
  }
  void finish(const std::vector<std::string>& known) const {
    if (numbers.empty()) return;
    throw SceneError(fmt::format("{}: unknown key \"{}\"{}", text, numbers[0].first,
                                 did_you_mean(numbers[0].first, known)));
  }
};

MerlFit analytic_fit(const std::string& source) {
  Analytic a(source);
  const std::vector<std::string> kinds = {"ggx", "lambert"};
  if (a.kind == "lambert") {
    LambertMaterial material;
    material.albedo.value = vec3(a.take("albedo", 0.5f, 0, 1));
    a.finish({"albedo"});
    return {source, "analytic", merl_function(material.at(vec2(0)))};
  }
  if (a.kind == "ggx") {
    MetallicRoughnessMaterial material;
    material.metallic.value = 1;
    material.base_color.value = vec3(a.take("f0", 0.9f, 0, 1));
    material.roughness.value = a.take("roughness", 0.3f, 0, 1);
    a.finish({"f0", "roughness"});
    return {source, "analytic", merl_function(material.at(vec2(0)))};
  }
  throw SceneError(
      fmt::format("{}: found neither a file nor an analytic model{}", source, did_you_mean(a.kind, kinds)));
}

/// A name that says what is in the file, since a MERL file has no place for it.
std::string default_output(const MerlFit& fit) {
  std::string name = fit.name;
  for (char& c : name) {
    if (c == ':' || c == ',' || c == '/') c = '-';
  }
  return name + (fit.model == "analytic" ? ".analytic.binary" : ".fit-" + fit.model + ".binary");
}

void write_material(const MerlOptions& options) {
  const bool is_file = std::filesystem::exists(options.source);
  const bool analytic = !is_file && (options.source.find(':') != std::string::npos ||
                                     options.source == "ggx" || options.source == "lambert");
  if (analytic && !options.material.empty()) {
    throw SceneError(fmt::format("{}: found --material {}, expected none for an analytic model",
                                 options.source, in_quotes(options.material)));
  }
  const MerlFit fit =
      analytic ? analytic_fit(options.source) : read_merl_fit(options.source, options.material);
  const std::string file = options.output.empty() ? default_output(fit) : options.output;

  const Clock::time_point start = Clock::now();
  write_merl(file, fit.brdf);
  if (options.quiet) return;
  const double seconds = seconds_since(start);
  const auto brdf = load_merl(file);
  const auto& merl = static_cast<const MerlBrdf&>(*brdf);
  const vec3 albedo = merl.albedo;
  fmt::print("{}: {} {}, {:.1f} MB in {:.1f} s\n", file, fit.model, fit.name,
             double(std::filesystem::file_size(file)) * 1e-6, seconds);
  fmt::print("  albedo ({:.3f}, {:.3f}, {:.3f}), at most {:.3f} of the light from {:.0f} degrees\n", albedo.x,
             albedo.y, albedo.z, max_component(merl.largest_albedo), merl.largest_albedo_degrees);
  for (const std::string& note : merl.notes) fmt::print("  {}\n", note);
}

}  // namespace

void add_material_merl(CLI::App& material, int* exit_code) {
  auto options = std::make_shared<MerlOptions>();
  CLI::App* command =
      material.add_subcommand("merl", "write a MERL file from a published fit or an analytic model");
  command
      ->add_option("source", options->source,
                   "table of ABC or SGD parameters (CSV), network (text), ggx:roughness=0.3,f0=0.9 or "
                   "lambert:albedo=0.5")
      ->required();
  command->add_option("--material", options->material, "row of the table, e.g. alum-bronze");
  command->add_option("-o,--output", options->output, "file to write (default: NAME.fit-MODEL.binary)");
  command->add_flag("--quiet", options->quiet, "print nothing");
  command->callback([=] {
    write_material(*options);
    *exit_code = kDone;
  });
}

}  // namespace zonal
