#include "sidestep/planner/gp_trajectory.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace sidestep::planner::gp_trajectory_test {
namespace {

class GpOfInterval : public ::testing::TestWithParam<double> {};

TEST_P(GpOfInterval, InformationIsTheInverseOfTheCovariance) {
  const double dt = GetParam(), qc = 2.5;
  const Eigen::Matrix2d product = GpCovariance(dt, qc) * GpInformation(dt, qc);
  EXPECT_LT((product - Eigen::Matrix2d::Identity()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(GpOfInterval, CovarianceIsTheIntegralOfTheDrivenNoise) {
  // Q = integral of Phi(s) [0; 1] qc [0; 1]^T Phi(s)^T ds; Simpson's rule is exact for quadratics.
  const double dt = GetParam(), qc = 2.5;
  const auto integrand = [qc](double s) -> Eigen::Matrix2d {
    const Eigen::Vector2d effect = GpTransition(s).col(1);
    return qc * effect * effect.transpose();
  };
  const Eigen::Matrix2d integral = dt / 6 * (integrand(0) + 4 * integrand(dt / 2) + integrand(dt));
  EXPECT_LT((GpCovariance(dt, qc) - integral).cwiseAbs().maxCoeff(), 1e-15);
}

TEST_P(GpOfInterval, WhiteningIsTheCholeskyFactorOfTheInformation) {
  const double dt = GetParam(), qc = 2.5;
  const Eigen::Matrix2d W = GpWhitening(dt, qc);
  const Eigen::Matrix2d expected = GpInformation(dt, qc).llt().matrixU();
  EXPECT_LT((W - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.cwiseAbs().maxCoeff());
  EXPECT_EQ(W(1, 0), 0);
}

TEST_P(GpOfInterval, InterpolationIsTheCubicOfTheTrajectory) {
  const double dt = GetParam();
  Trajectory trajectory{Eigen::Vector2d(0, dt), Eigen::RowVector2d(0.3, -0.8),
                        Eigen::RowVector2d(1.1, -0.4)};
  for (const double share : {0.0, 0.1, 0.5, 0.9, 0.999}) {
    const GpInterpolation gp = InterpolateGp(dt, share * dt);
    const Eigen::Vector2d state =
        gp.Lambda * Eigen::Vector2d(0.3, 1.1) + gp.Psi * Eigen::Vector2d(-0.8, -0.4);
    const TrajectoryPoint cubic = Sample(trajectory, HorizonOffset(share * dt));
    EXPECT_NEAR(state(0), cubic.q(0), 1e-12);
    EXPECT_NEAR(state(1), cubic.v(0), 1e-11 / dt);
  }
}

INSTANTIATE_TEST_SUITE_P(Lengths, GpOfInterval, ::testing::Values(0.02, 0.1, 1.0, 3.0));

TEST(GpCost, IsZeroForConstantVelocity) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(11, 0, 1);
  const Trajectory trajectory{t, t.transpose() * 0.7, Eigen::RowVectorXd::Constant(11, 0.7)};
  EXPECT_NEAR(ComputeGpCost(trajectory, 1), 0, 1e-24);
}

TEST(GpCost, IsHalfTheIntegralOfTheSquaredAccelerationOfTheCubics) {
  // The mean of this process minimises that integral, so its GP cost equals it.
  const Trajectory trajectory{Eigen::Vector3d(0, 0.1, 0.4),
                              (Eigen::MatrixXd(2, 3) << 0, 0.2, 0.1, 1, 1.1, 1.4).finished(),
                              (Eigen::MatrixXd(2, 3) << 0, 1, -1, 0.5, 0.5, 0).finished()};
  double integral = 0;
  for (int k = 0; k < 2; ++k) {
    const double begin = trajectory.t_s(k), dt = trajectory.t_s(k + 1) - begin;
    const auto squared_a = [&](double share) {
      return Sample(trajectory, HorizonOffset(begin + share * dt)).a.squaredNorm();
    };
    // The acceleration is linear, so Simpson's rule is exact; the right end belongs to the next.
    const Eigen::VectorXd a0 = Sample(trajectory, HorizonOffset(begin)).a;
    const Eigen::VectorXd a_half = Sample(trajectory, HorizonOffset(begin + dt / 2)).a;
    const Eigen::VectorXd a1 = 2 * a_half - a0;
    integral += dt / 6 * (squared_a(0) + 4 * squared_a(0.5) + a1.squaredNorm());
  }
  const double qc = 2;
  EXPECT_NEAR(ComputeGpCost(trajectory, qc), 0.5 * integral / qc, 1e-12 * integral);
}

TEST(GpCost, OfASingleStateIsZero) {
  const Trajectory trajectory{Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Ones(3, 1),
                              Eigen::MatrixXd::Ones(3, 1)};
  EXPECT_EQ(ComputeGpCost(trajectory, 1), 0);
}

}  // namespace
}  // namespace sidestep::planner::gp_trajectory_test
