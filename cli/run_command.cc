#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_folder.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/stop_signals.h"
#include "sidestep/cli/thin_things.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"

namespace sidestep::cli {
namespace {

struct RunOptions {
  ScenarioOptions scenario;
  std::string clock = "virtual";
  std::string out;
  bool json = false;
};

int Run(const RunOptions& options) {
  const DataPaths paths = FindDataPaths(options.scenario.models);
  const Problem problem =
      LoadProblem(options.scenario.scenario, ParseOverrides(options.scenario), paths);
  WarnOfThinThings(problem.scenario);
  if (options.clock == "wall" && problem.scenario.latency == scenarios::Latency::kNone) {
    throw InputError("--clock",
                     "on a wall clock planning takes time: --latency charged or measured");
  }
  RunFolder folder(options.out.empty()
                       ? "out/" + problem.scenario.name + "/" + problem.scenario.knowledge
                       : options.out,
                   Identify(problem.scenario, paths));
  const StopSignals signals;
  const bench::EpisodeOptions episode = {
      .observe_field = {},
      .why_stop = [&] { return signals.first(); },
      .clock = options.clock == "wall" ? bench::EpisodeClock::kWall : bench::EpisodeClock::kVirtual,
      .journal = &folder.journal()};
  bench::EpisodeResult result =
      bench::RunEpisode(problem.scenario, problem.robot, SimulatedWorlds(paths), episode);
  folder.KeepAndTell(result, problem.scenario, options.json);
  return 0;
}

}  // namespace

void AddRunCommand(CommandLine& line) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* const run = line.app.add_subcommand(
      "run", "Run one closed-loop episode headless; write result.json and trace.h5");
  AddScenarioOptions(*run, options->scenario);
  Overrides& overrides = options->scenario.overrides;
  run->add_option("--latency-ms", overrides.latency_ms,
                  "Episode time charged to each planning cycle [ms]")
      ->check(NumberFrom(0.0, 60000.0));
  run->add_option(
         "--latency", overrides.latency,
         "What a planning cycle takes: charged (always the same), measured (the CPU time it "
         "needs; no two runs are alike), none")
      ->check(CLI::IsMember({"charged", "measured", "none"}));
  run->add_option(
         "--safety", overrides.safety,
         "Of the robot's supervisor: off, observe (write down what lab would do), lab (act)")
      ->check(CLI::IsMember({"off", "observe", "lab"}));
  run->add_option(
         "--clock", options->clock,
         "virtual: as fast as it goes, the same bits again; wall: in real time, planning in "
         "a thread of its own, plans that come late dropped")
      ->check(CLI::IsMember({"virtual", "wall"}))
      ->capture_default_str();
  run->add_option("--epsilon", overrides.epsilon_m, "Safety margin of the obstacle cost [m]")
      ->check(NumberFrom(0.0, 10.0));
  run->add_option("--out", options->out, "Folder for the results [out/SCENARIO/KNOWLEDGE]");
  run->add_flag("--json", options->json, "Print result.json instead of the summary");
  run->callback([&line, options] { line.exit_code = Run(*options); });
}

}  // namespace sidestep::cli
