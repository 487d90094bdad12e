// What filters state of their own error, held against errors that are drawn by the same rules, and
// against the centroids of voxels.
#include "sidestep/sdf/prediction/motion_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/sdf/prediction/kalman_ca.h"
#include "sidestep/sdf/prediction/kalman_cv.h"
#include "sidestep/sdf/prediction/kalman_turn.h"
#include "sidestep/sdf/prediction/registry.h"

namespace sidestep::sdf::motion_filter_test {
namespace {

constexpr double kRate_hz = 30, kSigma_m = 0.01;
constexpr int kNumSightings = 31, kNumRuns = 400;

struct Model {
  const char* predictor;
  MotionModel model;
  double consistent_for_s;  // how far ahead it knows how wrong it is
};
std::ostream& operator<<(std::ostream& stream, const Model& m) { return stream << m.predictor; }
const Model kModels[] = {{"kalman_cv", kConstantVelocity, 2},
                         {"kalman_ca", kConstantAcceleration, 2},
                         // Later, the angle turned is too uncertain for a linear rule.
                         {"kalman_turn", kCoordinatedTurn, 1}};

// Of a covariance that may be singular.
MotionVector Normal(const MotionMatrix& covariance, RandomStream& random) {
  const Eigen::LDLT<MotionMatrix> factors(covariance);
  MotionVector z;
  for (int i = 0; i < kMotionDims; ++i)
    z(i) = random.Normal() * std::sqrt(std::max(0.0, factors.vectorD()(i)));
  return factors.transpositionsP().transpose() * MotionVector(factors.matrixL() * z);
}

MotionVector DrawFirst(const MotionModel& model, RandomStream& random) {
  MotionFilter prior(model, {EpisodeTime(0), Eigen::Vector3d::Zero(), Isotropic(kSigma_m)});
  MotionVector x = Normal(prior.estimate().P, random);
  x.head<3>().setZero();
  // What the model forgets does not move it.
  return model.move(x, 0, nullptr);
}

MotionVector Step(const MotionModel& model, const MotionVector& x, double dt_s,
                  RandomStream& random) {
  return model.move(model.move(x, dt_s, nullptr) + Normal(model.noise(dt_s), random), 0, nullptr);
}

Sighting See(double t_s, const MotionVector& x, RandomStream& random) {
  const Eigen::Vector3d noise{random.Normal(), random.Normal(), random.Normal()};
  return {EpisodeTime(t_s), x.head<3>() + kSigma_m * noise, Isotropic(kSigma_m)};
}

double Squared(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  return error.dot(covariance.inverse() * error);
}

class Consistency : public ::testing::TestWithParam<Model> {};

// The mean of chi^2 with 3 degrees of freedom is 3 and its variance 6.
TEST_P(Consistency, InnovationsAreAsLargeAsStated) {
  RandomStream random(1, "motion");
  double sum = 0;
  int count = 0;
  for (int run = 0; run < kNumRuns; ++run) {
    MotionVector x = DrawFirst(GetParam().model, random);
    MotionFilter filter(GetParam().model, See(0, x, random));
    for (int n = 1; n < kNumSightings; ++n) {
      x = Step(GetParam().model, x, 1 / kRate_hz, random);
      const Innovation innovation = filter.Update(See(n / kRate_hz, x, random));
      sum += Squared(innovation.residual_m, innovation.S_m2);
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 3, 4 * std::sqrt(6.0 / count));
}

TEST_P(Consistency, PredictionErrorsAreAsLargeAsStated) {
  const auto predictor = MakePredictor(GetParam().predictor);
  for (const double ahead_s : {0.0, 0.1, 0.3, 0.5, 1.0, 2.0}) {
    if (ahead_s > GetParam().consistent_for_s) break;
    RandomStream random(2, "motion");
    double sum = 0;
    for (int run = 0; run < kNumRuns; ++run) {
      MotionVector x = DrawFirst(GetParam().model, random);
      TrackedObject object;
      for (int n = 0; n < kNumSightings; ++n) {
        if (n > 0) x = Step(GetParam().model, x, 1 / kRate_hz, random);
        object.history.push_back(See(n / kRate_hz, x, random));
      }
      for (int n = 0; n < 60 * ahead_s; ++n) x = Step(GetParam().model, x, 1 / 60.0, random);
      const EpisodeTime then = object.latest().t + HorizonOffset(ahead_s);
      const PredictedMotion motion = predictor->Predict(object);
      sum += Squared(motion.X_WO(then).translation() - x.head<3>(), motion.covariance_m2(then));
    }
    EXPECT_NEAR(sum / kNumRuns, 3, 4 * std::sqrt(6.0 / kNumRuns)) << ahead_s << " s ahead";
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Consistency, ::testing::ValuesIn(kModels),
                         [](const auto& test) { return std::string(test.param.predictor); });

class EveryModel : public ::testing::TestWithParam<Model> {};

TEST_P(EveryModel, HasTheJacobianOfItsMotion) {
  RandomStream random(3, "motion");
  for (const double rate : {0.0, 1e-6, 1e-3, 0.7, -1.5}) {
    MotionVector x = Normal(MotionMatrix::Identity(), random);
    x(kTurn) = rate;
    for (const double dt_s : {1 / kRate_hz, 0.5, -0.3}) {
      MotionMatrix F;
      GetParam().model.move(x, dt_s, &F);
      for (int i = 0; i < kMotionDims; ++i) {
        const MotionVector step = 1e-6 * MotionVector::Unit(i);
        const MotionVector slope = (GetParam().model.move(x + step, dt_s, nullptr) -
                                    GetParam().model.move(x - step, dt_s, nullptr)) /
                                   2e-6;
        EXPECT_LT((F.col(i) - slope).norm(), 1e-6) << "part " << i << ", turning at " << rate;
      }
    }
  }
}

TEST_P(EveryModel, MovesTwiceHalfAsLongToTheSamePlace) {
  RandomStream random(4, "motion");
  MotionVector x = Normal(MotionMatrix::Identity(), random);
  const MotionVector once = GetParam().model.move(x, 0.8, nullptr);
  const MotionVector twice =
      GetParam().model.move(GetParam().model.move(x, 0.4, nullptr), 0.4, nullptr);
  EXPECT_LT((once - twice).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Models, EveryModel, ::testing::ValuesIn(kModels),
                         [](const auto& test) { return std::string(test.param.predictor); });

// Where the cells' centroid is when a box this long stands at y.
double VoxelCentroid(double y, double length_m, double cell_m) {
  const double first = std::ceil((y - length_m / 2) / cell_m);
  const double last = std::ceil((y + length_m / 2) / cell_m) - 1;
  return cell_m * (first + last) / 2;
}

// Root mean square of the error along a walkway, `ahead_s` after 0.3 to 1 s of sightings as voxels.
double VoxelError(const std::string& predictor, double ahead_s,
                  const std::function<Eigen::Vector3d(double)>& path) {
  const auto predict = MakePredictor(predictor);
  constexpr double kCell_m = 0.04;
  const Eigen::Vector3d size_m(0.48, 0.55, 1.2);
  double sum = 0;
  int count = 0;
  for (int phase = 0; phase < 10; ++phase) {
    TrackedObject object;
    for (int n = 0; n <= 30; ++n) {
      const Eigen::Vector3d p = path(n / kRate_hz) + Eigen::Vector3d::Constant(0.004 * phase);
      Eigen::Vector3d seen;
      for (int i = 0; i < 3; ++i) seen(i) = VoxelCentroid(p(i), size_m(i), kCell_m);
      object.history.push_back(
          {EpisodeTime(n / kRate_hz), seen, Isotropic(kCell_m / std::sqrt(12.0))});
      if (n < 9) continue;
      const Eigen::Vector3d then =
          path(n / kRate_hz + ahead_s) + Eigen::Vector3d::Constant(0.004 * phase);
      const Pose X_WO = predict->PredictPose(object, object.latest().t + HorizonOffset(ahead_s));
      sum += (X_WO.translation() - then).squaredNorm();
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

TEST(VoxelCentroids, CostTwoFramesMoreThanAFilter) {
  for (const double speed : {0.7, 1.0, 1.1, 1.3, 1.4, 1.7, 1.9}) {
    const auto line = [&](double t_s) { return Eigen::Vector3d(0.4, 2 - speed * t_s, 0.6); };
    const double two_frame_m = VoxelError("two_frame", 1, line);
    const double filtered_m = VoxelError("kalman_cv", 1, line);
    RecordProperty("two_frame_" + std::to_string(speed), std::to_string(two_frame_m));
    RecordProperty("kalman_cv_" + std::to_string(speed), std::to_string(filtered_m));
    EXPECT_LT(filtered_m, 0.75 * two_frame_m) << speed << " m/s";
  }
}

TEST(VoxelCentroids, ACoordinatedTurnIsFollowedBestByTheFilterThatTurns) {
  const auto circle = [](double t_s) {
    return Eigen::Vector3d(0.6 * std::cos(2 * t_s), 0.6 * std::sin(2 * t_s), 0.6);
  };
  EXPECT_LT(VoxelError("kalman_turn", 0.5, circle), 0.6 * VoxelError("kalman_cv", 0.5, circle));
  EXPECT_LT(VoxelError("imm", 0.5, circle), 0.8 * VoxelError("kalman_cv", 0.5, circle));
}

TEST(VoxelCentroids, BrakingIsFollowedBestByTheFilterThatAccelerates) {
  const auto braking = [](double t_s) {
    return Eigen::Vector3d(0.4, 2 - 2 * 2.0 * t_s + t_s * t_s, 0.6);
  };
  EXPECT_LT(VoxelError("kalman_ca", 0.5, braking), 0.8 * VoxelError("kalman_cv", 0.5, braking));
}

// An object that changes between the three models as the filter expects it to. The mean over models
// is only roughly consistent: the branches of the past are merged at each step.
TEST(Imm, KnowsRoughlyHowWrongItIs) {
  const auto predictor = MakePredictor("imm");
  for (const double ahead_s : {0.0, 0.1, 0.3}) {
    RandomStream random(5, "motion");
    double sum = 0;
    for (int run = 0; run < kNumRuns; ++run) {
      std::size_t active = static_cast<std::size_t>(run) % std::size(kModels);
      MotionVector x = DrawFirst(kModels[active].model, random);
      TrackedObject object;
      const auto step = [&] {
        if (random.Uniform() < 1 - std::exp(-1 / kRate_hz)) {
          active = (active + (random.Uniform() < 0.5 ? 1 : 2)) % std::size(kModels);
          const MotionVector fresh = DrawFirst(kModels[active].model, random);
          x.tail<4>() = fresh.tail<4>();
        }
        x = Step(kModels[active].model, x, 1 / kRate_hz, random);
      };
      for (int n = 0; n < kNumSightings; ++n) {
        if (n > 0) step();
        object.history.push_back(See(n / kRate_hz, x, random));
      }
      for (int n = 0; n < std::lround(kRate_hz * ahead_s); ++n) step();
      const EpisodeTime then = object.latest().t + HorizonOffset(ahead_s);
      const PredictedMotion motion = predictor->Predict(object);
      sum += Squared(motion.X_WO(then).translation() - x.head<3>(), motion.covariance_m2(then));
    }
    EXPECT_GT(sum / kNumRuns, 2) << ahead_s << " s ahead";
    EXPECT_LT(sum / kNumRuns, 4.5) << ahead_s << " s ahead";
  }
}

TEST(Imm, IsNearlyAsGoodAsTheFilterWhoseMotionItSees) {
  const auto line = [](double t_s) { return Eigen::Vector3d(0.4, 2 - 1.4 * t_s, 0.6); };
  EXPECT_LT(VoxelError("imm", 0.5, line), 1.5 * VoxelError("kalman_cv", 0.5, line));
}

}  // namespace
}  // namespace sidestep::sdf::motion_filter_test
