#include "sidestep/core/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

#include "sidestep/core/random.h"

namespace sidestep::trajectory_test {
namespace {

Eigen::VectorXd Vector(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<int>(values.size()));
}

// Three joints, uneven steps, not starting at zero.
Trajectory RandomTrajectory() {
  RandomStream random(7, "states");
  Trajectory trajectory;
  trajectory.t_s = Vector({0.2, 0.5, 0.6, 1.3, 2.0});
  trajectory.q = Eigen::MatrixXd::NullaryExpr(3, 5, [&]() { return random.Uniform(-1, 1); });
  trajectory.v = Eigen::MatrixXd::NullaryExpr(3, 5, [&]() { return random.Uniform(-1, 1); });
  return trajectory;
}

TEST(Trajectory, PassesThroughItsSupportStates) {
  const Trajectory trajectory = RandomTrajectory();
  for (int k = 0; k + 1 < trajectory.num_states(); ++k) {
    const TrajectoryPoint point = Sample(trajectory, HorizonOffset(trajectory.t_s(k)));
    EXPECT_LT((point.q - trajectory.q.col(k)).norm(), 1e-15) << k;
    EXPECT_LT((point.v - trajectory.v.col(k)).norm(), 1e-15) << k;
  }
}

TEST(Trajectory, HasTheDerivativesOfItsPosition) {
  const Trajectory trajectory = RandomTrajectory();
  const double step = 1e-5;
  for (const double t : {0.21, 0.35, 0.49, 0.55, 0.9, 1.29, 1.31, 1.7, 1.99}) {
    const TrajectoryPoint before = Sample(trajectory, HorizonOffset(t - step));
    const TrajectoryPoint here = Sample(trajectory, HorizonOffset(t));
    const TrajectoryPoint after = Sample(trajectory, HorizonOffset(t + step));
    // A cubic's central difference errs by step^2 q''' / 6, which is below 1e-7 here.
    EXPECT_LT((here.v - (after.q - before.q) / (2 * step)).norm(), 1e-6) << t;
    EXPECT_LT((here.a - (after.v - before.v) / (2 * step)).norm(), 1e-6) << t;
  }
}

TEST(Trajectory, ReproducesACubicExactly) {
  const auto q = [](double t) { return 1 - 2 * t + 0.5 * t * t + 0.25 * t * t * t; };
  const auto v = [](double t) { return -2 + t + 0.75 * t * t; };
  const auto a = [](double t) { return 1 + 1.5 * t; };
  Trajectory trajectory;
  trajectory.t_s = Vector({0, 0.7, 2});
  trajectory.q = trajectory.t_s.unaryExpr(q).transpose();
  trajectory.v = trajectory.t_s.unaryExpr(v).transpose();
  for (double t = 0; t < 2; t += 0.05) {
    const TrajectoryPoint point = Sample(trajectory, HorizonOffset(t));
    EXPECT_NEAR(point.q(0), q(t), 1e-13) << t;
    EXPECT_NEAR(point.v(0), v(t), 1e-13) << t;
    EXPECT_NEAR(point.a(0), a(t), 1e-12) << t;
  }
}

TEST(Trajectory, IsContinuousInPositionAndVelocityAcrossSupportStates) {
  const Trajectory trajectory = RandomTrajectory();
  const double tiny = 1e-9;
  for (int k = 1; k + 1 < trajectory.num_states(); ++k) {
    const double t = trajectory.t_s(k);
    const TrajectoryPoint before = Sample(trajectory, HorizonOffset(t - tiny));
    const TrajectoryPoint after = Sample(trajectory, HorizonOffset(t + tiny));
    EXPECT_LT((after.q - before.q).norm(), 1e-7) << k;
    EXPECT_LT((after.v - before.v).norm(), 1e-5) << k;
  }
}

TEST(Trajectory, TakesTheAccelerationOfTheIntervalThatBeginsAtASupportState) {
  const Trajectory trajectory = RandomTrajectory();
  for (int k = 0; k + 1 < trajectory.num_states(); ++k) {
    const double t = trajectory.t_s(k);
    const TrajectoryPoint at = Sample(trajectory, HorizonOffset(t));
    const TrajectoryPoint after = Sample(trajectory, HorizonOffset(t + 1e-9));
    EXPECT_LT((at.a - after.a).norm(), 1e-4) << k;
  }
}

TEST(Trajectory, RestsBeforeItsFirstStateAndFromItsLastOn) {
  const Trajectory trajectory = RandomTrajectory();
  struct Case {
    double t;
    int state;
  };
  for (const Case& c : {Case{-5, 0}, Case{std::nextafter(0.2, 0.0), 0}, Case{2.0, 4}, Case{9, 4}}) {
    const TrajectoryPoint point = Sample(trajectory, HorizonOffset(c.t));
    EXPECT_EQ(point.q, trajectory.q.col(c.state)) << c.t;
    EXPECT_EQ(point.v, Eigen::VectorXd::Zero(3)) << c.t;
    EXPECT_EQ(point.a, Eigen::VectorXd::Zero(3)) << c.t;
  }
}

TEST(Trajectory, OfOneStateRestsThere) {
  const Trajectory trajectory = {Vector({0}), Vector({0.4}), Vector({3})};
  CheckTrajectory(trajectory);
  for (const double t : {-1.0, 0.0, 1.0}) {
    const TrajectoryPoint point = Sample(trajectory, HorizonOffset(t));
    EXPECT_EQ(point.q(0), 0.4);
    EXPECT_EQ(point.v(0), 0);
  }
}

TEST(Trajectory, OfTheLeastIntervalHasFiniteAccelerations) {
  Trajectory trajectory = RandomTrajectory();
  trajectory.t_s = Eigen::VectorXd::LinSpaced(5, 0, 4) * (1.001 * kLeastInterval_s);
  ASSERT_NO_THROW(CheckTrajectory(trajectory));
  for (const double share : {0.0, 0.3, 1.0, 3.9}) {
    const TrajectoryPoint point = Sample(trajectory, HorizonOffset(share * kLeastInterval_s));
    EXPECT_TRUE(point.q.allFinite() && point.v.allFinite() && point.a.allFinite()) << share;
  }
}

struct Fault {
  std::string name;
  std::function<void(Trajectory&)> make;
};
std::ostream& operator<<(std::ostream& stream, const Fault& fault) { return stream << fault.name; }

class FaultyTrajectory : public ::testing::TestWithParam<Fault> {};

TEST_P(FaultyTrajectory, IsRefused) {
  Trajectory trajectory = RandomTrajectory();
  ASSERT_NO_THROW(CheckTrajectory(trajectory));
  GetParam().make(trajectory);
  EXPECT_THROW(CheckTrajectory(trajectory), std::invalid_argument);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(
    Kinds, FaultyTrajectory,
    ::testing::Values(
        Fault{"Empty", [](Trajectory& x) { x = Trajectory(); }},
        Fault{"NoJoints", [](Trajectory& x) { x.q.resize(0, 5), x.v.resize(0, 5); }},
        Fault{"FewerPositionsThanTimes", [](Trajectory& x) { x.q.conservativeResize(3, 4); }},
        Fault{"FewerVelocitiesThanTimes", [](Trajectory& x) { x.v.conservativeResize(3, 4); }},
        Fault{"FewerJointsInVelocity", [](Trajectory& x) { x.v.conservativeResize(2, 5); }},
        Fault{"EqualTimes", [](Trajectory& x) { x.t_s(2) = x.t_s(1); }},
        Fault{"DecreasingTimes", [](Trajectory& x) { x.t_s(4) = 0; }},
        Fault{"TimesThatDifferByNothingWorthIt",
              [](Trajectory& x) {
                x.t_s = Vector({0, 1e-200, 2e-200, 1, 2});
              }},
        Fault{"TimesJustTooNear",
              [](Trajectory& x) { x.t_s(2) = x.t_s(1) + 0.99 * kLeastInterval_s; }},
        Fault{"AccelerationBeyondAllNumbers", [](Trajectory& x) { x.q(1, 2) = 1e307; }},
        Fault{"TimeIsNan", [](Trajectory& x) { x.t_s(1) = kNan; }},
        Fault{"TimeIsInfinite", [](Trajectory& x) { x.t_s(4) = kInf; }},
        Fault{"PositionIsNan", [](Trajectory& x) { x.q(2, 3) = kNan; }},
        Fault{"VelocityIsInfinite", [](Trajectory& x) { x.v(0, 0) = -kInf; }}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep::trajectory_test
