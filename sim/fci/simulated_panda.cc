#include "sidestep/sim/fci/simulated_panda.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sidestep/core/number_text.h"

namespace sidestep::sim::fci {
namespace {

using robot::fci::Controller;
using robot::fci::Error;
using robot::fci::ErrorSet;
using robot::fci::Joints;
using robot::fci::Message;
using robot::fci::MotionGenerator;
using robot::fci::MoveStatus;
using robot::fci::Request;
using robot::fci::RobotCommand;
using robot::fci::RobotState;

// Own choices; the robot's are not published.
constexpr int kSettleTicks = 500;      // after the brake, until the world stands still
constexpr int kRecoveryTicks = 50;     // the real one takes up to seconds
constexpr double kAccelerating = 0.1;  // rad/s^2, of the reference: which thresholds hold
constexpr double kElbowFlip_rad = -0.467002423653011;  // of joint 4 (hardware fact: franka_ros)
constexpr double kMeasuredSpeed = 1.1;  // times its limit: a joint that only lags trips nothing
constexpr double kBlockStiffness = 1e4, kBlockDamping = 60;
constexpr double kFrictionSpeed_rad_s = 0.01;  // below, friction fades to zero

template <typename Values>
bool AllFinite(const Values& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

template <typename Values>
bool AllWithin(const Values& values, double least, double most) {
  return std::all_of(values.begin(), values.end(),
                     [&](double value) { return value >= least && value <= most; });
}

std::array<double, 2> Elbow(const Joints& q) { return {q[2], q[3] < kElbowFlip_rad ? -1.0 : 1.0}; }

std::array<std::uint8_t, robot::fci::kNumErrors> Flags(const ErrorSet& errors) {
  std::array<std::uint8_t, robot::fci::kNumErrors> flags{};
  for (std::size_t i = 0; i < flags.size(); ++i) flags[i] = errors[i] ? 1 : 0;
  return flags;
}

bool IsValid(const robot::fci::CollisionBehaviorRequest& request) {
  constexpr double kMost = 1e6;
  const auto is_valid = [&](const auto& values) { return AllWithin(values, 0, kMost); };
  return is_valid(request.lower_torque_acceleration) &&
         is_valid(request.upper_torque_acceleration) && is_valid(request.lower_torque_nominal) &&
         is_valid(request.upper_torque_nominal) && is_valid(request.lower_force_acceleration) &&
         is_valid(request.upper_force_acceleration) && is_valid(request.lower_force_nominal) &&
         is_valid(request.upper_force_nominal);
}

std::vector<Fault> ByTime(std::vector<Fault> faults) {
  std::stable_sort(faults.begin(), faults.end(),
                   [](const Fault& a, const Fault& b) { return a.at_s < b.at_s; });
  return faults;
}

}  // namespace

SimulatedPanda::SimulatedPanda(PandaPlant* plant, FaultScript faults)
    : plant_(*plant),
      script_(std::move(faults)),
      random_(script_.seed, "fci packet loss"),
      impedance_(plant->impedance()),
      NE_T_EE_(Identity4()),
      EE_T_K_(Identity4()) {
  script_.faults = ByTime(script_.faults);
  reference_.q = plant_.q();
}

void SimulatedPanda::Tell(const std::string& what) const {
  if (tell_) tell_(what);
}

std::optional<Message> SimulatedPanda::Handle(const Message& request) {
  Message reply{request.request, request.id, {robot::fci::status::kSuccess}};
  if (request.payload.size() != robot::fci::PayloadSize(request.request)) {
    reply.payload = {robot::fci::status::kNotPossible};
    return reply;
  }
  switch (request.request) {
    case Request::kMove:
      BeginMove(request, reply);
      break;
    case Request::kStopMove:
      reply.payload = {StopMove()};
      break;
    case Request::kAutomaticErrorRecovery:
      reply.payload = {Recover()};
      if (recovery_ticks_ > 0) {
        replies_.push_back(reply);  // once it has recovered
        return std::nullopt;
      }
      break;
    case Request::kGetCartesianLimit:
      reply.payload = robot::fci::NoCartesianLimit(robot::fci::status::kSuccess);
      break;
    case Request::kLoadModelLibrary:
      reply.payload = {robot::fci::status::kNoModelLibrary};
      break;
    default:
      reply.payload = {Set(request)};
  }
  return reply;
}

std::uint8_t SimulatedPanda::Set(const Message& request) {
  namespace status = robot::fci::status;
  using robot::fci::FromBytes;
  if (modes_.MaySet() != status::kSuccess) return status::kNotPossible;
  switch (request.request) {
    case Request::kSetCollisionBehavior: {
      const auto wanted = FromBytes<robot::fci::CollisionBehaviorRequest>(request.payload);
      if (!IsValid(wanted)) return status::kInvalidArgument;
      collision_ = wanted;
      return status::kSuccess;
    }
    case Request::kSetJointImpedance: {
      const auto wanted = FromBytes<robot::fci::JointImpedanceRequest>(request.payload);
      if (!AllWithin(wanted.stiffness, 0, kLargestStiffness)) return status::kInvalidArgument;
      impedance_.stiffness = wanted.stiffness;
      return status::kSuccess;
    }
    case Request::kSetEEToK:
    case Request::kSetNEToEE: {
      const auto wanted = FromBytes<robot::fci::FrameRequest>(request.payload);
      if (!IsTransform(wanted.pose)) return status::kInvalidArgument;
      (request.request == Request::kSetEEToK ? EE_T_K_ : NE_T_EE_) = wanted.pose;
      return status::kSuccess;
    }
    case Request::kSetLoad: {
      const auto wanted = FromBytes<robot::fci::LoadRequest>(request.payload);
      if (!(wanted.mass_kg >= 0) || !AllFinite(wanted.F_x_Cload) || !AllFinite(wanted.I_load)) {
        return status::kInvalidArgument;
      }
      load_ = wanted;
      return status::kSuccess;
    }
    case Request::kSetCartesianImpedance:
    case Request::kSetGuidingMode:
    case Request::kSetFilters:
      return status::kSuccess;  // of what is not simulated
    default:
      return status::kNotPossible;
  }
}

void SimulatedPanda::BeginMove(const Message& request, Message& reply) {
  const bool is_refused = script_.refuse_moves > 0 || !IsAtRest(reference_);
  script_.refuse_moves -= script_.refuse_moves > 0 ? 1 : 0;
  const MoveStatus status =
      is_refused
          ? MoveStatus::kNotPossible
          : modes_.StartMove(robot::fci::FromBytes<robot::fci::MoveRequest>(request.payload));
  reply.payload = {static_cast<std::uint8_t>(status)};
  if (status != MoveStatus::kMotionStarted) {
    Tell("motion refused");
    return;
  }
  move_id_ = request.id;
  has_begun_ = false;
  settle_ticks_ = 0;
  loss_ = PacketLoss();
  lost_commands_ = lost_states_ = 0;
  tau_d_ = {};
  const bool by_position = modes_.motion_generator() == MotionGenerator::kJointPosition;
  Tell(std::string("motion started: joint ") + (by_position ? "positions" : "velocities") +
       (modes_.controller() == Controller::kExternalTorque ? " and torques" : ""));
}

std::uint8_t SimulatedPanda::StopMove() {
  const From from = EndOfReference();
  const std::uint8_t status = modes_.StopMove();
  if (status == robot::fci::status::kSuccess) {
    Tell("motion stopped by the client");
    StopArm(from);
  }
  return status;
}

// Where a motion that is not aborted leaves off: an arm that torques have driven is not where the
// reference is.
SimulatedPanda::From SimulatedPanda::EndOfReference() const {
  return modes_.controller() == Controller::kExternalTorque ? From::kArm : From::kReference;
}

std::uint8_t SimulatedPanda::Recover() {
  const Joints q = plant_.q();
  bool is_within = true;
  for (std::size_t i = 0; i < q.size(); ++i) {
    is_within = is_within && q[i] > plant_.limits()[i].q_min && q[i] < plant_.limits()[i].q_max;
  }
  const std::uint8_t status = modes_.BeginRecovery(is_within);
  if (modes_.mode() == robot::fci::RobotMode::kRecovery) recovery_ticks_ = kRecoveryTicks;
  return status;
}

RobotState SimulatedPanda::State() const {
  RobotState state{};
  state.message_id = message_id_;
  state.q = plant_.q();
  state.dq = plant_.dq();
  state.q_d = reference_.q;
  state.dq_d = reference_.dq;
  state.ddq_d = reference_.ddq;
  state.F_T_NE = HandFrame();
  state.NE_T_EE = NE_T_EE_;
  state.F_T_EE = Product(state.F_T_NE, NE_T_EE_);
  state.EE_T_K = EE_T_K_;
  state.O_T_EE = plant_.O_T_EE(state.q, state.F_T_EE);
  state.O_T_EE_d = plant_.O_T_EE(state.q_d, state.F_T_EE);
  state.O_T_EE_c = state.O_T_EE_d;
  state.m_load = load_.mass_kg;
  state.F_x_Cload = load_.F_x_Cload;
  state.I_load = load_.I_load;
  state.elbow = Elbow(state.q);
  state.elbow_d = state.elbow_c = Elbow(state.q_d);
  state.tau_J = tau_J_;
  state.tau_J_d = tau_d_;
  state.dtau_J = dtau_J_;
  state.theta = state.q;  // the joints are stiff
  state.dtheta = state.dq;
  state.joint_contact = contacts_.joint_contact;
  state.joint_collision = contacts_.joint_collision;
  state.cartesian_contact = contacts_.cartesian_contact;
  state.cartesian_collision = contacts_.cartesian_collision;
  state.tau_ext_hat_filtered = felt_.tau;
  state.O_F_ext_hat_K = felt_.O_F_K;
  state.O_ddP_O = {0, 0, -9.81};
  state.motion_generator = modes_.motion_generator();
  state.controller = modes_.controller();
  state.errors = Flags(modes_.errors());
  state.reflex_reason = Flags(modes_.last_motion_errors());
  state.robot_mode = modes_.mode();
  state.success_rate = modes_.is_moving() ? loss_.success_rate() : 0;
  return state;
}

std::vector<Message> SimulatedPanda::TakeReplies() {
  std::vector<Message> replies;
  if (recovery_ticks_ == 0) replies = std::exchange(replies_, {});
  if (const auto status = modes_.TakeMoveEnd()) {
    replies.push_back({Request::kMove, move_id_, {static_cast<std::uint8_t>(*status)}});
  }
  return replies;
}

void SimulatedPanda::Tick(const std::optional<RobotCommand>& command) {
  ++message_id_;
  if (held_ticks_ > 0 && --held_ticks_ == 0) {
    modes_.ReleaseUserStop();
    modes_.EndGuiding();
    Tell("the arm is free again");
  }
  if (recovery_ticks_ > 0 && --recovery_ticks_ == 0) {
    modes_.EndRecovery();
    Tell("recovered");
  }
  const bool was_state_lost = lost_states_ > 0;
  if (was_state_lost) --lost_states_;
  const bool begins = awaits_first_command() && command.has_value();
  if (!(begins || (modes_.is_moving() && has_begun_) || settle_ticks_ > 0)) return;
  BeginFaults();
  if (modes_.is_moving()) {
    if (command && !was_state_lost && !IsCommandLost()) {
      FollowCommand(*command);
    } else if (has_begun_) {
      FollowNothing();
    } else {
      return;  // the motion's first command is lost: it has not begun
    }
  } else if (!IsAtRest(reference_)) {
    reference_ = Brake(reference_, plant_.limits());
  } else if (--settle_ticks_ == 0) {
    modes_.ClearErrors();
  }
  MoveArm();
  FeelForces();
  CheckArm();
}

bool SimulatedPanda::IsCommandLost() {
  const double t_s = plant_.time_s();
  bool is_lost = lost_commands_ > 0;
  if (is_lost) --lost_commands_;
  for (const Fault& fault : active_) {
    if (fault.kind == FaultKind::kLoseSome && fault.IsActive(t_s)) {
      is_lost = random_.Uniform() < fault.rate || is_lost;
    }
  }
  return is_lost;
}

void SimulatedPanda::FollowCommand(const RobotCommand& command) {
  const bool by_position = modes_.motion_generator() == MotionGenerator::kJointPosition;
  const bool by_torque = modes_.controller() == Controller::kExternalTorque;
  loss_.Received();
  ErrorSet errors;
  if (!has_begun_ && by_position) {
    errors = CheckStart(command.q_c, reference_.q, plant_.limits());
  }
  has_begun_ = true;
  if (!AllFinite(by_position ? command.q_c : command.dq_c) ||
      (by_torque && !AllFinite(command.tau_J_d))) {
    Tell("motion aborted: the command holds what is no number");
    modes_.AbortForBadInput();
    StopArm(From::kArm);
    return;
  }
  if (errors.none() && by_torque) errors = CheckTorque(tau_d_, command.tau_J_d, plant_.limits());
  if (errors.any()) {
    Abort(errors);
    return;
  }
  if (by_torque) tau_d_ = command.tau_J_d;
  GoTo(by_position ? FollowPositions(reference_, command.q_c)
                   : FollowVelocities(reference_, command.dq_c));
  EndIfFinished(command);
}

void SimulatedPanda::FollowNothing() {
  loss_.Lost();
  if (loss_.are_too_many()) {
    Abort(robot::fci::Only(Error::kCommunicationConstraintsViolation));
  } else {
    GoTo(Extrapolate(reference_));
  }
}

void SimulatedPanda::GoTo(const Reference& next) {
  const ErrorSet errors = CheckStep(reference_, next, plant_.limits());
  if (errors.any()) {
    Abort(errors);
  } else {
    reference_ = next;
  }
}

void SimulatedPanda::EndIfFinished(const RobotCommand& command) {
  if (command.motion_generation_finished == 0 || !modes_.is_moving()) return;
  const ErrorSet errors = CheckEnd(reference_, plant_.limits());
  if (errors.any()) {
    Abort(errors);
    return;
  }
  Tell("motion finished");
  const From from = EndOfReference();
  modes_.Finish();
  StopArm(from);
}

void SimulatedPanda::Abort(const ErrorSet& errors) {
  Tell("motion aborted: " + robot::fci::Text(errors));
  modes_.Abort(errors);
  StopArm(From::kArm);
}

// Whatever ended the motion: the arm brakes and settles, if it has moved at all.
void SimulatedPanda::StopArm(From from) {
  if (!has_begun_) return;
  has_begun_ = false;
  settle_ticks_ = kSettleTicks;
  if (from == From::kArm) reference_ = {plant_.q(), plant_.dq(), {}};
}

void SimulatedPanda::LoseClient() {
  if (modes_.is_moving()) Abort(robot::fci::Only(Error::kCommunicationConstraintsViolation));
}

void SimulatedPanda::BeginFaults() {
  constexpr double kRounding_s = 1e-9;
  while (next_fault_ < script_.faults.size() &&
         script_.faults[next_fault_].at_s <= plant_.time_s() + kRounding_s) {
    Fault fault = script_.faults[next_fault_++];
    fault.at_s = plant_.time_s();
    const int ticks = static_cast<int>(std::lround(fault.duration_s / kTick_s));
    switch (fault.kind) {
      case FaultKind::kLoseCommands:
        lost_commands_ = fault.count;
        break;
      case FaultKind::kLoseStates:
        lost_states_ = fault.count;
        break;
      case FaultKind::kUserStop:
        Tell("the user stop is pressed");
        modes_.PressUserStop();
        StopArm(From::kArm);
        held_ticks_ = ticks;
        break;
      case FaultKind::kGuiding:
        Tell("somebody guides the arm");
        modes_.BeginGuiding();
        StopArm(From::kArm);
        held_ticks_ = ticks;
        break;
      case FaultKind::kError:
        Abort(ErrorSet().set(static_cast<std::size_t>(fault.error)));
        break;
      case FaultKind::kCutLink:
        cuts_link_ = true;
        break;
      case FaultKind::kBlockedJoint:
        blocked_at_[static_cast<std::size_t>(fault.joint)] =
            plant_.q()[static_cast<std::size_t>(fault.joint)];
        active_.push_back(fault);
        break;
      default:
        active_.push_back(fault);
    }
  }
}

Reference SimulatedPanda::DisturbedReference() const {
  Reference reference = reference_;
  for (const Fault& fault : active_) {
    if (fault.kind == FaultKind::kTrackingOffset && fault.IsActive(plant_.time_s())) {
      reference.q[static_cast<std::size_t>(fault.joint)] += fault.offset_rad;
    }
  }
  return reference;
}

Joints SimulatedPanda::Disturbance() const {
  Joints disturbance{};
  if (active_.empty()) return disturbance;
  const double t_s = plant_.time_s();
  const Joints q = plant_.q(), dq = plant_.dq();
  for (const Fault& fault : active_) {
    if (!fault.IsActive(t_s)) continue;
    const auto i = static_cast<std::size_t>(fault.joint);
    if (fault.kind == FaultKind::kExternalTorque) disturbance[i] += fault.rate * (t_s - fault.at_s);
    if (fault.kind == FaultKind::kFriction) {
      disturbance[i] -= fault.torque_n_m * std::clamp(dq[i] / kFrictionSpeed_rad_s, -1.0, 1.0);
    }
    if (fault.kind == FaultKind::kBlockedJoint) {
      disturbance[i] =
          kBlockStiffness * (blocked_at_[i] - q[i]) - kBlockDamping * dq[i] - tau_d_[i];
    }
  }
  return disturbance;
}

void SimulatedPanda::MoveArm() {
  if (modes_.controller() != Controller::kExternalTorque) {
    tau_d_ = ImpedanceTorque(impedance_, DisturbedReference(), plant_.q(), plant_.dq());
  }
  const Joints before = tau_J_;
  plant_.Step(tau_d_, Disturbance());
  tau_J_ = plant_.motor_torque();
  for (std::size_t i = 0; i < tau_J_.size(); ++i) dtau_J_[i] = (tau_J_[i] - before[i]) / kTick_s;
}

void SimulatedPanda::FeelForces() {
  ExternalForce now = plant_.external();
  if (script_.force_per_speed_n_s_m > 0 || script_.force_per_acceleration_kg > 0) {
    const std::array<double, 3> v = plant_.hand_velocity();
    robot::fci::Wrench O_F{};
    for (std::size_t i = 0; i < v.size(); ++i) {
      const double a = (v[i] - hand_velocity_[i]) / kTick_s;
      O_F[i] = script_.force_per_speed_n_s_m * v[i] + script_.force_per_acceleration_kg * a;
    }
    hand_velocity_ = v;
    const ExternalForce of_motion = plant_.AtTheHand(O_F);
    for (std::size_t i = 0; i < O_F.size(); ++i) now.O_F_K[i] += of_motion.O_F_K[i];
    for (std::size_t i = 0; i < now.tau.size(); ++i) now.tau[i] += of_motion.tau[i];
  }
  felt_ = FilterForce(felt_, now);
  const bool is_accelerating = std::any_of(reference_.ddq.begin(), reference_.ddq.end(),
                                           [](double a) { return std::abs(a) > kAccelerating; });
  contacts_ = FindContacts(felt_, collision_, is_accelerating);
  if (contacts_.reflexes.any() && modes_.is_moving()) Abort(contacts_.reflexes);
}

// What the arm really does, beside its limits.
void SimulatedPanda::CheckArm() {
  if (!modes_.is_moving()) return;
  const Joints q = plant_.q(), dq = plant_.dq();
  ErrorSet errors;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const robot::JointLimits& limit = plant_.limits()[i];
    if (q[i] < limit.q_min || q[i] > limit.q_max) {
      errors |= robot::fci::Only(Error::kJointPositionLimitsViolation);
    }
    if (std::abs(dq[i]) > kMeasuredSpeed * limit.v_max)
      errors |= robot::fci::Only(Error::kJointVelocityViolation);
  }
  if (errors.any()) Abort(errors);
}

}  // namespace sidestep::sim::fci
