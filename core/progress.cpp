#include "core/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

namespace zonal {
namespace {

constexpr double kTerminalSeconds = 0.1, kLogSeconds = 5;

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::clamp(seconds, 0.0, 1e9) + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string progress_text(const std::string& label, const Progress& progress) {
  const double done = std::clamp(progress.fraction, 0.0, 1.0);
  std::string text = label + ": ";
  if (progress.pass >= 0) text += fmt::format("pass {}, ", progress.pass + 1);
  text += fmt::format("{} %, {} gone", static_cast<int>(100 * done), duration_text(progress.seconds));
  if (done >= 0.01) text += fmt::format(", {} left", duration_text(progress.seconds * (1 - done) / done));
  return text;
}

ProgressPrinter::ProgressPrinter(std::string label, bool quiet, std::FILE* stream)
    : label_(std::move(label)),
      quiet_(quiet),
      terminal_(::isatty(::fileno(stream)) != 0),
      stream_(stream),
      last_(Clock::now()) {}

void ProgressPrinter::update(const Progress& progress) {
  if (quiet_ || seconds_since(last_) < (terminal_ ? kTerminalSeconds : kLogSeconds)) return;
  last_ = Clock::now();
  // \r returns to the line's start, ESC [K clears what a longer line left behind.
  const std::string text = progress_text(label_, progress);
  fmt::print(stream_, "{}{}{}", terminal_ ? "\r" : "", text, terminal_ ? "\x1b[K" : "\n");
  std::fflush(stream_);
  line_shown_ = terminal_;
}

void ProgressPrinter::finish() {
  if (!line_shown_) return;
  fmt::print(stream_, "\r\x1b[K");
  std::fflush(stream_);
  line_shown_ = false;
}

}  // namespace zonal
