#include "sweep/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include "core/error.h"
#include "core/stop.h"

namespace zonal {
namespace {

/// The last line that is not blank.
std::string last_line_of(const std::string& text) {
  const size_t end = text.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) return {};
  const size_t start = text.find_last_of("\n\r", end);
  return text.substr(start == std::string::npos ? 0 : start + 1,
                     end - (start == std::string::npos ? 0 : start + 1) + 1);
}

/// Keeps the tail of what has arrived, so that a talkative process cannot fill the memory.
void drain(int pipe, std::string* text) {
  char buffer[4096];
  ssize_t n;
  while ((n = read(pipe, buffer, sizeof buffer)) > 0) {
    text->append(buffer, n);
    if (text->size() > 65536) text->erase(0, text->size() - 32768);
  }
}

[[noreturn]] void become(const std::vector<std::string>& command, int errors, pid_t parent) {
  // A group of its own: Ctrl-C reaches the sweep, which ends its child.
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, 0), dup2(nowhere, 1), dup2(errors, 2);
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  dprintf(2, "%s: %s\n", arguments[0], std::strerror(errno));
  _exit(127);
}

}  // namespace

std::string ProcessResult::reason() const {
  if (interrupted) return "interrupted";
  if (signal)
    return fmt::format("killed by signal {}{}", signal, signal == SIGKILL ? " (out of memory?)" : "");
  return fmt::format("exit code {}{}{}", exit_code, last_line.empty() ? "" : ": ", last_line);
}

ProcessResult run_process(const std::vector<std::string>& command, const std::atomic<bool>* stop) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0)
    throw SceneError(fmt::format("{}: could not be started: {}", command[0], std::strerror(errno)));
  ProcessResult result;
  const auto start = Clock::now();
  const pid_t parent = getpid(), child = fork();
  if (child == 0) become(command, ends[1], parent);
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    throw SceneError(fmt::format("{}: could not be started: {}", command[0], std::strerror(errno)));
  }
  std::string errors;
  int status = 0;
  // Asked 200 times a second: cheap beside any cell, and a finished one is noticed at once.
  while (waitpid(child, &status, WNOHANG) == 0) {
    drain(ends[0], &errors);
    if (stop && stop->load() && !result.interrupted) {
      result.interrupted = true;
      kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  result.seconds = seconds_since(start);
  drain(ends[0], &errors);
  close(ends[0]);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  result.last_line = last_line_of(errors);
  return result;
}

std::string own_program() {
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

}  // namespace zonal
