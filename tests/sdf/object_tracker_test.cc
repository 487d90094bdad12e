#include "sdf/tracking/object_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/sdf/box_scene.h"

namespace sidestep {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kRate_hz = 30;

class Replay {
 public:
  Replay(const GridSpec& grid, std::vector<SceneBox> boxes)
      : grid_(grid), boxes_(std::move(boxes)), tracker_(grid, {.max_distance_m = 0.3}) {}

  // Feeds frames up to (not including) time t_end_s, calling check(t) after each.
  template <class Check>
  void RunUntil(double t_end_s, const Check& check) {
    for (; frame_ / kRate_hz < t_end_s - 1e-9; ++frame_) {
      const EpisodeTime t(frame_ / kRate_hz);
      tracker_.Update(Rasterise(boxes_, grid_, t), t);
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
  ObjectTracker tracker_;
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
    ASSERT_THAT(replay.objects(), SizeIs(1)) << "at " << t.seconds();
    const TrackedObject& object = *replay.objects()[0];
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

}  // namespace
}  // namespace sidestep
