#include "sidestep/sdf/world_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/core/shape.h"
#include "tests/sdf/box_scene.h"
#include "tests/support/random_points.h"

namespace sidestep::sdf::world_model_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::Throws;

constexpr double kClamp_m = 0.32;

// A shelf, and a box of whole cells that passes it with 1.2 m/s: at 30 Hz exactly a cell a frame.
const Eigen::Vector3d kBoxSize_m(0.24, 0.32, 0.64);
const Eigen::Vector3d kBoxStart(0, 1.2, 0.12);
const Eigen::Vector3d kBoxVelocity(0, -1.2, 0);
GridSpec Grid() { return {{-0.98, -0.98, -0.98}, 0.04, {50, 64, 50}}; }
SceneBox Shelf() { return StillBox({0.4, 1.2, 0.08}, {-0.4, 0, 0.2}); }
SceneBox PassingBox() { return MovingBox(kBoxSize_m, kBoxStart, kBoxVelocity); }

Scan ScanAt(EpisodeTime t) { return MakeScan(Rasterise({Shelf(), PassingBox()}, Grid(), t), t); }

std::vector<MovingShape> Truth() {
  return {{Box{kBoxSize_m}, [](EpisodeTime t) { return Pose::Translation(PassingBox().p_WO(t)); }}};
}

WorldModelOptions Options(Knowledge knowledge) {
  WorldModelOptions options;
  options.knowledge = knowledge;
  options.grid = Grid();
  options.max_distance_m = kClamp_m;
  options.predictor = "two_frame";  // exact for whole cells a frame
  if (knowledge == Knowledge::kFullKnowledge) options.true_obstacles = Truth();
  return options;
}

// Half a second of scans at 30 Hz; the last is at t = 0.5 s.
std::unique_ptr<WorldModel> Watched(Knowledge knowledge, double until_s = 0.5) {
  auto world = MakeWorldModel(Options(knowledge));
  for (int frame = 0; frame / 30.0 < until_s + 1e-9; ++frame) {
    world->Observe(ScanAt(EpisodeTime(frame / 30.0)));
  }
  return world;
}

// Where the box is believed to be at t: the way along y through its true middle is searched.
std::vector<double> FilledAlongY(const DistanceField& field, EpisodeTime t) {
  std::vector<double> y_m;
  for (double y = -0.97; y < 1.5; y += 0.005) {
    if (field.Sample({0, y, 0.1}, t).distance_m < 0) y_m.push_back(y);
  }
  return y_m;
}

void ExpectBoxAt(double y_m, const DistanceField& field, EpisodeTime t) {
  SCOPED_TRACE(testing::Message() << "asked about " << t.seconds() << " s");
  const std::vector<double> filled = FilledAlongY(field, t);
  ASSERT_FALSE(filled.empty());
  EXPECT_NEAR((filled.front() + filled.back()) / 2, y_m, 0.011);
  EXPECT_NEAR(filled.back() - filled.front(), kBoxSize_m.y(), 0.011);
}

double TrueY(double t_s) { return PassingBox().p_WO(EpisodeTime(t_s)).y(); }

TEST(WorldModel, KeepsTheFirstScanUnderStaticKnowledge) {
  const auto field = Watched(Knowledge::kStatic)->MakeField();
  for (const double t_s : {0.0, 0.5, 1.5}) ExpectBoxAt(TrueY(0), *field, EpisodeTime(t_s));
}

TEST(WorldModel, FreezesTheLatestScanUnderExecuteAndUpdate) {
  const auto field = Watched(Knowledge::kExecuteAndUpdate)->MakeField();
  for (const double t_s : {0.0, 0.5, 1.5}) ExpectBoxAt(TrueY(0.5), *field, EpisodeTime(t_s));
}

TEST(WorldModel, PutsTheBoxWhereItWillBeUnderPrediction) {
  const auto field = Watched(Knowledge::kPrediction)->MakeField();
  for (const double t_s : {0.4, 0.5, 0.9, 1.5}) {
    ExpectBoxAt(TrueY(t_s), *field, EpisodeTime(t_s));
  }
}

TEST(WorldModel, PutsTheBoxWhereItTrulyIsUnderFullKnowledge) {
  const auto field = Watched(Knowledge::kFullKnowledge, /*until_s=*/0)->MakeField();
  for (const double t_s : {0.0, 0.5, 1.5}) ExpectBoxAt(TrueY(t_s), *field, EpisodeTime(t_s));
}

