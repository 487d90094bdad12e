#include "sidestep/sdf/tracking/object_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/sdf/map/grid_changes.h"
#include "tests/sdf/box_scene.h"

namespace sidestep::sdf::object_tracker_test {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kRate_hz = 30;

class Replay {
 public:
  Replay(const GridSpec& grid, std::vector<SceneBox> boxes)
      : grid_(grid),
        boxes_(std::move(boxes)),
        tracker_(grid, {.max_distance_m = 0.3}),
        told_(grid, {.max_distance_m = 0.3}) {}

  // Feeds frames up to (not including) time t_end_s, calling check(t) after each.
  template <class Check>
  void RunUntil(double t_end_s, const Check& check) {
    for (; frame_ / kRate_hz < t_end_s - 1e-9; ++frame_) {
      const EpisodeTime t(frame_ / kRate_hz);
      const OccupancyGrid occupancy = Rasterise(boxes_, grid_, t);
      tracker_.Update(occupancy, t);
      // One that is told what has changed comes to the same.
      OccupancyGrid before = told_.static_occupancy();
      told_.Update(occupancy, t, {}, changes_.Update(occupancy));
      ASSERT_EQ(told_.static_occupancy().cells, tracker_.static_occupancy().cells);
      if (const auto may_differ = told_.static_may_differ()) {
        for (const std::size_t cell : *may_differ) {
          before.cells[cell] = told_.static_occupancy().cells[cell];
        }
        ASSERT_EQ(before.cells, told_.static_occupancy().cells);
      }
      check(t);
    }
  }
  void RunUntil(double t_end_s) {
    RunUntil(t_end_s, [](EpisodeTime) {});
  }

  const ObjectTracker& tracker() const { return tracker_; }
  std::vector<std::shared_ptr<const TrackedObject>> objects() const {
    return tracker_.MovingObjects();
  }

