#include "sweep/report.h"

#include <fmt/format.h>

#include "core/atomic_file.h"

namespace zonal {
namespace {

using nlohmann::json;

void write_text_file(const std::string& file, const std::string& text) {
  write_atomically(file, text.data(), text.size());
}

/// Numbers as the page can show them: six digits.
void round_numbers(json* value) {
  if (value->is_number_float()) *value = std::stod(fmt::format("{:.6g}", value->get<double>()));
  if (value->is_structured())
    for (json& element : *value) round_numbers(&element);
}

/// The results without what the page does not show: it should open at once. All of it is in results.json.
json page_data(json results) {
  for (json& cell : results["cells"]) {
    for (const char* key : {"parameters", "seconds", "counters", "peak_memory_bytes", "runs", "scores_full"})
      cell.erase(key);
    if (cell.contains("curve"))
      for (json& point : cell["curve"])
        for (const char* key : {"rmse_unbiased", "reference_floor", "reference_limited"})
          point["scores"].erase(key);
  }
  for (json& reference : results["references"]) reference.erase("record");
  round_numbers(&results);
  return results;
}

}  // namespace

void write_report(const json& results, const CellStore& store) {
  const std::string folder = store.folder() + "/";
  const std::string metric = results["metrics"][0]["name"];
  for (const json& scene : results["scenes"])
    write_text_file(folder + scene["chart"].get<std::string>(), pareto_svg(results, scene["id"], metric));
  write_text_file(folder + "results.csv", results_csv(results));
  write_text_file(folder + "table.md", table_markdown(results));
  write_text_file(folder + "table.tex", table_latex(results));
  for (size_t i = 0; i < kReportFileCount; ++i)
    write_atomically(folder + kReportFiles[i].name, kReportFiles[i].bytes, kReportFiles[i].size);
  const std::string text = page_data(results).dump(-1, ' ', false, json::error_handler_t::replace);
  write_text_file(folder + "data.js", "zonal_results(" + text + ");\n");
  write_text_file(folder + "results.json",
                  results.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace zonal
