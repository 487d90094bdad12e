// What tracking says of each way in which an obstacle may behave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/tracking/object_tracker.h"
#include "tests/sdf/box_scene.h"

namespace sidestep::sdf::behaviour_test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;

constexpr double kRate_hz = 30, kDuration_s = 3.5;

SceneBox AsBox(const scenarios::MovingObstacle& obstacle) {
  return {std::get<Box>(obstacle.shape).size_m, [obstacle](EpisodeTime t) -> Eigen::Vector3d {
            return PoseAt(obstacle, t).translation();
          }};
}

// One behaviour of the walkway, watched from the start.
class Watched {
 public:
  explicit Watched(const std::string& behaviour, scenarios::Settings settings = {}) {
    settings.insert({{"behaviour", behaviour}, {"variations", "{}"}});
    scenario_ =
        scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/walkway_behaviours.yaml", settings);
    std::vector<SceneBox> boxes;
    for (const scenarios::StaticObstacle& box : scenario_.static_obstacles) {
      boxes.push_back(StillBox(std::get<Box>(box.shape).size_m, box.X_WO.translation()));
    }
    for (const scenarios::MovingObstacle& obstacle : scenario_.moving_obstacles) {
      boxes.push_back(AsBox(obstacle));
    }
    ObjectTracker tracker(scenario_.grid, {.max_distance_m = 0.3});
    for (int frame = 0; frame <= kRate_hz * kDuration_s; ++frame) {
      const EpisodeTime t(frame / kRate_hz);
      tracker.Update(Rasterise(boxes, scenario_.grid, t), t);
      for (TrackEvent& event : tracker.TakeEvents()) events_.push_back(std::move(event));
      CheckPositions(tracker, t);
    }
    num_moving_at_end_ = tracker.MovingObjects().size();
  }

  // What is said of things that move at some time, in order, without ids.
  std::vector<std::string> Story() const {
    std::vector<std::string> words;
    for (const TrackEvent& event : events_) {
      if (Moves(event.id) && event.what != track_event::kAppeared) words.push_back(event.what);
    }
    return words;
  }
  double TimeOf(const std::string& what) const {
    for (const TrackEvent& event : events_) {
      if (event.what == what && Moves(event.id)) return event.t.seconds();
    }
    return NAN;
  }
  std::size_t num_moving_at_end() const { return num_moving_at_end_; }
  // The furthest that a moving thing was from any true obstacle that is wholly in the grid.
  double worst_position_error_m() const { return worst_position_error_m_; }

 private:
  bool Moves(int id) const {
    return std::any_of(events_.begin(), events_.end(), [id](const TrackEvent& event) {
      return event.id == id && event.what == track_event::kMoved;
    });
  }
  bool IsInside(const scenarios::MovingObstacle& obstacle, const Eigen::Vector3d& p_WO) const {
    const GridSpec& grid = scenario_.grid;
    const Eigen::Vector3d half_m = HalfExtents(obstacle.shape);
    const auto [nx, ny, nz] = grid.size;
    const Eigen::Vector3d low = grid.Center(0, 0, 0), high = grid.Center(nx - 1, ny - 1, nz - 1);
    return ((p_WO - half_m).array() > low.array()).all() &&
           ((p_WO + half_m).array() < high.array()).all();
  }
  void CheckPositions(const ObjectTracker& tracker, EpisodeTime t) {
    for (const auto& object : tracker.MovingObjects()) {
      if (object->latest().t != t) continue;  // not in this scan
      double nearest_m = INFINITY;
      for (const scenarios::MovingObstacle& obstacle : scenario_.moving_obstacles) {
        const Eigen::Vector3d p_WBox = object->latest().p_WO + object->box_center_O;
        const Eigen::Vector3d p_WO = PoseAt(obstacle, t).translation();
        nearest_m = std::min(nearest_m, IsInside(obstacle, p_WO) ? (p_WBox - p_WO).norm() : 0);
      }
      worst_position_error_m_ = std::max(worst_position_error_m_, nearest_m);
    }
  }

  scenarios::Scenario scenario_;
  std::vector<TrackEvent> events_;
  std::size_t num_moving_at_end_ = 0;
  double worst_position_error_m_ = 0;
};

struct Behaviour {
  const char* name;
  std::vector<std::string> story;
};
std::ostream& operator<<(std::ostream& stream, const Behaviour& b) { return stream << b.name; }

class EveryBehaviour : public ::testing::TestWithParam<Behaviour> {};

TEST_P(EveryBehaviour, IsToldAsItHappens) {
  EXPECT_EQ(Watched(GetParam().name).Story(), GetParam().story);
}

TEST_P(EveryBehaviour, IsFollowedToWithinACellWhereAllOfItCanBeSeen) {
  EXPECT_LT(Watched(GetParam().name).worst_position_error_m(), 0.04);
}

