#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/database/run_csv.h"
#include "sidestep/bench/database/run_database.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/jobs_option.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/study_cases.h"
#include "sidestep/cli/sweep_runner.h"
#include "sidestep/cli/sweep_summary.h"
#include "sidestep/core/input_error.h"

namespace sidestep::cli {
namespace {

struct StudyOptions {
  StudySpace space;
  int jobs = 0;
  bool again = false;
  bench::TableAxes axes;
  std::string traces = "none", out;
  std::vector<std::string> models;
  std::string command;  // as it was typed
};

bench::KeptTraces KeptTracesFromString(const std::string& word) {
  const auto* const found =
      std::find(std::begin(bench::kKeptTracesWords), std::end(bench::kKeptTracesWords), word);
  return static_cast<bench::KeptTraces>(found - std::begin(bench::kKeptTracesWords));
}

// What sets the counted seeds apart is asked of the scenario; with it comes its description.
bench::Sweep CheckedSweep(const StudyOptions& options, const DataPaths& paths) {
  bench::Sweep sweep = SweepOf(options.space, paths);
  sweep.traces = KeptTracesFromString(options.traces);
  ChooseAxes(sweep, options.axes);
  const bench::SweepPlan plan(sweep);
  const SweepRunner::Checked checked = SweepRunner(plan, "", "", paths).Check();
  if (options.space.episodes > 0 && !checked.seed_matters) {
    throw InputError("--episodes",
                     "a seed changes nothing in this scenario: it has no variations, nothing walks "
                     "at random, and its sensor is perfect");
  }
  sweep.description = checked.description;
  return sweep;
}

int Study(const StudyOptions& options) {
  const DataPaths paths = FindDataPaths(options.models);
  const bench::SweepPlan plan(CheckedSweep(options, paths));
  const std::string out =
      MakeOutFolder(options.out.empty() ? "out/study/" + plan.sweep().name : options.out,
                    {"results.db", "results.csv", "summary.md"});
  const SweepRunner runner(plan, "", out, paths);
  if (!runner.Run({{}, options.jobs, options.again})) return 1;
  const bench::SweepRows rows = runner.Rows();
  runner.Merge(rows);
  const bench::RunDatabase database(runner.database());
  bench::WriteRunCsv(database, out + "/results.csv");
  TellSummary(database, ChooseAxes(plan.sweep(), options.axes), options.command, out);
  if (rows.num_unasked() > 0) {
    Print("{} rows of other runs in this folder are left out\n", rows.num_unasked());
  }
  Print("written {}/results.db, results.csv, summary.md\n", out);
  const auto count = [&](const char* outcome) {
    const auto found = rows.outcomes().find(outcome);
    return found == rows.outcomes().end() ? 0 : found->second;
  };
  return count(bench::kFailed) + count("aborted") == 0 ? 0 : 1;
}

}  // namespace

void AddStudyCommand(CommandLine& line) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* const study = line.app.add_subcommand(
      "study",
      "Run every combination of a scenario's choices and of the flags below: the short form of "
      "`sidestep sweep`, with the same results");
  StudySpace& space = options->space;
  study->add_option("SCENARIO", space.scenario, "A name (see `sidestep list`) or a path")
      ->required();
  study->add_option("--set", space.settings, "KEY=VALUE, as in `sidestep run`; fixes a choice")
      ->allow_extra_args(false);
  AddModels(*study, options->models);
  study
      ->add_option("--vary", space.varied,
                   "KEY=VALUE,VALUE,...: any key of --set, with several values; some options of a "
                   "choice. Keys that vary together: KEY/OTHER=VALUE/VALUE,VALUE/VALUE,...; may be "
                   "repeated")
      ->allow_extra_args(false);
  study->add_option("--knowledge", space.knowledge, "Kinds of knowledge, with commas")
      ->delimiter(',');
  study->add_option("--predictor", space.predictors, "Predictors, with commas")->delimiter(',');
  study->add_option("--speed", space.speeds, "Speeds of every moving obstacle [m/s], with commas")
      ->delimiter(',')
      ->check(NumberFrom(0.0, 100.0));
  study
      ->add_option(
          "--episodes", space.episodes,
          "Episodes of each combination, seeds 1, 2, ...: what a seed changes the scenario "
          "says (variations, random walks, the sensor's noise)")
      ->check(NumberFrom(1, 100000));
  study
      ->add_option("--search", space.search,
                   "Also look for a free motion among so many guesses, knowing all: a further "
                   "kind of knowledge, `search`")
      ->check(NumberFrom(1, 100000));
  study->add_option("--down", options->axes.down,
                    "What the table lists down: a choice, speed_m_s, what --vary names, ... [what "
                    "varies]");
  study->add_option("--across", options->axes.across,
                    "What it lists across: knowledge, predictor, ... [what varies]");
  AddJobsOption(*study, options->jobs);
  study
      ->add_option("--traces", options->traces,
                   "Traces to keep: none, failures (all that did not reach the goal), all; of an "
                   "episode that was run without one, it is made by running it again [none]")
      ->check(CLI::IsMember({"none", "failures", "all"}));
  study->add_flag("--again", options->again,
                  "Where the folder holds runs of another build or of a changed scenario or robot: "
                  "run them again");
  study->add_option("--out", options->out, "Folder for the results [out/study/SCENARIO]");
  study->callback([&line, options] {
    options->command = line.text;
    line.exit_code = Study(*options);
  });
}

}  // namespace sidestep::cli
