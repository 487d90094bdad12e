#include "sidestep/cli/hardware_world.h"

#include <memory>
#include <utility>

#include "sidestep/cli/operator_log.h"
#include "sidestep/cli/panda_connection.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/hardware/readiness.h"
#include "sidestep/sim/simulation.h"
#include "sidestep/sim/world_xml.h"

namespace sidestep::cli {
namespace {

constexpr double kAtStart_rad = 0.02;

scenarios::Scenario WithoutRobot(scenarios::Scenario scenario) {
  scenario.robot.clear();
  scenario.mount.clear();
  return scenario;
}

// The robot is real or plays it; what it is to step aside from is not.
class VirtualObstacles final : public robot::RobotInterface {
 public:
  VirtualObstacles(std::unique_ptr<hardware::PandaRobot> panda, const scenarios::Scenario& scenario,
                   const DataPaths& paths, const sim::SensorMaker& make_sensor)
      : panda_(std::move(panda)),
        obstacles_(WithoutRobot(scenario), paths.all_models(), make_sensor) {}

  hardware::PandaRobot& panda() { return *panda_; }
  sim::Simulation& obstacles() { return obstacles_; }

  JointState Read() const override { return panda_->Read(); }
  robot::RobotStatus Status() const override { return panda_->Status(); }
  void Submit(const Trajectory& trajectory, EpisodeTime start) override {
    panda_->Submit(trajectory, start);
  }
  void Hold() noexcept override { panda_->Hold(); }
  void Watch(const ObstacleReport& report) override { panda_->Watch(report); }
  std::vector<SafetyEvent> TakeSafetyEvents() override { return panda_->TakeSafetyEvents(); }
  void AdvanceTo(EpisodeTime t) override {
    panda_->AdvanceTo(t);
    obstacles_.robot().AdvanceTo(t);
  }
  std::vector<double> TakeAnswerTimes() override { return panda_->TakeAnswerTimes(); }
  std::vector<ControlSample> TakeControlLog() override { return panda_->TakeControlLog(); }

 private:
  std::unique_ptr<hardware::PandaRobot> panda_;
  sim::Simulation obstacles_;  // without a robot
};

}  // namespace

std::unique_ptr<hardware::PandaRobot> ConnectReadyPanda(const std::string& address,
                                                        const robot::RobotModel& robot,
                                                        const hardware::PandaOptions& options) {
  auto driver = ConnectPanda(address);
  try {
    return std::make_unique<hardware::PandaRobot>(std::move(driver), robot, options);
  } catch (const hardware::NotReady& error) {
    OperatorLog(address).Refused(error.objection());
    throw InputError("--robot", error.what());
  } catch (const hardware::FciError& error) {
    throw InputError("--robot", error.what());
  }
}

std::optional<std::string> WhyNotAtStart(const Eigen::VectorXd& q,
                                         const scenarios::Scenario& scenario) {
  Eigen::Index joint = 0;
  const double off_rad = (q - scenario.q_start).cwiseAbs().maxCoeff(&joint);
  if (off_rad <= kAtStart_rad) return std::nullopt;
  return "joint " + std::to_string(joint + 1) + " is " + FiniteText("{:.3f}", off_rad) +
         " rad from where the task starts, allowed 0.02: first `sidestep hardware go-to-start`";
}

bench::WorldFactory HardwareWorlds(const DataPaths& paths, const std::string& address,
                                   const hardware::PandaOptions& options,
                                   const sim::SensorMaker& make_sensor) {
  return [=](const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
    auto panda = ConnectReadyPanda(address, robot, options);
    if (const auto aside = WhyNotAtStart(panda->Read().q, scenario)) {
      throw InputError("--robot", *aside);
    }
    const auto stage =
        std::make_shared<VirtualObstacles>(std::move(panda), scenario, paths, make_sensor);
    bench::EpisodeWorld world;
    world.robot = stage.get();
    world.sensors = stage->obstacles().sensors();
    world.model_xml = sim::BuildWorldXml(scenario, robot.mount_links(), paths.all_models());
    world.joints = robot.joint_names();
    world.obstacles = stage->obstacles().obstacles();
    world.facts["robot_at"] = address + (IsLoopback(address) ? " (simulated)" : "");
    world.owner = stage;
    return world;
  };
}

}  // namespace sidestep::cli