class EveryKnowledge : public ::testing::TestWithParam<Knowledge> {};

TEST_P(EveryKnowledge, KnowsWhatDoesNotMove) {
  const auto field = Watched(GetParam())->MakeField();
  EXPECT_EQ(field->max_distance_m(), kClamp_m);
  const DistanceSample above_shelf = field->Sample({-0.4, -0.3, 0.34}, EpisodeTime(0.5));
  EXPECT_NEAR(above_shelf.distance_m, 0.1, 1e-6);
  EXPECT_LT((above_shelf.gradient_W - Eigen::Vector3d::UnitZ()).norm(), 1e-5);
  EXPECT_FALSE(field->Sample({5, 0, 0}, EpisodeTime(0.5)).in_grid);
}

TEST_P(EveryKnowledge, LeavesEarlierFieldsAsTheyWere) {
  const auto world = Watched(GetParam());
  const auto field = world->MakeField();
  const Eigen::Vector3d p(0.1, 0.3, 0.1);
  const double before_m = field->Sample(p, EpisodeTime(0.6)).distance_m;
  for (int frame = 16; frame < 30; ++frame) world->Observe(ScanAt(EpisodeTime(frame / 30.0)));
  const auto later = world->MakeField();
  EXPECT_EQ(field->Sample(p, EpisodeTime(0.6)).distance_m, before_m);
}

TEST_P(EveryKnowledge, GivesTheSameBitsForTheSameScans) {
  const auto one = Watched(GetParam())->MakeField();
  const auto other = Watched(GetParam())->MakeField();
  for (double x = -0.9; x < 1; x += 0.07) {
    for (double y = -0.9; y < 1.5; y += 0.07) {
      const Eigen::Vector3d p(x, y, 0.1);
      const DistanceSample a = one->Sample(p, EpisodeTime(0.83));
      const DistanceSample b = other->Sample(p, EpisodeTime(0.83));
      ASSERT_EQ(a.distance_m, b.distance_m);
      ASSERT_EQ(a.gradient_W, b.gradient_W);
    }
  }
}

TEST_P(EveryKnowledge, NeedsAScanAndTakesScansInOrder) {
  const auto world = MakeWorldModel(Options(GetParam()));
  EXPECT_THROW(world->MakeField(), std::invalid_argument);
  world->Observe(ScanAt(EpisodeTime(1)));
  EXPECT_THROW(world->Observe(ScanAt(EpisodeTime(0.9))), std::invalid_argument);
}

TEST_P(EveryKnowledge, AnswersTheClampInAnEmptyWorld) {
  WorldModelOptions options = Options(GetParam());
  options.true_obstacles.emplace();
  const auto world = MakeWorldModel(options);
  world->Observe(Scan());
  const DistanceSample sample = world->MakeField()->Sample({0, 0, 0}, EpisodeTime(0));
  EXPECT_EQ(sample.distance_m, kClamp_m);
  EXPECT_TRUE(sample.in_grid);
  EXPECT_THAT(world->DescribeObjects({EpisodeTime(0)}), IsEmpty());
}

TEST_P(EveryKnowledge, KnowsTheFloorExactlyAlsoOutsideTheGrid) {
  WorldModelOptions options = Options(GetParam());
  options.exact.half_spaces = {{Eigen::Vector3d::UnitZ(), -0.513}};
  const auto world = MakeWorldModel(options);
  world->Observe(ScanAt(EpisodeTime(0)));
  const auto field = world->MakeField();
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, -0.9, -0.4), Eigen::Vector3d(0.3, 0.1, -0.6),
                                   Eigen::Vector3d(9, 9, -0.5), Eigen::Vector3d(0, 0, -7)}) {
    const DistanceSample sample = field->Sample(p, EpisodeTime(0.7));
    EXPECT_NEAR(sample.distance_m, p.z() + 0.513, 1e-12) << p.transpose();
    EXPECT_EQ(sample.gradient_W, Eigen::Vector3d::UnitZ());
  }
}

