#include "sidestep/hardware/raw_fci_driver.h"

namespace sidestep::hardware {
namespace {

namespace fci = robot::fci;

fci::ErrorSet ErrorsOf(const std::array<std::uint8_t, fci::kNumErrors>& flags) {
  fci::ErrorSet errors;
  for (std::size_t i = 0; i < flags.size(); ++i) errors[i] = flags[i] != 0;
  return errors;
}

RobotSnapshot SnapshotOf(const fci::RobotState& state) {
  RobotSnapshot snapshot;
  snapshot.time_ms = state.message_id;
  snapshot.q = state.q;
  snapshot.dq = state.dq;
  snapshot.q_d = state.q_d;
  snapshot.dq_d = state.dq_d;
  snapshot.ddq_d = state.ddq_d;
  snapshot.tau_J = state.tau_J;
  snapshot.tau_ext = state.tau_ext_hat_filtered;
  snapshot.O_F_ext = state.O_F_ext_hat_K;
  snapshot.O_T_EE = state.O_T_EE;
  snapshot.F_T_EE = state.F_T_EE;
  snapshot.load_kg = state.m_load;
  snapshot.mode = state.robot_mode;
  snapshot.errors = ErrorsOf(state.errors);
  snapshot.last_motion_errors = ErrorsOf(state.reflex_reason);
  snapshot.success_rate = state.success_rate;
  return snapshot;
}

bool Moves(const fci::RobotState& state) {
  return state.robot_mode == fci::RobotMode::kMove &&
         state.motion_generator != fci::MotionGenerator::kIdle;
}

void CheckReply(fci::Request request, std::uint8_t status) {
  if (status == fci::status::kSuccess) return;
  const bool bad_value = status == fci::status::kInvalidArgument;
  throw FciError(FciError::Kind::kRefused,
                 std::string(fci::Name(request)) + " is refused" +
                     (bad_value ? ": invalid argument" : ": not possible in the robot's mode"));
}

// Libfranka's, so wide that they never bind.
constexpr std::array<double, 3> kDeviation = {10.0, 3.12, 6.28};

}  // namespace

RobotSnapshot RawFciDriver::ReadOnce() { return SnapshotOf(client_.AwaitFreshState()); }

void RawFciDriver::Configure(const FciSettings& settings) {
  using fci::Request;
  CheckReply(Request::kSetJointImpedance,
             client_.Ask(Request::kSetJointImpedance,
                         fci::ToBytes(fci::JointImpedanceRequest{settings.stiffness})));
  CheckReply(Request::kSetCollisionBehavior,
             client_.Ask(Request::kSetCollisionBehavior, fci::ToBytes(settings.collision)));
}

std::uint32_t RawFciDriver::Start(CommandKind kind) {
  fci::MoveRequest request{};
  request.controller =
      static_cast<std::uint32_t>(kind == CommandKind::kTorques ? fci::Controller::kExternalTorque
                                                               : fci::Controller::kJointImpedance);
  request.motion_generator =
      kind == CommandKind::kPositions ? 0 : 1;  // with torques, zero velocity
  request.path_deviation = request.goal_deviation = kDeviation;
  const std::uint32_t id = client_.Send(fci::Request::kMove, fci::ToBytes(request));
  const std::uint8_t status = client_.AwaitReply(id).front();
  if (status != static_cast<std::uint8_t>(fci::MoveStatus::kMotionStarted)) ThrowEnd(status, {});
  return id;
}

void RawFciDriver::Control(CommandKind kind, const NextCommand& next) {
  log_.Clear();
  const std::uint32_t move_id = Start(kind);
  try {
    Run(move_id, kind, next);
  } catch (const FciError& error) {
    if (error.kind() == FciError::Kind::kNetwork) {
      throw FciError(error.kind(), error.what(), {}, log_.InOrder());
    }
    StopAnyhow();
    throw;
  } catch (...) {
    StopAnyhow();
    throw;
  }
}

// Of a motion that the robot has ended, this asks for nothing.
void RawFciDriver::StopAnyhow() noexcept {
  try {
    Stop();
  } catch (const FciError&) {
  }
}

void RawFciDriver::Run(std::uint32_t move_id, CommandKind kind, const NextCommand& next) {
  fci::RobotState state = client_.AwaitState();
  while (!Moves(state)) {
    if (const auto end = client_.FindReply(move_id)) {
      ThrowEnd(end->front(), ErrorsOf(state.reflex_reason));  // before it has shown
    }
    state = client_.AwaitState();
  }
  // As libfranka: the first state of a motion only shows that it has begun.
  state = client_.AwaitState();
  std::uint64_t previous_ms = state.message_id;
  Command command;
  while (Moves(state)) {
    if (!command.finished) {
      command = NextAnswer(next, SnapshotOf(state),
                           static_cast<int>(state.message_id - previous_ms), log_);
      previous_ms = state.message_id;
    }
    Answer(state, kind, command);
    state = client_.AwaitState();
  }
  const std::uint8_t status = client_.AwaitReply(move_id).front();
  if (status != fci::status::kSuccess) ThrowEnd(status, ErrorsOf(state.reflex_reason));
}

void RawFciDriver::Answer(const fci::RobotState& state, CommandKind kind, const Command& command) {
  fci::RobotCommand answer{};
  answer.message_id = state.message_id;
  switch (kind) {
    case CommandKind::kPositions:
      answer.q_c = command.values;
      break;
    case CommandKind::kVelocities:
      answer.dq_c = command.values;
      break;
    case CommandKind::kTorques:
      answer.tau_J_d = command.values;
      break;
  }
  answer.motion_generation_finished = command.finished ? 1 : 0;
  client_.Answer(answer);
}

void RawFciDriver::ThrowEnd(std::uint8_t status, const fci::ErrorSet& errors) const {
  using Kind = FciError::Kind;
  const auto end = [&](Kind kind, const std::string& why) {
    return FciError(kind, "the motion " + why, errors, log_.InOrder());
  };
  switch (static_cast<fci::MoveStatus>(status)) {
    case fci::MoveStatus::kReflexAborted:
      throw end(Kind::kReflex, "was aborted by a reflex: " + fci::Text(errors));
    case fci::MoveStatus::kEmergencyAborted:
      throw end(Kind::kUserStop, "was aborted: the user stop is pressed");
    case fci::MoveStatus::kPreempted:
      throw end(Kind::kPreempted, "was stopped");
    case fci::MoveStatus::kNotPossible:
      throw end(Kind::kRefused, "is refused: not possible in the robot's mode");
    case fci::MoveStatus::kStartAtSingularPose:
      throw end(Kind::kRefused, "is refused: it starts at a singular pose");
    case fci::MoveStatus::kInvalidArgument:
      throw end(Kind::kRefused, "is refused: invalid argument");
    case fci::MoveStatus::kInputErrorAborted:
      throw end(Kind::kAborted, "was aborted: invalid input");
    default:
      throw end(Kind::kAborted, "was aborted");
  }
}

void RawFciDriver::Stop() { client_.Ask(fci::Request::kStopMove, {}); }

void RawFciDriver::Recover() {
  const std::uint8_t status = client_.Ask(fci::Request::kAutomaticErrorRecovery, {});
  if (status == fci::status::kSuccess) return;
  throw FciError(FciError::Kind::kRefused,
                 status == fci::status::kManualRecoveryRequired
                     ? "recovery is refused: the arm must be moved by hand first"
                     : "recovery is refused: not possible in the robot's mode");
}

}  // namespace sidestep::hardware
