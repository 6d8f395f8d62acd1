// What the values of several subcommands' options mean.

#include <fmt/format.h>

#include <map>

#include "apps/commands.h"
#include "core/error.h"

namespace zonal {

void apply_settings(const std::vector<std::string>& entries, nlohmann::json* settings) {
  for (const std::string& entry : entries) {
    const size_t equals = entry.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw SceneError(
          fmt::format("--set: found \"{}\", expected key=value, for example --set lights=400", entry));
    }
    const std::string value = entry.substr(equals + 1);
    // A word such as `brdf` is no JSON: it is meant as text.
    const nlohmann::json parsed = nlohmann::json::parse(value, nullptr, false);
    (*settings)[entry.substr(0, equals)] = parsed.is_discarded() ? nlohmann::json(value) : parsed;
  }
}

nlohmann::json material_replacements(const std::vector<std::string>& entries) {
  nlohmann::json replacements = nlohmann::json::object();
  for (const std::string& entry : entries) {
    const size_t equals = entry.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == entry.size())
      throw SceneError(fmt::format(
          "--material: found \"{}\", expected name=entry, for example --material bronze=rgl/paper_white",
          entry));
    const std::string value = entry.substr(equals + 1);
    const nlohmann::json parsed = nlohmann::json::parse(value, nullptr, false);
    replacements[entry.substr(0, equals)] = parsed.is_object() ? parsed : nlohmann::json(value);
  }
  return replacements;
}

void add_material_option(CLI::App& command, std::vector<std::string>* entries) {
  command
      .add_option("--material", *entries,
                  "name=entry: the scene's material of that name becomes the material database's entry (or a "
                  "JSON object)")
      ->allow_extra_args(false);
}

void add_pixels_option(CLI::App& command, RenderOptions::Pixels* pixels) {
  using Pixels = RenderOptions::Pixels;
  const std::map<std::string, Pixels> names{
      {"automatic", Pixels::automatic}, {"center", Pixels::center}, {"jitter", Pixels::jitter}};
  command
      .add_option("--pixels", *pixels,
                  "where in a pixel rays start: automatic (center for one pass, else jitter), center, jitter")
      ->transform(CLI::CheckedTransformer(names));
}

void parse_size(const std::string& text, int* width, int* height) {
  constexpr int kLargest = 32768;
  // At most five digits a side, so that stoi cannot overflow.
  const auto side = [](const std::string& digits) {
    if (digits.empty() || digits.size() > 5 || digits.find_first_not_of("0123456789") != std::string::npos)
      return 0;
    return std::stoi(digits);
  };
  const size_t cross = text.find('x');
  const int w = cross == std::string::npos ? 0 : side(text.substr(0, cross));
  const int h = cross == std::string::npos ? 0 : side(text.substr(cross + 1));
  if (w < 1 || h < 1 || w > kLargest || h > kLargest) {
    throw SceneError(fmt::format(
        "--size: found \"{}\", expected WIDTHxHEIGHT in pixels, each 1 to {}, for example 640x360", text,
        kLargest));
  }
  *width = w, *height = h;
}

}  // namespace zonal
