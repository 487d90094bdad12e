#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::planner {

// What the costs that treat joints apart say of one joint in one interval, whose x is (q, v) at its
// begin and (q, v) at its end.

/// The GP prior (gp_prior_cost.h).
class GpInterval {
 public:
  GpInterval(double dt_s, double qc) : dt_s_(dt_s), information_(GpInformation(dt_s, qc)) {
    Eigen::Matrix<double, 2, 4> dr_dx;
    dr_dx << GpTransition(dt_s), -Eigen::Matrix2d::Identity();
    hessian_ = dr_dx.transpose() * information_ * dr_dx;
  }

  /// @return the cost.
  double At(const std::array<double, 4>& x, std::array<double, 4>& gradient) const {
    const double r_q = x[0] + dt_s_ * x[1] - x[2], r_v = x[1] - x[3];
    const double w_q = information_(0, 0) * r_q + information_(0, 1) * r_v;
    const double w_v = information_(1, 0) * r_q + information_(1, 1) * r_v;
    gradient = {w_q, dt_s_ * w_q + w_v, -w_q, -w_v};
    return 0.5 * (r_q * w_q + r_v * w_v);
  }

  const Eigen::Matrix4d& hessian() const { return hessian_; }

 private:
  double dt_s_;
  Eigen::Matrix2d information_;
  Eigen::Matrix4d hessian_;
};

/// A residual that is 0 within a limit, and its slope in x beyond.
struct LimitTerm {
  double residual = 0;
  std::array<double, 4> slope{};
};
/// weight max(0, |share^T x| - limit).
inline LimitTerm LimitOf(const std::array<double, 4>& share, double limit, double weight,
                         const std::array<double, 4>& x) {
  const double value = (share[0] * x[0] + share[1] * x[1]) + (share[2] * x[2] + share[3] * x[3]);
  const double excess = std::abs(value) - limit;
  if (!(excess > 0)) return {};
  LimitTerm term{weight * excess, {}};
  for (std::size_t a = 0; a < 4; ++a) term.slope[a] = std::copysign(weight, value) * share[a];
  return term;
}

/// mid_velocity_limit_cost.h
inline LimitTerm MidVelocityLimit(double dt_s, double v_max, double weight,
                                  const std::array<double, 4>& x) {
  return LimitOf({-1.5 / dt_s, -0.25, 1.5 / dt_s, -0.25}, v_max, weight, x);
}

/// acceleration_limit_cost.h
inline LimitTerm AccelerationLimitAtBegin(double dt_s, double a_max, double weight,
                                          const std::array<double, 4>& x) {
  const double position = 6 / (dt_s * dt_s);
  return LimitOf({-position, -4 / dt_s, position, -2 / dt_s}, a_max, weight, x);
}
inline LimitTerm AccelerationLimitAtEnd(double dt_s, double a_max, double weight,
                                        const std::array<double, 4>& x) {
  const double position = 6 / (dt_s * dt_s);
  return LimitOf({position, 2 / dt_s, -position, 4 / dt_s}, a_max, weight, x);
}

}  // namespace sidestep::planner
