#include "sidestep/control/follower.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sidestep/robot/tolerance_scale.h"

namespace sidestep::control {
namespace {

constexpr std::size_t kTickLogLength = 4096;  // ticks: 4 s
constexpr double kQuickening_per_s = 4;       // from full speed to rest in a quarter of a second
constexpr double kForeseen_per_s = 2;         // what is seen to come is slowed down for more gently

TrackerLimits LimitsUnder(const SafetySettings& safety, const robot::RobotModel& robot,
                          const TrackerLimits& limits) {
  return safety.profile == SafetyProfile::kLab ? LabLimits(robot, safety) : limits;
}

}  // namespace

TrackerLimits LabLimits(const robot::RobotModel& robot, const SafetySettings& safety) {
  TrackerLimits lab = TrackerLimits::Of(robot, safety.v_share, safety.a_share, safety.jerk_share);
  const Eigen::VectorXd margin = safety.range_margin_rad * robot::ToleranceScale(robot);
  lab.q_min += margin;
  lab.q_max -= margin;
  return lab;
}

Follower::Follower(const TrackerLimits& limits, std::size_t log_length)
    : tracker_(limits), log_(log_length) {}

Follower::Follower(const robot::RobotModel& robot, const TrackerLimits& limits,
                   const SafetySettings& safety)
    : Follower(LimitsUnder(safety, robot, limits), kTickLogLength) {
  if (safety.profile != SafetyProfile::kOff) supervisor_.emplace(robot, tracker_, safety);
}

void Follower::Submit(Trajectory trajectory, EpisodeTime start) {
  CheckTrajectory(trajectory);
  if (trajectory.num_joints() != num_joints()) {
    throw std::invalid_argument("Follower: the trajectory has another number of joints");
  }
  plans_.Put(std::move(trajectory), start);
}

void Follower::Watch(ObstacleReport report) {
  if (supervisor_) supervisor_->Watch(std::move(report));
}

void Follower::Rearm() {
  if (supervisor_) supervisor_->Rearm();
}

JointPoint Follower::PointOf(const PlanSlot::Plan& plan, const Progress& progress) {
  // A start a rounding error after this tick is this tick, not a moment before the motion.
  const HorizonOffset offset = std::max(progress.t - plan.start, HorizonOffset(0));
  const Eigen::Index n = plan.trajectory.num_joints();
  JointPoint point = {JointVector(n), JointVector(n), JointVector(n)};
  SampleInto(plan.trajectory, offset, point.q, point.v, point.a);
  if (progress.pace != 1 || progress.quickening != 0) {
    point.a = progress.pace * progress.pace * point.a + progress.quickening * point.v;
    point.v *= progress.pace;
  }
  return point;
}

Follower::Progress Follower::Go(EpisodeTime t, double period_s) noexcept {
  const double wanted = supervisor_ ? supervisor_->pace() : 1, most = kQuickening_per_s * period_s;
  const double change = std::clamp(wanted - progress_.pace, -most, most);
  const double pace = progress_.pace + change;
  const double lost_s = target_ ? (1 - pace) * period_s : 0;  // by what is followed
  const double lag_s = lag_s_.load(std::memory_order_relaxed) + lost_s;
  lag_s_.store(lag_s, std::memory_order_relaxed);
  return {t - HorizonOffset(lag_s), pace, change / period_s};
}

const PlanSlot::Plan* Follower::PlanFor(const Measured& measured, const Progress& before,
                                        const Progress& now) noexcept {
  const PlanSlot::Plan* const plan = plans_.PlanAt(now.t);
  if (plan == nullptr) return nullptr;
  if (supervisor_ && plan->number > judged_) {
    judged_ = plan->number;
    const JointPoint* const other = target_ ? &*target_ : nullptr;
    if (supervisor_->Refuses(PointOf(*plan, before), before.t < plan->start, other, measured)) {
      dropped_ = plan->number;
    }
  }
  return plan->number > dropped_ ? plan : nullptr;
}

Command Follower::Tick(const Measured& measured, HorizonOffset period) noexcept {
  const double period_s = period.seconds();
  Progress before = progress_;
  before.t = measured.t - period - lag();
  progress_ = Go(measured.t, period_s);
  const PlanSlot::Plan* const plan = PlanFor(measured, before, progress_);
  const auto brake = [&] { return tracker_.Brake(measured.commanded, period_s); };
  target_.reset();
  if (plan != nullptr) target_ = PointOf(*plan, progress_);
  Command command;
  command.motion = target_ ? tracker_.Step(measured.commanded, *target_, period_s) : brake();

  Reaction reaction = Reaction::kNone;
  if (supervisor_ && plan != nullptr) {
    supervisor_->LookAhead(plan->trajectory, progress_.t - plan->start, progress_.pace,
                           kForeseen_per_s);
  }
  if (supervisor_) reaction = supervisor_->Judge(measured, command.motion, period_s);
  const bool is_stopped = reaction > Reaction::kEase;
  if (reaction != Reaction::kNone) command.motion = brake();
  if (is_stopped) {
    // The robot is not where the plan is any more: it goes on by a plan that begins after this.
    if (plan != nullptr) dropped_ = plan->number;
    target_.reset();
  }

  // Once something has begun, only a stop leaves nothing to follow.
  robot::RobotMode mode = this->mode();
  if (reaction == Reaction::kBrake) {
    mode = robot::RobotMode::kFault;
  } else if (plan != nullptr && !is_stopped) {
    mode = robot::RobotMode::kMoving;
  } else if (reaction == Reaction::kHold || mode != robot::RobotMode::kReady) {
    mode = robot::RobotMode::kHolding;
  }
  mode_.store(mode, std::memory_order_relaxed);
  is_held_.store(is_stopped, std::memory_order_relaxed);
  log_.Append({measured.t, measured.q, measured.v, measured.torque, command.motion});
  return command;
}

}  // namespace sidestep::control
