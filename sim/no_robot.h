#pragma once

#include <vector>

#include "sidestep/robot/robot_interface.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// Stands for the robot of a world that has none: it has no joints, and lets time pass.
class NoRobot final : public robot::RobotInterface {
 public:
  /// @param world is stepped by this; must outlive it.
  explicit NoRobot(World* world) : world_(*world) {}

  JointState Read() const override { return {world_.time(), world_.q(), world_.v()}; }
  robot::RobotStatus Status() const override { return {robot::RobotMode::kReady, ""}; }
  /// @throws std::invalid_argument always.
  void Submit(const Trajectory& trajectory, EpisodeTime start) override;
  void Hold() noexcept override {}
  void AdvanceTo(EpisodeTime t) override;
  std::vector<ControlSample> TakeControlLog() override { return {}; }

 private:
  World& world_;
};

}  // namespace sidestep::sim
