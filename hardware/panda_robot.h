#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "sidestep/control/follower.h"
#include "sidestep/control/ring_log.h"
#include "sidestep/hardware/fci_driver.h"
#include "sidestep/robot/robot_interface.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::hardware {

struct PandaOptions {
  control::SafetySettings safety;
  /// With a server that waits for each answer: the robot's clock goes no further than it is
  /// advanced to, so that a run is as repeatable as a simulated one. Without it the robot's clock
  /// is its own.
  bool lockstep = false;
  /// Asked whenever it waits for the robot, at its end too: once it says true the motion ends at
  /// once, and the robot stops by itself.
  std::function<bool()> stops_at_once;
  /// By which answers are timed; a test's may say that they are slow.
  std::chrono::steady_clock::time_point (*now)() = &std::chrono::steady_clock::now;
};

/// A Panda behind its control interface as a robot that follows trajectories: a thread answers each
/// of its states by what the follower says. That thread takes no lock, allocates nothing and waits
/// for nobody, but in lock-step.
///
/// Its episode begins when it is first advanced; until then nothing is sent to it.
class PandaRobot final : public robot::RobotInterface {
 public:
  /// Sets stiffness and collision thresholds.
  /// @throws NotReady (readiness.h) for a robot that is not to be moved as it is; FciError;
  /// std::invalid_argument for a robot that has not 7 joints, or no capsules and is to be
  /// supervised.
  PandaRobot(std::unique_ptr<FciDriver> driver, const robot::RobotModel& robot,
             const PandaOptions& options);
  /// Brakes, waits until it is at rest, and ends the motion as the robot wants it ended.
  ~PandaRobot() override;

  JointState Read() const override { return latest_; }
  robot::RobotStatus Status() const override;
  void Submit(const Trajectory& trajectory, EpisodeTime start) override;
  void Hold() noexcept override { follower_.Hold(); }
  void Watch(const ObstacleReport& report) override { follower_.Watch(report); }
  std::vector<SafetyEvent> TakeSafetyEvents() override;
  /// Waits until the robot's clock is there. @throws RobotError as soon as the motion has ended.
  void AdvanceTo(EpisodeTime t) override;
  std::vector<ControlSample> TakeControlLog() override;
  std::vector<double> TakeAnswerTimes() override;

  /// Ticks that nobody took in time to record them.
  std::size_t lost_ticks() const { return follower_.lost_ticks(); }

 private:
  void Begin();
  void Run();
  Command Answer(const RobotSnapshot& state, int elapsed_ms);
  Command MakeAnswer(const RobotSnapshot& state, int elapsed_ms, std::int64_t tick);
  void Collect();
  void CheckPace() const;
  void StopIfAsked() noexcept;
  [[noreturn]] void Fail();
  std::string HintOf(const FciError& error) const;

  std::unique_ptr<FciDriver> driver_;
  const PandaOptions options_;
  control::Follower follower_;
  std::thread thread_;
  std::chrono::steady_clock::time_point begin_;

  // Between the thread that answers and the other.
  struct Seen {
    std::int64_t tick;
    control::JointVector q, v;
  };
  control::RingLog<Seen> seen_;
  control::RingLog<double> answered_;  // how long each answer took [s]
  std::atomic<std::int64_t> allowed_ticks_{0};
  std::atomic<bool> is_ending_{false}, has_ended_{false};
  std::exception_ptr failure_;  // to be read once it has ended

  // Of the thread that answers.
  std::uint64_t first_ms_ = 0;
  int num_asked_ = 0, ticks_at_rest_ = 0;

  // Of the other.
  JointState latest_;
  std::int64_t latest_tick_ = -1;
  std::vector<ControlSample> log_;
  std::vector<SafetyEvent> safety_events_;
  std::string why_;
  bool is_stopped_at_once_ = false;
  std::vector<double> answers_s_;
  bool was_slow_ = false;
};

}  // namespace sidestep::hardware
