#pragma once

#include <string>
#include <vector>

#include "sidestep/core/obstacle_state.h"
#include "sidestep/core/samples.h"
#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"

namespace sidestep::robot {

/// What a robot is about.
enum class RobotMode {
  kDisarmed,  ///< follows nothing that it is told
  kReady,     ///< at rest, and has not been told anything since it was last ready
  kMoving,    ///< follows a trajectory, or rests at its end
  kHolding,   ///< brakes, or has come to rest by that
  kFault      ///< stopped by itself, and stays so until a person recovers it
};

struct RobotStatus {
  RobotMode mode = RobotMode::kDisarmed;
  std::string why;       ///< it holds or has stopped, where nobody told it to; else empty
  bool is_held = false;  ///< by its own safety: it would not follow a plan that begins now
  /// By how much it follows plans late, for having slowed down.
  HorizonOffset lag{0};
};

/// A robot that follows trajectories, simulated or real. One thread at a time.
class RobotInterface {
 public:
  virtual ~RobotInterface() = default;

  /// The measured state now.
  virtual JointState Read() const = 0;

  virtual RobotStatus Status() const = 0;

  /// Follows `trajectory` from `start` on; until then, what was submitted before goes on, and
  /// before the first one the robot is held. Where it is late by Status().lag, what is to begin at
  /// a moment has to be given a start that much before. A start in the past is allowed: the robot
  /// joins the trajectory where it is now. The robot's own limits hold whatever is asked for: what
  /// it cannot follow, it follows late.
  /// @throws std::invalid_argument for a wrong shape or a value that is not finite.
  virtual void Submit(const Trajectory& trajectory, EpisodeTime start) = 0;

  /// Brakes within its limits and stays there. Cannot fail: it is what is left when all else has.
  virtual void Hold() noexcept = 0;

  /// What moves nearby, for the robot's own safety.
  virtual void Watch(const ObstacleReport&) {}

  /// What its safety supervisor has found since the last call.
  virtual std::vector<SafetyEvent> TakeSafetyEvents() { return {}; }

  /// How long each command since the last call took to make, in real time [s]; none where nobody
  /// waited for it.
  virtual std::vector<double> TakeAnswerTimes() { return {}; }

  /// The simulator steps to time `t`; hardware waits for it. Never goes back.
  /// @throws RobotError if the robot has failed.
  virtual void AdvanceTo(EpisodeTime t) = 0;

  /// Every control tick since the last call.
  virtual std::vector<ControlSample> TakeControlLog() = 0;
};

}  // namespace sidestep::robot
