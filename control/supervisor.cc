#include "sidestep/control/supervisor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sidestep/control/joint_motion.h"
#include "sidestep/control/segment_box.h"
#include "sidestep/robot/tolerance_scale.h"

namespace sidestep::control {
namespace {

constexpr std::size_t kFindingLogLength = 1024;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of the tool's speed: a compliant arm comes up to 2.3 % over what it is told.
constexpr double kToolShare = 0.97;

// Of the longest stop: what is followed slowly enough keeps to the first, no command to be sent
// exceeds the second. The rest is for parts of the arm that lie beside the axes of its capsules.
constexpr double kUsualStop = 0.92, kLongestStop = 0.97;

constexpr HorizonOffset kToldAgain(
    0.5);  // what comes and goes is one finding until it is gone so long

// Of the pace that would do, and for how long after it had to brake: so that the arm can catch up
// without being too fast at once again. Else it would shake.
constexpr double kEasedShare = 0.9;
constexpr HorizonOffset kCatchesUp(2);

// Differences of sent positions are wrong by some 1e-15 rad, divided by the tick once a difference.
constexpr double kUseRounding = 1e-6;

// NaN if anything is.
double Largest(const JointVector& a, const JointVector& b, const JointVector& scale) {
  return (a - b).cwiseAbs().cwiseQuotient(scale).maxCoeff<Eigen::PropagateNaN>();
}

bool IsMoving(const JointPoint& point) { return !point.v.isZero(0) || !point.a.isZero(0); }

// No more than the distance below: from the ball around the capsule to that around the obstacle.
double LeastDistance(const ArmCapsules::Placed& capsule, const ObstacleState& obstacle,
                     const Eigen::Vector3d& shift_W) {
  const Eigen::Vector3d between =
      obstacle.X_WO.translation() + shift_W - (capsule.a + capsule.b) / 2;
  return between.norm() - (capsule.b - capsule.a).norm() / 2 - capsule.radius_m -
         obstacle.half_extents_m.norm() - obstacle.radius_m;
}

// From the capsule to the obstacle, both as they are, when the obstacle's box is moved by
// `shift_W`.
double Distance(const ArmCapsules::Placed& capsule, const ObstacleState& obstacle,
                const Eigen::Vector3d& shift_W) {
  const Eigen::Vector3d p_W = obstacle.X_WO.translation() + shift_W;
  const auto in_box = [&](const Eigen::Vector3d& q_W) {
    return obstacle.X_WO.RotateInverse(q_W - p_W);
  };
  return SegmentBoxDistance(in_box(capsule.a), in_box(capsule.b), obstacle.half_extents_m) -
         capsule.radius_m - obstacle.radius_m;
}

// The furthest of the way between two places of a capsule, its axis taken to where its caps end:
// what sticks out of it moves most where the arm turns about its other end.
double WayOfAxis_m(const ArmCapsules::Placed& from, const ArmCapsules::Placed& to) {
  const double length_m = (from.b - from.a).norm();
  const double beyond = length_m > 0 ? from.radius_m / length_m : 0;
  const Eigen::Vector3d a = to.a - from.a, b = to.b - from.b, beyond_b = beyond * (b - a);
  return std::max((b + beyond_b).norm(), (a - beyond_b).norm());
}

}  // namespace

// No more than the margin below.
double Supervisor::LeastMargin(const ArmCapsules::Placed& capsule, const ObstacleState& obstacle,
                               const Reach& reach) {
  return std::max(LeastDistance(capsule, obstacle, reach.shift_W) - reach.radius_m,
                  LeastDistance(capsule, obstacle, Eigen::Vector3d::Zero()) - reach.way_m);
}

// From the capsule to the nearest place that the obstacle can have come to, or less.
double Supervisor::Margin(const ArmCapsules::Placed& capsule, const ObstacleState& obstacle,
                          const Reach& reach) {
  return std::max(Distance(capsule, obstacle, reach.shift_W) - reach.radius_m,
                  Distance(capsule, obstacle, Eigen::Vector3d::Zero()) - reach.way_m);
}

Supervisor::Supervisor(const robot::RobotModel& robot, const JerkLimitedTracker& tracker,
                       const SafetySettings& settings)
    : robot_(robot),
      tracker_(tracker),
      settings_(settings),
      capsules_(robot),
      scale_(robot::ToleranceScale(robot)),
      findings_(kFindingLogLength),
      tool_gate_(robot, settings.tool_speed_m_s) {
  if (robot.capsules().empty()) {
    throw std::invalid_argument("Supervisor: the robot has no capsules");
  }
}

bool Supervisor::Refuses(const JointPoint& before, bool begins, const JointPoint* other,
                         const Measured& measured) noexcept {
  // It has to agree with the plan that is followed, which the robot may lag behind, or with the
  // robot.
  const auto shares = [&](const JointPoint& reference, bool with_a) {
    return std::array<double, 3>{
        Largest(before.q, reference.q, scale_) / settings_.splice_q_rad,
        Largest(before.v, reference.v, scale_) / settings_.splice_v_rad_s,
        with_a ? Largest(before.a, reference.a, scale_) / settings_.splice_a_rad_s2 : 0};
  };
  const auto largest = [](const std::array<double, 3>& of) {
    return *std::max_element(of.begin(), of.end());
  };
  double share = largest(shares(measured.commanded, !begins && other == nullptr));
  if (other != nullptr) share = std::min(share, largest(shares(*other, !begins)));
  now_ = measured.t;
  found_[static_cast<std::size_t>(SafetyCheck::kSplice)] = Reaction::kNone;  // each plan is told of
  const Reaction worst = std::exchange(worst_, Reaction::kNone);
  if (!(share <= 1)) Find(SafetyCheck::kSplice, Reaction::kRefuse, true, share, 1);
  const bool is_refused = worst_ != Reaction::kNone;
  worst_ = worst;
  return is_refused && settings_.profile == SafetyProfile::kLab;
}

void Supervisor::LookAhead(const Trajectory& plan, HorizonOffset offset, double pace,
                           double slowing_per_s) noexcept {
  followed_pace_ = pace;
  if (!tool_gate_.is_open()) tool_ahead_ = tool_gate_.LookAhead(plan, offset, slowing_per_s);
}

Reaction Supervisor::Judge(const Measured& measured, const JointPoint& next,
                           double period_s) noexcept {
  now_ = measured.t;
  if (!begin_) begin_ = now_;
  worst_ = Reaction::kNone;
  pace_ = 1;
  const ObstacleReport* const report = reports_.Get();
  // A robot at rest has nothing to brake: it waits.
  const Reaction if_low = IsMoving(measured.commanded) ? Reaction::kBrake : Reaction::kHold;
  JudgePerception(report);
  JudgeRobot(measured);
  JudgeCommand(measured, next, period_s);
  JudgePlaces(report, next, period_s, if_low);
  JudgeTool(measured, next, period_s);
  JudgeStop(period_s);
  pushed_s_ = 0 < pushed_s_ ? pushed_s_ + period_s : pushed_s_;
  return React();
}

void Supervisor::Find(SafetyCheck check, Reaction reaction, double value, double limit) {
  Reaction& found = found_[static_cast<std::size_t>(check)];
  worst_ = std::max(worst_, reaction);
  if (reaction > found) findings_.Append({now_, check, reaction, value, limit});
  found = reaction;
}

void Supervisor::JudgePerception(const ObstacleReport* report) {
  const double age_s = (now_ - (report == nullptr ? *begin_ : report->t)).seconds();
  const bool is_stale = age_s > settings_.stale_s, is_old = age_s > settings_.slow_after_s;
  if (is_old) pace_ = std::min(pace_, settings_.stale_pace);
  Find(SafetyCheck::kPerceptionStale, is_stale ? Reaction::kHold : Reaction::kSlow, is_old, age_s,
       is_stale ? settings_.stale_s : settings_.slow_after_s);
  Find(SafetyCheck::kTimeStamps, Reaction::kHold, age_s < -settings_.future_s, -age_s,
       settings_.future_s);
  double oldest_s = 0, fastest_m_s = 0;
  if (report != nullptr) {
    for (const ObstacleState& obstacle : report->obstacles) {
      if (!obstacle.has_left) oldest_s = std::max(oldest_s, (now_ - obstacle.t).seconds());
      // It is at least so fast.
      fastest_m_s = std::max(
          fastest_m_s, obstacle.v_W.norm() - settings_.too_fast_sigmas * obstacle.speed_sigma_m_s);
    }
  }
  // What is stale as a whole is told once.
  Find(SafetyCheck::kObstacleLost, Reaction::kHold,
       oldest_s > settings_.stale_s && age_s <= settings_.stale_s, oldest_s, settings_.stale_s);
  // The first estimates of a velocity are rough.
  if (!(fastest_m_s > settings_.obstacle_speed_m_s)) {
    fast_since_.reset();
  } else if (!fast_since_) {
    fast_since_ = now_;
  }
  Find(SafetyCheck::kObstacleTooFast, Reaction::kBrake,
       fast_since_ && now_ - *fast_since_ >= HorizonOffset(settings_.too_fast_s), fastest_m_s,
       settings_.obstacle_speed_m_s);
}

void Supervisor::JudgeRobot(const Measured& measured) {
  const double off_rad = Largest(measured.q, measured.commanded.q, scale_);
  Find(SafetyCheck::kTracking, Reaction::kBrake, !(off_rad <= settings_.tracking_rad), off_rad,
       settings_.tracking_rad);
  double pushed = 0;
  const Eigen::Index known = std::min(measured.tau_ext.size(), settings_.torque_n_m.size());
  for (Eigen::Index j = 0; j < known; ++j) {
    pushed = std::max(pushed, std::abs(measured.tau_ext(j)) / settings_.torque_n_m(j));
  }
  if (!(pushed > settings_.torque_share)) {
    pushed_s_ = 0;
  } else if (pushed_s_ == 0) {
    pushed_s_ = std::numeric_limits<double>::min();  // since this tick
  }
  Find(SafetyCheck::kExternalTorque, Reaction::kBrake, pushed_s_ >= settings_.torque_s, pushed,
       settings_.torque_share);
  const bool loses = measured.success_rate < settings_.success_rate ||
                     measured.lost_in_a_row > settings_.lost_in_a_row;
  const bool in_a_row = measured.lost_in_a_row > settings_.lost_in_a_row;
  Find(SafetyCheck::kLink, Reaction::kHold, loses,
       in_a_row ? measured.lost_in_a_row : measured.success_rate,
       in_a_row ? settings_.lost_in_a_row : settings_.success_rate);
  Find(SafetyCheck::kRobotMode, Reaction::kBrake, !measured.is_fit, 0, 0);
}

// Independent of how the command was made: by the positions that are sent, as the robot judges
// them.
void Supervisor::JudgeCommand(const Measured& measured, const JointPoint& next, double period_s) {
  double use = 0;
  for (int j = 0; j < capsules_.num_joints(); ++j) {
    const robot::JointLimits& limits = robot_.limits()[static_cast<std::size_t>(j)];
    const double v = (next.q(j) - measured.commanded.q(j)) / period_s;
    const double a = (v - measured.commanded.v(j)) / period_s;
    const double jerk = (a - measured.commanded.a(j)) / period_s;
    use = std::max({use, std::abs(v) / limits.v_max, std::abs(a) / limits.a_max,
                    std::abs(jerk) / limits.jerk_max,
                    next.q(j) < limits.q_min || next.q(j) > limits.q_max ? kInfinity : 0});
  }
  Find(SafetyCheck::kLimits, Reaction::kBrake, !(use <= 1 + kUseRounding), use, 1);
}

Supervisor::Reach Supervisor::ReachAfter(const ObstacleState& obstacle, double after_s) const {
  const double ahead_s = std::max(0.0, (now_ - obstacle.t).seconds() + after_s);
  const double most_m_s = std::max(settings_.obstacle_speed_m_s, obstacle.v_W.norm());
  return {ahead_s * obstacle.v_W, settings_.obstacle_acceleration_m_s2 * ahead_s * ahead_s / 2,
          ahead_s * most_m_s};
}

void Supervisor::JudgePlaces(const ObstacleReport* report, const JointPoint& next, double period_s,
                             Reaction if_low) {
  PlaceStop(next, period_s);
  double lowest_m = kInfinity, nearest_m = kInfinity, margin_m = kInfinity;
  for (std::size_t c = 0; c < static_cast<std::size_t>(capsules_.size()); ++c) {
    if (!placed_[0][c].moves) continue;
    for (std::size_t k = 0; k <= kStops; ++k) {
      const ArmCapsules::Placed& at = placed_[k][c];
      lowest_m = std::min(lowest_m, std::min(at.a.z(), at.b.z()) - at.radius_m);
      if (report == nullptr) continue;
      // Between two moments the capsule is no further from one of them than half its way.
      double half_way_m = 0;
      for (const std::size_t other : {k - 1, k + 1}) {
        if (other > kStops) continue;  // of an unsigned k - 1, too
        const ArmCapsules::Placed& near = placed_[other][c];
        half_way_m = std::max({half_way_m, (near.a - at.a).norm() / 2, (near.b - at.b).norm() / 2});
      }
      for (const ObstacleState& obstacle : report->obstacles) {
        const Reach reach = ReachAfter(obstacle, placed_s_[k]);
        // Most are too far to matter, which the balls around both tell sooner.
        if (k == 0 && LeastDistance(at, obstacle, reach.shift_W) < nearest_m) {
          nearest_m = std::min(nearest_m, Distance(at, obstacle, reach.shift_W));
        }
        if (LeastMargin(at, obstacle, reach) - half_way_m >= margin_m) continue;
        margin_m = std::min(margin_m, Margin(at, obstacle, reach) - half_way_m);
      }
    }
  }
  const double least_height_m = settings_.floor_m + settings_.floor_margin_m;
  Find(SafetyCheck::kWorkspace, if_low, lowest_m < least_height_m, lowest_m, least_height_m);
  Find(SafetyCheck::kClearance, Reaction::kHold, nearest_m < settings_.clearance_m, nearest_m,
       settings_.clearance_m);
  const double left_m = margin_m - settings_.margin_m;
  double pace = 1;
  if (left_m < settings_.slow_m) {
    pace = PaceFor(left_m, MarginAtRest(*report) - settings_.margin_m);
    pace_ = std::min(pace_, pace);
  }
  // It is told again that it slows only after there was a fifth more room than would slow it.
  const bool was_found =
      found_[static_cast<std::size_t>(SafetyCheck::kStopPath)] != Reaction::kNone;
  const bool is_slow = pace < 1 || (was_found && left_m < 1.2 * settings_.slow_m);
  if (left_m < 0) {
    Find(SafetyCheck::kStopPath, Reaction::kHold, margin_m, settings_.margin_m);
  } else {
    Find(SafetyCheck::kStopPath, Reaction::kSlow, is_slow, margin_m,
         settings_.margin_m + settings_.slow_m);
  }
}

// It slows down where what is planned is too fast. A plan that gets faster more suddenly than the
// pace can fall is not followed as quickly: the stop that is left keeps to the speed, too.
void Supervisor::JudgeTool(const Measured& measured, const JointPoint& next, double period_s) {
  if (tool_gate_.is_open()) return;
  const ToolGate::Ahead ahead = std::exchange(tool_ahead_, {});
  const bool catches_up = eased_ && now_ - *eased_ <= kCatchesUp;
  pace_ = std::min(pace_, (catches_up ? kEasedShare : 1) * ahead.pace);
  const double speed_m_s = std::max(tool_gate_.SpeedBetween(measured.commanded.q, next.q, period_s),
                                    FastestOnStop_m_s(next, period_s));
  const double most_m_s = kToolShare * tool_gate_.most_m_s();
  if (!(speed_m_s <= most_m_s)) {
    eased_ = now_;
    pace_ = std::min(pace_, kEasedShare * most_m_s / speed_m_s);
    Find(SafetyCheck::kToolSpeed, Reaction::kEase, speed_m_s, most_m_s);
  } else if (!eased_ || now_ - *eased_ > kToldAgain) {
    Find(SafetyCheck::kToolSpeed, Reaction::kSlow, ahead.pace < 1, ahead.fastest_m_s, most_m_s);
  }
}

// The less of the longest stop is left, the slower the plan is followed.
void Supervisor::JudgeStop(double period_s) {
  double way_m = 0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(capsules_.size()); ++c) {
    const ArmCapsules::Placed &from = placed_[0][c], &to = placed_[kStops][c];
    if (!from.moves) continue;
    way_m = std::max(way_m, WayOfAxis_m(from, to));
  }
  const double pace = std::exchange(followed_pace_, 1);
  const double use = std::max(stop_ticks_ * period_s / settings_.stop_s, way_m / settings_.stop_m);
  if (use > kUsualStop) pace_ = std::min(pace_, pace * kUsualStop / use);
  const bool was_found =
      found_[static_cast<std::size_t>(SafetyCheck::kLongStop)] != Reaction::kNone;
  const bool is_long = use > kUsualStop || (was_found && use > 0.8 * kUsualStop);
  Find(SafetyCheck::kLongStop, use > kLongestStop ? Reaction::kEase : Reaction::kSlow, is_long, use,
       kLongestStop);
}