TEST_P(EveryKnowledge, KnowsAStaticShapeBetterThanByCellsIfToldOfIt) {
  // The shelf is scanned as cells; in truth it is 1 cm larger all round than what they say.
  const Box shelf{Shelf().size_m + Eigen::Vector3d::Constant(0.02)};
  WorldModelOptions options = Options(GetParam());
  options.exact.shapes = {{shelf, Pose::Translation(Shelf().p_WO(EpisodeTime(0)))}};
  for (const CellRule rule : {CellRule::kTouched, CellRule::kCentre}) {
    options.cells = rule;
    const auto world = MakeWorldModel(options);
    world->Observe(ScanAt(EpisodeTime(0)));
    const auto field = world->MakeField();
    for (double y = -0.7; y < 0.4; y += 0.0137) {
      for (double z = 0.0; z < 0.4; z += 0.0137) {
        const Eigen::Vector3d p(-0.4, y, z);
        const double exact_m = SignedDistance(shelf, p - Shelf().p_WO(EpisodeTime(0)));
        ASSERT_NEAR(field->Sample(p, EpisodeTime(0)).distance_m, std::min(exact_m, kClamp_m), 1e-12)
            << p.transpose();
      }
    }
  }
}

TEST_P(EveryKnowledge, ReportsItsTimesOnce) {
  const auto world = Watched(GetParam());
  world->MakeField();
  EXPECT_GT(world->TakeTimes().map_s, 0);
  EXPECT_EQ(world->TakeTimes().map_s, 0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKnowledge, ::testing::ValuesIn(kAllKnowledge),
                         [](const auto& test) { return ToString(test.param); });

TEST(WorldModel, DescribesWhatItPredictsByTheBoxAroundIt) {
  for (const Knowledge knowledge : {Knowledge::kPrediction, Knowledge::kFullKnowledge}) {
    SCOPED_TRACE(ToString(knowledge));
    const auto world = Watched(knowledge);
    world->MakeField();
    const std::vector<EpisodeTime> times = {EpisodeTime(0.5), EpisodeTime(1.0)};
    const std::vector<PredictedObject> objects = world->DescribeObjects(times);
    ASSERT_THAT(objects, SizeIs(1));
    EXPECT_LT((objects[0].half_extents_m - kBoxSize_m / 2).norm(), 1e-9);
    EXPECT_EQ(objects[0].t, times);
    ASSERT_THAT(objects[0].X_WO, SizeIs(2));
    for (std::size_t n = 0; n < times.size(); ++n) {
      const Eigen::Vector3d p_WBox = PassingBox().p_WO(times[n]);
      EXPECT_LT((objects[0].X_WO[n].translation() - p_WBox).norm(), 1e-9);
    }
  }
}

TEST(WorldModel, DescribesNoObjectsWhereItKnowsOfNone) {
  for (const Knowledge knowledge : {Knowledge::kStatic, Knowledge::kExecuteAndUpdate}) {
    const auto world = Watched(knowledge);
    world->MakeField();
    EXPECT_THAT(world->DescribeObjects({EpisodeTime(1)}), IsEmpty());
  }
}

TEST(WorldModel, LeavesTheBoxWhereItIsWithAPredictorThatSaysSo) {
  WorldModelOptions options = Options(Knowledge::kPrediction);
  options.predictor = "stationary";
  const auto world = MakeWorldModel(options);
  for (int frame = 0; frame <= 15; ++frame) world->Observe(ScanAt(EpisodeTime(frame / 30.0)));
  ExpectBoxAt(TrueY(0.5), *world->MakeField(), EpisodeTime(1.5));
}

TEST(WorldModel, AsksEachTrueMotionOnceAQueryHoweverManyThereAre) {
  int num_asked = 0;
  WorldModelOptions options = Options(Knowledge::kFullKnowledge);
  options.true_obstacles.emplace();
  constexpr int kObstacles = 12;
  for (int n = 0; n < kObstacles; ++n) {
    options.true_obstacles->push_back({Sphere{0.1}, [&num_asked, n](EpisodeTime) {
                                         ++num_asked;
                                         return Pose::Translation({0.1 * n, 0, 0});
                                       }});
  }
  const auto world = MakeWorldModel(options);
  world->Observe(ScanAt(EpisodeTime(0)));
  const auto field = world->MakeField();
  num_asked = 0;
  RandomStream random(1, "points");
  DistanceSamples samples;
  field->SampleMany(UniformPoints(random, 100, 1), EpisodeTime(0.3), samples);
  EXPECT_EQ(num_asked, kObstacles);
}

TEST(WorldModel, TakesNothingOfATrueObstacleForStaticUnderFullKnowledge) {
  const auto field = Watched(Knowledge::kFullKnowledge, /*until_s=*/0.2)->MakeField();
  // Once the box has gone on, the place where it was scanned is free, far from the shelf.
  EXPECT_EQ(field->Sample(PassingBox().p_WO(EpisodeTime(0.2)), EpisodeTime(3)).distance_m,
            kClamp_m);
}

// A sheet and a pole between cells, as a sensor sees them that fills every cell they touch.
TEST(WorldModel, LeavesNoGhostOfThinThingsUnderFullKnowledge) {
  const std::vector<Shape> shapes = {Box{{0.5, 0.02, 0.5}}, Cylinder{0.015, 0.6},
                                     Capsule{0.01, 0.5}};
  for (const Shape& shape : shapes) {
    for (int trial = 0; trial < 20; ++trial) {
      SCOPED_TRACE(ShapeName(shape) + " " + std::to_string(trial));
      const auto pose = [trial](EpisodeTime t) {
        return Pose::FromRollPitchYaw({0.1 * trial, 0.05 * trial, 0},
                                      {0.0013 * trial, 0.5 - t.seconds(), 0.0029 * trial});
      };
      WorldModelOptions options = Options(Knowledge::kFullKnowledge);
      options.true_obstacles = {{shape, pose}};
      OccupancyGrid seen(Grid());
      FillObjects({{"thin", EpisodeTime(0), pose(EpisodeTime(0)), {}, shape}}, CellRule::kTouched,
                  &seen);
      ASSERT_GT(seen.CountFilled(), 0u);
      const auto world = MakeWorldModel(options);
      world->Observe(MakeScan(seen, EpisodeTime(0)));
      const auto field = world->MakeField();
      for (std::size_t cell = 0; cell < seen.cells.size(); ++cell) {
        if (seen.cells[cell] == 0) continue;
        // A second later it is a metre on.
        ASSERT_EQ(field->Sample(Grid().CenterOf(cell), EpisodeTime(1)).distance_m, kClamp_m);
      }
    }
  }
}

TEST(WorldModel, ErasesTheCellsOfASurfaceUnderFullKnowledgeWhateverTheRule) {
  // A camera's points lie on the box, in cells whose centres may be well outside it.
  for (const CellRule rule : {CellRule::kTouched, CellRule::kCentre}) {
    WorldModelOptions options = Options(Knowledge::kFullKnowledge);
    options.cells = rule;
    Scan scan;
    scan.kind = ScanKind::kSurface;
    scan.X_WC = Pose::Translation({0, -0.9, 0.9});
    std::vector<Eigen::Vector3d> points;
    for (double x = -0.11; x < 0.12; x += 0.02) {
      for (double z = -0.19; z < 0.44; z += 0.02) points.push_back({x, 1.2 - 0.16 - 1e-7, z});
    }
    scan.p_CP.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t n = 0; n < points.size(); ++n) {
      scan.p_CP.col(static_cast<Eigen::Index>(n)) = scan.X_WC.Inverse() * points[n];
    }
    options.grid.first_center_m.y() += 0.013;  // faces between centres
    const auto world = MakeWorldModel(options);
    world->Observe(scan);
    const auto field = world->MakeField();
    for (const Eigen::Vector3d& p : points) {
      EXPECT_EQ(field->Sample(p, EpisodeTime(2)).distance_m, kClamp_m);
    }
  }
}

