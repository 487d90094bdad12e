#include "sidestep/core/trajectory.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace sidestep {

void CheckTrajectory(const Trajectory& trajectory) {
  const Eigen::Index K = trajectory.t_s.size();
  if (K < 1 || trajectory.q.rows() < 1 || trajectory.q.cols() != K || trajectory.v.cols() != K ||
      trajectory.v.rows() != trajectory.q.rows()) {
    throw std::invalid_argument("trajectory: t_s must be K >= 1 long, q and v n x K");
  }
  if (!trajectory.t_s.allFinite() || !trajectory.q.allFinite() || !trajectory.v.allFinite()) {
    throw std::invalid_argument("trajectory: every number must be finite");
  }
  for (Eigen::Index k = 1; k < K; ++k) {
    if (!(trajectory.t_s(k) > trajectory.t_s(k - 1))) {
      throw std::invalid_argument("trajectory: times must increase strictly");
    }
    const double h = trajectory.t_s(k) - trajectory.t_s(k - 1);
    if (h < kLeastInterval_s) {
      throw std::invalid_argument("trajectory: states must be at least 1e-6 s apart");
    }
    // What lies between two states is bounded by what it is at them.
    const auto v0 = trajectory.v.col(k - 1), v1 = trajectory.v.col(k);
    const auto turn = 6 / (h * h) * (trajectory.q.col(k) - trajectory.q.col(k - 1));
    if (!(turn - (4 * v0 + 2 * v1) / h).allFinite() ||
        !((2 * v0 + 4 * v1) / h - turn).allFinite()) {
      throw std::invalid_argument("trajectory: every acceleration must be finite, not so after " +
                                  std::to_string(trajectory.t_s(k - 1)) + " s");
    }
  }
}

void SampleInto(const Trajectory& trajectory, HorizonOffset offset, Eigen::Ref<Eigen::VectorXd> q,
                Eigen::Ref<Eigen::VectorXd> v, Eigen::Ref<Eigen::VectorXd> a) noexcept {
  const int last = trajectory.num_states() - 1;
  const double t = offset.seconds();
  if (t < trajectory.t_s(0) || t >= trajectory.t_s(last)) {
    q = trajectory.q.col(t < trajectory.t_s(0) ? 0 : last);
    v.setZero();
    a.setZero();
    return;
  }
  const double* const begin = trajectory.t_s.data();
  const int k = static_cast<int>(std::upper_bound(begin, begin + last + 1, t) - begin) - 1;
  const double h = trajectory.t_s(k + 1) - trajectory.t_s(k);
  const double s = (t - trajectory.t_s(k)) / h;
  const auto q0 = trajectory.q.col(k), q1 = trajectory.q.col(k + 1);
  const auto v0 = trajectory.v.col(k), v1 = trajectory.v.col(k + 1);
  // The Hermite basis, and its first and second derivatives in s.
  const double s2 = s * s, s3 = s2 * s;
  q = (1 - 3 * s2 + 2 * s3) * q0 + h * (s - 2 * s2 + s3) * v0 + (3 * s2 - 2 * s3) * q1 +
      h * (s3 - s2) * v1;
  v = (6 * s2 - 6 * s) / h * (q0 - q1) + (1 - 4 * s + 3 * s2) * v0 + (3 * s2 - 2 * s) * v1;
  a = (12 * s - 6) / (h * h) * (q0 - q1) + (6 * s - 4) / h * v0 + (6 * s - 2) / h * v1;
}

TrajectoryPoint Sample(const Trajectory& trajectory, HorizonOffset offset) {
  const Eigen::Index n = trajectory.num_joints();
  TrajectoryPoint point{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  SampleInto(trajectory, offset, point.q, point.v, point.a);
  return point;
}

}  // namespace sidestep
