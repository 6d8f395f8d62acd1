#include "materials/merl_fits.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "core/error.h"
#include "core/json_fields.h"

namespace zonal {
namespace {

using glm::dvec3;
constexpr double kPiD = 3.14159265358979323846;

/// Cosine of 89.5 degrees, where the outermost samples lie that fits were made to. Both models divide by
/// cosines: smaller ones would leave isolated spikes of 1e8 / sr in the few cells whose centre happens to
/// touch the horizon.
constexpr double kLeastCosine = 0.0087265354983739347;
double cosine_of(const glm::dvec3& w) {
  return std::max(w.z, kLeastCosine);
}

[[noreturn]] void fail(const std::string& file, const std::string& what) {
  throw SceneError(file + ": " + what);
}

/// A table of a hundred materials has 40 kB, a network 9 kB.
constexpr uintmax_t kLargestText = 1 << 20;

std::string read_text_file(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    fail(file, std::filesystem::exists(file, error) ? "not a file" : "cannot be opened");
  }
  const uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kLargestText) {
    fail(file,
         fmt::format("found {} bytes, expected a table or a network of at most {}", size, kLargestText));
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) fail(file, "cannot be opened");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else if (c != '\r') {
      parts.back() += c;
    }
  }
  return parts;
}

/// Columns and rows of a parameter table, as text.
struct Table {
  std::string file;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<size_t> lines;  ///< where each row stands in the file, from 1
};

Table read_table(const std::string& file, const std::string& text) {
  Table table;
  table.file = file;
  const std::vector<std::string> lines = split(text, '\n');
  table.columns = split(lines[0], ',');
  for (size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    table.rows.push_back(split(lines[i], ','));
    table.lines.push_back(i + 1);
    if (table.rows.back().size() != table.columns.size()) {
      fail(file, fmt::format("line {}: found {} columns, expected {}", i + 1, table.rows.back().size(),
                             table.columns.size()));
    }
  }
  if (table.rows.empty()) fail(file, "found no material, expected one a line");
  return table;
}

/// Numbers of one row, by column.
struct Row {
  const Table& table;
  size_t row;

  double number(const std::string& column, double low) const {
    const auto found = std::find(table.columns.begin(), table.columns.end(), column);
    if (found == table.columns.end()) {
      fail(table.file,
           fmt::format("line 1: found no column \"{}\"{}", column, did_you_mean(column, table.columns)));
    }
    const std::string& text = table.rows[row][size_t(found - table.columns.begin())];
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    // Where the masking of (FIT-2) is a step, its c is published as 1e38.
    if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= 1e40)) {
      fail(table.file, fmt::format("line {}, column {}: found {}, expected a number from {} to 1e40",
                                   table.lines[row], column, in_quotes(text), low));
    }
    return value;
  }
  dvec3 color(const std::string& name, double low) const {
    return {number(name + "_r", low), number(name + "_g", low), number(name + "_b", low)};
  }
};

MerlFunction abc_function(const Row& row) {
  AbcParameters p;
  p.diffuse = row.color("kD", 0), p.A = row.color("A", 0);
  p.B = row.number("B", 0), p.C = row.number("C", 0), p.ior = row.number("ior", 1);
  return [p](const dvec3& w_out, const dvec3& w_in) { return evaluate_abc(p, w_out, w_in); };
}

MerlFunction sgd_function(const Row& row) {
  constexpr double kAny = -1e9;
  SgdParameters p;
  p.diffuse = row.color("rhoD", 0), p.specular = row.color("rhoS", 0);
  p.alpha = row.color("alpha", 1e-9), p.p = row.color("p", 0), p.kap = row.color("kap", 0);
  p.f0 = row.color("f0", kAny), p.f1 = row.color("f1", kAny);
  p.lambda = row.color("lambda", 0), p.c = row.color("c", 0), p.k = row.color("k", 0);
  p.theta0 = row.color("theta0", kAny);
  return [p](const dvec3& w_out, const dvec3& w_in) { return evaluate_sgd(p, w_out, w_in); };
}

enum class Kind { abc, sgd, network };
Kind kind_of(const std::string& file, const std::string& text) {
  const std::string first = text.substr(0, text.find('\n'));
  if (first.rfind("merl_name,", 0) == 0) {
    if (first.find(",kD_r,") != std::string::npos) return Kind::abc;
    if (first.find(",rhoD_r,") != std::string::npos) return Kind::sgd;
  }
  if (!first.empty() && first[0] >= '0' && first[0] <= '9') return Kind::network;
  fail(file,
       fmt::format(
           "line 1: found {}, expected the columns of an ABC or SGD table (merl_name, ...) or the size of "
           "a network's first layer (6 21)",
           in_quotes(first)));
}