// Not only what gets faster until its acceleration is taken back: where joints make up for each
// other, the tool gets faster when one of them comes to rest before the other.
double Supervisor::FastestOnStop_m_s(const JointPoint& next, double period_s) {
  constexpr int kStep = 8, kMost = 96;  // ticks; by then all of them get slower
  double fastest_m_s = 0;
  JointVector from = next.q;
  const double end = std::min<double>(stop_ticks_, kMost) + kStep;
  for (int after = kStep; after < end; after += kStep) {
    const JointVector to = OnStop(after);
    fastest_m_s = std::max(fastest_m_s, tool_gate_.SpeedBetween(from, to, kStep * period_s));
    from = to;
  }
  return fastest_m_s;
}

// What would be left in the same time, if the arm stood where it is now.
double Supervisor::MarginAtRest(const ObstacleReport& report) const {
  double margin_m = kInfinity;
  for (std::size_t c = 0; c < static_cast<std::size_t>(capsules_.size()); ++c) {
    const ArmCapsules::Placed& at = placed_[0][c];
    if (!at.moves) continue;
    for (const double after_s : placed_s_) {
      for (const ObstacleState& obstacle : report.obstacles) {
        const Reach reach = ReachAfter(obstacle, after_s);
        if (LeastMargin(at, obstacle, reach) >= margin_m) continue;
        margin_m = std::min(margin_m, Margin(at, obstacle, reach));
      }
    }
  }
  return margin_m;
}

