#include "sdf/map/occupancy_from_scan.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/sdf/box_scene.h"

namespace sidestep {
namespace {

TEST(OccupancyFromScan, GivesBackTheCellsWhoseCentresWereScanned) {
  std::vector<SceneBox> boxes = WalkwayTables();
  boxes.push_back(WalkwayRobot(1.4));
  const OccupancyGrid occupancy = Rasterise(boxes, WalkwayGrid(), EpisodeTime(0.7));
  ASSERT_GT(occupancy.CountFilled(), 10000u);
  EXPECT_EQ(FillFromScan(MakeScan(occupancy, EpisodeTime(0.7)), WalkwayGrid()).cells,
            occupancy.cells);
}

TEST(OccupancyFromScan, PlacesPointsByTheSensorsPose) {
  const GridSpec grid{{0, 0, 0}, 0.1, {10, 10, 10}};
  Scan scan;
  scan.X_WC = Pose::FromRollPitchYaw({0, 0, M_PI / 2}, {0.5, 0.2, 0.3});
  scan.p_CP = Eigen::Vector3d(0.2, 0.1, 0.4);  // in W: (0.4, 0.4, 0.7)
  const OccupancyGrid occupancy = FillFromScan(scan, grid);
  EXPECT_EQ(occupancy.CountFilled(), 1u);
  EXPECT_TRUE(occupancy.At(4, 4, 7));
}

TEST(OccupancyFromScan, LeavesOutWhatIsOutsideTheGridOrNotANumber) {
  const double kNan = std::numeric_limits<double>::quiet_NaN();
  const double kInfinity = std::numeric_limits<double>::infinity();
  const GridSpec grid{{0, 0, 0}, 0.1, {10, 10, 10}};
  Scan scan;
  scan.p_CP.resize(3, 5);
  scan.p_CP << 0.96, -0.06, kNan, kInfinity, 1e300,  //
      0.5, 0.5, 0.5, 0.5, 0.5,                       //
      0.5, 0.5, 0.5, 0.5, 0.5;
  EXPECT_EQ(FillFromScan(scan, grid).CountFilled(), 0u);
  EXPECT_THROW(FillFromScan(scan, GridSpec()), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep
