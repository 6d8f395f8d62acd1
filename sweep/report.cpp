#include "sweep/report.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <bit>
#include <cmath>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/image.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void write_text_file(const std::string& file, const std::string& text) {
  write_atomically(file, text.data(), text.size());
}

std::string base64(const std::vector<uint32_t>& words) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = reinterpret_cast<const unsigned char*>(words.data());
  const size_t size = words.size() * 4;
  std::string text;
  text.reserve(size * 4 / 3 + 4);
  for (size_t i = 0; i < size; i += 3) {
    const size_t left = std::min<size_t>(3, size - i);
    const uint32_t three =
        bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += kDigits[three >> 18], text += kDigits[three >> 12 & 63];
    text += left > 1 ? kDigits[three >> 6 & 63] : '=', text += left > 2 ? kDigits[three & 63] : '=';
  }
  return text;
}

/// A picture is written once; it changes only with the EXR it was made of.
void write_picture(const CellStore& store, const std::string& id, const std::string& exr) {
  const std::string file = store.folder() + "/images/" + id + ".js";
  std::error_code error;
  if (!fs::exists(exr, error)) return;
  if (fs::exists(file, error) && fs::last_write_time(file) >= fs::last_write_time(exr)) return;
  write_text_file(file, picture_script(id, exr));
}

}  // namespace

uint32_t pack_rgb9e5(vec3 color) {
  static_assert(std::endian::native == std::endian::little);
  constexpr float kLargest = 65408.0f;  // 511/512 2^16
  const auto clean = [](float x) {
    return x > 0 ? std::fmin(x, kLargest) : 0.0f;
  };  // NaN fails the comparison
  const float r = clean(color.x), g = clean(color.y), b = clean(color.z);
  const float most = std::fmax(r, std::fmax(g, b));
  int exponent = most > 0 ? std::max(-16, std::ilogb(most)) + 16 : 0;
  float scale = std::exp2(float(exponent - 24));
  if (std::lround(most / scale) == 512) ++exponent, scale *= 2;
  const auto mantissa = [&](float x) { return static_cast<uint32_t>(std::lround(x / scale)); };
  return mantissa(r) | mantissa(g) << 9 | mantissa(b) << 18 | static_cast<uint32_t>(exponent) << 27;
}

std::string picture_script(const std::string& id, const std::string& exr_file) {
  const ImageFile file = read_image(exr_file);
  const Image& image = file.layers.at("");
  std::vector<uint32_t> words(static_cast<size_t>(image.width) * image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      words[static_cast<size_t>(y) * image.width + x] = pack_rgb9e5(image.rgb(x, y));
  const auto exposure = file.metadata.find("exposure");
  return fmt::format("zonal_image({}, {{width: {}, height: {}, exposure: {}, data: \"{}\"}});\n",
                     json(id).dump(), image.width, image.height,
                     exposure == file.metadata.end() ? "1" : exposure->second, base64(words));
}

void write_report(const json& results, const CellStore& store) {
  const std::string folder = store.folder() + "/";
  const auto& cells = results["cells"];
  oneapi::tbb::parallel_for(size_t(0), cells.size(), [&](size_t i) {
    if (cells[i]["image"].is_null()) return;
    const std::string id = cells[i]["id"];
    write_picture(store, id, store.cell_folder(id) + "/image.exr");
  });
  for (const json& reference : results["references"])
    write_picture(store, reference["id"], store.reference_file(reference["id"]));
  const std::string metric = results["metrics"][0]["name"];
  for (const json& scene : results["scenes"])
    write_text_file(folder + "charts/" + scene["id"].get<std::string>() + ".svg",
                    pareto_svg(results, scene["id"], metric));
  write_text_file(folder + "results.csv", results_csv(results));
  write_text_file(folder + "table.md", table_markdown(results));
  write_text_file(folder + "table.tex", table_latex(results));
  for (size_t i = 0; i < kReportFileCount; ++i)
    write_atomically(folder + kReportFiles[i].name, kReportFiles[i].bytes, kReportFiles[i].size);
  const std::string text = results.dump(-1, ' ', false, json::error_handler_t::replace);
  write_text_file(folder + "data.js", "zonal_results(" + text + ");\n");
  write_text_file(folder + "results.json",
                  results.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace zonal
