// Things that turn, followed from the cells that they fill.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/core/shape.h"
#include "sidestep/sdf/tracking/object_tracker.h"
#include "tests/sdf/box_scene.h"

namespace sidestep::sdf::turning_box_test {
namespace {

constexpr double kRate_hz = 30;
const Box kBox{{0.23, 0.57, 0.4}};

struct Turning {
  const char* name;
  std::function<Pose(double)> X_WO;
};
std::ostream& operator<<(std::ostream& stream, const Turning& c) { return stream << c.name; }

Pose Turned(double yaw_rad, double x_m, double y_m) {
  return Pose::FromRollPitchYaw({0, 0, yaw_rad}, {x_m, y_m, 0.4});
}

const std::vector<Turning> kTurnings = {
    {"RoundACurve",
     [](double t) { return Turned(1.2 * t, 0.5 * std::sin(1.2 * t), -0.5 * std::cos(1.2 * t)); }},
    {"SpinningOnAStraightWay", [](double t) { return Turned(6 * t, -0.7 + 0.7 * t, 0.1); }},
    {"SpinningRoundACorner",
     [](double t) {
       return Turned(4 * t, -0.6 + 0.8 * std::min(t, 1.0), -0.6 + 0.8 * std::max(t - 1, 0.0));
     }},
    {"SpinningThereAndBack",
     [](double t) { return Turned(4 * t, 0.5 - 0.9 * std::abs(t - 1), 0.1); }},
};

OccupancyGrid Filled(const GridSpec& spec, const Pose& X_WO) {
  OccupancyGrid grid(spec);
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    grid.cells[cell] = SignedDistance(kBox, X_WO.Inverse() * spec.CenterOf(cell)) < 0 ? 1 : 0;
  }
  return grid;
}

class ATurningBox : public ::testing::TestWithParam<Turning> {};

// Its middle is seen at every frame, as that of one that does not turn.
TEST_P(ATurningBox, IsFollowedAsOneThingToHalfACell) {
  const GridSpec spec{{-1, -1, 0.02}, 0.04, {50, 50, 20}};
  ObjectTracker tracker(spec, {.max_distance_m = 0.3});
  std::vector<std::string> story;
  for (int frame = 0; frame <= 2 * kRate_hz; ++frame) {
    const EpisodeTime t(frame / kRate_hz);
    const Pose X_WO = GetParam().X_WO(t.seconds());
    tracker.Update(Filled(spec, X_WO), t);
    for (const TrackEvent& event : tracker.TakeEvents()) story.push_back(event.what);
    for (const auto& object : tracker.MovingObjects()) {
      EXPECT_LT((object->latest().p_WO - X_WO.translation()).norm(), 0.02) << t.seconds() << " s";
    }
  }
  EXPECT_EQ(story, (std::vector<std::string>{"appeared", "moved"}));
}

INSTANTIATE_TEST_SUITE_P(EveryWay, ATurningBox, ::testing::ValuesIn(kTurnings),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep::sdf::turning_box_test
