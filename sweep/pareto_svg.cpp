// A still chart of error against time, for papers and for where the page's own charts were not built.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sweep/report.h"

namespace zonal {
namespace {

using nlohmann::json;

// Okabe and Ito 2008: told apart with any colour vision.
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#555555"};
constexpr double kWidth = 640, kHeight = 420, kLeft = 70, kRight = 190, kTop = 36, kBottom = 50;

/// A logarithmic axis over the data, a little wider than it.
struct Axis {
  double low = 1e300, high = 0;
  void include(double x) {
    if (x > 0) low = std::min(low, x), high = std::max(high, x);
  }
  void close() {
    if (high <= 0) low = 0.1, high = 10;
    low /= 1.25, high *= 1.25;
  }
  double at(double x, double from, double to) const {
    return from + (to - from) * std::log(std::clamp(x, low, high) / low) / std::log(high / low);
  }
  /// 1, 2 and 5 times powers of ten.
  std::vector<double> ticks() const {
    std::vector<double> found;
    for (int e = static_cast<int>(std::floor(std::log10(low))); e <= std::log10(high) + 1; ++e)
      for (const double m : {1.0, 2.0, 5.0})
        if (const double x = m * std::pow(10.0, e); x >= low && x <= high) found.push_back(x);
    return found;
  }
};

struct Point {
  double time, error, low, high;
  bool limited;
};

std::string marker(int kind, double x, double y, const std::string& color, bool hollow) {
  const std::string paint = fmt::format("fill=\"{}\" stroke=\"{}\"", hollow ? "white" : color, color);
  switch (kind % 4) {
    case 0:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" {}/>\n", x, y, paint);
    case 1:
      return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"7\" height=\"7\" {}/>\n", x - 3.5, y - 3.5,
                         paint);
    case 2:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l4.5 8h-9z\" {}/>\n", x, y - 5, paint);
    default:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l5 5-5 5-5-5z\" {}/>\n", x, y - 5, paint);
  }
}

std::string text(double x, double y, const std::string& what, const char* anchor = "start") {
  std::string safe;
  for (const char c : what) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, safe);
}

/// Errors fall; similarity and PSNR do not belong on this chart as they are.
double error_of(double score, const std::string& metric) {
  if (metric == "ssim") return 1 - score;
  return metric == "psnr" ? std::pow(10.0, -score / 20) : score;
}

}  // namespace

std::string pareto_svg(const json& results, const std::string& scene, const std::string& metric) {
  std::map<std::string, std::vector<Point>> families;
  std::map<std::string, std::string> family_of;
  for (const json& method : results["methods"]) family_of[method["id"]] = method["family"];
  Axis x_axis, y_axis;
  for (const json& group : results["groups"]) {
    if (group["scene"] != scene || group["time"].is_null() || !group["scores"].contains(metric)) continue;
    const json& score = group["scores"][metric];
    Point p{group["time"]["median"], error_of(score["mean"], metric), error_of(score["low"], metric),
            error_of(score["high"], metric), group["reference_limited"]};
    if (p.low > p.high) std::swap(p.low, p.high);
    x_axis.include(p.time);
    for (const double e : {p.error, p.high}) y_axis.include(e);
    families[family_of[group["method"]]].push_back(p);
  }
  double floor = 0;
  for (const json& reference : results["references"])
    if (reference["scene"] == scene && metric == "rmse")
      floor = std::max(floor, reference["floor"].value("rmse", 0.0));
  x_axis.close(), y_axis.close();

  const double right = kWidth - kRight, bottom = kHeight - kBottom;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      kWidth, kHeight);
  svg += text(kLeft, 20, scene + ": " + (metric == "ssim" ? "1 - SSIM" : metric) + " against time");
  for (const double t : x_axis.ticks()) {
    const double x = x_axis.at(t, kLeft, right);
    svg += fmt::format("<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/>\n", x, kTop, bottom) +
           text(x, bottom + 16, fmt::format("{:g}", t), "middle");
  }
  for (const double e : y_axis.ticks()) {
    const double y = y_axis.at(e, bottom, kTop);
    svg += fmt::format("<path d=\"M{0} {2:.1f}H{1}\" stroke=\"#ddd\"/>\n", kLeft, right, y) +
           text(kLeft - 6, y + 4, fmt::format("{:g}", e), "end");
  }
  svg += text(0.5 * (kLeft + right), kHeight - 12, "seconds (begin_pass + radiance)", "middle");
  if (floor > y_axis.low) {
    const double y = y_axis.at(floor, bottom, kTop);
    svg += fmt::format("<path d=\"M{} {:.1f}H{}\" stroke=\"#888\" stroke-dasharray=\"4 3\"/>\n", kLeft, y,
                       right) +
           text(right + 6, y + 4, "noise of the reference");
  }
  int i = 0;
  for (auto& [family, points] : families) {
    const std::string color = kColors[i % 7];
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.time < b.time; });
    std::string path;
    for (const Point& p : points)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x_axis.at(p.time, kLeft, right),
                          y_axis.at(p.error, bottom, kTop));
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-opacity=\"0.5\"/>\n", path, color);
    for (const Point& p : points) {
      const double x = x_axis.at(p.time, kLeft, right), y = y_axis.at(p.error, bottom, kTop);
      svg += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"{3}\"/>\n", x,
                         y_axis.at(p.low, bottom, kTop), y_axis.at(p.high, bottom, kTop), color);
      svg += marker(i, x, y, color, p.limited);
    }
    svg += marker(i, right + 14, kTop + 10 + 18 * i, color, false) +
           text(right + 24, kTop + 14 + 18 * i, family);
    ++i;
  }
  return svg + "</svg>\n";
}

}  // namespace zonal
