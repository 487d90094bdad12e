#include "sidestep/hardware/panda_robot.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sidestep/core/number_text.h"
#include "sidestep/hardware/readiness.h"
#include "sidestep/robot/robot_error.h"

namespace sidestep::hardware {
namespace {

constexpr int kJoints = 7;
constexpr int kTicksPerSecond = 1000;
constexpr std::size_t kLogLength = 4096;
// Identical commands before the end of a motion: a real arm has settled by then.
constexpr int kTicksToSettle = 250;
// Twice the 20 ms without a command after which a Panda ends a motion.
constexpr std::chrono::milliseconds kLongerThanARobotWaits(40);
constexpr int kSilentAt = 20;  // the first answers may come too late to count

// What Franka's documentation leaves for an answer (frankaemika/docs, requirements.rst).
constexpr double kSlowAnswer_s = 300e-6;

// Of the robot's limits, without a supervisor that keeps more: its controller judges what it is
// sent by differences, and stops where they reach a limit.
constexpr double kSpeedShare = 0.97, kAccelerationShare = 0.95, kJerkShare = 0.5;

// Thresholds above which the robot stops by itself: those that franka_ros starts with
// (frankaemika/franka_ros, franka_control_node.yaml, Apache-2.0).
constexpr robot::fci::Joints kTorques_n_m = {20, 20, 18, 18, 16, 14, 12};
constexpr robot::fci::Wrench kForces_n = {20, 20, 20, 25, 25, 25};

control::JointVector JointVectorOf(const robot::fci::Joints& joints) {
  control::JointVector vector(kJoints);
  std::copy(joints.begin(), joints.end(), vector.begin());
  return vector;
}

FciSettings SettingsFor(const robot::RobotModel& robot) {
  FciSettings settings;
  for (std::size_t j = 0; j < kJoints; ++j) {
    settings.stiffness[j] = robot.stiffness()(static_cast<Eigen::Index>(j));
  }
  robot::fci::CollisionBehaviorRequest& collision = settings.collision;
  for (robot::fci::Joints* torques :
       {&collision.lower_torque_acceleration, &collision.upper_torque_acceleration,
        &collision.lower_torque_nominal, &collision.upper_torque_nominal}) {
    *torques = kTorques_n_m;
  }
  for (robot::fci::Wrench* forces :
       {&collision.lower_force_acceleration, &collision.upper_force_acceleration,
        &collision.lower_force_nominal, &collision.upper_force_nominal}) {
    *forces = kForces_n;
  }
  return settings;
}

control::SafetySettings WithTorques(control::SafetySettings safety) {
  safety.torque_n_m = JointVectorOf(kTorques_n_m);
  return safety;
}

const robot::RobotModel& SevenJoints(const robot::RobotModel& robot) {
  if (robot.num_joints() != kJoints) throw std::invalid_argument("PandaRobot: must have 7 joints");
  return robot;
}

EpisodeTime TimeOf(std::int64_t tick) {
  return EpisodeTime(static_cast<double>(tick) / kTicksPerSecond);
}

std::vector<ControlSample> SamplesOf(const std::vector<ExchangeRecord>& log,
                                     std::uint64_t first_ms) {
  std::vector<ControlSample> samples;
  for (const ExchangeRecord& record : log) {
    ControlSample& sample = samples.emplace_back();
    sample.t = TimeOf(static_cast<std::int64_t>(record.state.time_ms - first_ms));
    sample.q = JointVectorOf(record.state.q);
    sample.v = JointVectorOf(record.state.dq);
    sample.q_command = JointVectorOf(record.command.values);
    sample.v_command = JointVectorOf(record.state.dq_d);
    sample.a_command = JointVectorOf(record.state.ddq_d);
    sample.torque = JointVectorOf(record.state.tau_J);
  }
  return samples;
}

}  // namespace

PandaRobot::PandaRobot(std::unique_ptr<FciDriver> driver, const robot::RobotModel& robot,
                       const PandaOptions& options)
    : driver_(std::move(driver)),
      options_(options),
      follower_(SevenJoints(robot),
                control::TrackerLimits::Of(robot, kSpeedShare, kAccelerationShare, kJerkShare),
                WithTorques(options.safety)),
      seen_(kLogLength),
      answered_(kLogLength) {
  const RobotSnapshot state = AwaitReady(*driver_, robot);
  driver_->Configure(SettingsFor(robot));
  latest_ = {EpisodeTime(0), JointVectorOf(state.q), JointVectorOf(state.dq)};
}

PandaRobot::~PandaRobot() {
  if (!thread_.joinable()) return;
  follower_.Hold();
  is_ending_ = true;
  allowed_ticks_ = std::numeric_limits<std::int64_t>::max();
  allowed_ticks_.notify_all();
  while (!has_ended_) {
    StopIfAsked();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  thread_.join();
}

robot::RobotStatus PandaRobot::Status() const {
  const robot::RobotMode mode = has_ended_ ? robot::RobotMode::kFault : follower_.mode();
  return {mode, mode == robot::RobotMode::kFault ? why_ : "", follower_.is_held(), follower_.lag()};
}

void PandaRobot::Submit(const Trajectory& trajectory, EpisodeTime start) {
  follower_.Submit(trajectory, start);
}

void PandaRobot::AdvanceTo(EpisodeTime t) {
  constexpr double kTolerance = 1e-6;  // of a tick
  const auto tick =
      static_cast<std::int64_t>(std::ceil(t.seconds() * kTicksPerSecond - kTolerance));
  if (!thread_.joinable()) {
    begin_ = std::chrono::steady_clock::now();
    thread_ = std::thread([this] { Run(); });
  }
  if (options_.lockstep && tick > allowed_ticks_) {
    allowed_ticks_ = tick;
    allowed_ticks_.notify_all();
  }
  for (Collect(); latest_tick_ < tick; Collect()) {
    if (has_ended_) Fail();
    StopIfAsked();
    std::this_thread::sleep_for(std::chrono::microseconds(options_.lockstep ? 20 : 200));
  }
  CheckPace();
}

std::vector<ControlSample> PandaRobot::TakeControlLog() { return std::exchange(log_, {}); }

std::vector<double> PandaRobot::TakeAnswerTimes() { return std::exchange(answers_s_, {}); }

std::vector<SafetyEvent> PandaRobot::TakeSafetyEvents() {
  return std::exchange(safety_events_, {});
}

void PandaRobot::Run() {
  try {
    driver_->Control(CommandKind::kPositions, [this](const RobotSnapshot& state, int elapsed_ms) {
      return Answer(state, elapsed_ms);
    });
  } catch (...) {
    failure_ = std::current_exception();
  }
  has_ended_ = true;
}

Command PandaRobot::Answer(const RobotSnapshot& state, int elapsed_ms) {
  if (elapsed_ms == 0) first_ms_ = state.time_ms;
  const auto tick = static_cast<std::int64_t>(state.time_ms - first_ms_);
  seen_.Append({tick, JointVectorOf(state.q), JointVectorOf(state.dq)});
  if (options_.lockstep) {
    // Who does not wait gives up soon after the beginning, not just where a plan takes long.
    if (++num_asked_ == kSilentAt) std::this_thread::sleep_for(kLongerThanARobotWaits);
    for (std::int64_t allowed = allowed_ticks_; allowed <= tick; allowed = allowed_ticks_) {
      allowed_ticks_.wait(allowed);
    }
  }
  const auto begin = options_.now();
  const Command command = MakeAnswer(state, elapsed_ms, tick);
  answered_.Append(std::chrono::duration<double>(options_.now() - begin).count());
  return command;
}

Command PandaRobot::MakeAnswer(const RobotSnapshot& state, int elapsed_ms, std::int64_t tick) {
  control::Measured measured;
  measured.t = TimeOf(tick);
  measured.q = JointVectorOf(state.q);
  measured.v = JointVectorOf(state.dq);
  measured.commanded = {JointVectorOf(state.q_d), JointVectorOf(state.dq_d),
                        JointVectorOf(state.ddq_d)};
  measured.torque = JointVectorOf(state.tau_J);
  measured.tau_ext = JointVectorOf(state.tau_ext);
  // A motion begins without a history.
  measured.success_rate = tick < 100 ? 1 : state.success_rate;
  measured.lost_in_a_row = std::max(0, elapsed_ms - 1);
  measured.is_fit = state.mode == robot::fci::RobotMode::kMove;
  const control::JointPoint motion =
      follower_.Tick(measured, HorizonOffset(1.0 / kTicksPerSecond)).motion;

  Command command;
  std::copy(motion.q.begin(), motion.q.end(), command.values.begin());
  const bool rests = motion.v.isZero(0) && motion.a.isZero(0);
  ticks_at_rest_ = rests ? ticks_at_rest_ + 1 : 0;
  command.finished = is_ending_ && ticks_at_rest_ > kTicksToSettle;
  return command;
}

// Takes what the other thread has put down.
void PandaRobot::Collect() {
  seen_.Drain([this](const Seen& seen) {
    latest_tick_ = seen.tick;
    latest_ = {TimeOf(seen.tick), seen.q, seen.v};
  });
  follower_.DrainLog([this](const control::TickRecord& tick) {
    log_.push_back(
        {tick.t, tick.command.q, tick.command.v, tick.command.a, tick.q, tick.v, tick.torque});
  });
  follower_.DrainFindings([this](const control::Finding& found) {
    safety_events_.push_back({found.t, control::ToString(found.check),
                              control::ToString(found.reaction), found.value, found.limit});
    if (found.reaction == control::Reaction::kBrake) why_ = control::Describe(found);
  });
  answered_.Drain([this](double seconds) {
    answers_s_.push_back(seconds);
    // In lock-step nothing is late. All of them are told in the end; the first at once.
    if (options_.lockstep || was_slow_ || seconds <= kSlowAnswer_s) return;
    was_slow_ = true;
    safety_events_.push_back({latest_.t, control::ToString(control::SafetyCheck::kSlowAnswer),
                              control::ToString(control::Reaction::kNone), seconds, kSlowAnswer_s});
  });
}

// A server in lock-step answers as fast as it is answered.
void PandaRobot::CheckPace() const {
  constexpr double kTooFast = 1.5, kSlack_s = 0.5;
  if (options_.lockstep) return;
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin_;
  if (TimeOf(latest_tick_).seconds() < kTooFast * passed.count() + kSlack_s) return;
  throw robot::RobotError(
      "the robot's clock runs faster than real time: for a server in lock-step, --clock lockstep");
}

void PandaRobot::StopIfAsked() noexcept {
  if (is_stopped_at_once_ || !options_.stops_at_once || !options_.stops_at_once()) return;
  is_stopped_at_once_ = true;
  try {
    safety_events_.push_back({latest_.t, control::ToString(control::SafetyCheck::kOperatorStop),
                              control::ToString(control::Reaction::kAbort), 0, 0});
    driver_->Stop();
  } catch (const std::exception&) {  // there is nobody to stop any more
  }
}

void PandaRobot::Fail() {
  try {
    if (failure_ != nullptr) std::rethrow_exception(failure_);
    throw robot::RobotError("the robot's motion has ended");
  } catch (const FciError& error) {
    why_ = error.what() + HintOf(error);
    throw robot::RobotError(why_, SamplesOf(error.log(), first_ms_));
  }
}

// What else is known of a motion's end.
std::string PandaRobot::HintOf(const FciError& error) const {
  const bool lost =
      robot::fci::Holds(error.errors(), robot::fci::Error::kCommunicationConstraintsViolation);
  if (lost && options_.lockstep) {
    return "; --clock lockstep is for a server that waits for each answer: `sidestep fci-server "
           "--clock lockstep`, where --grace says how long";
  }
  if (error.kind() != FciError::Kind::kAborted) return "";
  try {  // such as by a hand that guides the arm
    return std::string("; its mode is now '") + robot::fci::Name(driver_->ReadOnce().mode) + "'";
  } catch (const FciError&) {
    return "";
  }
}

}  // namespace sidestep::hardware
