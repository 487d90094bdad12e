#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/sdf/prediction/registry.h"
#include "tests/support/random_points.h"

namespace sidestep::sdf::every_predictor_test {
namespace {

TrackedObject SeenAt(const std::vector<double>& times_s,
                     const std::function<Eigen::Vector3d(double)>& p_WO) {
  TrackedObject object;
  for (const double t_s : times_s) object.history.push_back({EpisodeTime(t_s), p_WO(t_s)});
  object.first_seen = object.history.front().t;
  return object;
}

std::vector<double> Frames(double first_s, int count, double rate_hz = 30) {
  std::vector<double> times_s;
  for (int n = 0; n < count; ++n) times_s.push_back(first_s + n / rate_hz);
  return times_s;
}

std::vector<TrackedObject> Objects() {
  RandomStream random(5, "jitter");
  const auto jitter = [&](double) { return UniformPoint(random, 0.02); };
  const auto line = [](double t_s) { return Eigen::Vector3d(0.4, 2 - 1.4 * t_s, 0.6); };
  return {SeenAt({0.0}, line), SeenAt(Frames(0, 2), line), SeenAt(Frames(1, 60), line),
          SeenAt(Frames(0.5, 40), jitter), SeenAt({1, 1 + 1e-6}, jitter)};
}

class EveryPredictor : public ::testing::TestWithParam<std::string> {
 protected:
  const std::unique_ptr<ObstaclePredictor> predictor_ = MakePredictor(GetParam());
};

TEST_P(EveryPredictor, AnswersThePoseThatWasSeenAtTheTimeOfTheLatestSighting) {
  for (const TrackedObject& object : Objects()) {
    const Pose X_WO = predictor_->PredictPose(object, object.latest().t);
    EXPECT_LT((X_WO.translation() - object.latest().p_WO).norm(), 1e-12);
    EXPECT_LT(X_WO.rotation().vec().norm(), 1e-12);
  }
}

// A history holds positions only; how a thing is turned is added to the answer by who knows it.
TEST_P(EveryPredictor, DoesNotTurnWhatGoesRoundACurve) {
  const TrackedObject object = SeenAt(Frames(0, 60), [](double t_s) {
    return Eigen::Vector3d(std::cos(1.2 * t_s), std::sin(1.2 * t_s), 0.6);
  });
  for (const double t_s : {0.0, 2.0, 3.5}) {
    EXPECT_EQ(predictor_->PredictPose(object, EpisodeTime(t_s)).rotation().vec(),
              Eigen::Vector3d(0, 0, 0));
  }
}

TEST_P(EveryPredictor, IsFiniteAndContinuousBeforeAndAfterThatTime) {
  constexpr double kStep_s = 1e-9;
  for (const TrackedObject& object : Objects()) {
    const PredictedMotion motion = predictor_->Predict(object);
    for (double t_s = -1; t_s < 10; t_s += 0.01) {
      const Pose now = motion.X_WO(EpisodeTime(t_s));
      const Pose next = motion.X_WO(EpisodeTime(t_s + kStep_s));
      ASSERT_TRUE(now.translation().allFinite());
      // Two sightings a microsecond apart make some 50 km/s: still no jump.
      ASSERT_LT((next.translation() - now.translation()).norm(), 1e-3);
    }
  }
}

TEST_P(EveryPredictor, IsAsSureAsTheSightingAtItsTimeAndNoSurerLater) {
  for (const TrackedObject& object : Objects()) {
    const PredictedMotion motion = predictor_->Predict(object);
    const double variance_m2 = object.latest().covariance_m2(0, 0);
    const Eigen::Matrix3d seen = motion.covariance_m2(object.latest().t);
    EXPECT_LT((seen - variance_m2 * Eigen::Matrix3d::Identity()).norm(), 1e-9 * variance_m2);
    double least_m2 = variance_m2;
    for (int i = 1; i <= 30; ++i) {
      const Eigen::Matrix3d later =
          motion.covariance_m2(object.latest().t + HorizonOffset(0.1 * i));
      ASSERT_TRUE(later.allFinite());
      EXPECT_LT((later - later.transpose()).norm(), 1e-9 * later.norm());
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(later);
      EXPECT_GE(axes.eigenvalues()(0), 0.99 * variance_m2);
      EXPECT_GE(later.trace(), 0.99 * 3 * least_m2);
      least_m2 = later.trace() / 3;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registered, EveryPredictor, ::testing::ValuesIn(PredictorNames()));

// It may have any speed: who asks, a second later, is told so.
TEST_P(EveryPredictor, IsNotSureThatWhatWasSeenOnceRests) {
  if (GetParam() == "stationary") return;  // it takes everything to rest
  const TrackedObject object = SeenAt({1.0}, [](double) { return Eigen::Vector3d(1, 2, 3); });
  const Eigen::Matrix3d later = predictor_->Predict(object).covariance_m2(EpisodeTime(2));
  for (int axis = 0; axis < 3; ++axis) EXPECT_GT(std::sqrt(later(axis, axis)), 1);
}

TEST(TwoFramePredictor, IsExactForConstantVelocity) {
  const auto line = [](double t_s) { return Eigen::Vector3d(0.4 + t_s, 2 - 1.4 * t_s, 0.6); };
  const auto predictor = MakePredictor("two_frame");
  for (const auto& times_s : {Frames(1, 60), Frames(0.2, 2), Frames(3, 4), Frames(0, 9, 10)}) {
    const TrackedObject object = SeenAt(times_s, line);
    for (const double t_s : {0.0, 1.5, 4.0}) {
      const Pose X_WO = predictor->PredictPose(object, EpisodeTime(t_s));
      EXPECT_LT((X_WO.translation() - line(t_s)).norm(), 1e-12);
    }
  }
}

// It asks for a moment of the episode. Taken for "so much ahead", the answer would be off by the
// time of the sighting.
TEST(TwoFramePredictor, TakesATimeOfTheEpisodeNotAnOffsetFromNow) {
  const TrackedObject object =
      SeenAt(Frames(2, 4), [](double t_s) { return Eigen::Vector3d(t_s, 0, 0); });
  const Pose X_WO = MakePredictor("two_frame")->PredictPose(object, EpisodeTime(2.5));
  EXPECT_NEAR(X_WO.translation().x(), 2.5, 1e-12);
}

TEST(TwoFramePredictor, MeasuresOverItsBaselineNotBetweenNeighbouringFrames) {
  // At rest but for the last frame, where the centroid jumps by half a 4 cm cell.
  TrackedObject object = SeenAt(Frames(0, 30), [](double) { return Eigen::Vector3d(0, 0, 0); });
  object.history.back().p_WO.x() = 0.02;
  EXPECT_NEAR(MeanVelocity(object.history, kVelocityBaseline).x(), 0.2, 1e-9);
}

TEST(TwoFramePredictor, StandsStillAfterASingleSighting) {
  const TrackedObject object = SeenAt({1}, [](double) { return Eigen::Vector3d(1, 2, 3); });
  const Pose X_WO = MakePredictor("two_frame")->PredictPose(object, EpisodeTime(5));
  EXPECT_EQ(X_WO.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(StationaryPredictor, StaysWhereTheObjectWasSeenLast) {
  const TrackedObject object =
      SeenAt(Frames(0, 30), [](double t_s) { return Eigen::Vector3d(t_s, 0, 0); });
  const Pose X_WO = MakePredictor("stationary")->PredictPose(object, EpisodeTime(5));
  EXPECT_EQ(X_WO.translation(), object.latest().p_WO);
}

TEST(PredictorRegistry, NamesWhatThereIsWhenItIsAskedForSomethingElse) {
  try {
    MakePredictor("crystal_ball");
    FAIL() << "was accepted";
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("crystal_ball"), std::string::npos);
    for (const std::string& name : PredictorNames()) {
      EXPECT_NE(what.find(name), std::string::npos) << name;
    }
  }
}

}  // namespace
}  // namespace sidestep::sdf::every_predictor_test