// In proportion to what is left, but as quick as planned where it is not the arm's motion that
// brings the two together: there, who slows down is caught.
double Supervisor::PaceFor(double left_m, double at_rest_m) const {
  const double near = std::clamp(left_m / settings_.slow_m, settings_.near_pace, 1.0);
  const double aside = std::clamp(1 - (at_rest_m - left_m) / settings_.approach_m, 0.0, 1.0);
  return std::max(near, aside);
}

JointVector Supervisor::OnStop(double ticks) const {
  JointVector q(tracker_.num_joints());
  for (int j = 0; j < tracker_.num_joints(); ++j) {
    q(j) = stop_[static_cast<std::size_t>(j)]->PositionAfter(ticks);
  }
  return q;
}

void Supervisor::PlaceStop(const JointPoint& next, double period_s) {
  stop_ticks_ = 0;
  for (int j = 0; j < tracker_.num_joints(); ++j) {
    auto& stop = stop_[static_cast<std::size_t>(j)];
    stop.emplace(JointMotion{next.q(j), next.v(j), next.a(j)}, tracker_.bounds(j), period_s);
    stop_ticks_ = std::max(stop_ticks_, stop->ticks());
  }
  for (std::size_t k = 0; k <= kStops; ++k) {
    const double after = std::round(stop_ticks_ * static_cast<double>(k) / kStops);
    placed_s_[k] = (1 + after) * period_s;
    if (stop_ticks_ == 0 && k > 0) {
      placed_[k] = placed_[0];
    } else {
      capsules_.Place(OnStop(after), placed_[k]);
    }
  }
}

Reaction Supervisor::React() {
  if (settings_.profile != SafetyProfile::kLab) {
    pace_ = 1;
    return Reaction::kNone;
  }
  const int rearms = rearms_.load(std::memory_order_relaxed);
  if (rearms != std::exchange(rearmed_, rearms)) is_braked_ = false;
  if (worst_ == Reaction::kBrake) is_braked_ = true;
  if (worst_ == Reaction::kHold) held_until_ = now_ + HorizonOffset(settings_.resume_s);
  if (is_braked_) return Reaction::kBrake;
  if (held_until_ && now_ < *held_until_) return Reaction::kHold;
  return worst_ == Reaction::kEase ? Reaction::kEase : Reaction::kNone;
}

}  // namespace sidestep::control
