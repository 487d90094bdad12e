#pragma once

#include <Eigen/Core>
#include <cmath>

#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::planner {

/// A quadratic in one joint's (q, v) at the begin and (q, v) at the end of an interval: what the
/// costs that treat joints apart add up to.
struct JointQuadratic {
  double cost = 0;
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  Eigen::Matrix4d hessian = Eigen::Matrix4d::Zero();

  /// A residual and its slope.
  void Add(double residual, const Eigen::Vector4d& slope) {
    cost += 0.5 * residual * residual;
    gradient += residual * slope;
    hessian += slope * slope.transpose();
  }
};

/// The GP prior of an interval (gp_prior_cost.h), of one joint.
class GpInterval {
 public:
  GpInterval(double dt_s, double qc) : information_(GpInformation(dt_s, qc)) {
    dr_dx_ << GpTransition(dt_s), -Eigen::Matrix2d::Identity();
    hessian_ = dr_dx_.transpose() * information_ * dr_dx_;
  }

  /// At x = (q, v, q, v).
  JointQuadratic At(const Eigen::Vector4d& x) const {
    const Eigen::Vector2d r = dr_dx_ * x, weighted = information_ * r;
    return {0.5 * r.dot(weighted), dr_dx_.transpose() * weighted, hessian_};
  }

 private:
  Eigen::Matrix2d information_;
  Eigen::Matrix<double, 2, 4> dr_dx_;
  Eigen::Matrix4d hessian_;
};

/// Adds mid_velocity_limit_cost.h, of one joint.
inline void AddMidVelocityLimit(double dt_s, double v_max, double weight, const Eigen::Vector4d& x,
                                JointQuadratic& quadratic) {
  const Eigen::Vector4d slope(-1.5 / dt_s, -0.25, 1.5 / dt_s, -0.25);
  const double v = slope.dot(x), excess = std::abs(v) - v_max;
  if (excess > 0) quadratic.Add(weight * excess, std::copysign(weight, v) * slope);
}

/// Adds acceleration_limit_cost.h, of one joint.
inline void AddAccelerationLimit(double dt_s, double a_max, double weight, const Eigen::Vector4d& x,
                                 JointQuadratic& quadratic) {
  const double position = 6 / (dt_s * dt_s), near = 4 / dt_s, far = 2 / dt_s;
  for (const Eigen::Vector4d& slope : {Eigen::Vector4d(-position, -near, position, -far),
                                       Eigen::Vector4d(position, far, -position, near)}) {
    const double a = slope.dot(x), excess = std::abs(a) - a_max;
    if (excess > 0) quadratic.Add(weight * excess, std::copysign(weight, a) * slope);
  }
}

}  // namespace sidestep::planner
