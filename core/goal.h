#pragma once

#include <Eigen/Core>
#include <optional>

#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"

namespace sidestep {

/// The largest difference of two configurations, or of two velocities, joint by joint [rad, rad/s].
/// @param scale here and below what one rad is for each joint, in its own unit
///   (robot/tolerance_scale.h); empty where all turn.
double LargestDifference(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                         const Eigen::VectorXd& scale);

/// An arm is at its goal when no joint is further from it than this ...
inline constexpr double kGoalTolerance_rad = 0.02;
/// ... and a plan leads to the goal when it ends this near: half as far, so that an arm that lags
/// its plan a little still arrives ...
inline constexpr double kPlannedGoalTolerance_rad = 0.01;
/// ... and none is faster than this [rad/s].
inline constexpr double kGoalSpeed_rad_s = 0.05;

/// Whether an arm that moves by (q, v) is at `q_goal`. All of shape n.
bool IsAtGoal(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& q_goal,
              const Eigen::VectorXd& scale = {});

/// Whether a plan leads to `q_goal` (shape n): by where it ends.
bool EndsAtGoal(const Trajectory& plan, const Eigen::VectorXd& q_goal,
                const Eigen::VectorXd& scale = {});

/// What it is to reach a goal, for whoever has to decide it: to be there without a break for as
/// long as was asked for. Shown a motion state by state, in order.
class GoalWatch {
 public:
  /// @param dwell_s how long to stay, >= 0; with 0 the first state at the goal will do.
  GoalWatch(const Eigen::VectorXd& q_goal, double dwell_s, const Eigen::VectorXd& scale = {});

  void Observe(EpisodeTime t, const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  double dwell_s() const { return dwell_s_; }

  /// When the stay began that goes on now; none away from the goal. Of the stay that counted, for
  /// ever.
  std::optional<EpisodeTime> arrived() const { return arrived_; }
  /// The first state at which it had lasted long enough: then the goal is reached, for good.
  std::optional<EpisodeTime> dwelt() const { return dwelt_; }

 private:
  Eigen::VectorXd q_goal_;
  double dwell_s_;
  Eigen::VectorXd scale_;
  std::optional<EpisodeTime> arrived_, dwelt_;
};

}  // namespace sidestep
