#include "sidestep/sim/fci/simulated_panda.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
constexpr int kSettleTicks = 500;       // after the brake, until the world stands still
constexpr int kRecoveryTicks = 50;      // the real one takes up to seconds
constexpr double kAccelerating = 0.1;   // rad/s^2, of the reference: which thresholds hold
constexpr double kMeasuredSpeed = 1.1;  // times its limit: a joint that only lags trips nothing

constexpr double kElbowFlip_rad = -0.467002423653011;  // of joint 4. Source: franka_ros

std::array<double, 2> Elbow(const Joints& q) { return {q[2], q[3] < kElbowFlip_rad ? -1.0 : 1.0}; }

std::array<std::uint8_t, robot::fci::kNumErrors> Flags(const ErrorSet& errors) {
  std::array<std::uint8_t, robot::fci::kNumErrors> flags{};
  for (std::size_t i = 0; i < flags.size(); ++i) flags[i] = errors[i] ? 1 : 0;
  return flags;
}

}  // namespace

SimulatedPanda::SimulatedPanda(PandaPlant* plant, FaultScript faults)
    : plant_(*plant), script_(std::move(faults)), faults_(script_) {
  settings_.impedance = plant_.impedance();
  reference_.q = plant_.q();
  tau_J_ = plant_.holding_torque();
}

void SimulatedPanda::BeginAnew() {
  plant_.BeginAnew();
  faults_.BeginAnew();
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
      reply.payload = {modes_.MaySet()};
      if (modes_.MaySet() == robot::fci::status::kSuccess) {
        reply.payload = {Apply(request, settings_)};
      }
  }
  return reply;
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
  faults_.BeginMotion();
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
  state.NE_T_EE = settings_.NE_T_EE;
  state.F_T_EE = Product(state.F_T_NE, settings_.NE_T_EE);
  state.EE_T_K = settings_.EE_T_K;
  state.O_T_EE = plant_.O_T_EE(state.q, state.F_T_EE);
  state.O_T_EE_d = plant_.O_T_EE(state.q_d, state.F_T_EE);
  state.O_T_EE_c = state.O_T_EE_d;
  state.m_load = settings_.load.mass_kg;
  state.F_x_Cload = settings_.load.F_x_Cload;
  state.I_load = settings_.load.I_load;
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
  if (recovery_ticks_ > 0 && IsAtRest(reference_) && --recovery_ticks_ == 0) {
    modes_.EndRecovery();
    // What pushed the arm away has done so: it is held where it is.
    reference_ = {plant_.q(), {}, {}};
    Tell("recovered");
  }
  const bool was_state_lost = faults_.TakeLostState();
  const bool begins = awaits_first_command() && command.has_value();
  if (!(begins || (modes_.is_moving() && has_begun_) || settle_ticks_ > 0)) return;
  BeginFaults();
  if (modes_.is_moving()) {
    if (command && !was_state_lost && !faults_.TakeLostCommand(plant_.time_s())) {
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
  for (const Fault& fault : faults_.Begin(plant_.time_s(), plant_.q())) {
    const int ticks = static_cast<int>(std::lround(fault.duration_s / kTick_s));
    switch (fault.kind) {
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
      default:
        cuts_link_ = true;
    }
  }
}

void SimulatedPanda::MoveArm() {
  const double t_s = plant_.time_s();
  const Joints q = plant_.q(), dq = plant_.dq();
  if (modes_.controller() != Controller::kExternalTorque) {
    Reference aim = reference_;
    const Joints offset = faults_.Offset(t_s);
    for (std::size_t i = 0; i < offset.size(); ++i) aim.q[i] += offset[i];
    tau_d_ = ImpedanceTorque(settings_.impedance, aim, q, dq);
  }
  const Joints before = tau_J_;
  plant_.Step(tau_d_, faults_.Disturbance(t_s, q, dq, tau_d_));
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
  contacts_ = FindContacts(felt_, settings_.collision, is_accelerating);
  if (contacts_.reflexes.any() && modes_.is_moving()) Abort(contacts_.reflexes);
}

// What the arm really does, beside its limits.
void SimulatedPanda::CheckArm() {
  if (!modes_.is_moving()) return;
  const Joints q = plant_.q(), dq = plant_.dq();
  ErrorSet errors;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const robot::JointLimits& limit = plant_.limits()[i];
    // A joint that follows may be a tick's way ahead of its reference.
    const double ahead = limit.v_max * kTick_s;
    if (q[i] < limit.q_min - ahead || q[i] > limit.q_max + ahead) {
      errors |= robot::fci::Only(Error::kJointPositionLimitsViolation);
    }
    if (std::abs(dq[i]) > kMeasuredSpeed * limit.v_max)
      errors |= robot::fci::Only(Error::kJointVelocityViolation);
  }
  if (errors.any()) Abort(errors);
}

}  // namespace sidestep::sim::fci
