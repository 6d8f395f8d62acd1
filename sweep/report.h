#pragma once
/// Writes what people look at: index.html with its data and pictures, results.json, results.csv, table.md,
/// table.tex and charts/*.svg, all in the sweep's folder, readable from the file system without a server.

#include <nlohmann/json.hpp>

#include "sweep/cell_store.h"

namespace zonal {

void write_report(const nlohmann::json& results, const CellStore& store);

/// A picture as the page reads it: a script that hands over RGB9E5 pixels in base64 (sweep/report/images.js).
std::string picture_script(const std::string& id, const std::string& exr_file);
/// OpenGL's EXT_texture_shared_exponent: three 9-bit mantissas and a 5-bit exponent, bias 15. Negative and
/// not-finite values become 0, too bright ones the largest.
uint32_t pack_rgb9e5(vec3 color);

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
