// What tracking says of each way in which an obstacle may behave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sdf/tracking/object_tracker.h"
#include "tests/sdf/box_scene.h"

namespace sidestep {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kRate_hz = 30, kDuration_s = 3.5;

SceneBox AsBox(const MovingObstacle& obstacle) {
  return {std::get<Box>(obstacle.shape).size_m, [obstacle](EpisodeTime t) -> Eigen::Vector3d {
            return PoseAt(obstacle, t).translation();
          }};
}

// One behaviour of the walkway, watched from the start.
class Watched {
 public:
  explicit Watched(const std::string& behaviour)
      : scenario_(LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/walkway_behaviours.yaml",
                               {{"behaviour", behaviour}})) {
    std::vector<SceneBox> boxes;
    for (const StaticBox& box : scenario_.static_boxes) {
      boxes.push_back(StillBox(box.size_m, box.X_WO.translation()));
    }
    for (const MovingObstacle& obstacle : scenario_.moving_obstacles) {
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
  void CheckPositions(const ObjectTracker& tracker, EpisodeTime t) {
    for (const auto& object : tracker.MovingObjects()) {
      if (object->latest().t != t) continue;  // not in this scan
      double nearest_m = INFINITY;
      for (const MovingObstacle& obstacle : scenario_.moving_obstacles) {
        const Eigen::Vector3d p_WBox = object->latest().p_WO + object->box_center_O;
        nearest_m = std::min(nearest_m, (p_WBox - PoseAt(obstacle, t).translation()).norm());
      }
      worst_position_error_m_ = std::max(worst_position_error_m_, nearest_m);
    }
  }

  Scenario scenario_;
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

TEST_P(EveryBehaviour, IsFollowedToWithinACell) {
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
                      Behaviour{"stop", {kMoved, kRested}}, Behaviour{"reverse", {kMoved}},
                      Behaviour{"turn", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"brake_2", {kMoved, kRested}},
                      Behaviour{"brake_4", {kMoved, kRested}},
                      Behaviour{"speed_up_2", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"speed_up_4", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"circle", {kMoved}},
                      Behaviour{"late_entry", {kMoved, kPartly, kWholly}},
                      Behaviour{"leave", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"brush", {kMoved, kPartly, kMissed, kLost}},
                      Behaviour{"park", {kMoved, kRested}}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep
