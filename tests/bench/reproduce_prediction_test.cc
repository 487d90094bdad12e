// What the open-loop protocol believes under prediction, and what a motion truly clears.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sidestep/bench/reproduce/open_loop_study.h"
#include "sidestep/bench/reproduce/predicted_maps.h"
#include "sidestep/bench/reproduce/published_maps.h"
#include "sidestep/bench/reproduce/true_clearance.h"
#include "sidestep/core/random.h"

namespace sidestep::bench::reproduce_prediction_test {
namespace {

constexpr double kClamp_m = 0.42;
const std::string kModels = SIDESTEP_SOURCE_DIR "/models";
const std::string kScenarios = SIDESTEP_SOURCE_DIR "/scenarios";

// Points in a box around the Panda and the way of the HSR.
std::vector<Eigen::Vector3d> Points() {
  RandomStream random(7, "points");
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 3000; ++i) {
    const double x = random.Uniform(), y = random.Uniform(), z = random.Uniform();
    points.emplace_back(-0.5 + 1.6 * x, -0.9 + 3.0 * y, -0.3 + 1.8 * z);
  }
  return points;
}

struct World {
  explicit World(double speed) : speed_m_s(speed) { experiment.speeds_m_s = {speed}; }

  OpenLoopExperiment experiment = MakeOpenLoopExperiment("panda_hsr", kScenarios);
  double speed_m_s;
  PublishedMaps MakeMaps() const {
    return PublishedMaps(experiment, BoxAlignment::kOneCellLow, sdf::DistanceConvention::kBwdist,
                         1);
  }
  PredictedMaps MakePredictions(const PublishedMaps& maps) const {
    return PredictedMaps(experiment, maps, sdf::DistanceConvention::kBwdist, "two_frame", kClamp_m,
                         1);
  }
};

TEST(PredictedMaps, KnowOfNoMotionAtFirst) {
  const World world(1.4);
  const PublishedMaps maps = world.MakeMaps();
  const PredictedMaps predictions = world.MakePredictions(maps);
  const sdf::DistanceField& first = *maps.FieldsAt(1.4)[0];
  for (const Eigen::Vector3d& p_W : Points()) {
    const double expected = std::min(first.Sample(p_W, EpisodeTime()).distance_m, kClamp_m);
    EXPECT_EQ(predictions.At(1.4, 0, 0).Sample(p_W, EpisodeTime()).distance_m, expected);
    EXPECT_EQ(predictions.At(1.4, 0, 20).Sample(p_W, EpisodeTime()).distance_m, expected);
  }
}

TEST(PredictedMaps, AreFullKnowledgeWhereTheObstacleMovesByWholeCells) {
  // 2 m/s are 5 cells a step. Seen at steps 0, 1 and 2, predicted on its way through the gap, while
  // all of it is within the grid.
  const World world(2.0);
  const PublishedMaps maps = world.MakeMaps();
  const PredictedMaps predictions = world.MakePredictions(maps);
  const std::vector<const sdf::DistanceField*> truth = maps.FieldsAt(2.0);
  int near_the_obstacle = 0;
  for (const int k : {2, 5, 9, 12}) {
    for (const Eigen::Vector3d& p_W : Points()) {
      const double expected = std::min(
          truth[static_cast<std::size_t>(k)]->Sample(p_W, EpisodeTime()).distance_m, kClamp_m);
      if (expected < 0.04) continue;  // a composite's depth inside obstacles is a bound only
      const double predicted = predictions.At(2.0, 2, k).Sample(p_W, EpisodeTime()).distance_m;
      // Interpolation between two objects' fields is not that of their minimum: near where they
      // are equally far it is off by a part of a cell.
      EXPECT_NEAR(predicted, expected, 0.02) << "step " << k << " at " << p_W.transpose();
      near_the_obstacle += std::abs(predicted - expected) < 1e-6 && expected < kClamp_m;
    }
  }
  EXPECT_GT(near_the_obstacle, 1000);
}

TEST(OpenLoop, UnderPredictionPassesTheHsrWithLessEffortThanUnderUpdates) {
  OpenLoopExperiment panda = MakeOpenLoopExperiment("panda_hsr", kScenarios);
  panda.speeds_m_s = {1.4};
  const OpenLoopStudy study = RunOpenLoopStudy(
      panda, kModels,
      {.cases = {sdf::Knowledge::kExecuteAndUpdate, sdf::Knowledge::kPrediction}, .pairs = {1}});
  const auto& cases = study.rows.at(0).cases;
  EXPECT_EQ(cases.at(sdf::Knowledge::kPrediction).result.colliding_states, 0);
  EXPECT_LT(cases.at(sdf::Knowledge::kPrediction).result.gp_cost,
            0.5 * cases.at(sdf::Knowledge::kExecuteAndUpdate).result.gp_cost);
}

// The WAM at rest, straight up, with its shoulder sphere of 0.15 m in the origin.
class TrueClearanceTest : public ::testing::Test {
 protected:
  TrueClearanceTest() {
    experiment_.scene.static_obstacles = {
        {"block", Pose::Translation({0, 0, -1}), Box{Eigen::Vector3d::Constant(0.2)}}};
    scenarios::MovingObstacle& pillar = experiment_.scene.moving_obstacles.front();
    pillar.shape = Box{Eigen::Vector3d::Constant(0.2)};
    std::get<scenarios::LinearMotion>(pillar.motion).start_m = {0, -3, 0};
    experiment_.direction = {0, 1, 0};
    trajectory_.t_s = Eigen::VectorXd::LinSpaced(31, 0, 3);
    trajectory_.q = trajectory_.v = Eigen::MatrixXd::Zero(7, 31);
  }

  OpenLoopExperiment experiment_ = MakeOpenLoopExperiment("wam_single_pillar", kScenarios);
  const robot::RobotModel robot_ = robot::RobotModel::Load(kModels, "wam", Pose());
  Trajectory trajectory_;
};

TEST_F(TrueClearanceTest, IsTheDistanceToTheExactBoxes) {
  const TrueClearance clearance = MeasureTrueClearance(experiment_, robot_, trajectory_, 1.0);
  EXPECT_NEAR(clearance.static_m, 1 - 0.1 - 0.15, 1e-12);
  EXPECT_NEAR(clearance.moving_m, 1 - 0.1 - 0.15, 1e-12) << "it stops after 2 s, 1 m away";
  EXPECT_NEAR(clearance.states_m, 0.75, 1e-12);
}

TEST_F(TrueClearanceTest, SeesWhatPassesBetweenTwoStates) {
  // 5.5 m in 0.1 s: at state 0 it is 3 m before the arm, at state 1 it is 2.5 m behind.
  const TrueClearance clearance = MeasureTrueClearance(experiment_, robot_, trajectory_, 55.0);
  EXPECT_LT(clearance.moving_m, 0);
  EXPECT_LT(clearance.motion_m(), 0);
  EXPECT_GT(clearance.states_m, 0.7);
}

}  // namespace
}  // namespace sidestep::bench::reproduce_prediction_test
