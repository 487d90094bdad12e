#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/hindsight.h"
#include "sidestep/bench/recorded_fields.h"
#include "sidestep/bench/resolve.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/trace_files.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/input_error.h"
#include "sidestep/record/questions.h"

namespace sidestep::cli {
namespace {

struct HindsightOptions {
  std::vector<std::string> traces, models;
  int guesses = 40;
  bool brief = false;
};

std::string EndOf(const bench::Hindsight& hindsight) {
  if (!hindsight.contact) return "never reached its goal";
  return fmt::format("touched something at {:.2f} s", hindsight.contact->seconds());
}

std::string WayOf(bool found, double clearance_m) {
  return found ? fmt::format("yes, {:.0f} mm", 1e3 * clearance_m) : std::string("none found");
}

void PrintCycles(const std::vector<bench::HindsightCycle>& cycles) {
  Print("  cycle s  effect s  plan thought  a way was known  a way was left\n");
  for (const bench::HindsightCycle& cycle : cycles) {
    Print("  {:7.2f}  {:8.2f}  {:<12}  {:<15}  {}\n", cycle.t.seconds(), cycle.t_effect.seconds(),
          cycle.was_thought_free ? "free" : "to touch",
          WayOf(cycle.knew_a_way, cycle.known_clearance_m),
          WayOf(cycle.had_a_way, cycle.true_clearance_m));
  }
}

void LookBackAt(const render::NamedRecording& trace, const HindsightOptions& options,
                const DataPaths& paths) {
  const record::Recording& recording = trace.recording;
  if (const auto why = bench::WhyCutShort(recording)) {
    Print("{}: was aborted at {:.2f} s: {}\n", trace.name, record::EndOf(recording).seconds(),
          OneLine(*why));
    return;
  }
  if (recording.scenario_yaml.empty()) throw InputError(trace.name, "holds no scenario");
  scenarios::Scenario scenario =
      scenarios::ParseScenario(recording.scenario_yaml, trace.name + ": scenario_yaml");
  if (scenario.robot.empty()) throw InputError(trace.name, "is of a world without a robot");
  const robot::RobotModel robot = RobotOf(scenario, paths.all_models());
  if (robot.joint_names() != recording.joints) {
    throw InputError(trace.name, "is of another robot than '" + scenario.robot + "' is now");
  }
  if (recording.control.empty()) throw InputError(trace.name, "tells of no motion");
  bench::ResolveTask(scenario, robot);
  const std::string why_not = bench::WhyNoRecordedFields(recording, scenario);
  if (!why_not.empty()) throw InputError(trace.name, why_not);
  const bench::Hindsight hindsight =
      bench::LookBack(recording, scenario, robot, options.guesses, scenario.seed);
  if (hindsight.verdict == bench::HindsightVerdict::kReached) {
    Print("{}: reached its goal untouched\n", trace.name);
    return;
  }
  Print("{}: {}: {}\n", trace.name, EndOf(hindsight), bench::ToString(hindsight.verdict));
  if (!options.brief) PrintCycles(hindsight.cycles);
}

int Hindsight(const HindsightOptions& options) {
  const DataPaths paths = FindDataPaths(options.models);
  int exit_code = 0;
  for (const std::string& path : options.traces) {
    try {
      LookBackAt(ReadTraces({path}).front(), options, paths);
    } catch (const InputError& error) {
      FinishOutput();  // what was said of those before comes before
      PrintError("{}\n", OneLine(error.what()));
      exit_code = 2;
    }
  }
  return exit_code;
}

}  // namespace

void AddHindsightCommand(CommandLine& line) {
  auto options = std::make_shared<HindsightOptions>();
  CLI::App* const hindsight = line.app.add_subcommand(
      "hindsight", "Say of runs that failed whether it could have been known in time");
  hindsight->add_option("TRACE", options->traces, "trace.h5 of `sidestep run`, one or more")
      ->required();
  hindsight->add_option("--guesses", options->guesses, "Guesses of each search, two a cycle")
      ->check(NumberFrom(1, 10000))
      ->capture_default_str();
  hindsight->add_flag("--brief", options->brief, "One line a trace, without the cycles");
  AddModels(*hindsight, options->models);
  hindsight->footer(
      "For each planning cycle before the first contact two long searches look for a motion to "
      "the\n"
      "goal from where the arm was when the cycle's plan took effect: one in the world as it was\n"
      "known then, the other as it came.\n"
      "  known in time      the plan was thought to touch something while a way was left and "
      "known\n"
      "  not known in time  as long as a way was left, the plan was thought to be free, or no way\n"
      "                     was known\n"
      "  no way             none was left from the first cycle on, as far as the search can tell\n"
      "Of a run that was aborted before it touched anything it says why, and asks no further.\n"
      "A trace that cannot be read is told, the others are looked at, and the exit code is 2.");
  hindsight->callback([&line, options] { line.exit_code = Hindsight(*options); });
}

}  // namespace sidestep::cli
