#pragma once

#include <Eigen/Core>

#include "sidestep/core/time.h"

namespace sidestep {

/// What a robot's joints do at one moment. Joint vectors are rad and rad/s (m, m/s for a slider).
struct JointState {
  EpisodeTime t;
  Eigen::VectorXd q;  ///< shape n
  Eigen::VectorXd v;  ///< shape n
};

/// A point of a trajectory: position, velocity and acceleration, each of shape n.
struct TrajectoryPoint {
  Eigen::VectorXd q;
  Eigen::VectorXd v;
  Eigen::VectorXd a;
};

/// Support states stand at least this far apart. Nearer ones would be a jump to whatever executes
/// them, and the accelerations between them numbers that mean nothing.
inline constexpr double kLeastInterval_s = 1e-6;

/// Support states of a joint motion. Between two of them the motion is the cubic that matches both
/// positions and both velocities (the mean of the constant-velocity Gaussian process), so position
/// and velocity are continuous and the acceleration jumps at support states.
/// Column k is the state at `t_s(k)` seconds after the trajectory's start, which travels beside it.
struct Trajectory {
  Eigen::VectorXd t_s;  ///< [s] shape K >= 1, rising by >= kLeastInterval_s, from the start
  Eigen::MatrixXd q;    ///< n x K
  Eigen::MatrixXd v;    ///< n x K

  int num_states() const { return static_cast<int>(t_s.size()); }
  int num_joints() const { return static_cast<int>(q.rows()); }
};

/// @throws std::invalid_argument if shapes disagree, a number is not finite, times do not increase
/// by kLeastInterval_s at least, or an acceleration in between is not finite.
void CheckTrajectory(const Trajectory& trajectory);

/// The point `offset` after the start. Before the first state and after the last one the motion
/// rests: that state's position, zero velocity and acceleration. At an inner support state the
/// acceleration is that of the interval which begins there.
TrajectoryPoint Sample(const Trajectory& trajectory, HorizonOffset offset);

/// The same, bit for bit, into vectors of shape n that are there already: allocates nothing.
void SampleInto(const Trajectory& trajectory, HorizonOffset offset, Eigen::Ref<Eigen::VectorXd> q,
                Eigen::Ref<Eigen::VectorXd> v, Eigen::Ref<Eigen::VectorXd> a) noexcept;

}  // namespace sidestep
