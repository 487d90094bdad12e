#pragma once

#include <array>
#include <atomic>
#include <optional>

#include "sidestep/control/arm_capsules.h"
#include "sidestep/control/joint_motion.h"
#include "sidestep/control/latest.h"
#include "sidestep/control/ring_log.h"
#include "sidestep/control/safety.h"
#include "sidestep/control/tick.h"
#include "sidestep/control/tool_gate.h"
#include "sidestep/control/tracker.h"
#include "sidestep/core/obstacle_state.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::control {

/// Looks at every tick before it is sent, and says whether the robot has to come to rest instead.
/// Which checks there are, with what bounds, for what reasons: docs/safety.md.
///
/// Its promise rests on an induction: a motion is let through only if the stop that would follow it
/// meets no place that an obstacle can reach by then, where an obstacle moves as it was seen to and
/// may change its velocity by obstacle_acceleration. So at every tick there is a stop that has been
/// checked. Before a stop is due it asks for a slower pace. It is not certified and does not make a
/// robot safe for people.
///
/// One thread watches, one judges. Judge allocates nothing, takes no lock and never waits.
class Supervisor {
 public:
  /// @param tracker whose stops are judged.
  /// @throws std::invalid_argument for a robot without capsules.
  Supervisor(const robot::RobotModel& robot, const JerkLimitedTracker& tracker,
             const SafetySettings& settings);

  const SafetySettings& settings() const { return settings_; }

  /// What moves, as it is known now.
  void Watch(ObstacleReport report) { reports_.Put(std::move(report)); }

  /// A person has seen to the cause of a brake: it may move again.
  void Rearm() { rearms_.fetch_add(1, std::memory_order_relaxed); }

  /// Whether a plan is refused that is to be followed from this tick on.
  /// @param before where it is at the tick before, when measured.commanded was sent; its first
  /// point
  ///   if it begins now. @param begins whether it does: the acceleration of plans jumps at support
  ///   states, of which the first is one. A plan that goes on with another has to agree with its
  ///   acceleration, too. @param other where that one is at the tick before; null: none is
  ///   followed.
  bool Refuses(const JointPoint& before, bool begins, const JointPoint* other,
               const Measured& measured) noexcept;

  /// The plan that is followed is at `offset` now, at this pace: as of the next Judge, the tool is
  /// to keep its speed on it. @param slowing_per_s how quickly the pace can fall.
  void LookAhead(const Trajectory& plan, HorizonOffset offset, double pace,
                 double slowing_per_s) noexcept;

  /// What is to be done instead of sending `next`: kNone, kEase, kHold or kBrake.
  Reaction Judge(const Measured& measured, const JointPoint& next, double period_s) noexcept;

  /// The share of the planned speed at which plans are to be followed on, as of the latest Judge.
  double pace() const { return pace_; }

  /// Calls take(Finding) for what has begun to be found since the last call.
  template <class Take>
  void DrainFindings(const Take& take) {
    findings_.Drain(take);
  }

 private:
  static constexpr int kStops = 8;  // the way to rest is looked at in so many pieces

  // Where an obstacle can have come: anywhere within the radius of where it would be by itself that
  // is no further from where it was seen than it can go.
  struct Reach {
    Eigen::Vector3d shift_W;
    double radius_m;
    double way_m;
  };
  Reach ReachAfter(const ObstacleState& obstacle, double after_s) const;
  static double LeastMargin(const ArmCapsules::Placed& capsule, const ObstacleState& obstacle,
                            const Reach& reach);
  static double Margin(const ArmCapsules::Placed& capsule, const ObstacleState& obstacle,
                       const Reach& reach);

  // kNone: it is not found.
  void Find(SafetyCheck check, Reaction reaction, double value, double limit);
  void Find(SafetyCheck check, Reaction reaction, bool is_found, double value, double limit) {
    Find(check, is_found ? reaction : Reaction::kNone, value, limit);
  }
  void JudgePerception(const ObstacleReport* report);
  void JudgeRobot(const Measured& measured);
  void JudgeCommand(const Measured& measured, const JointPoint& next, double period_s);
  void JudgePlaces(const ObstacleReport* report, const JointPoint& next, double period_s,
                   Reaction if_low);
  void JudgeTool(const Measured& measured, const JointPoint& next, double period_s);
  void JudgeStop(double period_s);
  double MarginAtRest(const ObstacleReport& report) const;
  double PaceFor(double left_m, double at_rest_m) const;
  double FastestOnStop_m_s(const JointPoint& next, double period_s);
  void PlaceStop(const JointPoint& next, double period_s);
  JointVector OnStop(double ticks) const;
  Reaction React();

  const robot::RobotModel robot_;
  const JerkLimitedTracker tracker_;
  const SafetySettings settings_;
  const ArmCapsules capsules_;
  const JointVector scale_;  // of tolerances

  Latest<ObstacleReport> reports_;
  RingLog<Finding> findings_;
  std::atomic<int> rearms_{0};

  // Of the thread that judges.
  EpisodeTime now_;
  std::optional<EpisodeTime> begin_;
  std::array<Reaction, kNumSafetyChecks> found_{};
  Reaction worst_ = Reaction::kNone;  // of this tick
  double pace_ = 1;
  double pushed_s_ = 0;
  std::optional<EpisodeTime> fast_since_;
  int rearmed_ = 0;
  bool is_braked_ = false;
  std::optional<EpisodeTime> held_until_;
  std::array<std::optional<JointStop>, kMaxJoints> stop_;  // that would follow the command
  double stop_ticks_ = 0;
  // The capsules at kStops + 1 moments of the stop after the command, and those moments.
  std::array<ArmCapsules::All, kStops + 1> placed_;
  std::array<double, kStops + 1> placed_s_{};
  std::optional<EpisodeTime> eased_;  // the latest time
  ToolGate tool_gate_;
  ToolGate::Ahead tool_ahead_;
  double followed_pace_ = 1;  // of the plan that is followed, if any
};

}  // namespace sidestep::control