TEST(WorldModel, RefusesOptionsThatMeanNothing) {
  WorldModelOptions options = Options(Knowledge::kPrediction);
  options.predictor = "crystal_ball";
  EXPECT_THAT([&] { MakeWorldModel(options); }, Throws<std::invalid_argument>());
  for (const double clamp_m : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    options = Options(Knowledge::kStatic);
    options.max_distance_m = clamp_m;
    EXPECT_THAT([&] { MakeWorldModel(options); }, Throws<std::invalid_argument>());
  }
  options = Options(Knowledge::kStatic);
  options.grid.cell_m = 0;
  EXPECT_THAT([&] { MakeWorldModel(options); }, Throws<std::invalid_argument>());
  options = Options(Knowledge::kFullKnowledge);
  options.true_obstacles.reset();
  EXPECT_THAT([&] { MakeWorldModel(options); }, Throws<std::invalid_argument>());
}

TEST(Knowledge, HasAWordForEachKindAndBack) {
  for (const Knowledge knowledge : kAllKnowledge) {
    EXPECT_EQ(KnowledgeFromString(ToString(knowledge)), knowledge);
  }
  EXPECT_EQ(ToString(Knowledge::kExecuteAndUpdate), "execute_and_update");
  EXPECT_THROW(KnowledgeFromString("omniscience"), std::invalid_argument);
}

