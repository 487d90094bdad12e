#include "sidestep/cli/server_trace.h"

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "sidestep/bench/metrics/registry.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_folder.h"
#include "sidestep/record/recording_file.h"

namespace sidestep::cli {
namespace {

Eigen::VectorXd VectorOf(const robot::fci::Joints& joints) {
  return Eigen::Map<const Eigen::VectorXd>(joints.data(), static_cast<Eigen::Index>(joints.size()));
}

bench::EpisodeWorld WorldOf(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                            const std::string& model_xml) {
  bench::EpisodeWorld world;
  world.model_xml = model_xml;
  world.joints = robot.joint_names();
  for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
    world.obstacles.push_back(obstacle.name);
  }
  return world;
}

}  // namespace

ServerTrace::ServerTrace(const std::string& out, int number, const scenarios::Scenario& scenario,
                         const robot::RobotModel& robot, const std::string& model_xml,
                         const bench::RunIdentity& identity)
    : name_("trace" + (number > 1 ? "_" + std::to_string(number) : "") + ".h5"),
      out_(MakeOutFolder(out, {name_, kJournalName})),
      identity_(identity),
      recorder_(scenario, robot, WorldOf(scenario, robot, model_xml)),
      journal_(out_ + "/" + kJournalName, Provenance(identity),
               [](const std::string& why) { PrintError("{}; the server goes on\n", why); }) {}

void ServerTrace::Keep(const sim::fci::PandaPlant& plant, const sim::fci::SimulatedPanda& panda) {
  const robot::fci::RobotState state = panda.State();
  ControlSample tick;
  tick.t = EpisodeTime(plant.time_s());
  tick.q_command = VectorOf(state.q_d);
  tick.v_command = VectorOf(state.dq_d);
  tick.a_command = VectorOf(state.ddq_d);
  tick.q = VectorOf(plant.q());
  tick.v = VectorOf(plant.dq());
  tick.torque = VectorOf(plant.motor_torque());
  recorder_.Keep(std::move(tick));
  journal_.Keep(recorder_.recording());
}

std::string ServerTrace::Write() {
  record::Recording recording = recorder_.Take();
  recording.header["knowledge"] = "robot server";  // nobody planned here
  AddProvenance(identity_, recording);
  bench::ComputeMetrics(recording);
  std::string path = out_ + "/" + name_;
  record::WriteRecording(recording, path);
  journal_.Remove();
  return path;
}

}  // namespace sidestep::cli
