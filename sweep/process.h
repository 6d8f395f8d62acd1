#pragma once
/// A program run as a process of its own, so that its crash or its hunger costs one row of a table.

#include <atomic>
#include <string>
#include <vector>

namespace zonal {

struct ProcessResult {
  int exit_code = -1;        ///< of a process that ended by itself
  int signal = 0;            ///< that ended it, 0 = none
  bool interrupted = false;  ///< `stop` was set: it was killed
  double seconds = 0;        ///< wall clock
  std::string last_line;     ///< of what it wrote to its standard error
  bool ok() const { return exit_code == 0 && signal == 0 && !interrupted; }
  /// "exit code 2: scene.json: ...", "killed by signal 9 (out of memory?)"
  std::string reason() const;
};

/// Runs `command[0]` with its standard output thrown away. The child dies with this process, whatever kills
/// it. Throws SceneError when it cannot be started.
ProcessResult run_process(const std::vector<std::string>& command, const std::atomic<bool>* stop);

/// The program that is running now.
std::string own_program();

}  // namespace zonal