TEST(GrownObjects, AreThickerByTheStandardDeviationsAskedForUpToTheLimit) {
  const auto field_with = [](double sigmas) {
    WorldModelOptions options = Options(Knowledge::kPrediction);
    options.growth_sigmas = sigmas;
    options.growth_limit_m = 0.07;
    const auto world = MakeWorldModel(options);
    for (int frame = 0; frame <= 15; ++frame) world->Observe(ScanAt(EpisodeTime(frame / 30.0)));
    return world->MakeField();
  };
  // Two centimetres beside the box, which is predicted exactly.
  const auto distance_m = [](const DistanceField& field, double t_s) {
    const Eigen::Vector3d p_WO = PassingBox().p_WO(EpisodeTime(t_s));
    return field.Sample(p_WO + Eigen::Vector3d(0.14, 0, 0), EpisodeTime(t_s)).distance_m;
  };
  const auto plain = field_with(0), grown = field_with(2);
  // The sighting: a cell's 4 cm / sqrt(12). From two, 0.1 s apart, after 0.05 s: times
  // sqrt(1.5^2 + 0.5^2). After a second the limit holds.
  const double sigma_m = 0.04 / std::sqrt(12.0);
  EXPECT_NEAR(distance_m(*plain, 0.5) - distance_m(*grown, 0.5), 2 * sigma_m, 1e-9);
  EXPECT_NEAR(distance_m(*plain, 0.55) - distance_m(*grown, 0.55), 2 * sigma_m * std::sqrt(2.5),
              1e-9);
  EXPECT_NEAR(distance_m(*plain, 1.5) - distance_m(*grown, 1.5), 0.07, 1e-9);
}

TEST(GrownObjects, AreThickerByAsFarAsTheyCanStrayBesides) {
  const auto field_with = [](double sigmas, double stray_m_s2) {
    WorldModelOptions options = Options(Knowledge::kPrediction);
    options.growth_sigmas = sigmas;
    options.growth_limit_m = 0.03;
    options.stray_m_s2 = stray_m_s2;
    options.stray_s = 0.2;
    const auto world = MakeWorldModel(options);
    for (int frame = 0; frame <= 15; ++frame) world->Observe(ScanAt(EpisodeTime(frame / 30.0)));
    return world->MakeField();
  };
  const auto distance_m = [](const DistanceField& field, double after_s) {
    const EpisodeTime t(0.5 + after_s);  // since it was seen last
    return field.Sample(PassingBox().p_WO(t) + Eigen::Vector3d(0.2, 0, 0), t).distance_m;
  };
  const auto plain = field_with(0, 0), stray = field_with(0, 2), both = field_with(50, 2);
  const struct {
    double after_s, stray_m;
  } cases[] = {{-0.1, 0}, {0, 0}, {0.1, 0.01}, {0.2, 0.04}, {1, 0.04}};
  for (const auto& [after_s, stray_m] : cases) {
    const double plain_m = distance_m(*plain, after_s);
    EXPECT_NEAR(plain_m - distance_m(*stray, after_s), stray_m, 1e-9) << after_s;
    EXPECT_NEAR(plain_m - distance_m(*both, after_s), stray_m + 0.03, 1e-9) << after_s;
  }
}

TEST(GrownObjects, GoOnToTheClampWithoutAJump) {
  WorldModelOptions options = Options(Knowledge::kPrediction);
  options.growth_sigmas = 2;
  options.stray_m_s2 = 2;
  options.stray_s = 0.2;
  const auto world = MakeWorldModel(options);
  for (int frame = 0; frame <= 15; ++frame) world->Observe(ScanAt(EpisodeTime(frame / 30.0)));
  const auto field = world->MakeField();
  const EpisodeTime t(1);
  const Eigen::Vector3d p_WO = PassingBox().p_WO(t);
  double last_m = field->Sample(p_WO, t).distance_m;
  for (double x = 0; x < 0.7; x += 0.001) {
    const double next_m = field->Sample(p_WO + Eigen::Vector3d(x, 0, 0), t).distance_m;
    EXPECT_LT(std::abs(next_m - last_m), 0.0015) << x;
    last_m = next_m;
  }
  EXPECT_EQ(last_m, kClamp_m);
}

}  // namespace
}  // namespace sidestep::sdf::world_model_test
