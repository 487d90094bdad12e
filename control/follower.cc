#include "sidestep/control/follower.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sidestep::control {

Follower::Follower(const TrackerLimits& limits, std::size_t log_length)
    : tracker_(limits), log_(log_length) {}

void Follower::Submit(Trajectory trajectory, EpisodeTime start) {
  CheckTrajectory(trajectory);
  if (trajectory.num_joints() != num_joints()) {
    throw std::invalid_argument("Follower: the trajectory has another number of joints");
  }
  plans_.Put(std::move(trajectory), start);
}

Command Follower::Tick(const Measured& measured, HorizonOffset period) noexcept {
  Command command;
  if (const PlanSlot::Plan* const plan = plans_.PlanAt(measured.t)) {
    // A start a rounding error after this tick is this tick, not a moment before the motion.
    const HorizonOffset offset = std::max(measured.t - plan->start, HorizonOffset(0));
    JointPoint target = RestAt(measured.q);
    SampleInto(plan->trajectory, offset, target.q, target.v, target.a);
    command.motion = tracker_.Step(measured.commanded, target, period.seconds());
    mode_.store(robot::RobotMode::kMoving, std::memory_order_relaxed);
  } else {
    command.motion = tracker_.Brake(measured.commanded, period.seconds());
    // Once something has begun, only Hold leaves nothing to follow.
    if (mode() == robot::RobotMode::kMoving) {
      mode_.store(robot::RobotMode::kHolding, std::memory_order_relaxed);
    }
  }
  log_.Append({measured.t, measured.q, measured.v, command.motion});
  return command;
}

}  // namespace sidestep::control