std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& row : table.rows) names.push_back(row[0]);
  return names;
}

}  // namespace

MerlFit read_merl_fit(const std::string& file, const std::string& material) {
  const std::string text = read_text_file(file);
  const Kind kind = kind_of(file, text);
  if (kind == Kind::network) {
    const std::string name = std::filesystem::path(file).stem().string();
    if (!material.empty() && material != name) {
      fail(file, fmt::format("found a network, which is one material, expected a table to look up \"{}\" in",
                             material));
    }
    return {name, "network", read_merl_network(file, text)};
  }
  const Table table = read_table(file, text);
  const std::vector<std::string> names = names_of(table);
  if (material.empty()) {
    fail(file, fmt::format("found {} materials, expected the name of one of them{}", names.size(),
                           did_you_mean("", names)));
  }
  const auto found = std::find(names.begin(), names.end(), material);
  if (found == names.end()) {
    fail(file, fmt::format("found no material {}{}", in_quotes(material), did_you_mean(material, names)));
  }
  const Row row{table, size_t(found - names.begin())};
  if (kind == Kind::abc) return {material, "abc", abc_function(row)};
  return {material, "sgd", sgd_function(row)};
}

std::vector<std::string> merl_fit_names(const std::string& file) {
  const std::string text = read_text_file(file);
  if (kind_of(file, text) == Kind::network) return {std::filesystem::path(file).stem().string()};
  return names_of(read_table(file, text));
}

glm::dvec3 evaluate_abc(const AbcParameters& p, const dvec3& w_out, const dvec3& w_in) {
  const dvec3 sum = w_out + w_in;
  const double length = glm::length(sum), cos_d = std::min(0.5 * length, 1.0);
  // 1 - cos(theta_h) without cancellation: B reaches 1e7.
  const double cos_h = sum.z / length, sine2 = (sum.x * sum.x + sum.y * sum.y) / (length * length);
  const double one_minus_cos = sine2 / (1 + cos_h);

  // Fresnel of a dielectric at the half vector, by Snell's law.
  const double cos_t = std::sqrt(1 - (1 - cos_d * cos_d) / (p.ior * p.ior));
  const double s = (cos_d - p.ior * cos_t) / (cos_d + p.ior * cos_t);
  const double t = (p.ior * cos_d - cos_t) / (p.ior * cos_d + cos_t);
  const double fresnel = 0.5 * (s * s + t * t);

  // Masking by V-shaped grooves (Cook and Torrance 1982), divided by both cosines. (FIT-1)
  const double out = cosine_of(w_out), in = cosine_of(w_in), low = std::min(out, in),
               high = std::max(out, in);
  const double grooves = std::min(1 / low, 2 * cos_h / cos_d) / high;
  return p.diffuse / kPiD + p.A * (fresnel * grooves / kPiD * std::pow(1 + p.B * one_minus_cos, -p.C));
}

glm::dvec3 evaluate_sgd(const SgdParameters& p, const dvec3& w_out, const dvec3& w_in) {
  const dvec3 sum = w_out + w_in;
  const double length = glm::length(sum), cos_d = std::min(0.5 * length, 1.0);
  const double cos2 = std::max(sum.z * sum.z / (length * length), 1e-9);
  const double tan2 = (sum.x * sum.x + sum.y * sum.y) / std::max(sum.z * sum.z, 1e-9 * length * length);
  const double theta[2] = {std::atan2(std::hypot(w_out.x, w_out.y), w_out.z),
                           std::atan2(std::hypot(w_in.x, w_in.y), w_in.z)};
  const double schlick = std::pow(1 - cos_d, 5), cosines = cosine_of(w_out) * cosine_of(w_in);

  dvec3 f;
  for (int i = 0; i < 3; ++i) {
    const double fresnel = std::max(p.f0[i] - p.f1[i] * cos_d + (1 - p.f0[i]) * schlick, 0.0);
    const double x = p.alpha[i] + tan2 / p.alpha[i];
    const double normals = p.kap[i] * std::exp(-x) / (kPiD * std::pow(x, p.p[i]) * cos2 * cos2);
    double masking = 1;
    for (double angle : theta) {
      const double beyond = std::pow(std::max(angle - p.theta0[i], 0.0), p.k[i]);
      // exp of more than 500 hides everything already; more would overflow.
      masking *= std::clamp(1 + p.lambda[i] * (1 - std::exp(std::min(p.c[i] * beyond, 500.0))), 0.0, 1.0);
    }
    f[i] = (p.diffuse[i] + p.specular[i] * fresnel * normals * masking / cosines) / kPiD;  // (FIT-2)
  }
  return f;
}

}  // namespace zonal
