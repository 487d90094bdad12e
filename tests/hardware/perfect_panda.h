#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "sidestep/hardware/fci_driver.h"

namespace sidestep::hardware {

/// A Panda without a wire that does at once what it is told, each millisecond or as fast as it is
/// answered.
class PerfectPanda : public FciDriver {
 public:
  explicit PerfectPanda(RobotSnapshot state, bool in_real_time = false)
      : state_(std::move(state)), in_real_time_(in_real_time) {}

  /// Looks at each answer, in the thread that made it.
  std::function<void(const Command&)> look = [](const Command&) {};
  /// Is called before and after each answer is made.
  std::function<void()> before = [] {}, after = [] {};

  int server_version() const override { return 5; }
  RobotSnapshot ReadOnce() override { return state_; }
  void Configure(const FciSettings&) override {}
  void Stop() override { is_stopped_ = true; }
  void Recover() override {}

  void Control(CommandKind, const NextCommand& next) override {
    constexpr double kTick_s = 1e-3;
    state_.mode = robot::fci::RobotMode::kMove;
    state_.success_rate = 1;
    auto due = std::chrono::steady_clock::now();
    for (int elapsed_ms = 0;; elapsed_ms = 1) {
      before();
      const Command command = next(state_, elapsed_ms);
      after();
      look(command);
      if (is_stopped_) throw FciError(FciError::Kind::kPreempted, "the motion was stopped");
      if (command.finished) break;
      for (std::size_t j = 0; j < command.values.size(); ++j) {
        const double dq = (command.values[j] - state_.q_d[j]) / kTick_s;
        state_.ddq_d[j] = (dq - state_.dq_d[j]) / kTick_s;
        state_.dq_d[j] = state_.dq[j] = dq;
        state_.q_d[j] = state_.q[j] = command.values[j];
      }
      ++state_.time_ms;
      if (in_real_time_) std::this_thread::sleep_until(due += std::chrono::milliseconds(1));
    }
    state_.mode = robot::fci::RobotMode::kIdle;
  }

 private:
  RobotSnapshot state_;
  bool in_real_time_;
  std::atomic<bool> is_stopped_ = false;
};

/// As the simulated one tells it: idle, at home, with its hand.
inline RobotSnapshot RestingPanda() {
  RobotSnapshot state;
  state.time_ms = 1;
  state.q = state.q_d = {
      0, -0.7853981633974483, 0, -2.356194490192345, 0, 1.5707963267948966, 0.7853981633974483};
  state.mode = robot::fci::RobotMode::kIdle;
  const double h = 0.7071067811865476;
  state.F_T_EE = {h, -h, 0, 0, h, h, 0, 0, 0, 0, 1, 0, 0, 0, 0.1034, 1};
  return state;
}

}  // namespace sidestep::hardware
