// `zonal sweep`: a sweep file in, a folder with every cell's picture and a report out.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <set>

#include "apps/commands.h"
#include "core/error.h"
#include "core/progress.h"
#include "sweep/digest.h"
#include "sweep/estimate.h"
#include "sweep/process.h"
#include "sweep/replay.h"
#include "sweep/report.h"
#include "sweep/results.h"
#include "sweep/runner.h"

namespace zonal {
namespace {

struct Options {
  std::string file, output, runner = "local", only;
  bool dry_run = false, quiet = false, score_only = false, retry = false, replay = false;
};

/// The cells, and how long they take as far as that can be told.
int print_plan(const SweepPlan& plan) {
  std::set<std::string> references;
  for (const Cell& cell : plan.cells) {
    fmt::print("{}\n", cell_name(plan, cell));
    for (const ReferenceRequest& request : cell_references(plan, cell))
      references.insert(reference_key(request));
  }
  std::fflush(stdout);
  catch_interrupts();
  const Estimate estimate = estimate_time(plan, own_program(), &stop_asked());
  if (stop_asked()) return kInterrupted;
  fmt::print("{} cells in {} groups, {} references; about {} from the start{}\n", plan.cells.size(),
             plan.groups, references.size(), duration_text(estimate.seconds),
             estimate.untold ? fmt::format(", and {} cells whose time cannot be told", estimate.untold) : "");
  return kDone;
}

int replay_command(const SweepPlan& plan, const CellStore& store, const RunnerOptions& options) {
  const ReplaySummary summary = replay_cells(plan, store, options);
  if (summary.interrupted) return kInterrupted;
  fmt::print("{} cells replayed: {} the same bit for bit, {} different\n", summary.same + summary.different,
             summary.same, summary.different);
  for (const std::string& name : summary.names) fmt::print(stderr, "different: {}\n", name);
  return summary.different ? kCheckFailed : kDone;
}

int sweep_command(const Options& options) {
  if (options.runner == "slurm")
    throw SceneError("--runner: \"slurm\" is reserved and does not exist yet, expected \"local\"");
  if (options.runner != "local")
    throw SceneError(fmt::format("--runner: found \"{}\", expected \"local\"", options.runner));
  const SweepPlan plan = read_sweep(options.file);
  if (options.dry_run) return print_plan(plan);
  const std::string folder =
      options.output.empty() ? "out/" + std::filesystem::path(options.file).stem().string() : options.output;
  const CellStore store(folder, plan);
  catch_interrupts();
  const RunnerOptions run{.program = own_program(),
                          .only = options.only,
                          .retry = options.retry,
                          .quiet = options.quiet,
                          .stop = &stop_asked()};
  if (options.replay) return replay_command(plan, store, run);
  RunSummary summary;
  if (!options.score_only) summary = run_cells(plan, store, run);
  const auto start = Clock::now();
  digest_cells(plan, store);
  write_report(sweep_results(plan, store), store);
  if (!options.quiet) {
    const double scoring = seconds_since(start), all = summary.seconds + scoring;
    fmt::print(
        "{} cells done, {} kept from before, {} failed, {} left; {}, {:.1f} % of it outside cells, searches "
        "and "
        "references ({:.1f} s scoring and report)\n",
        summary.done, summary.kept, summary.failed, summary.left, duration_text(all),
        100 * (1 - summary.child_seconds / all), scoring);
    fmt::print("report: {}/index.html\n", folder);
  }
  if (summary.interrupted) {
    fmt::print(stderr, "interrupted: what is finished is kept; the same command goes on\n");
    return kInterrupted;
  }
  return summary.failed > 0 ? kCheckFailed : kDone;
}

}  // namespace

void add_sweep(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("sweep", "methods x scenes x parameters, compared in a report; resumes by itself");
  command->add_option("sweep", options->file, "sweep file (JSON; schema in scenes/sweeps/)")->required();
  command->add_option("-o,--output", options->output,
                      "folder of cells and report; default: out/ and the file's name");
  command->add_option("--runner", options->runner, "local");
  command->add_option("--only", options->only, "run only cells whose name contains this");
  command->add_flag("--dry-run", options->dry_run,
                    "print the cells and an estimate of their time, from a small pass of each method");
  command->add_flag("--score-only", options->score_only, "run nothing: score and report what is there");
  command->add_flag(
      "--replay", options->replay,
      "render finished cells again from their recorded passes and parameters: the same bits must come out");
  command->add_flag("--retry", options->retry, "run failed cells again");
  command->add_flag("--quiet", options->quiet, "print errors and warnings only");
  command->callback([=] { *exit_code = sweep_command(*options); });
}

}  // namespace zonal
