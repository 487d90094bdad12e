#include "sidestep/sim/simulated_robot.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sidestep::sim {
namespace {

Eigen::VectorXd TorqueLimits(const robot::RobotModel& robot) {
  Eigen::VectorXd limits(robot.num_joints());
  for (int i = 0; i < robot.num_joints(); ++i) {
    limits(i) = robot.limits()[static_cast<std::size_t>(i)].torque_max;
  }
  return limits;
}

}  // namespace

SimulatedRobot::SimulatedRobot(const robot::RobotModel& robot, World* world,
                               std::function<void()> after_tick, double v_scale)
    : world_(*world),
      after_tick_(std::move(after_tick)),
      stiffness_(robot.stiffness()),
      damping_(robot.damping()),
      torque_max_(TorqueLimits(robot)),
      tracker_(control::TrackerLimits::Of(robot, v_scale), 1.0 / World::kTicksPerSecond) {
  const Eigen::VectorXd q = world_.q();
  if (q.size() != robot.num_joints()) {
    throw std::invalid_argument("SimulatedRobot: the world's arm has another number of joints");
  }
  tracker_.Reset(q);
}

JointState SimulatedRobot::Read() const { return {world_.time(), world_.q(), world_.v()}; }

void SimulatedRobot::Submit(const Trajectory& trajectory, EpisodeTime start) {
  CheckTrajectory(trajectory);
  if (trajectory.num_joints() != static_cast<int>(torque_max_.size())) {
    throw std::invalid_argument("SimulatedRobot: the trajectory has another number of joints");
  }
  while (!queue_.empty() && queue_.back().start >= start) queue_.pop_back();
  queue_.push_back({trajectory, start});
}

void SimulatedRobot::Hold() noexcept {
  queue_.clear();
  motion_.reset();
}

void SimulatedRobot::AdvanceTo(EpisodeTime t) {
  const std::int64_t last = World::TickNotBefore(t);
  while (world_.ticks() < last) Tick();
}

control::TrackerCommand SimulatedRobot::NextCommand() {
  const std::int64_t now = world_.ticks();
  while (!queue_.empty() && World::TickNotBefore(queue_.front().start) <= now) {
    motion_ = std::move(queue_.front());
    queue_.pop_front();
  }
  if (!motion_) return tracker_.StepBrake();
  // A start a rounding error after this tick is this tick, not a moment before the motion.
  const HorizonOffset offset = std::max(world_.time() - motion_->start, HorizonOffset(0));
  return tracker_.Step(Sample(motion_->trajectory, offset));
}

void SimulatedRobot::Tick() {
  ControlSample sample;
  sample.t = world_.time();
  sample.q = world_.q();
  sample.v = world_.v();
  const control::TrackerCommand command = NextCommand();
  const Eigen::VectorXd torque = stiffness_.cwiseProduct(command.q - sample.q) +
                                 damping_.cwiseProduct(command.v - sample.v) + world_.bias_torque();
  world_.Step(torque.cwiseMax(-torque_max_).cwiseMin(torque_max_));
  sample.q_command = command.q;
  sample.v_command = command.v;
  sample.a_command = command.a;
  sample.torque = world_.motor_torque();
  log_.push_back(std::move(sample));
  after_tick_();
}

std::vector<ControlSample> SimulatedRobot::TakeControlLog() { return std::exchange(log_, {}); }

}  // namespace sidestep::sim
