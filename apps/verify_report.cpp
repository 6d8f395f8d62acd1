#include "apps/verify_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>

namespace zonal {
namespace {

/// "(l,m)" of the index l(l+1)+m.
std::string degree_and_order(size_t i) {
  const int l = static_cast<int>(std::sqrt(static_cast<double>(i) + 0.5));
  return fmt::format("({},{})", l, static_cast<int>(i) - l * (l + 1));
}

std::string element(Layout layout, size_t i, size_t size) {
  if (layout == Layout::kCoefficients) return degree_and_order(i);
  if (layout == Layout::kCoefficientGradients)
    return fmt::format("{}.{}", degree_and_order(i / 3), "xyz"[i % 3]);
  return size == 1 ? "" : fmt::format("[{}]", i);
}

const Deviation* worst(const std::vector<Deviation>& all) {
  const auto found = std::max_element(all.begin(), all.end(),
                                      [](const auto& a, const auto& b) { return a.share < b.share; });
  return found == all.end() ? nullptr : &*found;
}

std::string phrase(const Deviation& d) {
  return fmt::format("{:.2g} absolute, {:.2g} relative at {}, tolerance {:.2g}", d.absolute, d.relative,
                     d.place, d.allowed);
}

}  // namespace

void Report::compare(Precision p, const char* quantity, const std::string& label,
                     const std::vector<double>& got, const std::vector<double>& truth, double condition) {
  assert(got.size() == truth.size());
  const bool is_float = p == Precision::kFloat;
  const Tolerance& row = tolerance_of(kind_.c_str(), quantity);
  std::vector<Deviation>& all = is_float ? in_float : in_double;
  auto place = std::find_if(all.begin(), all.end(), [&](const auto& d) { return d.quantity == quantity; });
  if (place == all.end()) {
    all.push_back({.quantity = quantity, .place = {}});
    place = all.end() - 1;
  }

  double largest = 0;
  for (double x : truth) largest = std::max(largest, std::abs(x));
  // Below the smallest normal number a type has no relative precision left to ask for.
  const double smallest =
      is_float ? double(std::numeric_limits<float>::min()) : std::numeric_limits<double>::min();
  const double biggest =
      is_float ? double(std::numeric_limits<float>::max()) : std::numeric_limits<double>::max();
  const double base = (is_float ? row.in_float : row.in_double) * (row.unit == Unit::kAbsolute ? 1 : largest);
  const double allowed = base + condition + smallest;
  for (size_t i = 0; i < truth.size(); ++i) {
    // What no number of this type can hold may come out as infinity, not as NaN.
    const bool overflows = std::abs(truth[i]) > biggest && !std::isnan(got[i]);
    const double absolute = overflows ? 0 : std::abs(got[i] - truth[i]);
    const double share =
        std::isfinite(absolute) ? absolute / allowed : std::numeric_limits<double>::infinity();
    ++place->values;
    if (share <= place->share) continue;
    *place = {.quantity = quantity,
              .place = fmt::format("{} {}{}", label, quantity, element(row.layout, i, truth.size())),
              .absolute = absolute,
              .relative = largest > 0 ? absolute / largest : 0,
              .allowed = allowed,
              .share = share,
              .values = place->values};
  }
}

bool Verdict::passed() const {
  const auto within = [](const Deviation& d) { return d.share <= 1; };
  return std::all_of(in_float.begin(), in_float.end(), within) &&
         std::all_of(in_double.begin(), in_double.end(), within);
}

std::string one_line(const Verdict& verdict) {
  std::string line = fmt::format("{}: {}, {}, {} case{}", verdict.file, verdict.passed() ? "ok" : "FAIL",
                                 verdict.kind, verdict.cases, verdict.cases == 1 ? "" : "s");
  if (const Deviation* d = worst(verdict.in_float)) line += "; float: " + phrase(*d);
  if (const Deviation* d = worst(verdict.in_double)) line += "; double: " + phrase(*d);
  return line;
}

std::string details(const Verdict& verdict) {
  std::string text;
  for (const auto& [name, all] :
       {std::pair("float", &verdict.in_float), std::pair("double", &verdict.in_double)})
    for (const Deviation& d : *all)
      text += fmt::format("  {:<4} {:<6} {}: {}; {:.2g} of the tolerance, {} values\n",
                          d.share <= 1 ? "ok" : "FAIL", name, d.quantity, phrase(d), d.share, d.values);
  return text;
}

}  // namespace zonal