const char* const kMoved = track_event::kMoved;
const char* const kRested = track_event::kRested;
const char* const kPartly = track_event::kPartlySeen;
const char* const kWholly = track_event::kWhollySeen;
const char* const kMissed = track_event::kMissed;
const char* const kLost = track_event::kLost;

INSTANTIATE_TEST_SUITE_P(
    OfOneObstacle, EveryBehaviour,
    ::testing::Values(Behaviour{"straight", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"stop", {kMoved, kRested}}, Behaviour{"reverse", {kMoved, kRested}},
                      Behaviour{"turn", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"brake_2", {kMoved, kRested}},
                      Behaviour{"brake_4", {kMoved, kRested}},
                      Behaviour{"speed_up_2", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"speed_up_4", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"circle", {kMoved}},
                      Behaviour{"late_entry", {kMoved, kPartly, kWholly, kPartly, kMissed, kLost}},
                      Behaviour{"leave", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"brush", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"park", {kMoved, kRested}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(RandomWalk, IsFollowedAsOneThing) {
  for (const char* const seed : {"1", "2", "3", "4", "5"}) {
    // Beside the tables: in the walkway it soon drives into one of them.
    const Watched watched(
        "random_walk",
        {{"moving_obstacles[0].motion.random_walk.start_m", "[2.2, 2, 0.6]"}, {"seed", seed}});
    EXPECT_EQ(watched.Story().front(), kMoved) << seed;
    EXPECT_THAT(watched.Story(), Not(Contains(track_event::kSplit))) << seed;
    EXPECT_LT(watched.worst_position_error_m(), 0.04) << seed;
  }
}

TEST(Stop, IsNoticedFourTenthsOfASecondLater) {
  EXPECT_NEAR(Watched("stop").TimeOf(kRested), 0.9 + 0.4, 0.1);
}

TEST(Park, LeavesNothingThatMoves) { EXPECT_EQ(Watched("park").num_moving_at_end(), 0u); }

// Where the two nearly touch they are one piece for two scans; then they are told apart again.
TEST(Crossing, IsAMergeAfterWhichBothAreFoundAgain) {
  const Watched watched("crossing");
  EXPECT_THAT(watched.Story(), Contains(track_event::kMerged));
  EXPECT_THAT(watched.Story(), Contains(track_event::kFound));
  EXPECT_LT(watched.TimeOf(track_event::kMerged), watched.TimeOf(track_event::kFound));
  EXPECT_THAT(watched.Story(), Not(Contains(track_event::kSplit)));
}

std::vector<std::string> StoryOf(const std::vector<SceneBox>& boxes, double until_s) {
  const GridSpec grid{{-1, -1, -1}, 0.04, {96, 96, 96}};
  ObjectTracker tracker(grid, {.max_distance_m = 0.3});
  std::vector<std::string> words;
  for (int frame = 0; frame <= kRate_hz * until_s; ++frame) {
    const EpisodeTime t(frame / kRate_hz);
    tracker.Update(Rasterise(boxes, grid, t), t);
    for (const TrackEvent& event : tracker.TakeEvents()) {
      words.push_back(event.what + std::to_string(event.id));
      if (event.other_id > 0) words.back() += "_" + std::to_string(event.other_id);
    }
  }
  return words;
}

TEST(TwoThatGoSideBySideForAWhile, MergeAndAreToldApart) {
  const SceneBox first = WalkwayRobot(1);
  SceneBox second = first;
  second.p_WO = [first](EpisodeTime t) -> Eigen::Vector3d {
    const double gap_m = 0.4 * std::max(0.0, std::abs(t.seconds() - 0.55) - 0.25);
    return first.p_WO(t) + Eigen::Vector3d(0.48 + gap_m, 0, 0);
  };
  EXPECT_THAT(StoryOf({first, second}, 1.1),
              ElementsAre("appeared1", "appeared2", "moved1", "moved2", "merged2_1", "found2"));
}

// A box that the sensor does not see for so many scans.
std::vector<std::string> StoryOfAGap(int num_scans) {
  SceneBox box = WalkwayRobot(1.4);
  box.is_there = [num_scans](EpisodeTime t) {
    const double scan = t.seconds() * kRate_hz;
    return scan < 14.5 || scan > 14.5 + num_scans;
  };
  return StoryOf({box}, 1);
}

TEST(AThingUnseenForAFewScans, IsFoundAgainAsTheSame) {
  EXPECT_THAT(StoryOfAGap(3), ElementsAre("appeared1", "moved1", "missed1", "found1"));
}

TEST(AThingUnseenForLong, IsLostAndComesBackAsAnother) {
  EXPECT_THAT(StoryOfAGap(8),
              ElementsAre("appeared1", "moved1", "missed1", "lost1", "appeared2", "moved2"));
}

}  // namespace
}  // namespace sidestep::sdf::behaviour_test
