#include "sidestep/hardware/libfranka_driver.h"

#include <franka/exception.h>
#include <franka/robot.h>

#include <utility>

#include "sidestep/hardware/exchange_log.h"

namespace sidestep::hardware {
namespace {

namespace fci = robot::fci;
using Kind = FciError::Kind;

fci::RobotMode ModeOf(franka::RobotMode mode) {
  switch (mode) {
    case franka::RobotMode::kIdle:
      return fci::RobotMode::kIdle;
    case franka::RobotMode::kMove:
      return fci::RobotMode::kMove;
    case franka::RobotMode::kGuiding:
      return fci::RobotMode::kGuiding;
    case franka::RobotMode::kReflex:
      return fci::RobotMode::kReflex;
    case franka::RobotMode::kUserStopped:
      return fci::RobotMode::kUserStopped;
    case franka::RobotMode::kAutomaticErrorRecovery:
      return fci::RobotMode::kRecovery;
    default:
      return fci::RobotMode::kOther;
  }
}

// Libfranka gives each error a member of its own, and all their names as one text.
fci::ErrorSet ErrorsOfFranka(const franka::Errors& errors) {
  fci::ErrorSet result;
  if (!errors) return result;
  const std::string text = static_cast<std::string>(errors);
  for (int i = 0; i < fci::kNumErrors; ++i) {
    const std::string quoted = '"' + std::string(fci::ErrorName(i)) + '"';
    result[static_cast<std::size_t>(i)] = text.find(quoted) != std::string::npos;
  }
  return result;
}

// Called each millisecond: the errors, whose text allocates, are read only where there are some.
RobotSnapshot SnapshotOfFranka(const franka::RobotState& state) {
  RobotSnapshot snapshot;
  snapshot.time_ms = state.time.toMSec();
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
  snapshot.mode = ModeOf(state.robot_mode);
  snapshot.errors = ErrorsOfFranka(state.current_errors);
  snapshot.last_motion_errors = ErrorsOfFranka(state.last_motion_errors);
  snapshot.success_rate = state.control_command_success_rate;
  return snapshot;
}

// Libfranka tells the kinds apart by its texts alone.
Kind KindOf(const std::string& what) {
  const std::pair<const char*, Kind> kTexts[] = {
      {"User Stop pressed", Kind::kUserStop}, {"aborted by reflex", Kind::kReflex},
      {"still moving", Kind::kReflex},        {"preempted", Kind::kPreempted},
      {"rejected", Kind::kRefused},
  };
  for (const auto& [text, kind] : kTexts) {
    if (what.find(text) != std::string::npos) return kind;
  }
  return Kind::kAborted;
}

// Calls `ask`; what libfranka throws becomes an FciError. What a callback throws goes through.
template <typename Ask>
auto Asked(const Ask& ask, const ExchangeLog* log = nullptr) {
  const auto exchanged = [log] {
    return log == nullptr ? std::vector<ExchangeRecord>() : log->InOrder();
  };
  try {
    return ask();
  } catch (const franka::IncompatibleVersionException& error) {
    throw FciError(Kind::kVersion, error.what());
  } catch (const franka::NetworkException& error) {
    throw FciError(Kind::kNetwork, error.what(), {}, exchanged());
  } catch (const franka::RealtimeException& error) {
    throw FciError(Kind::kRefused, error.what());
  } catch (const franka::ControlException& error) {
    const fci::ErrorSet errors = error.log.empty()
                                     ? fci::ErrorSet()
                                     : ErrorsOfFranka(error.log.back().state.last_motion_errors);
    throw FciError(KindOf(error.what()), error.what(), errors, exchanged());
  } catch (const franka::Exception& error) {
    throw FciError(KindOf(error.what()), error.what(), {}, exchanged());
  }
}

class LibfrankaDriver final : public FciDriver {
 public:
  LibfrankaDriver(const std::string& address, const LibfrankaOptions& options)
      : options_(options),
        robot_(address, options.enforce_realtime ? franka::RealtimeConfig::kEnforce
                                                 : franka::RealtimeConfig::kIgnore) {}

  int server_version() const override { return robot_.serverVersion(); }

  RobotSnapshot ReadOnce() override {
    return Asked([&] { return SnapshotOfFranka(robot_.readOnce()); });
  }

  void Configure(const FciSettings& settings) override {
    const fci::CollisionBehaviorRequest& c = settings.collision;
    Asked([&] {
      robot_.setJointImpedance(settings.stiffness);
      robot_.setCollisionBehavior(c.lower_torque_acceleration, c.upper_torque_acceleration,
                                  c.lower_torque_nominal, c.upper_torque_nominal,
                                  c.lower_force_acceleration, c.upper_force_acceleration,
                                  c.lower_force_nominal, c.upper_force_nominal);
    });
  }

  void Control(CommandKind kind, const NextCommand& next) override {
    log_.Clear();
    Asked(
        [&] {
          constexpr auto kImpedance = franka::ControllerMode::kJointImpedance;
          switch (kind) {
            case CommandKind::kPositions:
              robot_.control(Callback<franka::JointPositions>(next), kImpedance,
                             options_.limit_rate, options_.cutoff_hz);
              break;
            case CommandKind::kVelocities:
              robot_.control(Callback<franka::JointVelocities>(next), kImpedance,
                             options_.limit_rate, options_.cutoff_hz);
              break;
            case CommandKind::kTorques:
              robot_.control(Callback<franka::Torques>(next), options_.limit_rate,
                             options_.cutoff_hz);
              break;
          }
        },
        &log_);
  }

  void Stop() override {
    try {
      robot_.stop();
    } catch (const franka::CommandException&) {  // there is nothing to stop
    } catch (const franka::Exception& error) {
      throw FciError(Kind::kNetwork, error.what());
    }
  }

  void Recover() override {
    Asked([&] { robot_.automaticErrorRecovery(); });
  }

 private:
  template <typename Output>
  std::function<Output(const franka::RobotState&, franka::Duration)> Callback(
      const NextCommand& next) {
    return [this, &next](const franka::RobotState& state, franka::Duration elapsed) {
      const Command command =
          NextAnswer(next, SnapshotOfFranka(state), static_cast<int>(elapsed.toMSec()), log_);
      Output output(command.values);
      output.motion_finished = command.finished;
      return output;
    };
  }

  LibfrankaOptions options_;
  franka::Robot robot_;
  ExchangeLog log_;
};

}  // namespace

bool HasLibfranka() { return true; }

std::unique_ptr<FciDriver> MakeLibfrankaDriver(const std::string& address,
                                               const LibfrankaOptions& options) {
  return Asked([&] { return std::make_unique<LibfrankaDriver>(address, options); });
}

}  // namespace sidestep::hardware
