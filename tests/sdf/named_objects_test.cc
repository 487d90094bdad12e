#include "sidestep/sdf/tracking/named_objects.h"

#include <gtest/gtest.h>

#include "sidestep/sdf/prediction/registry.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::sdf::named_objects_test {
namespace {

ObjectObservation Seen(const std::string& id, double t_s, const Pose& X_WO) {
  ObjectObservation seen;
  seen.id = id;
  seen.t = EpisodeTime(t_s);
  seen.X_WO = X_WO;
  seen.shape = Box{{0.4, 0.2, 0.2}};
  return seen;
}

TEST(NamedObjects, AreFollowedByNameWhateverTheirOrder) {
  NamedObjects objects({.cell_m = 0.05, .max_distance_m = 0.2});
  objects.Update(
      {Seen("a", 0, Pose::Translation({0, 0, 0})), Seen("b", 0, Pose::Translation({1, 0, 0}))},
      EpisodeTime(0));
  objects.Update({Seen("b", 0.1, Pose::Translation({1, 0.1, 0})),
                  Seen("a", 0.1, Pose::Translation({0.2, 0, 0}))},
                 EpisodeTime(0.1));
  const std::vector<NamedObject> followed = objects.Objects();
  ASSERT_EQ(followed.size(), 2u);
  EXPECT_EQ(followed[0].object->id, -1);
  EXPECT_EQ(followed[1].object->id, -2);
  EXPECT_TRUE(MeanVelocity(followed[0].object->history, HorizonOffset(0.1))
                  .isApprox(Eigen::Vector3d(2, 0, 0)));
  EXPECT_TRUE(MeanVelocity(followed[1].object->history, HorizonOffset(0.1))
                  .isApprox(Eigen::Vector3d(0, 1, 0)));
}

TEST(NamedObjects, AreForgottenASecondAfterTheirLastSightAndKeepTheirId) {
  NamedObjects objects({.cell_m = 0.05, .max_distance_m = 0.2});
  objects.Update({Seen("a", 0, Pose())}, EpisodeTime(0));
  objects.Update({Seen("b", 0.9, Pose())}, EpisodeTime(0.9));
  EXPECT_EQ(objects.Objects().size(), 2u);
  objects.Update({}, EpisodeTime(1.1));
  EXPECT_EQ(objects.Objects().size(), 1u);
  objects.Update({Seen("a", 1.2, Pose())}, EpisodeTime(1.2));
  EXPECT_EQ(objects.Objects()[0].object->id, -1);
}

TEST(NamedObjects, ThatWereSeenLastWithinWhatIsKeptAreNotForgotten) {
  const GridSpec room{Eigen::Vector3d::Constant(-0.95), 0.1, {20, 20, 20}};  // -1 to 1 m
  NamedObjects objects({.cell_m = 0.05, .max_distance_m = 0.2, .keep_within = room});
  objects.Update({Seen("inside", 0, Pose::Translation({0.99, 0, 0})),
                  Seen("outside", 0, Pose::Translation({1.01, 0, 0}))},
                 EpisodeTime(0));
  objects.Update({}, EpisodeTime(100));
  ASSERT_EQ(objects.Objects().size(), 1u);
  EXPECT_EQ(objects.Objects()[0].object->latest().p_WO.x(), 0.99);
}

Scan Tags(double t_s) {
  Scan scan;
  scan.t = EpisodeTime(t_s);
  scan.p_CP.resize(3, 0);
  scan.objects = {
      Seen("cart", t_s, Pose::FromRollPitchYaw({0, 0, 0.8}, {-0.5 + 0.4 * t_s, 0.1, 0}))};
  return scan;
}

// The distance to the true cart.
double Truth(const Eigen::Vector3d& p_W, double t_s) {
  const ObjectObservation cart = Tags(t_s).objects[0];
  return SignedDistance(cart.shape, cart.X_WO.Inverse() * p_W);
}

TEST(WorldModel, PredictsNamedObjectsWithTheirExactShapeAndTurn) {
  WorldModelOptions options;
  options.predictor = "two_frame";
  options.grid = {{-1, -1, -1}, 0.05, {41, 41, 41}};
  options.max_distance_m = 0.3;
  const auto model = MakeWorldModel(options);
  for (int k = 0; k <= 3; ++k) model->Observe(Tags(0.1 * k));
  const auto field = model->MakeField();
  for (const Eigen::Vector3d& p_W : {Eigen::Vector3d(0.1, 0.1, 0), Eigen::Vector3d(0.3, 0.35, 0.1),
                                     Eigen::Vector3d(0, 0, 0.2)}) {
    for (const double t_s : {0.3, 1.0, 1.5}) {
      const double want = std::min(Truth(p_W, t_s), options.max_distance_m);
      EXPECT_NEAR(field->Sample(p_W, EpisodeTime(t_s)).distance_m, want, 0.01);
    }
  }
  EXPECT_EQ(model->DescribeObjects({EpisodeTime(1)}).size(), 1u);
}

// No predictor says how a thing goes on turning.
TEST(WorldModel, PredictsThatNamedObjectsStayTurnedAsTheyWereSeenLast) {
  for (const std::string& predictor : PredictorNames()) {
    WorldModelOptions options;
    options.predictor = predictor;
    options.grid = {{-1, -1, -1}, 0.05, {41, 41, 41}};
    options.max_distance_m = 0.3;
    const auto model = MakeWorldModel(options);
    Pose X_WO;
    for (int k = 0; k <= 10; ++k) {
      Scan scan = Tags(0.1 * k);
      X_WO = Pose::FromRollPitchYaw({0, 0.1, 0.12 * k}, scan.objects[0].X_WO.translation());
      scan.objects[0].X_WO = X_WO;
      model->Observe(scan);
    }
    model->MakeField();
    const std::vector<EpisodeTime> times = {EpisodeTime(1), EpisodeTime(1.5), EpisodeTime(3)};
    const auto described = model->DescribeObjects(times);
    ASSERT_EQ(described.size(), 1u);
    EXPECT_LT((described[0].X_WO[0].translation() - X_WO.translation()).norm(), 1e-9) << predictor;
    for (const Pose& predicted : described[0].X_WO) {
      EXPECT_LT(predicted.rotation().angularDistance(X_WO.rotation()), 1e-7) << predictor;
    }
  }
}

TEST(WorldModel, TakesNamedObjectsForSolidsWhereItDoesNotPredict) {
  WorldModelOptions options;
  options.knowledge = Knowledge::kExecuteAndUpdate;
  options.grid = {{-1, -1, -1}, 0.05, {41, 41, 41}};
  options.max_distance_m = 0.3;
  const auto model = MakeWorldModel(options);
  model->Observe(Tags(0));
  EXPECT_GT(model->Occupancy().CountFilled(), 100u);
  const auto field = model->MakeField();
  EXPECT_LT(field->Sample({-0.5, 0.1, 0}, EpisodeTime(2)).distance_m, 0);
}

}  // namespace
}  // namespace sidestep::sdf::named_objects_test
