#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "sidestep/control/plan_slot.h"
#include "sidestep/control/ring_log.h"
#include "sidestep/control/supervisor.h"
#include "sidestep/control/tick.h"
#include "sidestep/control/tracker.h"
#include "sidestep/core/obstacle_state.h"
#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_interface.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::control {

/// What commands keep to under the profile kLab: the settings' shares of the robot's limits.
TrackerLimits LabLimits(const robot::RobotModel& robot, const SafetySettings& safety);

/// Owns the tick of a robot: what stands between a plan, which comes when it comes, and a motor,
/// which must be told something every millisecond. The simulated arm and a driver of a real one
/// call the same Tick. Unless its profile is off, a supervisor (control/supervisor.h) looks at
/// every command before it is sent.
///
/// One thread submits, watches and reads the logs, one ticks; they may be the same. Tick takes no
/// lock, allocates nothing, and never waits.
class Follower {
 public:
  static constexpr std::size_t kLogLength = 4096;  ///< 4 s

  /// @param log_length of ticks, kept between two calls of DrainLog.
  /// @throws std::invalid_argument as JerkLimitedTracker.
  explicit Follower(const TrackerLimits& limits, std::size_t log_length = kLogLength);

  /// Of a robot, under a supervisor if the profile is not off. Under kLab, commands keep to the
  /// settings' shares of the robot's limits, else to `limits`.
  /// @throws std::invalid_argument for a robot without capsules that is to be supervised.
  Follower(const robot::RobotModel& robot, const TrackerLimits& limits,
           const SafetySettings& safety, std::size_t log_length = kLogLength);

  int num_joints() const { return tracker_.num_joints(); }

  /// Follows `trajectory` from `start` on; until then, what was submitted before goes on. A plan
  /// that is submitted later takes precedence from its start on, for good.
  /// @throws std::invalid_argument for a wrong shape or a value that is not finite.
  void Submit(Trajectory trajectory, EpisodeTime start);

  /// What moves nearby, for the supervisor.
  void Watch(ObstacleReport report);

  /// After a brake of the supervisor: a person has seen to its cause.
  void Rearm();

  /// Forgets what was submitted: brakes within the limits, and stays until something new begins.
  void Hold() noexcept { plans_.Recall(); }

  // As of the latest tick; to be asked from any thread.
  robot::RobotMode mode() const { return mode_.load(std::memory_order_relaxed); }
  /// Whether its supervisor keeps it from following anything.
  bool is_held() const { return is_held_.load(std::memory_order_relaxed); }
  /// By how much plans are followed late, for having been followed more slowly than planned. What
  /// begins at `start` is begun that much later.
  HorizonOffset lag() const { return HorizonOffset(lag_s_.load(std::memory_order_relaxed)); }

  /// The command for the tick that begins at measured.t and lasts `period`: towards the plan, or to
  /// rest where there is none, within the limits (control/tracker.h).
  Command Tick(const Measured& measured, HorizonOffset period) noexcept;

  /// Calls take(TickRecord) for each tick since the last call.
  template <class Take>
  void DrainLog(const Take& take) {
    log_.Drain(take);
  }
  /// Calls take(Finding) for what the supervisor has found since the last call.
  template <class Take>
  void DrainFindings(const Take& take) {
    if (supervisor_) supervisor_->DrainFindings(take);
  }
  /// Ticks that were not logged because nobody drained the log in time.
  std::size_t lost_ticks() const { return log_.lost(); }

 private:
  // How far a plan has been followed, and how quickly.
  struct Progress {
    EpisodeTime t;          // on the plans' own clock, which is late by the lag
    double pace = 1;        // of that clock
    double quickening = 0;  // [1/s] its rate of change
  };
  static JointPoint PointOf(const PlanSlot::Plan& plan, const Progress& progress);
  Progress Go(EpisodeTime t, double period_s) noexcept;
  // The plan to follow there, unless it is refused or from before a stop.
  const PlanSlot::Plan* PlanFor(const Measured& measured, const Progress& before,
                                const Progress& now) noexcept;

  JerkLimitedTracker tracker_;
  std::optional<Supervisor> supervisor_;
  PlanSlot plans_;
  std::atomic<robot::RobotMode> mode_{robot::RobotMode::kReady};
  std::atomic<bool> is_held_{false};
  std::atomic<double> lag_s_{0};
  RingLog<TickRecord> log_;

  // Of the thread that ticks: numbers of plans.
  std::uint64_t judged_ = 0;          // by the supervisor, the latest
  std::optional<JointPoint> target_;  // of the tick before, if a plan was followed
  std::uint64_t dropped_ = 0;         // neither that one nor those before it are followed any more
  Progress progress_;                 // at the latest tick
};

}  // namespace sidestep::control
