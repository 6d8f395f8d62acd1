#include "sweep/report.h"

#include <fmt/format.h>

#include "core/atomic_file.h"

namespace zonal {
namespace {

using nlohmann::json;

void write_text_file(const std::string& file, const std::string& text) {
  write_atomically(file, text.data(), text.size());
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
  const std::string text = results.dump(-1, ' ', false, json::error_handler_t::replace);
  write_text_file(folder + "data.js", "zonal_results(" + text + ");\n");
  write_text_file(folder + "results.json",
                  results.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace zonal
