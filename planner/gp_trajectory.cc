#include "sidestep/planner/gp_trajectory.h"

#include <cmath>

namespace sidestep::planner {

Eigen::Matrix2d GpTransition(double dt_s) {
  Eigen::Matrix2d Phi;
  Phi << 1, dt_s, 0, 1;
  return Phi;
}

Eigen::Matrix2d GpCovariance(double dt_s, double qc) {
  Eigen::Matrix2d Q;
  Q << dt_s * dt_s * dt_s / 3, dt_s * dt_s / 2, dt_s * dt_s / 2, dt_s;
  return qc * Q;
}

Eigen::Matrix2d GpInformation(double dt_s, double qc) {
  Eigen::Matrix2d information;
  information << 12 / (dt_s * dt_s * dt_s), -6 / (dt_s * dt_s), -6 / (dt_s * dt_s), 4 / dt_s;
  return information / qc;
}

Eigen::Matrix2d GpWhitening(double dt_s, double qc) {
  // The Cholesky factor of GpInformation; 4 / dt - (6 / dt^2)^2 dt^3 / 12 leaves 1 / dt.
  Eigen::Matrix2d W;
  W << std::sqrt(12 / dt_s) / dt_s, -std::sqrt(3 / dt_s), 0, std::sqrt(1 / dt_s);
  return W / std::sqrt(qc);
}

GpInterpolation InterpolateGp(double dt_s, double tau_s) {
  GpInterpolation result;
  result.Psi =
      GpCovariance(tau_s, 1) * GpTransition(dt_s - tau_s).transpose() * GpInformation(dt_s, 1);
  result.Lambda = GpTransition(tau_s) - result.Psi * GpTransition(dt_s);
  return result;
}

double ComputeGpCost(const Trajectory& trajectory, double qc) {
  double cost = 0;
  for (int k = 0; k + 1 < trajectory.num_states(); ++k) {
    const double dt = trajectory.t_s(k + 1) - trajectory.t_s(k);
    const Eigen::Matrix2d information = GpInformation(dt, qc);
    const Eigen::VectorXd r_q =
        trajectory.q.col(k) + dt * trajectory.v.col(k) - trajectory.q.col(k + 1);
    const Eigen::VectorXd r_v = trajectory.v.col(k) - trajectory.v.col(k + 1);
    cost += 0.5 * (information(0, 0) * r_q.squaredNorm() + 2 * information(0, 1) * r_q.dot(r_v) +
                   information(1, 1) * r_v.squaredNorm());
  }
  return cost;
}

}  // namespace sidestep::planner
