#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/database/run_files.h"
#include "sidestep/bench/reproduce/closed_loop.h"
#include "sidestep/bench/reproduce/closed_loop_report.h"
#include "sidestep/bench/reproduce/published_columns.h"
#include "sidestep/cli/build_id.h"
#include "sidestep/cli/checked_robots.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/machine.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/reproduce.h"
#include "sidestep/cli/run_case.h"
#include "sidestep/cli/versions.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/record/recording_file.h"

namespace sidestep::cli {
namespace {

struct ClosedLoopCommand {
  bench::ClosedLoopOptions options;
  std::string published_predictions, published_loops, out = "out/closed_loop";
};

constexpr const char* kScenario = "hsr_walkway";

// The traces of the first two runs, and the rows of all.
void WriteRuns(const ClosedLoopCommand& command, bench::ClosedLoopStudy& study,
               const std::string& out) {
  const bench::Factors settings = bench::PublishedSettings(command.options.speed_m_s);
  const std::map<std::string, std::string> machine = Machine();
  std::vector<bench::SingleRun> runs;
  for (const bench::RunRow& row : study.rows) {
    bench::SingleRun& run = runs.emplace_back();
    run.row = row;
    bench::Factors all = settings;
    all.insert(row.factors.begin(), row.factors.end());
    run.row.command = RunCommandOf(kScenario, all);
    run.scenario = run.setup = kScenario;
    run.machine = machine;
  }
  std::size_t n = 0;
  for (bench::EpisodeResult* const result : {&study.update, &study.prediction}) {
    bench::SingleRun& run = runs[n++];
    run.row.trace = run.row.subject.knowledge + ".h5";
    AddProvenance(run.row.identity, result->recording);
    record::WriteRecording(result->recording, out + "/" + run.row.trace);
  }
  bench::RunFilesHead head;
  head.facts = {{"title", "closed_loop"},
                {"description", "The published closed loop: does it help to know what will move?"},
                {"scenarios", kScenario},
                {"build_id", BuildId()},
                {"compare.factor", "knowledge"},
                {"compare.of", "prediction"},
                {"compare.with", "execute_and_update"}};
  for (const auto& [key, value] : settings) head.facts["set." + key] = value;
  head.version = VersionNumber();
  bench::WriteRunFiles(out, head, runs);
}

int Run(const ClosedLoopCommand& command) {
  const bench::PublishedRates published = {
      ReadPublished(command.published_predictions, {bench::kVoxelsColumn}),
      ReadPublished(command.published_loops, {bench::kVoxelsColumn})};
  const DataPaths paths = FindDataPaths();
  const std::string out = MakeOutFolder(
      command.out, {"execute_and_update.h5", "prediction.h5", "results.db", "results.csv",
                    "rates.csv", "whole_run.csv", "joints.gp", "rates.gp", "index.html"});

  CheckedRobots robots;
  const auto load = [&](const bench::Factors& factors) -> bench::ClosedLoopCase {
    Problem problem = LoadCase(kScenario, factors, paths, &robots);
    const bench::RunIdentity identity = Identify(problem.scenario, paths);
    return {std::move(problem.scenario), std::move(problem.robot), identity};
  };
  bench::ClosedLoopStudy study =
      bench::RunClosedLoopStudy(load, SimulatedWorlds(paths), paths.scenarios, command.options,
                                [](const std::string& part) { PrintError("{}\n", part); });
  WriteRuns(command, study, out);
  const bench::CsvTable rates = bench::MakeRatesTable(study, published);
  WriteFile(out + "/rates.csv", rates.ToText());
  WriteFile(out + "/whole_run.csv", bench::MakeWholeRunTable(study.whole_run).ToText());
  Print(
      "{}\nwritten: {}/rates.csv, whole_run.csv, execute_and_update.h5, prediction.h5, "
      "results.db, results.csv\n",
      bench::DescribeClosedLoop(study, published), out);
  const std::string joints = DrawInto(out, "joints", bench::MakeJointsFigure(study));
  const std::string rates_svg = DrawInto(out, "rates", bench::MakeRatesFigure(rates));
  WriteFile(out + "/index.html",
            bench::MakeClosedLoopPage(command.options, study, published, joints, rates_svg));
  Print("written: {}/index.html\n", out);
  return 0;
}

}  // namespace

void AddReproduceClosedLoop(CommandLine& line, CLI::App& reproduce) {
  auto options = std::make_shared<ClosedLoopCommand>();
  CLI::App* const command = reproduce.add_subcommand(
      "closed_loop", "The closed loop: execute-and-update against prediction, and its rates");
  command->add_option("--speed", options->options.speed_m_s, "Speed of the HSR [1.4 m/s]")
      ->check(NumberFrom(0.0, 100.0));
  command
      ->add_option("--sizes", options->options.voxels_per_side,
                   "Voxels per side whose rates are measured, comma-separated [64,96,...,320]")
      ->delimiter(',')
      ->check(NumberFrom(32, 512));
  command->add_option("--published-predictions", options->published_predictions,
                      "A CSV file of stored prediction times to show");
  command->add_option("--published-loops", options->published_loops,
                      "A CSV file of stored loop rates to show");
  command->add_option("--out", options->out, "Folder for the results [out/closed_loop]");
  command->callback([&line, options] { line.exit_code = Run(*options); });
}

}  // namespace sidestep::cli
