// `zonal sweep`: a sweep file in, a folder with every cell's picture and a report out.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "apps/commands.h"
#include "core/error.h"
#include "core/progress.h"
#include "sweep/process.h"
#include "sweep/report.h"
#include "sweep/results.h"
#include "sweep/runner.h"
#include "sweep/score.h"

namespace zonal {
namespace {

struct Options {
  std::string file, output, runner = "local", only;
  bool dry_run = false, quiet = false, score_only = false, retry = false;
};

/// The cells and, as far as budgets tell, how long they take.
void print_plan(const SweepPlan& plan) {
  double seconds = 0;
  bool known = true;
  for (const Cell& cell : plan.cells) {
    const CellBudget& budget = plan.budgets[cell.budget];
    fmt::print("{}\n", cell_name(plan, cell));
    if (budget.kind == CellBudget::seconds)
      seconds += budget.value;
    else if (budget.kind == CellBudget::equal_time)
      seconds += budget.value * (plan.runs + double(budget.most_runs) / plan.seeds.size());
    else
      known = false;
  }
  std::map<std::string, double> references;
  for (const Cell& cell : plan.cells)
    for (const ReferenceRequest& request : cell_references(plan, cell))
      references[reference_key(request)] = request.seconds;
  for (const auto& [key, value] : references) seconds += value, known = known && value > 0;
  fmt::print("{} cells in {} groups, {} references; ", plan.cells.size(), plan.groups, references.size());
  if (known)
    fmt::print("about {} of rendering\n", duration_text(seconds));
  else
    fmt::print("at least {} of rendering (budgets in passes and errors cannot be told beforehand)\n",
               duration_text(seconds));
}

int sweep_command(const Options& options) {
  if (options.runner == "slurm")
    throw SceneError("--runner: \"slurm\" is reserved and does not exist yet, expected \"local\"");
  if (options.runner != "local")
    throw SceneError(fmt::format("--runner: found \"{}\", expected \"local\"", options.runner));
  const SweepPlan plan = read_sweep(options.file);
  if (options.dry_run) {
    print_plan(plan);
    return kDone;
  }
  const std::string folder =
      options.output.empty() ? "out/" + std::filesystem::path(options.file).stem().string() : options.output;
  const CellStore store(folder, plan);
  catch_interrupts();
  RunSummary summary;
  if (!options.score_only)
    summary = run_cells(plan, store,
                        {.program = own_program(),
                         .only = options.only,
                         .retry = options.retry,
                         .quiet = options.quiet,
                         .stop = &stop_asked()});
  const auto start = Clock::now();
  score_cells(plan, store);
  write_report(sweep_results(plan, store), store);
  if (!options.quiet) {
    fmt::print(
        "{} cells done, {} kept from before, {} failed, {} left; {} of which {:.1f} % outside the cells; "
        "scoring and "
        "report {:.1f} s\n",
        summary.done, summary.kept, summary.failed, summary.left, duration_text(summary.seconds),
        summary.seconds > 0 ? 100 * (1 - summary.child_seconds / summary.seconds) : 0.0,
        seconds_since(start));
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
                    "print the cells and an estimate of their time; run nothing");
  command->add_flag("--score-only", options->score_only, "run nothing: score and report what is there");
  command->add_flag("--retry", options->retry, "run failed cells again");
  command->add_flag("--quiet", options->quiet, "print errors and warnings only");
  command->callback([=] { *exit_code = sweep_command(*options); });
}

}  // namespace zonal
