#pragma once

#include <limits>
#include <string>

#include "sidestep/control/joint_vector.h"
#include "sidestep/core/time.h"

namespace sidestep::control {

/// What the supervisor does about what it finds.
enum class SafetyProfile {
  kOff,      ///< it does not look
  kObserve,  ///< it writes down what kLab would have done
  kLab       ///< it acts
};

/// What it looks for; 15 to 19 are looked for by those who drive a robot. Numbers are those of the
/// table in docs/safety.md.
enum class SafetyCheck {
  kPerceptionStale = 1,   ///< no scan has been accepted for too long
  kObstacleLost = 2,      ///< one that was followed has not been seen for too long
  kTimeStamps = 3,        ///< a report of the future
  kSplice = 6,            ///< a plan does not begin where the robot is
  kLimits = 7,            ///< a command beyond the limits
  kWorkspace = 8,         ///< a capsule is too near the floor
  kClearance = 9,         ///< an obstacle is too near
  kStopPath = 10,         ///< the way to rest might meet an obstacle
  kTracking = 11,         ///< the robot is not where it was told to be
  kExternalTorque = 12,   ///< something pushes
  kLink = 13,             ///< packets are lost
  kRobotMode = 14,        ///< the robot says that it is not fit to move
  kRecovery = 15,         ///< a person asks for a recovery that is not to be
  kOperatorStop = 16,     ///< a person stops it, or nobody attends it any more
  kConfiguration = 17,    ///< it is not set up as the robot that is planned for
  kSlowAnswer = 18,       ///< an answer to the robot took too long to make
  kClockJump = 19,        ///< a sensor's clock and ours have moved against each other
  kObstacleTooFast = 20,  ///< an obstacle is faster than was declared
  kToolSpeed = 21,        ///< the tool is to be faster than it may be
  kLongStop = 22,         ///< the way to rest takes too long, or is too long
};
inline constexpr int kNumSafetyChecks = 23;
/// "perception_stale", "clearance", ...
const char* ToString(SafetyCheck check);

enum class Reaction {
  kNone,
  kSlow,    ///< follows its plan more slowly
  kEase,    ///< brakes for this tick, and follows its plan on
  kRefuse,  ///< the plan is not followed: the robot brakes until another one begins
  kHold,    ///< brakes; goes on when the cause has been gone for resume_s and a new plan begins
  kBrake,   ///< brakes, and stays until a person rearms it
  kAbort,   ///< the motion ends at once: the robot stops by itself
};
/// "none", "slow", "ease", "refuse", "hold", "brake", "abort".
const char* ToString(Reaction reaction);

/// What the supervisor found, when it found it.
struct Finding {
  EpisodeTime t;
  SafetyCheck check = SafetyCheck::kPerceptionStale;
  Reaction reaction = Reaction::kNone;
  double value = 0, limit = 0;  ///< what was measured, and what it may be; units as the check's
};

/// "clearance of 0.043, allowed 0.05".
std::string Describe(const Finding& finding);

/// The bounds. Defaults are common practice; docs/safety.md tells the reason of each.
struct SafetySettings {
  SafetyProfile profile = SafetyProfile::kOff;

  // What obstacles are declared to do.
  double obstacle_speed_m_s = 0.5;
  double obstacle_acceleration_m_s2 = 2;

  double slow_after_s = 0.15;    ///< 1: with a report older than that it moves at stale_pace
  double stale_pace = 0.3;       ///< 1: share of the speed that was planned
  double stale_s = 0.3;          ///< 1, 2: the oldest a report, or an obstacle in it, may be
  double future_s = 0.01;        ///< 3
  double splice_q_rad = 0.005;   ///< 6
  double splice_v_rad_s = 0.05;  ///< 6
  double splice_a_rad_s2 = 1;    ///< 6
  /// 7: kept from position limits; what a robot makes up for lost packets may take some of it.
  double range_margin_rad = 0.101;
  /// 7: of the robot's limits, for commands. A lost packet is made up for by another millisecond of
  /// the acceleration before it: a Panda at half of that is faster by 0.0075 rad/s then, and what
  /// three of them in a row take is kept below half of its velocity.
  double v_share = 0.49;
  double a_share = 0.5;          ///< 7
  double jerk_share = 0.022;     ///< 7
  double floor_m = 0;            ///< 8
  double floor_margin_m = 0.02;  ///< 8
  double clearance_m = 0.05;     ///< 9
  double margin_m = 0.03;        ///< 10: for what is not known exactly
  double slow_m = 0.1;           ///< 10: so far before that margin is used up it begins to slow
  double approach_m = 0.02;      ///< 10: slows in full only if resting would leave so much more
  double near_pace = 0.1;        ///< 10: share of the speed that was planned, at the margin
  double tracking_rad = 0.02;    ///< 11
  JointVector torque_n_m;        ///< 12: at which the robot would stop by itself; empty: not known
  double torque_share = 0.5;     ///< 12: of that
  double torque_s = 0.02;        ///< 12: for so long
  double success_rate = 0.9;     ///< 13: of the latest 100 packets
  int lost_in_a_row = 5;         ///< 13
  double too_fast_s = 0.1;       ///< 20: for so long
  double too_fast_sigmas = 3;    ///< 20: of its speed, that may be an error
  double tool_speed_m_s = std::numeric_limits<double>::infinity();  ///< 21
  double stop_s = 0.35;                                             ///< 22: the longest stop ...
  double stop_m = 0.1;  ///< 22: ... and how far it moves any part of the arm
  double resume_s = 1;
};

}  // namespace sidestep::control
