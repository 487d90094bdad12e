#include <memory>
#include <string>

#include "sidestep/bench/reproduce/closed_loop.h"
#include "sidestep/bench/reproduce/closed_loop_report.h"
#include "sidestep/bench/reproduce/published_columns.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/reproduce.h"
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

int Run(const ClosedLoopCommand& command) {
  const bench::PublishedRates published = {
      ReadPublished(command.published_predictions, {bench::kVoxelsColumn}),
      ReadPublished(command.published_loops, {bench::kVoxelsColumn})};
  const DataPaths paths = FindDataPaths();
  const Problem problem = LoadProblem("hsr_walkway", {}, paths);
  const std::string out =
      MakeOutFolder(command.out, {"execute_and_update.h5", "prediction.h5", "rates.csv",
                                  "whole_run.csv", "joints.gp", "rates.gp", "index.html"});

  bench::ClosedLoopStudy study = bench::RunClosedLoopStudy(
      problem.scenario, problem.robot, SimulatedWorlds(paths), paths.scenarios, command.options,
      [](const std::string& part) { PrintError("{}\n", part); });
  for (bench::EpisodeResult* const result : {&study.update, &study.prediction}) {
    for (const auto& [part, version] : Versions()) {
      result->recording.header["version." + part] = version;
    }
    record::WriteRecording(result->recording,
                           out + "/" + result->recording.header.at("knowledge") + ".h5");
  }
  const bench::CsvTable rates = bench::MakeRatesTable(study, published);
  WriteFile(out + "/rates.csv", rates.ToText());
  WriteFile(out + "/whole_run.csv", bench::MakeWholeRunTable(study.whole_run).ToText());
  Print("{}\nwritten: {}/rates.csv, whole_run.csv, execute_and_update.h5, prediction.h5\n",
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
