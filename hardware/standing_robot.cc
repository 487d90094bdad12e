#include "sidestep/hardware/standing_robot.h"

#include <Eigen/Core>
#include <utility>

#include "sidestep/robot/robot_error.h"

namespace sidestep::hardware {
namespace {

Eigen::VectorXd VectorOf(const robot::fci::Joints& joints) {
  return Eigen::Map<const Eigen::VectorXd>(joints.data(), static_cast<Eigen::Index>(joints.size()));
}

}  // namespace

StandingRobot::StandingRobot(std::unique_ptr<FciDriver> driver) : driver_(std::move(driver)) {
  const RobotSnapshot state = driver_->ReadOnce();
  latest_ = {EpisodeTime(0), VectorOf(state.q), VectorOf(state.dq)};
}

void StandingRobot::AdvanceTo(EpisodeTime t) {
  try {
    const RobotSnapshot state = driver_->ReadOnce();
    latest_ = {t, VectorOf(state.q), VectorOf(state.dq)};
    ControlSample& tick = log_.emplace_back();
    tick.t = t;
    tick.q = tick.q_command = latest_.q;
    tick.v = latest_.v;
    tick.v_command = tick.a_command = Eigen::VectorXd::Zero(latest_.q.size());
    tick.torque = VectorOf(state.tau_J);
  } catch (const FciError& error) {
    throw robot::RobotError(error.what());
  }
}

std::vector<ControlSample> StandingRobot::TakeControlLog() { return std::exchange(log_, {}); }

}  // namespace sidestep::hardware
