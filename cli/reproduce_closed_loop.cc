#include <cstdio>
#include <memory>
#include <string>

#include "bench/reproduce/closed_loop.h"
#include "bench/reproduce/closed_loop_report.h"
#include "bench/reproduce/published_columns.h"
#include "bench/result_file.h"
#include "cli/number_range.h"
#include "cli/out_folder.h"
#include "cli/reproduce.h"
#include "cli/versions.h"
#include "cli/wiring.h"

namespace sidestep {
namespace {

struct ClosedLoopCommand {
  ClosedLoopOptions options;
  std::string published_predictions, published_loops, out = "out/closed_loop";
};

int Run(const ClosedLoopCommand& command) {
  PublishedRates published;
  if (!command.published_predictions.empty()) {
    published.predictions = CsvTable::Read(command.published_predictions, {kVoxelsColumn});
  }
  if (!command.published_loops.empty()) {
    published.loops = CsvTable::Read(command.published_loops, {kVoxelsColumn});
  }
  const DataPaths paths = FindDataPaths();
  const Problem problem = LoadProblem("hsr_walkway", {}, paths);
  const std::string out = MakeOutFolder(command.out);

  ClosedLoopStudy study = RunClosedLoopStudy(
      problem.scenario, problem.robot, SimulatedWorlds(paths), command.options,
      [](const std::string& part) { std::fprintf(stderr, "%s\n", part.c_str()); });
  for (EpisodeResult* const result : {&study.update, &study.prediction}) {
    for (const auto& [part, version] : Versions()) {
      result->recording.header["version." + part] = version;
    }
    WriteRecording(result->recording, out + "/" + result->recording.header.at("knowledge") + ".h5");
  }
  const CsvTable rates = MakeRatesTable(study, published);
  WriteTextFile(out + "/rates.csv", rates.ToText());
  WriteTextFile(out + "/whole_run.csv", MakeWholeRunTable(study.whole_run).ToText());
  std::printf("%s\nwritten: %s/rates.csv, whole_run.csv, execute_and_update.h5, prediction.h5\n",
              DescribeClosedLoop(study, published).c_str(), out.c_str());
  const std::string joints = DrawInto(out, "joints", MakeJointsFigure(study));
  const std::string rates_svg = DrawInto(out, "rates", MakeRatesFigure(rates));
  WriteTextFile(out + "/index.html",
                MakeClosedLoopPage(command.options, study, published, joints, rates_svg));
  std::printf("written: %s/index.html\n", out.c_str());
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

}  // namespace sidestep
