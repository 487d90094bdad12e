#include <unistd.h>

#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "sidestep/bench/episode.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/hardware_world.h"
#include "sidestep/cli/panda_connection.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_folder.h"
#include "sidestep/cli/run_summary.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/stop_signals.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/input_error.h"
#include "sidestep/hardware/slow_move.h"
#include "sidestep/sim/safety_of.h"

namespace sidestep::cli {
namespace {

constexpr const char* kDefaultAddress = "127.0.0.1";

const char* NameOf(robot::fci::RobotMode mode) {
  constexpr const char* kNames[] = {"other",  "idle",         "move",    "guiding",
                                    "reflex", "user stopped", "recovery"};
  return kNames[static_cast<int>(mode)];
}

struct HardwareOptions {
  ScenarioOptions scenario;
  std::string robot = kDefaultAddress;
  std::string clock = "wall";
  std::string out;
  bool json = false, dry_run = false, yes = false;
};

// A scenario for a Panda, supervised by `lab` unless it or the command line says otherwise.
Problem LoadForHardware(HardwareOptions& options, const DataPaths& paths) {
  Overrides overrides = ParseOverrides(options.scenario);
  if (!overrides.safety) {
    const scenarios::Scenario asked =
        LoadProblem(options.scenario.scenario, overrides, paths).scenario;
    if (asked.safety.profile == scenarios::SafetyProfile::kOff) overrides.safety = "lab";
  }
  Problem problem = LoadProblem(options.scenario.scenario, overrides, paths);
  if (problem.robot.name() != "panda") {
    throw InputError("SCENARIO", "its robot must be the panda, is '" + problem.robot.name() + "'");
  }
  if (problem.scenario.safety.profile != scenarios::SafetyProfile::kLab &&
      !IsLoopback(options.robot)) {
    throw InputError("--safety", "a real robot moves under lab alone");
  }
  if (problem.scenario.knowledge == "full_knowledge") {
    throw InputError("--knowledge", "nobody knows the true future on hardware");
  }
  return problem;
}

// Connects, looks, and plans; nothing is sent to the robot.
int DryRun(const HardwareOptions& options, Problem problem, const DataPaths& paths) {
  const auto driver = ConnectPanda(options.robot);
  const hardware::RobotSnapshot state = driver->ReadOnce();
  scenarios::Scenario& scenario = problem.scenario;
  double off_rad = 0;
  for (std::size_t j = 0; j < state.q.size(); ++j) {
    const auto joint = static_cast<Eigen::Index>(j);
    off_rad = std::max(off_rad, std::abs(state.q[j] - scenario.q_start(joint)));
  }
  Print("robot            {}, protocol version {}, mode {}\n", options.robot,
        driver->server_version(), NameOf(state.mode));
  Print("from the start   {:.4f} rad, allowed 0.02\n", off_rad);
  Print("in simulation, from the start of the task, under the same supervision:\n");
  const bench::EpisodeResult result =
      bench::RunEpisode(scenario, problem.robot, SimulatedWorlds(paths));
  PrintOutcome(result, scenario);
  const bool is_ready = state.mode == robot::fci::RobotMode::kIdle && off_rad <= 0.02;
  if (!is_ready)
    PrintError("hardware run: the robot is not ready: it must be idle, at the start\n");
  return is_ready ? 0 : 1;
}

int RunOnHardware(HardwareOptions options) {
  const DataPaths paths = FindDataPaths();
  Problem problem = LoadForHardware(options, paths);
  if (options.dry_run) return DryRun(options, std::move(problem), paths);
  const bool lockstep = options.clock == "lockstep";
  if (!lockstep && problem.scenario.latency == scenarios::Latency::kNone) {
    throw InputError("replanning.latency", "planning takes time on hardware: charged or measured");
  }
  if (lockstep && !IsLoopback(options.robot)) {
    throw InputError("--clock", "a real robot has a clock of its own: wall");
  }
  RunFolder folder(options.out.empty() ? "out/" + problem.scenario.name + "/hardware" : options.out,
                   Identify(problem.scenario, paths));
  const StopSignals signals;
  hardware::PandaRobot* panda = nullptr;
  const bench::WorldFactory worlds = HardwareWorlds(
      paths, options.robot, {sim::SafetyOf(problem.scenario, problem.robot), lockstep},
      [&panda](hardware::PandaRobot* robot) { panda = robot; });
  bench::EpisodeOptions episode;
  episode.clock = lockstep ? bench::EpisodeClock::kVirtual : bench::EpisodeClock::kRobot;
  episode.is_stopped = [&] {
    if (signals.count() > 1 && panda != nullptr) panda->StopNow();
    return signals.count() > 0;
  };
  episode.journal = &folder.journal();
  bench::EpisodeResult result = bench::RunEpisode(problem.scenario, problem.robot, worlds, episode);
  folder.KeepAndTell(result, problem.scenario, options.json);
  return 0;
}

void AskToMove(const HardwareOptions& options, double seconds) {
  Print("The robot at {} will move to the start of the task, alone and unseeing, for {:.1f} s.\n",
        options.robot, seconds);
  if (options.yes) return;
  Print("Is its way free, and the stop in your hand? [y/N] ");
  FinishOutput();
  std::string answer;
  if (!std::getline(std::cin, answer) || (answer != "y" && answer != "yes")) {
    throw InputError("hardware go-to-start", "not without a yes");
  }
}

int GoToStart(HardwareOptions options) {
  const DataPaths paths = FindDataPaths();
  const Problem problem = LoadForHardware(options, paths);
  control::SafetySettings safety = sim::SafetyOf(problem.scenario, problem.robot);
  safety.stale_s = 1e9;       // it moves unseeing
  const StopSignals signals;  // until the robot has come to rest, below
  hardware::PandaRobot panda(ConnectPanda(options.robot), problem.robot,
                             {safety, options.clock == "lockstep"});
  const Trajectory way =
      hardware::SlowMove(problem.robot, panda.Read().q, problem.scenario.q_start);
  const double seconds = way.t_s(way.num_states() - 1);
  AskToMove(options, seconds);
  panda.AdvanceTo(EpisodeTime(0.01));
  panda.Submit(way, EpisodeTime(0.02));
  for (double t_s = 0.02; t_s < seconds + 0.5 && signals.count() == 0; t_s += 0.02) {
    panda.AdvanceTo(EpisodeTime(t_s));
    panda.TakeControlLog();
  }
  const double off_rad = (panda.Read().q - problem.scenario.q_start).cwiseAbs().maxCoeff();
  Print("from the start   {:.4f} rad\n", off_rad);
  for (const SafetyEvent& event : panda.TakeSafetyEvents()) {
    Print("supervisor       {:.3f} s: {}: {}\n", event.t.seconds(), event.check, event.reaction);
  }
  return signals.count() == 0 && off_rad <= 0.02 ? 0 : 1;
}

int Recover(const HardwareOptions& options) {
  const auto driver = ConnectPanda(options.robot);
  try {
    const hardware::RobotSnapshot before = driver->ReadOnce();
    Print("mode             {}\n", NameOf(before.mode));
    Print("last errors      {}\n", robot::fci::Text(before.last_motion_errors));
    driver->Recover();
    Print("mode             {}\n", NameOf(driver->ReadOnce().mode));
  } catch (const hardware::FciError& error) {
    PrintError("hardware recover: {}\n", error.what());
    return 1;
  }
  return 0;
}

void AddRobotOption(CLI::App& command, HardwareOptions& options) {
  command
      .add_option("--robot", options.robot,
                  "Its address; on the loopback, that of `sidestep fci-server`")
      ->capture_default_str();
}

void AddScenario(CLI::App& command, HardwareOptions& options) {
  AddScenarioOptions(command, options.scenario);
  command
      .add_option("--safety", options.scenario.overrides.safety,
                  "Of the robot's supervisor: lab (act; the default), observe, off; the latter two "
                  "on the loopback alone")
      ->check(CLI::IsMember({"off", "observe", "lab"}));
  command
      .add_option(
          "--clock", options.clock,
          "wall: the robot's own; lockstep: with a server in lock-step, as fast as it goes, "
          "the same bits again")
      ->check(CLI::IsMember({"wall", "lockstep"}))
      ->capture_default_str();
  AddRobotOption(command, options);
}

}  // namespace

void AddHardwareCommand(CommandLine& line) {
  auto options = std::make_shared<HardwareOptions>();
  CLI::App* const hardware =
      line.app.add_subcommand("hardware", "Run a scenario on a Panda, real or simulated");
  hardware->require_subcommand(1);

  CLI::App* const run = hardware->add_subcommand(
      "run",
      "Run one episode on a robot; its obstacles are virtual. Ctrl-C once brakes and ends the "
      "motion, twice stops the robot, three times leaves");
  AddScenario(*run, *options);
  run->add_option("--out", options->out, "Folder for the results [out/SCENARIO/hardware]");
  run->add_flag("--json", options->json, "Print result.json instead of the summary");
  run->add_flag("--dry-run", options->dry_run, "Connect, look and plan; send nothing to the robot");
  run->callback([&line, options] { line.exit_code = RunOnHardware(*options); });

  CLI::App* const go = hardware->add_subcommand(
      "go-to-start", "Move slowly to where the scenario's task starts, after asking");
  AddScenario(*go, *options);
  go->add_flag("--yes", options->yes, "Do not ask");
  go->callback([&line, options] { line.exit_code = GoToStart(*options); });

  CLI::App* const recover = hardware->add_subcommand(
      "recover", "Out of a reflex, back to idle: after a person has seen to its cause");
  AddRobotOption(*recover, *options);
  recover->callback([&line, options] { line.exit_code = Recover(*options); });
}

}  // namespace sidestep::cli
