#pragma once

#include <Eigen/Core>

#include "sidestep/core/trajectory.h"

namespace sidestep::planner {

/// The constant-velocity Gaussian process behind every trajectory: acceleration is white noise of
/// power spectral density Qc = qc I. All joints are alike and independent, so each matrix here is
/// that of one joint's (position, velocity); the whole one is its Kronecker product with I_n.
/// Source: Mukadam et al., "Continuous-time Gaussian process motion planning via probabilistic
/// inference", IJRR 37(11):1319-1340, 2018, section 4.

/// Phi(dt): takes (q, v) to dt later under no acceleration.
Eigen::Matrix2d GpTransition(double dt_s);

/// Q(dt): covariance of (q, v) after dt, given the state before.
Eigen::Matrix2d GpCovariance(double dt_s, double qc);

/// Q(dt)^-1, in closed form.
Eigen::Matrix2d GpInformation(double dt_s, double qc);

/// The upper triangular W with W^T W = Q(dt)^-1: W (Phi x0 - x1) is the whitened residual of an
/// interval, in closed form.
Eigen::Matrix2d GpWhitening(double dt_s, double qc);

/// The mean state between two support states: x(tau) = Lambda x0 + Psi x1. It does not depend on
/// qc; its top rows are the cubic Hermite polynomial.
struct GpInterpolation {
  Eigen::Matrix2d Lambda;
  Eigen::Matrix2d Psi;
};
/// @param dt_s the interval; @param tau_s time since its begin, in [0, dt_s].
GpInterpolation InterpolateGp(double dt_s, double tau_s);

/// Half the sum over the intervals of r^T Q^-1 r with r = Phi x_k - x_{k+1}: how far the motion is
/// from constant velocity; 0 is the smoothest. Also a metric of an executed motion, sampled at
/// 0.1 s. Start and goal priors are not in it. 0 for a single state.
double ComputeGpCost(const Trajectory& trajectory, double qc);

}  // namespace sidestep::planner
