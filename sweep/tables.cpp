// The tables of a sweep: CSV with a row a cell, Markdown and LaTeX with a row a group.

#include <fmt/format.h>

#include "sweep/report.h"

namespace zonal {
namespace {

using nlohmann::json;

std::string text_of(const json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.9g}", value.get<double>());
  return value.dump();
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string latex(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// "0.1234 +- 0.002": mean and half of its 95 % interval.
std::string interval(const json& score, const char* plus_minus) {
  const double mean = score["mean"], half = 0.5 * (score["high"].get<double>() - score["low"].get<double>());
  if (!(half > 0)) return fmt::format("{:.4g}", mean);
  return fmt::format("{:.4g} {} {}", mean, plus_minus,
                     half < 10 ? fmt::format("{:.1g}", half) : fmt::format("{:.0f}", half));
}

struct Row {
  std::vector<std::string> columns;
};

std::vector<Row> rows_of(const json& results, const std::vector<std::string>& metrics,
                         const char* plus_minus) {
  std::vector<Row> rows;
  for (const json& group : results["groups"]) {
    Row row;
    std::string method = group["method"];
    // A count that was searched is part of what the row is about.
    for (const auto& [key, value] : group["varied"].items())
      if (method.find(key + "=") == std::string::npos) method += fmt::format(" {}={}", key, text_of(value));
    row.columns = {group["scene"], method, group["budget"]};
    const json& time = group["time"];
    row.columns.push_back(time.is_null() ? "-" : fmt::format("{:.3g}", time["median"].get<double>()));
    row.columns.push_back(group["time_ratio"].is_null() ? "" : interval(group["time_ratio"], plus_minus));
    for (const std::string& metric : metrics) {
      const json& scores = group["scores"];
      row.columns.push_back(scores.contains(metric) ? interval(scores[metric], plus_minus) : "-");
    }
    row.columns.push_back(group["noise"].is_null() ? "-"
                                                   : fmt::format("{:.3g}", group["noise"].get<double>()));
    row.columns.push_back(group["bias"].is_null() ? "-" : fmt::format("{:.3g}", group["bias"].get<double>()));
    std::string note;
    if (group["failed"].get<int>() > 0) note = fmt::format("{} failed", group["failed"].get<int>());
    if (group["reference_limited"].get<bool>())
      note += note.empty() ? "reference-limited" : ", reference-limited";
    for (const json& cell : results["cells"])
      if (cell["group"] == group["id"] && cell["status"] == "not_reached") {
        note += note.empty() ? "not reached" : ", not reached";
        break;
      }
    row.columns.push_back(note);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The metrics that the sweep file names.
std::vector<std::string> shown_metrics(const json& results) {
  std::vector<std::string> names;
  for (const json& metric : results["metrics"])
    if (metric["named"].get<bool>()) names.push_back(metric["name"]);
  return names;
}

std::vector<std::string> headings(const std::vector<std::string>& metrics) {
  std::vector<std::string> all{"scene", "method", "budget", "seconds", "ratio"};
  all.insert(all.end(), metrics.begin(), metrics.end());
  for (const char* more : {"noise", "bias", "note"}) all.push_back(more);
  return all;
}

}  // namespace

std::string results_csv(const json& results) {
  std::string text =
      "scene,method,backend,budget,seed,status,reason,parameters,passes,load_s,begin_pass_s,radiance_s,time_"
      "s";
  for (const json& metric : results["metrics"]) text += "," + metric["name"].get<std::string>();
  text += ",reference,reference_limited\n";
  for (const json& cell : results["cells"]) {
    std::vector<std::string> fields;
    for (const char* key :
         {"scene", "method", "backend", "budget", "seed", "status", "reason", "parameters", "passes"})
      fields.push_back(cell.contains(key) ? text_of(cell[key]) : "");
    for (const char* key : {"load", "begin_pass", "radiance"})
      fields.push_back(cell.contains("seconds") ? text_of(cell["seconds"][key]) : "");
    fields.push_back(text_of(cell["time"]));
    for (const json& metric : results["metrics"]) {
      const std::string name = metric["name"];
      fields.push_back(cell["scores"].contains(name) ? text_of(cell["scores"][name]) : "");
    }
    fields.push_back(text_of(cell["reference"]));
    fields.push_back(cell.contains("reference_limited") ? text_of(cell["reference_limited"]) : "");
    for (size_t i = 0; i < fields.size(); ++i) text += (i ? "," : "") + csv_field(fields[i]);
    text += "\n";
  }
  return text;
}

std::string table_markdown(const json& results) {
  const std::vector<std::string> metrics = shown_metrics(results);
  std::string text;
  const auto line = [&](const std::vector<std::string>& columns) {
    for (const std::string& column : columns) text += "| " + column + " ";
    text += "|\n";
  };
  const std::vector<std::string> all = headings(metrics);
  line(all);
  for (size_t i = 0; i < all.size(); ++i) text += i < 3 || i + 1 == all.size() ? "|---" : "|---:";
  text += "|\n";
  for (const Row& row : rows_of(results, metrics, "±")) line(row.columns);
  text +=
      "\nMean and 95 % interval over seeds; seconds: median of begin_pass plus radiance; ratio: to the "
      "scene's first method, a repeat of the sweep falls inside in 95 % of cases. noise: what seeds "
      "differ by; bias: "
      "what their mean is off by (both linear RMS).\n";
  for (const json& metric : results["metrics"])
    if (metric["named"].get<bool>())
      text +=
          fmt::format("{}: {}\n", metric["name"].get<std::string>(), metric["formula"].get<std::string>());
  return text;
}

std::string table_latex(const json& results) {
  const std::vector<std::string> metrics = shown_metrics(results);
  const std::vector<std::string> all = headings(metrics);
  std::string text = "\\begin{tabular}{lll" + std::string(all.size() - 4, 'r') + "l}\n\\hline\n";
  const auto line = [&](const std::vector<std::string>& columns, bool escape) {
    for (size_t i = 0; i < columns.size(); ++i)
      text += (i ? " & " : "") + (escape ? latex(columns[i]) : columns[i]);
    text += " \\\\\n";
  };
  line(all, true);
  text += "\\hline\n";
  for (Row row : rows_of(results, metrics, "@")) {
    for (std::string& column : row.columns) {
      column = latex(column);
      if (const size_t at = column.find('@'); at != std::string::npos) column.replace(at, 1, "$\\pm$");
    }
    line(row.columns, false);
  }
  return text + "\\hline\n\\end{tabular}\n";
}

}  // namespace zonal
