// `zonal compare`: the metrics of one pair of pictures, as a table or as JSON.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>

#include "apps/commands.h"
#include "core/error.h"
#include "core/error_map.h"
#include "core/flip_hdr.h"
#include "core/metrics.h"

namespace zonal {
namespace {

struct Options {
  std::string image, reference, error_map, flip_map;
  double exposure = 0;  ///< 0: from the metadata
  bool json = false, flip_hdr = false;
};

const Image* layer(const ImageFile& file, const std::string& name) {
  const auto found = file.layers.find(name);
  return found == file.layers.end() ? nullptr : &found->second;
}

/// The pair shares one exposure: the option's, else the reference's, else the image's, else 1.
float exposure_of(const Options& options, const ImageFile& image, const ImageFile& reference) {
  if (options.exposure > 0) return static_cast<float>(options.exposure);
  for (const auto& [file, name] :
       {std::pair(&reference, &options.reference), std::pair(&image, &options.image)}) {
    const auto found = file->metadata.find("exposure");
    if (file->display_referred || found == file->metadata.end()) continue;
    char* end = nullptr;
    const float exposure = std::strtof(found->second.c_str(), &end);
    if (*end == 0 && !found->second.empty() && exposure > 0 && std::isfinite(exposure)) return exposure;
    throw SceneError(fmt::format("{}: metadata zonal:exposure: found \"{}\", expected a number > 0", *name,
                                 found->second));
  }
  return 1;
}

/// JSON has no infinity; NaN becomes null by itself.
nlohmann::ordered_json number(double x) {
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  return x;
}

nlohmann::ordered_json to_json(const LinearMetrics& m) {
  return {{"rmse", number(m.rmse)},           {"mae", number(m.mae)},
          {"relmse", number(m.relmse)},       {"relmse_trimmed", number(m.relmse_trimmed)},
          {"smape", number(m.smape)},         {"bias", number(m.bias)},
          {"fireflies", number(m.fireflies)}, {"nan", m.nan}};
}

nlohmann::ordered_json to_json(const DisplayMetrics& m) {
  return {{"rmse", number(m.rmse)},
          {"mae", number(m.mae)},
          {"psnr", number(m.psnr)},
          {"ssim", number(m.ssim)},
          {"flip", number(m.flip)}};
}

/// What only a reference of two halves can tell.
nlohmann::ordered_json reference_json(const LinearMetrics& m) {
  return {{"rmse_unbiased", number(std::sqrt(std::max(0.0, *m.mse_unbiased)))},
          {"reference_floor", number(*m.reference_floor)},
          {"reference_limited", m.reference_limited()}};
}

std::string cell(const nlohmann::ordered_json& value) {
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() ? "-" : value.dump();
}

void print_table(const nlohmann::ordered_json& result) {
  for (const auto& [group, metrics] : result.items()) {
    for (const auto& [name, value] : metrics.items()) {
      std::string unit;
      for (const MetricInfo& info : metric_infos()) {
        if (info.values == group && info.name == name) unit = info.unit;
      }
      fmt::print("{:<10}{:<18}{:>14}  {}\n", group, name, cell(value), unit);
    }
  }
}

int compare_command(const Options& options) {
  for (const std::string& file : {options.error_map, options.flip_map})
    if (!file.empty()) check_writable(file);
  const ImageFile image = read_image(options.image), reference = read_image(options.reference);
  const Image &x = image.layers.at(""), &r = reference.layers.at("");
  const float exposure = exposure_of(options, image, reference);
  // Values of a PNG are display values already; a radiance compared with one is brought there.
  const bool linear = !image.display_referred && !reference.display_referred;
  const Image shown_x = image.display_referred ? x : to_display(x, exposure);
  const Image shown_r = reference.display_referred ? r : to_display(r, exposure);

  nlohmann::ordered_json result;
  std::optional<LinearMetrics> metrics;
  if (linear) {
    metrics =
        linear_metrics(x, r, layer(reference, "A"), layer(reference, "B"), layer(reference, "variance"));
    result["linear"] = to_json(*metrics);
    if (options.flip_hdr) result["linear"]["flip_hdr"] = number(mean_of_map(FlipHdr(r).map(x)));
  }
  result["display"] = to_json(display_metrics(shown_x, shown_r));
  if (metrics && metrics->mse_unbiased) result["reference"] = reference_json(*metrics);
  if (options.json) {
    fmt::print("{}\n", result.dump(2));
  } else {
    print_table(result);
  }

  const auto draw = [&](const std::string& file, const char* what, const Image& error) {
    ImageFile map = error_map(error);
    map.metadata["image"] = options.image, map.metadata["reference"] = options.reference;
    write_image(file, map, 1);
    if (!options.json)
      fmt::print("{}: {} from {} (dark) to {} (bright)\n", file, what, map.metadata["error_map_low"],
                 map.metadata["error_map_high"]);
  };
  if (!options.error_map.empty())
    draw(options.error_map, "relative error",
         linear ? relative_error(x, r) : relative_error(shown_x, shown_r));
  if (!options.flip_map.empty()) draw(options.flip_map, "FLIP", flip_map(shown_x, shown_r));
  return kDone;
}

}  // namespace

void add_compare(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("compare", "metrics of one pair of pictures");
  command->add_option("image", options->image, "picture to score (.exr, .hdr, .png)")->required();
  command->add_option("reference", options->reference, "what it should look like")->required();
  command
      ->add_option("--exposure", options->exposure,
                   "factor before the display transform; default: the metadata's")
      ->check(CLI::Range(1e-30, 1e30));
  command->add_option("--error-map", options->error_map, "PNG of the relative error of each pixel");
  command->add_option("--flip-map", options->flip_map, "PNG of what FLIP says of each pixel");
  command->add_flag("--flip-hdr", options->flip_hdr,
                    "HDR-FLIP too: FLIP's worst over exposures, as many times as slow");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([=] { *exit_code = compare_command(*options); });
}

}  // namespace zonal
