#include "sidestep/sim/fci/panda_world.h"

#include "sidestep/sim/robot_agreement.h"
#include "sidestep/sim/world_xml.h"

namespace sidestep::sim::fci {

scenarios::Scenario PandaAlone() {
  scenarios::Scenario scenario;
  scenario.name = "panda_alone";
  scenario.file = "fci-server";
  scenario.robot = "panda";
  return scenario;
}

std::unique_ptr<World> MakePandaWorld(const scenarios::Scenario& scenario,
                                      const robot::RobotModel& robot, const ModelFolders& models,
                                      const Eigen::VectorXd& q_start) {
  std::string xml = BuildWorldXml(scenario, robot.mount_links(), models);
  MujocoModelPtr model = LoadMujocoModel(WithoutPictures(xml), scenario.file + ": its world");
  CheckAgreement(robot, *model, RobotMjcf(scenario, models));
  return std::make_unique<World>(scenario, std::move(xml), std::move(model), robot.joint_names(),
                                 q_start);
}

}  // namespace sidestep::sim::fci