 private:
  GridSpec grid_;
  std::vector<SceneBox> boxes_;
  ObjectTracker tracker_, told_;
  GridChanges changes_;
  int frame_ = 0;
};

Eigen::Vector3d Velocity(const TrackedObject& object) {
  return MeanVelocity(object.history, kVelocityBaseline);
}

Eigen::Vector3d BoxCentre(const TrackedObject& object) {
  return object.latest().p_WO + object.box_center_O;
}

class Walkway : public ::testing::TestWithParam<int> {};

// The robot passes the tables with one free cell on each side and is cut off by the grid's border
// at y = -1 in the end.
TEST_P(Walkway, IsCrossedByOneObjectWithASaneVelocityUntilItHasLeft) {
  const double speed_m_s = GetParam() / 10.0;
  std::vector<SceneBox> boxes = WalkwayTables();
  boxes.push_back(WalkwayRobot(speed_m_s));
  const OccupancyGrid tables = Rasterise(WalkwayTables(), WalkwayGrid(), EpisodeTime(0));
  Replay replay(WalkwayGrid(), boxes);
  const double t_last_cell_s = (2.0 + 0.275 + 1.0) / speed_m_s;  // its last cell leaves the grid
  std::set<int> ids;
  double worst_velocity_error_m_s = 0, worst_position_error_m = 0;
  replay.RunUntil(t_last_cell_s - 1 / kRate_hz, [&](EpisodeTime t) {
    if (t.seconds() < 0.13) return;  // four frames: the velocity's baseline
    const auto objects = replay.objects();
    ASSERT_THAT(objects, SizeIs(1)) << "at " << t.seconds();
    const TrackedObject& object = *objects[0];
    ids.insert(object.id);
    worst_velocity_error_m_s = std::max(
        worst_velocity_error_m_s, (Velocity(object) - Eigen::Vector3d(0, -speed_m_s, 0)).norm());
    worst_position_error_m =
        std::max(worst_position_error_m, (BoxCentre(object) - boxes[2].p_WO(t)).norm());
    EXPECT_EQ(replay.tracker().static_occupancy().cells, tables.cells) << "at " << t.seconds();
  });
  EXPECT_THAT(ids, SizeIs(1));
  EXPECT_LT(worst_velocity_error_m_s, 0.45);
  EXPECT_LT(worst_position_error_m, 0.04);  // one cell

  replay.RunUntil(t_last_cell_s + 5 / kRate_hz);
  EXPECT_THAT(replay.objects(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Speeds, Walkway, ::testing::Range(10, 21), [](const auto& test) {
  return std::to_string(test.param * 100) + "MillimetresPerSecond";
});

// Scenes on a smaller grid, from -1 to 1 m along x and y.
GridSpec RoomGrid() { return {{-0.98, -0.98, 0.02}, 0.04, {50, 50, 25}}; }

std::function<Eigen::Vector3d(EpisodeTime)> Still(const Eigen::Vector3d& p) {
  return [=](EpisodeTime) { return p; };
}
std::function<Eigen::Vector3d(EpisodeTime)> Line(const Eigen::Vector3d& p, const Eigen::Vector3d& v,
                                                 double t_begin_s = 0, double t_end_s = 1e9) {
  return [=](EpisodeTime t) -> Eigen::Vector3d {
    return p + v * (std::clamp(t.seconds(), t_begin_s, t_end_s) - t_begin_s);
  };
}
std::function<bool(EpisodeTime)> Except(double t_begin_s, double t_end_s) {
  return [=](EpisodeTime t) { return t.seconds() < t_begin_s || t.seconds() >= t_end_s; };
}
const auto kAlways = [](EpisodeTime) { return true; };

// Which boxes must be tracked as moving objects from one time to another, and no others.
struct Expectation {
  double t_begin_s, t_end_s;
  std::vector<std::size_t> moving;
};

struct SceneCase {
  std::string name;
  std::vector<SceneBox> boxes;
  std::vector<Expectation> expected;
  std::size_t num_ids;  // how many objects there are by name over the whole scene
};
void PrintTo(const SceneCase& scene, std::ostream* stream) { *stream << scene.name; }

std::vector<SceneCase> SceneCases() {
  const Eigen::Vector3d kSmall(0.2, 0.24, 0.4);
  const SceneBox table = {{0.8, 0.6, 0.4}, Still({-0.5, 0.5, 0.2}), kAlways};
  const SceneBox box_beyond = {{0.3, 0.2, 0.6}, Still({0.7, -0.7, 0.4}), kAlways};
  return {
      {"NothingMoves", {table, box_beyond}, {{0, 2, {}}}, 0},
      {"OneMovesAtWalkingSpeed",
       {table, {kSmall, Line({-0.7, -0.3, 0.3}, {1.0, 0, 0}), kAlways}},
       {{0.13, 1.5, {1}}},
       1},
      {"OneCreeps",
       {table, {kSmall, Line({-0.7, -0.3, 0.3}, {0.15, 0, 0}), kAlways}},
       {{0.8, 3, {1}}},
       1},
      {"TwoCrossOneCellApart",
       {{kSmall, Line({-0.7, -0.14, 0.3}, {1.0, 0, 0}), kAlways},
        {kSmall, Line({0.7, 0.14, 0.3}, {-1.2, 0, 0}), kAlways},
        box_beyond},
       {{0.13, 1.2, {0, 1}}},
       2},
      {"OneStopsAndRests",
       {table, {kSmall, Line({-0.7, -0.3, 0.3}, {1.0, 0, 0}, 0, 0.8), kAlways}},
       {{0.13, 0.75, {1}}, {0.95, 1.15, {1}}, {1.3, 2.5, {}}},
       1},
      {"OneStartsLater",
       {table, {kSmall, Line({-0.7, -0.3, 0.3}, {1.0, 0, 0}, 1.01), kAlways}},
       {{0, 1.01, {}}, {1.15, 2.3, {1}}},
       1},
      {"OneStopsAndGoesOnUnderTheSameName",
       {table,
        {kSmall,
         [](EpisodeTime t) -> Eigen::Vector3d {
           const double t_s = t.seconds();
           const double travelled_s = std::min(t_s, 0.5) + std::max(t_s - 1.5, 0.0);
           return {-0.7 + travelled_s, -0.3, 0.3};
         },
         kAlways}},
       {{0.13, 0.45, {1}}, {1.0, 1.5, {}}, {1.65, 2.1, {1}}},
       1},
      {"OneEntersLateAcrossTheBorder",
       {table, {kSmall, Line({-2.0, -0.3, 0.3}, {1.0, 0, 0}), kAlways}},
       {{0, 0.89, {}}, {1.05, 2.5, {1}}},
       1},
      {"OneLeavesAcrossTheBorder",
       {table, {kSmall, Line({0.3, -0.3, 0.3}, {1.0, 0, 0}), kAlways}},
       {{0.13, 0.75, {1}}, {0.99, 1.5, {}}},
       1},
      {"OneAppearsWithinAndMoves",
       {table, {kSmall, Line({-1.2, -0.3, 0.3}, {1.0, 0, 0}), Except(0, 0.7)}},
       {{0, 0.7, {}}, {0.85, 1.7, {1}}},
       1},
      {"OneSlidesAlongTheTableAndTouchesIt",
       {table, {kSmall, Line({0.6, 0.08, 0.2}, {-1.2, 0, 0}), kAlways}},
       {{0.13, 1.0, {1}}},
       1},
      {"OneIsMissedForTwoScans",
       {table, {kSmall, Line({-0.7, -0.3, 0.3}, {1.0, 0, 0}), Except(0.59, 0.65)}},
       {{0.13, 1.3, {1}}},
       1},
      {"OneIsLostForLongAndComesBackUnderAnotherName",
       {table, {kSmall, Line({-0.7, -0.3, 0.3}, {1.0, 0, 0}), Except(0.5, 0.8)}},
       {{0.13, 0.5, {1}}, {0.65, 0.8, {}}, {0.95, 1.3, {1}}},
       2},
  };
}

class Scene : public ::testing::TestWithParam<SceneCase> {};

TEST_P(Scene, IsTrackedAsItIs) {
  const SceneCase& scene = GetParam();
  Replay replay(RoomGrid(), scene.boxes);
  std::set<int> ids;
  for (const Expectation& expectation : scene.expected) {
    const auto note_ids = [&](EpisodeTime) {
      for (const auto& object : replay.objects()) ids.insert(object->id);
    };
    replay.RunUntil(expectation.t_begin_s, note_ids);
    replay.RunUntil(expectation.t_end_s, [&](EpisodeTime t) {
      SCOPED_TRACE(testing::Message() << "at " << t.seconds() << " s");
      note_ids(t);
      const auto objects = replay.objects();
      ASSERT_THAT(objects, SizeIs(expectation.moving.size()));
      for (const std::size_t b : expectation.moving) {
        const SceneBox& box = scene.boxes[b];
        const Eigen::Vector3d p_WBox = box.p_WO(t);
        const EpisodeTime before = t - kVelocityBaseline;
        const Eigen::Vector3d v_WBox = (p_WBox - box.p_WO(before)) / kVelocityBaseline.seconds();
        const auto nearest = std::min_element(
            objects.begin(), objects.end(), [&](const auto& one, const auto& other) {
              return (BoxCentre(*one) - p_WBox).norm() < (BoxCentre(*other) - p_WBox).norm();
            });
        if (!box.is_there(t)) continue;  // only its prediction goes on
        EXPECT_LT((BoxCentre(**nearest) - p_WBox).norm(), 0.06) << "box " << b;
        EXPECT_LT((Velocity(**nearest) - v_WBox).norm(), 0.45) << "box " << b;
      }
    });
  }
  EXPECT_THAT(ids, SizeIs(scene.num_ids));
}

INSTANTIATE_TEST_SUITE_P(Cases, Scene, ::testing::ValuesIn(SceneCases()),
                         [](const auto& test) { return test.param.name; });

TEST(ObjectTracker, CountsWhatIsNewAsStaticUntilItHasMoved) {
  Replay replay(RoomGrid(), {MovingBox({0.2, 0.2, 0.4}, {-0.5, 0, 0.3}, {1, 0, 0})});
  replay.RunUntil(1 / kRate_hz);
  EXPECT_GT(replay.tracker().static_occupancy().CountFilled(), 0u);
  EXPECT_THAT(replay.objects(), IsEmpty());
  replay.RunUntil(0.13);
  EXPECT_EQ(replay.tracker().static_occupancy().CountFilled(), 0u);
  EXPECT_THAT(replay.objects(), SizeIs(1));
}

TEST(ObjectTracker, KeepsTheWholeShapeOfAThingThatLeavesTheGrid) {
  Replay replay(RoomGrid(), {MovingBox({0.4, 0.2, 0.4}, {0, 0, 0.3}, {1, 0, 0})});
  replay.RunUntil(0.5);
  const Eigen::Vector3d whole_m = replay.objects().at(0)->box_half_extents_m;
  EXPECT_NEAR(whole_m.x(), 0.2, 0.021);
  replay.RunUntil(1.1);  // 5 cm of it are left
  EXPECT_EQ(replay.objects().at(0)->box_half_extents_m, whole_m);
}

TEST(ObjectTracker, LearnsTheWholeShapeOfAThingThatEnters) {
  Replay replay(RoomGrid(), {MovingBox({0.4, 0.2, 0.4}, {-1.15, 0, 0.3}, {1, 0, 0})});
  replay.RunUntil(0.15);
  EXPECT_LT(replay.objects().at(0)->box_half_extents_m.x(), 0.15);
  replay.RunUntil(0.6);
  EXPECT_NEAR(replay.objects().at(0)->box_half_extents_m.x(), 0.2, 0.021);
}

TEST(ObjectTracker, BuildsTheFieldOfAShapeOnceAndSharesIt) {
  // Whole cells in size, so that it is rasterised alike wherever it stands.
  Replay replay(RoomGrid(), {MovingBox({0.2, 0.2, 0.4}, {-0.5, 0, 0.3}, {1, 0, 0})});
  replay.RunUntil(0.2);
  const auto field = replay.objects().at(0)->field_O;
  ASSERT_NE(field, nullptr);
  replay.RunUntil(0.8);
  EXPECT_EQ(replay.objects().at(0)->field_O, field);
}

TEST(ObjectTracker, FindsBothAgainAfterTwoMovingThingsHaveTouchedAndParted) {
  Replay replay(RoomGrid(), {MovingBox({0.2, 0.2, 0.4}, {-0.7, -0.1, 0.3}, {1.0, 0, 0}),
                             MovingBox({0.2, 0.2, 0.4}, {0.7, 0.1, 0.3}, {-1.0, 0, 0})});
  replay.RunUntil(0.5);
  EXPECT_THAT(replay.objects(), SizeIs(2));
  // Their sides touch from 0.6 s to 0.8 s, and they are one thing.
  replay.RunUntil(1.15, [&](EpisodeTime) {
    for (const auto& object : replay.objects()) {
      EXPECT_LT(Velocity(*object).norm(), 2.5);
    }
  });
  ASSERT_THAT(replay.objects(), SizeIs(2));
  for (const auto& object : replay.objects()) {
    EXPECT_NEAR(std::abs(Velocity(*object).x()), 1.0, 0.45);
    EXPECT_NEAR(object->box_half_extents_m.x(), 0.1, 0.021);
  }
}

TEST(ObjectTracker, RemembersABoundedPast) {
  Replay replay(RoomGrid(), {StillBox({0.2, 0.2, 0.2}, {0, 0, 0.3}),
                             MovingBox({0.2, 0.2, 0.4}, {-0.9, 0.5, 0.3}, {0.25, 0, 0})});
  replay.RunUntil(6);
  ASSERT_THAT(replay.objects(), SizeIs(1));
  EXPECT_LE(replay.objects()[0]->history.size(), 2 * kRate_hz + 2);
}

TEST(ObjectTracker, RefusesAnotherGridAndTimeThatDoesNotGoOn) {
  ObjectTracker tracker(RoomGrid(), {.max_distance_m = 0.3});
  tracker.Update(OccupancyGrid(RoomGrid()), EpisodeTime(1));
  EXPECT_THROW(tracker.Update(OccupancyGrid(RoomGrid()), EpisodeTime(1)), std::invalid_argument);
  EXPECT_THROW(tracker.Update(OccupancyGrid(WalkwayGrid()), EpisodeTime(2)), std::invalid_argument);
  EXPECT_THROW(ObjectTracker(RoomGrid(), {}), std::invalid_argument);
  EXPECT_THROW(ObjectTracker(GridSpec(), {.max_distance_m = 0.3}), std::invalid_argument);
}

// Whole cells a scan: the gate of a thing just seen is 4 m/s and two cells, 5.33 cells at 30 Hz.
TEST(ObjectTracker, FollowsAThingUpToItsGateAndNoFaster) {
  for (const int cells_a_scan : {1, 3, 5, 6, 8}) {
    SCOPED_TRACE(cells_a_scan);
    const double speed_m_s = 0.04 * cells_a_scan * kRate_hz;
    const bool is_within = speed_m_s <= 4 + 2 * 0.04 * kRate_hz;
    Replay replay(WalkwayGrid(),
                  {MovingBox({0.24, 0.32, 0.64}, {0, 2.4, 0.12}, {0, -speed_m_s, 0})});
    replay.RunUntil(6.5 / kRate_hz);
    if (is_within) {
      ASSERT_THAT(replay.objects(), SizeIs(1));
      EXPECT_NEAR(Velocity(*replay.objects()[0]).y(), -speed_m_s, 1e-9);
    } else {
      EXPECT_THAT(replay.objects(), IsEmpty());
    }
  }
}

}  // namespace
}  // namespace sidestep::sdf::object_tracker_test
