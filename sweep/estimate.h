#pragma once
/// How long a sweep takes, told beforehand from one small pass of each method on each scene.

#include <atomic>
#include <string>

#include "sweep/sweep_file.h"

namespace zonal {

struct Estimate {
  double seconds = 0;  ///< of cells, searches and references, loading included
  int untold = 0;      ///< cells whose time is the question itself (equal error), or whose method failed
};

/// Renders small pictures with `program`, in a temporary folder.
Estimate estimate_time(const SweepPlan& plan, const std::string& program, const std::atomic<bool>* stop);

}  // namespace zonal
