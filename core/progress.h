#pragma once
/// Tells how far a render is and how long it will take: one line rewritten on a terminal, one line every few
/// seconds in a log, nothing when quiet.
///
///     ProgressPrinter printer("cornell path", quiet);
///     render(scene, *integrator, film, budget, options, {}, [&](const Progress& p) { printer.update(p); });
///     printer.finish();

#include <cstdio>
#include <string>

#include "core/render.h"

namespace zonal {

/// "8 s", "2 min 05 s", "3 h 07 min".
std::string duration_text(double seconds);

/// "cornell path: pass 12, 34 %, 8 s gone, 15 s left". The time left is the time gone scaled by what is left
/// to do; it is not told before a hundredth is done. A negative pass is left out: work that has none.
std::string progress_text(const std::string& label, const Progress& progress);

/// Not to be called from two threads at once; `render` sees to that.
class ProgressPrinter {
 public:
  /// Writes to `stream`; whether that is a terminal decides the manner.
  ProgressPrinter(std::string label, bool quiet, std::FILE* stream = stderr);
  ~ProgressPrinter() { finish(); }
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  void update(const Progress& progress);
  /// Clears the terminal's line, so that what is printed next starts on its own.
  void finish();

 private:
  std::string label_;
  bool quiet_, terminal_;
  std::FILE* stream_;
  Clock::time_point last_;
  bool line_shown_ = false;
};

}  // namespace zonal
