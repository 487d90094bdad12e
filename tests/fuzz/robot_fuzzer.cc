// Any file is refused with an InputError, or is a robot whose kinematics can be asked for.
#include <cstdlib>

#include "sidestep/core/input_error.h"
#include "sidestep/robot/robot_model.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const sidestep::MemoryFile file(bytes, size);
  try {
    const auto robot = sidestep::robot::RobotModel::FromFile(file.path(), sidestep::Pose());
    const Eigen::VectorXd q = Eigen::VectorXd::Zero(robot.num_joints());
    if (robot.ComputeSphereCenters(q, true).p_WS.cols() != robot.num_spheres()) std::abort();
  } catch (const sidestep::InputError&) {
  }
  return 0;
}
