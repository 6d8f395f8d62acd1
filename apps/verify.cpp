// `zonal verify`: golden-vector files against this build, one line a file.

#include "apps/verify.h"

#include <fmt/format.h>

#include <cstdio>

#include "apps/commands.h"
#include "core/error.h"

namespace zonal {
namespace {

struct Options {
  std::vector<std::string> files;
  bool details = false, tolerances = false;
};

int verify_command(const Options& options) {
  if (options.tolerances) {
    fmt::print("{}", tolerance_table());
    if (options.files.empty()) return kDone;
  }
  if (options.files.empty()) throw SceneError("expected a golden-vector file; see zonal verify --help");
  int exit_code = kDone;
  for (const std::string& file : options.files) {
    // A file that cannot be read does not keep the others from being checked.
    try {
      const Verdict verdict = verify_file(file);
      fmt::print("{}\n", one_line(verdict));
      if (options.details) fmt::print("{}", details(verdict));
      if (!verdict.passed() && exit_code == kDone) exit_code = kCheckFailed;
    } catch (const SceneError& error) {
      std::fflush(stdout);
      fmt::print(stderr, "zonal: {}\n", error.what());
      exit_code = kBadInput;
    }
  }
  return exit_code;
}

}  // namespace

void add_verify(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("verify", "golden-vector files against this build's spherical harmonics");
  command->add_option("files", options->files, "golden-vector files (schema in tests/golden/README.md)");
  command->add_flag("--details", options->details, "also a line a quantity and precision");
  command->add_flag("--tolerances", options->tolerances, "print the table of tolerances");
  command->callback([=] { *exit_code = verify_command(*options); });
}

}  // namespace zonal
