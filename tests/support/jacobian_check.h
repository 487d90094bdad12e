#pragma once

#include <ceres/cost_function.h>
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

namespace sidestep {

/// Expects the analytic Jacobian of `cost` to agree with Ridders' differences at `blocks`, and that
/// the point is no idle one: every parameter block matters there.
inline void ExpectJacobianMatchesDifferences(const ceres::CostFunction& cost,
                                             const std::vector<Eigen::VectorXd>& blocks,
                                             double tolerance = 1e-6) {
  ceres::NumericDiffOptions options;
  options.ridders_relative_initial_step_size = 1e-4;  // The default, 0.01 rad, leaps over seams.
  const std::vector<const ceres::Manifold*>* const kEuclidean = nullptr;
  const ceres::GradientChecker checker(&cost, kEuclidean, options);
  std::vector<const double*> pointers;
  for (const Eigen::VectorXd& block : blocks) pointers.push_back(block.data());
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(pointers.data(), tolerance, &results)) << results.error_log;
  for (const auto& jacobian : results.jacobians) {
    EXPECT_GT(jacobian.cwiseAbs().maxCoeff(), 0) << "the cost is idle at this point";
  }
}

}  // namespace sidestep
