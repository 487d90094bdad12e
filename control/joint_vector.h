#pragma once

#include <Eigen/Core>

namespace sidestep::control {

/// The control path handles at most so many joints: its vectors then need no memory from the heap.
inline constexpr int kMaxJoints = 16;

/// One number a joint, of shape n <= kMaxJoints, held in place.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;

/// The motion of all joints at one tick: rad, rad/s, rad/s^2 (m for a slider).
struct JointPoint {
  JointVector q, v, a;
};

/// At rest at `q`.
inline JointPoint RestAt(const JointVector& q) {
  return {q, JointVector::Zero(q.size()), JointVector::Zero(q.size())};
}

}  // namespace sidestep::control
