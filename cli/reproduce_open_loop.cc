#include <unistd.h>

#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/bench/reproduce/open_loop_report.h"
#include "sidestep/bench/reproduce/open_loop_rows.h"
#include "sidestep/bench/reproduce/open_loop_statistics.h"
#include "sidestep/bench/reproduce/open_loop_statistics_text.h"
#include "sidestep/bench/reproduce/open_loop_study.h"
#include "sidestep/bench/reproduce/published_columns.h"
#include "sidestep/bench/reproduce/published_table.h"
#include "sidestep/bench/task_pool.h"
#include "sidestep/cli/build_id.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/machine.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/option_lists.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/reproduce.h"
#include "sidestep/cli/versions.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/sdf/prediction/registry.h"

namespace sidestep::cli {
namespace {

struct OpenLoopCommand {
  std::optional<double> sigma_obs, epsilon_m;
  std::optional<int> num_interpolated;
  std::string speeds, pairs, cases, predictor;
  bool once = false, intended_geometry = false;
  int num_jobs = 1;
  std::string published, out;
};

bench::OpenLoopExperiment MakeExperiment(const std::string& name, const OpenLoopCommand& command) {
  bench::OpenLoopExperiment experiment =
      bench::MakeOpenLoopExperiment(name, FindDataPaths().scenarios);
  if (command.sigma_obs) experiment.sigma_obs = *command.sigma_obs;
  if (command.epsilon_m) experiment.epsilon_m = *command.epsilon_m;
  if (command.num_interpolated) experiment.num_interpolated = *command.num_interpolated;
  if (!command.speeds.empty()) experiment.speeds_m_s = ParseSpeeds("--speeds", command.speeds);
  return experiment;
}

bench::OpenLoopStudyOptions MakeStudyOptions(const OpenLoopCommand& command, int num_pairs) {
  bench::OpenLoopStudyOptions options;
  if (!command.cases.empty()) options.cases = ParseKnowledge("--case", command.cases);
  if (!command.pairs.empty()) options.pairs = ParseNumbers("--pairs", command.pairs, num_pairs);
  if (!command.predictor.empty()) {
    try {
      sdf::MakePredictor(command.predictor);
    } catch (const std::invalid_argument& error) {
      throw InputError("--predictor", error.what());
    }
    options.predictor = command.predictor;
  }
  options.once = command.once;
  options.intended_geometry = command.intended_geometry;
  options.num_jobs = command.num_jobs;
  return options;
}

// One line that is rewritten on a terminal; elsewhere a line at every tenth of the work.
void ReportRows(int done, int all) {
  if (isatty(STDERR_FILENO) != 0) {
    PrintError("\r{} of {} rows{}", done, all, done == all ? "\n" : "");
  } else if (done * 10 / all != (done - 1) * 10 / all) {
    PrintError("{} of {} rows\n", done, all);
  }
}

void PrintVerdicts(const bench::OpenLoopStudy& study) {
  Print("{}", bench::ToText(bench::MakeVerdictTable(study)));
  Print(
      "(truly free: of the collision-free, those whose spheres clear the exact boxes, which stand\n"
      "where they were meant to and move between the states)\n");
  if (!study.ignored_spheres.empty()) {
    std::string spheres;
    for (const int s : study.ignored_spheres) spheres += " " + std::to_string(s);
    Print("ignored, for they overlap what the robot stands on: spheres{}\n", spheres);
  }
}

void WriteRuns(const bench::OpenLoopExperiment& experiment, const bench::OpenLoopStudy& study,
               const bench::OpenLoopStudyOptions& options, const std::string& out) {
  std::vector<bench::SingleRun> runs = bench::OpenLoopRuns(experiment, study, options.predictor);
  const std::map<std::string, std::string> machine = Machine();
  for (bench::SingleRun& run : runs) run.machine = machine;
  const bench::RunFilesHead head = {
      {{"title", experiment.name},
       {"description",
        "The published open loop: seeds are pairs of start and goal, and who is "
        "collision-free at the support states has reached the goal"},
       {"scenarios", experiment.name},
       {"build_id", BuildId()}},
      VersionNumber()};
  bench::WriteRunFiles(out, head, runs);
}

int Run(const std::string& name, const OpenLoopCommand& command) {
  const bench::OpenLoopExperiment experiment = MakeExperiment(name, command);
  const bench::OpenLoopStudyOptions options =
      MakeStudyOptions(command, static_cast<int>(experiment.pairs.size()));
  // Read before the long work, so that a wrong path is found at once.
  const std::optional<bench::CsvTable> published_table =
      ReadPublished(command.published, {bench::kPairColumn, bench::kSpeedColumn});
  const std::string out = MakeOutFolder(
      command.out.empty() ? "out/" + name : command.out,
      {"rows.csv", "results.db", "results.csv", "statistics.json", "figure.gp", "index.html"});

  const bench::OpenLoopStudy study =
      bench::RunOpenLoopStudy(experiment, FindDataPaths().models, options, ReportRows);
  const bench::CsvTable table = bench::MakeOpenLoopTable(study);
  WriteFile(out + "/rows.csv", table.ToText());
  WriteRuns(experiment, study, options, out);
  const std::vector<bench::MatchedOutcomes> outcomes = bench::ReadOutcomes(table);
  std::optional<bench::PublishedComparison> published;
  if (published_table) {
    published = {bench::CompareTables(table, *published_table, command.published),
                 bench::ReadOutcomes(*published_table)};
  }
  std::vector<bench::OpenLoopStatistics> statistics;
  for (const bench::RowFilter filter :
       {bench::RowFilter::kAllRows, bench::RowFilter::kPublishedExclusions}) {
    if (!bench::CanFilter(outcomes, filter)) continue;
    statistics.push_back(bench::ComputeOpenLoopStatistics(outcomes, filter, experiment));
  }
  WriteFile(out + "/statistics.json", bench::ToJson(statistics));

  PrintVerdicts(study);
  for (const bench::OpenLoopStatistics& filtered : statistics) {
    Print("\n{}", bench::Describe(filtered));
  }
  if (!bench::CanFilter(outcomes, bench::RowFilter::kPublishedExclusions)) {
    Print(
        "\npublished_exclusions: left out, they need --case static,execute_and_update,"
        "full_knowledge\n");
  }
  if (published) {
    Print("\nagainst {}: {}", command.published, bench::Describe(published->table));
  }
  Print("\nwritten: {0}/rows.csv, {0}/statistics.json, {0}/results.db, {0}/results.csv\n", out);
  const std::string svg = DrawInto(
      out, "figure",
      bench::MakeOpenLoopFigure(outcomes, published ? published->outcomes : decltype(outcomes)()));
  WriteFile(out + "/index.html",
            bench::MakeOpenLoopPage(experiment, options, study, published, statistics, svg));
  Print("written: {}/index.html\n", out);
  return !published || published->table.AllCountsAgree() ? 0 : 1;
}

}  // namespace

void AddReproduceOpenLoop(CommandLine& line, CLI::App& reproduce) {
  for (const std::string& name : bench::OpenLoopExperimentNames()) {
    auto options = std::make_shared<OpenLoopCommand>();
    options->num_jobs = bench::NumProcessors();
    CLI::App* const command = reproduce.add_subcommand(
        name, "Open loop: a table of colliding states and costs, row for row");
    command->add_option("--published", options->published,
                        "Compare with this CSV file, row by row; exit 1 if a count differs");
    command->add_option("--sigma-obs", options->sigma_obs, "Sigma of the obstacle cost")
        ->check(NumberFrom(1e-6, 1e6));
    command->add_option("--epsilon", options->epsilon_m, "Safety margin of the obstacle cost [m]")
        ->check(NumberFrom(0.0, 10.0));
    command
        ->add_option("--n-int", options->num_interpolated,
                     "Obstacle costs between two support states")
        ->check(NumberFrom(0, 1000));
    command->add_option("--speeds", options->speeds, "FIRST:LAST:STEP, or one speed [m/s]");
    command->add_option("--pairs", options->pairs, "Pairs of start and goal, as 1,4-6 [all]");
    command->add_option("--case", options->cases,
                        "Kinds of knowledge, comma-separated: static, execute_and_update, "
                        "full_knowledge, prediction");
    command->add_option("--predictor", options->predictor,
                        "How moving things are extrapolated under prediction");
    command->add_flag("--once", options->once,
                      "Solve static and full_knowledge once only, as the paper's text says");
    command->add_flag("--intended-geometry", options->intended_geometry,
                      "Static boxes where they were meant to be, not one cell low");
    command->add_option("-j,--jobs", options->num_jobs, "Threads")->check(NumberFrom(1, 1024));
    command->add_option("--out", options->out, "Folder for the results [out/" + name + "]");
    command->callback([&line, name, options] { line.exit_code = Run(name, *options); });
  }
}

}  // namespace sidestep::cli
