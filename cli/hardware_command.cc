#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/cli/calibrate.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/hardware_world.h"
#include "sidestep/cli/look_around.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/operator_log.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/panda_connection.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_folder.h"
#include "sidestep/cli/run_summary.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/sensors.h"
#include "sidestep/cli/stop_signals.h"
#include "sidestep/cli/tag_camera.h"
#include "sidestep/cli/tether.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/input_error.h"
#include "sidestep/hardware/recovery.h"
#include "sidestep/hardware/slow_move.h"
#include "sidestep/sim/safety_of.h"

namespace sidestep::cli {
namespace {

constexpr const char* kDefaultAddress = "127.0.0.1";

struct HardwareOptions {
  ScenarioOptions scenario;
  std::string robot = kDefaultAddress;
  std::string clock = "wall";
  std::string out;
  std::string calibration, camera = "virtual";
  double seconds = 0;  // of a dry run
  bool json = false, dry_run = false, yes = false;
};

// Who may stop a robot that moves: a person at the keyboard, and whoever started us by ending.
class Operator {
 public:
  std::string WhyStop() const {
    return signals_.count() > 0 ? signals_.first() : tether_.WhatIsGone();
  }
  bool WantsItAtOnce() const { return signals_.count() > 1; }

 private:
  StopSignals signals_;
  Tether tether_;
};

// A scenario for a Panda, supervised by `lab` unless it or the command line says otherwise.
Problem LoadForHardware(const HardwareOptions& options, const DataPaths& paths) {
  Overrides overrides = ParseOverrides(options.scenario);
  Problem problem = LoadProblem(options.scenario.scenario, overrides, paths);
  if (problem.robot.name() != "panda") {
    throw InputError("SCENARIO", "its robot must be the panda, is '" + problem.robot.name() + "'");
  }
  if (!overrides.safety && problem.scenario.safety.profile == scenarios::SafetyProfile::kOff) {
    problem.scenario.safety.profile = scenarios::SafetyProfile::kLab;
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

CameraUse CameraUseOf(const HardwareOptions& options) {
  CameraUse use = {ParseCamera(options.camera), std::nullopt, options.robot, {}};
  if (!options.calibration.empty()) {
    use.calibration = hardware::ReadCalibration(options.calibration);
  }
  return use;
}

// What is around the robot, and how it is seen.
HardwareSite SiteOf(const HardwareOptions& options, const scenarios::Scenario& scenario) {
  const CameraUse use = CameraUseOf(options);
  if (use.choice.kind == CameraKind::kVirtual && !use.calibration) {
    return {options.robot, &MakeSensor, ""};
  }
  ReadyCamera camera = OpenTagCamera(scenario, use, TodayUtc());
  return {options.robot, std::move(camera.make_sensor), camera.description};
}

// What of a camera and a clock does not go together.
void CheckCamera(const HardwareOptions& options, bool lockstep) {
  switch (ParseCamera(options.camera).kind) {
    case CameraKind::kServer:
      if (!lockstep) throw InputError("--camera", "the server shows pictures in lock-step alone");
      return;
    case CameraKind::kRealSense:
      if (lockstep) throw InputError("--camera", "a real camera has a clock of its own: wall");
      return;
    case CameraKind::kVirtual:
    case CameraKind::kRecorded:
      return;
  }
}

// Connects, looks, and plans; nothing is sent to the robot.
int DryRun(const HardwareOptions& options, const Problem& problem, const DataPaths& paths) {
  const bool has_camera = problem.scenario.sensor.name == kTagImages;
  for (const auto& [flag, is_given] : {std::pair("--out", !has_camera && !options.out.empty()),
                                       std::pair("--json", options.json)}) {
    if (is_given) throw InputError(flag, "is of a run: --dry-run leaves no results");
  }
  if (!has_camera) SiteOf(options, problem.scenario);  // which has no use for one
  auto driver = ConnectPanda(options.robot);
  const hardware::RobotSnapshot state = driver->ReadOnce();
  const scenarios::Scenario& scenario = problem.scenario;
  Eigen::VectorXd q(static_cast<Eigen::Index>(state.q.size()));
  std::copy(state.q.begin(), state.q.end(), q.begin());
  const std::optional<std::string> aside = WhyNotAtStart(q, scenario);
  const std::optional<hardware::Objection> objection = WhyNotReady(state, problem.robot);
  Print("robot            {}, protocol version {}, mode {}\n", options.robot,
        driver->server_version(), robot::fci::Name(state.mode));
  Print("from the start   {:.4f} rad, allowed 0.02\n",
        (q - scenario.q_start).cwiseAbs().maxCoeff());
  if (has_camera) {
    const Operator person;
    LookAround(problem, paths,
               {CameraUseOf(options),
                options.out.empty() ? "out/" + scenario.name + "/dry_run" : options.out,
                options.seconds, [&] { return person.WhyStop(); }},
               std::move(driver));
  } else {
    Print("in simulation, from the start of the task, under the same supervision:\n");
    const bench::EpisodeResult result =
        bench::RunEpisode(scenario, problem.robot, SimulatedWorlds(paths));
    PrintOutcome(result, scenario);
  }
  FinishOutput();
  if (objection) PrintError("hardware run: not ready: {}\n", objection->why);
  if (aside) PrintError("hardware run: not ready: {}\n", *aside);
  return objection || aside ? 1 : 0;
}

int RunOnHardware(const HardwareOptions& options) {
  const DataPaths paths = FindDataPaths(options.scenario.models);
  Problem problem = LoadForHardware(options, paths);
  if (options.dry_run) return DryRun(options, problem, paths);
  const bool lockstep = options.clock == "lockstep";
  if (!lockstep && problem.scenario.latency == scenarios::Latency::kNone) {
    throw InputError("replanning.latency", "planning takes time on hardware: charged or measured");
  }
  if (lockstep && !IsLoopback(options.robot)) {
    throw InputError("--clock", "a real robot has a clock of its own: wall");
  }
  CheckCamera(options, lockstep);
  const std::string out =
      options.out.empty() ? "out/" + problem.scenario.name + "/hardware" : options.out;
  const HardwareSite site = SiteOf(options, problem.scenario);
  RunFolder folder(out, Identify(problem.scenario, paths));
  const Operator person;
  const bench::WorldFactory worlds =
      HardwareWorlds(paths, site,
                     {.safety = sim::SafetyOf(problem.scenario, problem.robot),
                      .lockstep = lockstep,
                      .stops_at_once = [&] { return person.WantsItAtOnce(); }});
  bench::EpisodeOptions episode;
  episode.clock = lockstep ? bench::EpisodeClock::kVirtual : bench::EpisodeClock::kRobot;
  episode.why_stop = [&] { return person.WhyStop(); };
  episode.journal = &folder.journal();
  bench::EpisodeResult result = bench::RunEpisode(problem.scenario, problem.robot, worlds, episode);
  folder.KeepAndTell(result, problem.scenario, options.json);
  return 0;
}

void AskToMove(const HardwareOptions& options, double seconds) {
  Print("The robot at {} will move to the start of the task, alone and unseeing, for {:.1f} s.\n",
        options.robot, seconds);
  FinishOutput();
  if (options.yes) return;
  Print("Is its way free, and the stop in your hand? [y/N] ");
  FinishOutput();
  std::string answer;
  if (!std::getline(std::cin, answer) || (answer != "y" && answer != "yes")) {
    throw InputError("hardware go-to-start", "not without a yes");
  }
}

// Why it ended before it was there; else empty.
std::string MoveAlong(hardware::PandaRobot& panda, const Trajectory& way, const Operator& person) {
  panda.AdvanceTo(EpisodeTime(0.01));
  panda.Submit(way, EpisodeTime(0.02));
  const double seconds = way.t_s(way.num_states() - 1);
  const int num_steps = static_cast<int>(std::ceil((seconds + 0.5) / 0.02));
  for (int step = 1; step < num_steps; ++step) {
    const std::string why_stop = person.WhyStop();
    if (!why_stop.empty()) return why_stop;
    panda.AdvanceTo(EpisodeTime(0.02 * step));
    panda.TakeControlLog();
    panda.TakeAnswerTimes();
  }
  return "";
}

int GoToStart(const HardwareOptions& options) {
  const DataPaths paths = FindDataPaths(options.scenario.models);
  const Problem problem = LoadForHardware(options, paths);
  control::SafetySettings safety = sim::SafetyOf(problem.scenario, problem.robot);
  safety.slow_after_s = safety.stale_s = 1e9;  // it moves unseeing
  std::optional<Operator> person;              // of the motion, until it has come to rest
  const auto panda = ConnectReadyPanda(options.robot, problem.robot,
                                       {.safety = safety,
                                        .lockstep = options.clock == "lockstep",
                                        .stops_at_once = [&] { return person->WantsItAtOnce(); }});
  const Trajectory way =
      hardware::SlowMove(problem.robot, panda->Read().q, problem.scenario.q_start);
  AskToMove(options, way.t_s(way.num_states() - 1));
  person.emplace();
  const std::string why_stop = MoveAlong(*panda, way, *person);
  const std::optional<std::string> aside = WhyNotAtStart(panda->Read().q, problem.scenario);
  Print("from the start   {:.4f} rad\n",
        (panda->Read().q - problem.scenario.q_start).cwiseAbs().maxCoeff());
  PrintText(FindingsText(panda->TakeSafetyEvents(), !IsLoopback(options.robot)));
  FinishOutput();
  if (!why_stop.empty()) {
    PrintError("hardware go-to-start: it was stopped from outside: {}\n", why_stop);
  }
  return why_stop.empty() && !aside ? 0 : 1;
}

// What of a scenario is near the arm when it begins: until there are cameras, its obstacles are
// virtual.
std::vector<ObstacleState> ObstaclesOf(const scenarios::Scenario& scenario) {
  std::vector<ObstacleState> obstacles;
  for (const sdf::MovingShape& moving : bench::TrueMotions(scenario)) {
    ObstacleState& obstacle = obstacles.emplace_back();
    obstacle.X_WO = moving.X_WO(EpisodeTime(0));
    obstacle.half_extents_m = HalfExtents(moving.shape);
  }
  return obstacles;
}

int Recover(const HardwareOptions& options) {
  const DataPaths paths = FindDataPaths(options.scenario.models);
  std::optional<Problem> problem;
  if (!options.scenario.scenario.empty()) problem = LoadForHardware(options, paths);
  const robot::RobotModel robot =
      problem ? problem->robot : robot::RobotModel::Load(paths.models, "panda", Pose());
  const auto driver = ConnectPanda(options.robot);
  const OperatorLog log(options.robot);
  const auto refuse = [&](const hardware::Objection& objection) {
    log.Refused(objection);
    FinishOutput();
    PrintError("hardware recover: {}\n", objection.why);
    return 1;
  };
  try {
    hardware::RecoveryRequest request;
    request.state = driver->ReadOnce();
    const std::string errors = robot::fci::Text(request.state.last_motion_errors);
    Print("mode             {}\n", robot::fci::Name(request.state.mode));
    Print("last errors      {}\n", errors);
    if (request.state.mode == robot::fci::RobotMode::kIdle) return 0;  // there is no need
    request.since_last_s = log.SecondsSinceRecovery();
    const double obstacle_speed_m_s = problem ? problem->scenario.safety.obstacle_speed_m_s
                                              : control::SafetySettings().obstacle_speed_m_s;
    if (problem) request.obstacles = ObstaclesOf(problem->scenario);
    if (const auto objection = WhyNotRecover(request, robot, obstacle_speed_m_s)) {
      return refuse(*objection);
    }
    driver->Recover();
    Print("mode             {}\n", robot::fci::Name(driver->ReadOnce().mode));
    log.Recovered(errors);
    AwaitReady(*driver, robot);
  } catch (const hardware::NotReady& error) {
    return refuse(error.objection());
  } catch (const hardware::FciError& error) {
    return refuse({control::SafetyCheck::kRecovery, error.what()});
  }
  return 0;
}

void AddRobotOption(CLI::App& command, HardwareOptions& options) {
  command
      .add_option("--robot", options.robot,
                  "Its address; on the loopback, that of `sidestep fci-server`")
      ->check(CLI::Validator(
          [](std::string& address) {
            return address.empty() ? "must be an address, is empty" : "";
          },
          ""))
      ->capture_default_str();
}

void AddClock(CLI::App& command, HardwareOptions& options) {
  command
      .add_option(
          "--clock", options.clock,
          "wall: the robot's own; lockstep: with a server in lock-step, as fast as it goes, "
          "the same bits again")
      ->check(CLI::IsMember({"wall", "lockstep"}))
      ->capture_default_str();
}

}  // namespace

void AddHardwareCommand(CommandLine& line) {
  auto options = std::make_shared<HardwareOptions>();
  CLI::App* const hardware =
      line.app.add_subcommand("hardware", "Run a scenario on a Panda, real or simulated");
  hardware->require_subcommand(1);

  CLI::App* const run = hardware->add_subcommand(
      "run",
      "Run one episode on a robot; its obstacles are virtual, or seen by a camera. Ctrl-C once "
      "brakes and ends the motion, twice stops the robot, three times leaves");
  AddScenarioOptions(*run, options->scenario, KnowsNoFuture());
  run->add_option("--safety", options->scenario.overrides.safety,
                  "Of the robot's supervisor: lab (act; the default), observe, off; the latter two "
                  "on the loopback alone")
      ->check(CLI::IsMember({"off", "observe", "lab"}));
  AddClock(*run, *options);
  AddRobotOption(*run, *options);
  run->add_option("--out", options->out,
                  "Folder for the results [out/SCENARIO/hardware, or dry_run]");
  run->add_flag("--json", options->json, "Print result.json instead of the summary");
  run->add_option(
         "--camera", options->camera,
         "Whose pictures tag_images looks at: virtual (drawn of virtual obstacles), server "
         "(of the simulated robot server's world, in lock-step), recorded:DIR, "
         "realsense:SERIAL")
      ->capture_default_str();
  run->add_option("--calibration", options->calibration,
                  "Where the camera of tag_images stands, of `sidestep hardware calibrate`; else "
                  "as the scenario says");
  run->add_flag("--dry-run", options->dry_run,
                "Connect, look and plan; send nothing to the robot. With tag_images, leaves the "
                "pictures, what was seen in them, and a video of that");
  run->add_option(
         "--seconds", options->seconds,
         "How long a dry run with tag_images looks [s] [two horizons; all that is recorded]")
      ->check(NumberFrom(0.1, 3600.0));
  run->callback([&line, options] { line.exit_code = RunOnHardware(*options); });

  CLI::App* const go = hardware->add_subcommand(
      "go-to-start", "Move slowly to where the scenario's task starts, after asking");
  AddScenario(*go, options->scenario);
  AddClock(*go, *options);
  AddRobotOption(*go, *options);
  go->add_flag("--yes", options->yes, "Do not ask");
  go->callback([&line, options] { line.exit_code = GoToStart(*options); });

  CLI::App* const recover = hardware->add_subcommand(
      "recover",
      "Out of a reflex, back to idle: after a person has seen to its cause; once a minute at most");
  AddScenario(*recover, options->scenario)
      ->required(false)
      ->description("Whose obstacles must be further off than the protective distance");
  AddRobotOption(*recover, *options);
  recover->callback([&line, options] { line.exit_code = Recover(*options); });

  auto replay = std::make_shared<std::pair<std::string, std::string>>();  // folder, out
  CLI::App* const again = hardware->add_subcommand(
      "replay",
      "Look at the pictures of a dry run again: the same has to be found in them, to the bit");
  again->add_option("DIR", replay->first, "Folder of the dry run")->required();
  again->add_option("--out", replay->second, "Folder for a video of what is found");
  again->callback([&line, replay] {
    line.exit_code = LookAgain(FindDataPaths(), replay->first, replay->second) ? 0 : 1;
  });

  AddCalibrate(*hardware, line);
}

}  // namespace sidestep::cli
