#pragma once

#include <memory>
#include <vector>

#include "sidestep/hardware/fci_driver.h"
#include "sidestep/robot/robot_interface.h"

namespace sidestep::hardware {

/// A robot that is looked at and sent nothing: it holds, wherever it stands or a hand guides it,
/// and follows no plan. So every plan is made anew from where it is.
class StandingRobot final : public robot::RobotInterface {
 public:
  explicit StandingRobot(std::unique_ptr<FciDriver> driver);

  JointState Read() const override { return latest_; }
  robot::RobotStatus Status() const override { return {robot::RobotMode::kHolding, ""}; }
  void Submit(const Trajectory&, EpisodeTime) override {}
  void Hold() noexcept override {}
  /// Looks at the robot; waits for nothing. @throws RobotError if it is gone.
  void AdvanceTo(EpisodeTime t) override;
  /// What it was last seen to do, once for each advance.
  std::vector<ControlSample> TakeControlLog() override;

 private:
  std::unique_ptr<FciDriver> driver_;
  JointState latest_;
  std::vector<ControlSample> log_;
};

}  // namespace sidestep::hardware
