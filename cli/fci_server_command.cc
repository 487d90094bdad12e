#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/sensors.h"
#include "sidestep/cli/server_trace.h"
#include "sidestep/cli/stop_signals.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/render/rendered_camera.h"
#include "sidestep/sim/fci/fault_script.h"
#include "sidestep/sim/fci/frame_server.h"
#include "sidestep/sim/fci/panda_world.h"
#include "sidestep/sim/fci/server.h"
#include "sidestep/sim/simulated_truth.h"
#include "sidestep/sim/world_xml.h"

namespace sidestep::cli {
namespace {

struct ServerCommand {
  sim::fci::ServerOptions server;
  std::string clock = "lockstep", scenario, faults, out;
  std::vector<std::string> settings, models;
  std::optional<double> speed_m_s;
  std::vector<double> q_start;
};

Eigen::VectorXd StartOf(const ServerCommand& options, const scenarios::Scenario& scenario,
                        const robot::RobotModel& robot) {
  if (options.q_start.empty()) {
    if (scenario.q_start.size() > 0) return scenario.q_start;
    return robot.configurations().at(scenario.start_name.empty() ? "home" : scenario.start_name);
  }
  Eigen::VectorXd q(robot.num_joints());
  for (int i = 0; i < robot.num_joints(); ++i) {
    const robot::JointLimits& limit = robot.limits()[static_cast<std::size_t>(i)];
    q(i) = options.q_start[static_cast<std::size_t>(i)];
    if (!(q(i) > limit.q_min && q(i) < limit.q_max)) {
      throw InputError("--q-start", fmt::format("joint {} must be between {} and {} rad, is {}",
                                                i + 1, limit.q_min, limit.q_max, q(i)));
    }
  }
  return q;
}

scenarios::Scenario WorldOf(const ServerCommand& options, const DataPaths& paths) {
  if (options.scenario.empty()) {
    if (!options.settings.empty()) throw InputError("--set", "is of a --scenario");
    if (options.speed_m_s) throw InputError("--speed", "is of the things of a --scenario");
    return sim::fci::PandaAlone();
  }
  Overrides overrides;
  overrides.settings = ParseSettings(options.settings);
  overrides.speed_m_s = options.speed_m_s;
  Problem problem = LoadProblem(options.scenario, overrides, paths);
  if (problem.robot.name() != "panda") {
    throw InputError("--scenario",
                     "its robot must be the panda, is '" + problem.robot.name() + "'");
  }
  return std::move(problem.scenario);
}

// Judges what happens in the server's world, as a simulated run is judged: says when the arm begins
// to touch a thing, and in the end how near it came to one.
class Judge {
 public:
  explicit Judge(const sim::World& world) : world_(world) { truth_.emplace(world); }

  void Observe(ServerTrace* trace) {
    if (world_.ticks() == 0) {
      truth_.emplace(world_);
    } else {
      truth_->Observe();
    }
    for (const TruthSample& sample : truth_->TakeSamples()) {
      if (trace != nullptr) trace->Keep(sample);
      if (sample.in_contact && sample.contact_object != touched_) {
        Print("{:.3f} s: contact with {}\n", sample.contact_s, sample.contact_object);
      }
      touched_ = sample.in_contact ? sample.contact_object : "";
      if (!(sample.clearance_m >= nearest_.clearance_m)) nearest_ = sample;
    }
  }

  void Conclude() const {
    Print("least clearance  {}", FiniteText("{:.1f} mm", 1e3 * nearest_.clearance_m));
    if (std::isfinite(nearest_.clearance_m)) {
      Print(", {} and {}, at {:.2f} s", nearest_.nearest_robot_part, nearest_.nearest_object,
            nearest_.t.seconds());
    }
    Print("\n");
  }

 private:
  static TruthSample Nothing() {
    TruthSample sample;
    sample.clearance_m = std::numeric_limits<double>::infinity();
    return sample;
  }

