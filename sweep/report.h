#pragma once
/// Writes what people look at: index.html with its data, results.json, results.csv, table.md,
/// table.tex and charts/*.svg, all in the sweep's folder, readable from the file system without a server.

#include <nlohmann/json.hpp>

#include "sweep/cell_store.h"

namespace zonal {

void write_report(const nlohmann::json& results, const CellStore& store);

std::string results_csv(const nlohmann::json& results);
std::string table_markdown(const nlohmann::json& results);
std::string table_latex(const nlohmann::json& results);
/// Error against time of one scene, log-log, one colour and marker a method.
std::string pareto_svg(const nlohmann::json& results, const std::string& scene, const std::string& metric);

/// The page's own files, built into the program: name and content.
struct ReportFile {
  const char* name;
  const unsigned char* bytes;
  size_t size;
};
extern const ReportFile kReportFiles[];
extern const size_t kReportFileCount;

}  // namespace zonal
