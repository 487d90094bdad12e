#include "sidestep/cli/hardware_world.h"

#include <memory>
#include <utility>

#include "sidestep/cli/operator_log.h"
#include "sidestep/cli/panda_connection.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/hardware/readiness.h"
#include "sidestep/hardware/standing_robot.h"
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

// The robot is real or plays it; what it is to step aside from is not, unless a camera sees it.
class Stage final : public robot::RobotInterface {
 public:
  Stage(std::unique_ptr<robot::RobotInterface> arm, const scenarios::Scenario& scenario,
        const DataPaths& paths, const sim::SensorMaker& make_sensor)
      : arm_(std::move(arm)), obstacles_(WithoutRobot(scenario), paths.all_models(), make_sensor) {}

  sim::Simulation& obstacles() { return obstacles_; }

  JointState Read() const override { return arm_->Read(); }
  robot::RobotStatus Status() const override { return arm_->Status(); }
  void Submit(const Trajectory& trajectory, EpisodeTime start) override {
    arm_->Submit(trajectory, start);
  }
  void Hold() noexcept override { arm_->Hold(); }
  void Watch(const ObstacleReport& report) override { arm_->Watch(report); }
  std::vector<SafetyEvent> TakeSafetyEvents() override { return arm_->TakeSafetyEvents(); }
  void AdvanceTo(EpisodeTime t) override {
    arm_->AdvanceTo(t);
    obstacles_.robot().AdvanceTo(t);
  }
  std::vector<double> TakeAnswerTimes() override { return arm_->TakeAnswerTimes(); }
  std::vector<ControlSample> TakeControlLog() override { return arm_->TakeControlLog(); }

 private:
  std::unique_ptr<robot::RobotInterface> arm_;
  sim::Simulation obstacles_;  // without a robot
};

bench::EpisodeWorld WorldAround(std::unique_ptr<robot::RobotInterface> arm,
                                const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                                const DataPaths& paths, const HardwareSite& site) {
  const auto stage = std::make_shared<Stage>(std::move(arm), scenario, paths, site.make_sensor);
  bench::EpisodeWorld world;
  world.robot = stage.get();
  world.sensors = stage->obstacles().sensors();
  world.model_xml = sim::BuildWorldXml(scenario, robot.mount_links(), paths.all_models());
  world.joints = robot.joint_names();
  world.obstacles = stage->obstacles().obstacles();
  world.facts["robot_at"] = site.address + (IsLoopback(site.address) ? " (simulated)" : "");
  if (!site.camera.empty()) world.facts["camera"] = site.camera;
  world.owner = stage;
  return world;
}

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

bench::WorldFactory HardwareWorlds(const DataPaths& paths, const HardwareSite& site,
                                   const hardware::PandaOptions& options) {
  return [=](const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
    auto panda = ConnectReadyPanda(site.address, robot, options);
    if (const auto aside = WhyNotAtStart(panda->Read().q, scenario)) {
      throw InputError("--robot", *aside);
    }
    return WorldAround(std::move(panda), scenario, robot, paths, site);
  };
}

bench::WorldFactory StandingWorlds(const DataPaths& paths, const HardwareSite& site,
                                   std::unique_ptr<hardware::FciDriver> driver) {
  const auto held = std::make_shared<std::unique_ptr<hardware::FciDriver>>(std::move(driver));
  return [=](const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
    return WorldAround(std::make_unique<hardware::StandingRobot>(std::move(*held)), scenario, robot,
                       paths, site);
  };
}

}  // namespace sidestep::cli