  const sim::World& world_;
  std::optional<sim::SimulatedTruth> truth_;
  std::string touched_;
  TruthSample nearest_ = Nothing();
};

// Puts the trace of a client's world into its place, if traces are asked for.
void BeginTrace(const ServerCommand& options, int number, scenarios::Scenario scenario,
                const robot::RobotModel& robot, const DataPaths& paths,
                std::optional<ServerTrace>& trace) {
  if (options.out.empty()) return;
  scenario.q_start = StartOf(options, scenario, robot);
  if (scenario.q_goal.size() == 0) scenario.q_goal = scenario.q_start;
  trace.emplace(options.out, number, scenario, robot,
                sim::BuildWorldXml(scenario, robot.mount_links(), paths.all_models()),
                Identify(scenario, paths));
}

// Shows what the scenario's camera sees, if it has one; a picture takes longer than a tick of the
// wall.
std::optional<sim::fci::FrameServer> CameraOf(const ServerCommand& options,
                                              const scenarios::Scenario& scenario,
                                              const sim::World& world) {
  if (scenario.sensor.name != kTagImages || options.clock == "wall") return std::nullopt;
  sim::CheckSensorSettings(scenario, kTagImages);
  try {
    return std::make_optional<sim::fci::FrameServer>(options.server.address, world, [&] {
      return std::make_unique<render::RenderedCamera>(scenario, world);
    });
  } catch (const robot::fci::LinkError& error) {
    throw InputError("--address", error.what());
  }
}

int Serve(ServerCommand options) {
  const DataPaths paths = FindDataPaths(options.models);
  const sim::fci::FaultScript faults =
      options.faults.empty() ? sim::fci::FaultScript() : sim::fci::ReadFaultScript(options.faults);
  const scenarios::Scenario scenario = WorldOf(options, paths);
  const ModelFolders models = paths.all_models();
  const robot::RobotModel robot = RobotOf(scenario, models);
  const auto world =
      sim::fci::MakePandaWorld(scenario, robot, models, StartOf(options, scenario, robot));
  Judge judge(*world);
  std::optional<ServerTrace> trace;
  const auto write_trace = [&] {
    if (trace) Print("written          {}\n", trace->Write());
    trace.reset();
  };
  int num_clients = 0;
  sim::fci::PandaPlant plant(robot, world.get());
  sim::fci::SimulatedPanda panda(&plant, faults);
  plant.AfterStep([&] {
    if (world->ticks() == 0 || num_clients == 0) {  // a world of its own for each client
      write_trace();
      BeginTrace(options, ++num_clients, scenario, robot, paths, trace);
    }
    judge.Observe(trace ? &*trace : nullptr);
    if (trace) trace->Keep(plant, panda);
  });
  const auto tell = [&](const std::string& what) {
    Print("{:.3f} s: {}\n", plant.time_s(), what);
    FinishOutput();
  };
  panda.TellWith(tell);
  options.server.version = faults.version;
  options.server.clock =
      options.clock == "wall" ? sim::fci::ServerClock::kWall : sim::fci::ServerClock::kLockStep;
  std::optional<sim::fci::Server> server;
  try {
    server.emplace(&panda, options.server);
  } catch (const robot::fci::LinkError& error) {
    throw InputError("--address", error.what());
  }
  server->TellWith(tell);
  std::optional<sim::fci::FrameServer> frames = CameraOf(options, scenario, *world);
  if (frames) server->Show(&*frames);
  Print("simulated Panda at {}, FCI version {}, {}{}; Ctrl-C ends it\n", options.server.address,
        faults.version, options.clock, frames ? ", with a camera" : "");
  FinishOutput();
  const StopSignals signals;
  server->Run([&] { return signals.count() > 0; });
  judge.Conclude();
  write_trace();
  return 0;
}

}  // namespace

void AddFciServerCommand(CommandLine& line) {
  auto options = std::make_shared<ServerCommand>();
  CLI::App* const server = line.app.add_subcommand(
      "fci-server", "Simulate a Franka Panda behind its own network protocol");
  server->add_option("--address", options->server.address,
                     "Where to listen, an address of this machine [127.0.0.1]; the port is 1337");
  server
      ->add_option("--clock", options->clock,
                   "lockstep: wait for each answer, as fast as it goes; wall: 1 kHz [lockstep]")
      ->check(CLI::IsMember({"lockstep", "wall"}));
  server
      ->add_option("--grace", options->server.grace_s,
                   "In lock-step, how long to wait for an answer before it is lost [s] [10]")
      ->check(NumberFrom(0.001, 3600.0));
  server
      ->add_option("--q-start", options->q_start,
                   "Where the arm is at first: seven angles [rad] [the scenario's, or home]")
      ->delimiter(',')
      ->expected(7);
  server->add_option("--scenario", options->scenario,
                     "Whose things stand and move around the arm; a name or a path");
  server->add_option("--set", options->settings, "KEY=VALUE of the scenario, as for `sidestep run`")
      ->allow_extra_args(false);
  AddModels(*server, options->models);
  server
      ->add_option("--speed", options->speed_m_s,
                   "Speed of every moving obstacle of the scenario [m/s]")
      ->check(NumberFrom(0.0, 100.0));
  server->add_option("--faults", options->faults, "FILE.yaml of what goes wrong, and when");
  server->add_option("--out", options->out,
                     "Folder for a trace of what truly happens: motion, contacts, clearance");
  server->add_flag("--once", options->server.once, "End with the first client");
  server->footer(
      "Speaks protocol version 5, that of libfranka 0.9: joint positions, joint velocities and\n"
      "torques. The world begins with each client and stands still until the first command of its\n"
      "first motion, and while the arm rests; times count from there. docs/hardware.md tells what\n"
      "is checked, and by which source. In lock-step, with a scenario that is seen by tag_images, "
      "its\n"
      "camera is shown to `sidestep hardware run --camera server`.");
  server->callback([&line, options] { line.exit_code = Serve(*options); });
}

}  // namespace sidestep::cli
