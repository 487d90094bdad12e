#include "sidestep/sim/simulated_robot.h"

#include <cstddef>
#include <stdexcept>
#include <utility>

namespace sidestep::sim {
namespace {

// Each tick is read before the next one.
constexpr std::size_t kLogLength = 4;

Eigen::VectorXd TorqueLimits(const robot::RobotModel& robot) {
  Eigen::VectorXd limits(robot.num_joints());
  for (int i = 0; i < robot.num_joints(); ++i) {
    limits(i) = robot.limits()[static_cast<std::size_t>(i)].torque_max;
  }
  return limits;
}

}  // namespace

SimulatedRobot::SimulatedRobot(const robot::RobotModel& robot, World* world,
                               std::function<void()> after_tick, double v_scale,
                               const control::SafetySettings& safety)
    : world_(*world),
      after_tick_(std::move(after_tick)),
      stiffness_(robot.stiffness()),
      damping_(robot.damping()),
      torque_max_(TorqueLimits(robot)),
      follower_(robot, control::TrackerLimits::Of(robot, v_scale), safety, kLogLength) {
  const Eigen::VectorXd q = world_.q();
  if (q.size() != robot.num_joints()) {
    throw std::invalid_argument("SimulatedRobot: the world's arm has another number of joints");
  }
  commanded_ = control::RestAt(q);
}

JointState SimulatedRobot::Read() const { return {world_.time(), world_.q(), world_.v()}; }

robot::RobotStatus SimulatedRobot::Status() const {
  const robot::RobotMode mode = follower_.mode();
  return {mode, mode == robot::RobotMode::kFault ? why_ : "", follower_.is_held(), follower_.lag()};
}

void SimulatedRobot::Submit(const Trajectory& trajectory, EpisodeTime start) {
  follower_.Submit(trajectory, start);
}

void SimulatedRobot::Hold() noexcept { follower_.Hold(); }

void SimulatedRobot::Watch(const ObstacleReport& report) { follower_.Watch(report); }

std::vector<SafetyEvent> SimulatedRobot::TakeSafetyEvents() {
  return std::exchange(safety_events_, {});
}

void SimulatedRobot::AdvanceTo(EpisodeTime t) {
  const std::int64_t last = World::TickNotBefore(t);
  while (world_.ticks() < last) Tick();
}

void SimulatedRobot::Tick() {
  constexpr HorizonOffset kPeriod(1.0 / World::kTicksPerSecond);
  control::Measured measured;
  measured.t = world_.time();
  measured.q = world_.q();
  measured.v = world_.v();
  measured.commanded = commanded_;
  commanded_ = follower_.Tick(measured, kPeriod).motion;
  const Eigen::VectorXd torque = stiffness_.cwiseProduct(commanded_.q - measured.q) +
                                 damping_.cwiseProduct(commanded_.v - measured.v) +
                                 world_.bias_torque();
  world_.Step(torque.cwiseMax(-torque_max_).cwiseMin(torque_max_));
  follower_.DrainLog([this](const control::TickRecord& tick) {
    log_.push_back({tick.t, tick.command.q, tick.command.v, tick.command.a, tick.q, tick.v,
                    world_.motor_torque()});
  });
  follower_.DrainFindings([this](const control::Finding& found) {
    safety_events_.push_back({found.t, control::ToString(found.check),
                              control::ToString(found.reaction), found.value, found.limit});
    if (found.reaction == control::Reaction::kBrake) why_ = control::Describe(found);
  });
  after_tick_();
}

std::vector<ControlSample> SimulatedRobot::TakeControlLog() { return std::exchange(log_, {}); }

}  // namespace sidestep::sim
