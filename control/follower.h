#pragma once

#include <atomic>
#include <cstddef>

#include "sidestep/control/joint_vector.h"
#include "sidestep/control/plan_slot.h"
#include "sidestep/control/ring_log.h"
#include "sidestep/control/tracker.h"
#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_interface.h"

namespace sidestep::control {

/// What a robot's controller tells of itself at one tick.
struct Measured {
  EpisodeTime t;
  JointVector q, v;      ///< as measured, shape n
  JointPoint commanded;  ///< the motion that it was last told, as it understood it
};

/// What the motors are told in one tick.
struct Command {
  JointPoint motion;
};

/// One tick, as it is logged: what was measured at its beginning and what was commanded then.
struct TickRecord {
  EpisodeTime t;
  JointVector q, v;
  JointPoint command;
};

/// Owns the tick of a robot: what stands between a plan, which comes when it comes, and a motor,
/// which must be told something every millisecond. The simulated arm and a driver of a real one
/// call the same Tick.
///
/// One thread submits and reads the log, one ticks; they may be the same. Tick takes no lock,
/// allocates nothing, and never waits.
class Follower {
 public:
  /// @param log_length of ticks, kept between two calls of DrainLog.
  /// @throws std::invalid_argument as JerkLimitedTracker.
  explicit Follower(const TrackerLimits& limits, std::size_t log_length = 4096);

  int num_joints() const { return tracker_.num_joints(); }

  /// Follows `trajectory` from `start` on; until then, what was submitted before goes on. A plan
  /// that is submitted later takes precedence from its start on, for good.
  /// @throws std::invalid_argument for a wrong shape or a value that is not finite.
  void Submit(Trajectory trajectory, EpisodeTime start);

  /// Forgets what was submitted: brakes within the limits, and stays until something new begins.
  void Hold() noexcept { plans_.Recall(); }

  /// As of the latest tick; to be asked from any thread.
  robot::RobotMode mode() const { return mode_.load(std::memory_order_relaxed); }

  /// The command for the tick that begins at measured.t and lasts `period`: towards the plan, or to
  /// rest where there is none, within the limits (control/tracker.h).
  Command Tick(const Measured& measured, HorizonOffset period) noexcept;

  /// Calls take(TickRecord) for each tick since the last call.
  template <class Take>
  void DrainLog(const Take& take) {
    log_.Drain(take);
  }
  /// Ticks that were not logged because nobody drained the log in time.
  std::size_t lost_ticks() const { return log_.lost(); }

 private:
  JerkLimitedTracker tracker_;
  PlanSlot plans_;
  std::atomic<robot::RobotMode> mode_{robot::RobotMode::kReady};
  RingLog<TickRecord> log_;
};

}  // namespace sidestep::control
