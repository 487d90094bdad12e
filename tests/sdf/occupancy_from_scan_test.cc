#include "sidestep/sdf/map/occupancy_from_scan.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

#include "sidestep/core/random.h"
#include "tests/sdf/box_scene.h"

namespace sidestep::sdf::occupancy_from_scan_test {
namespace {

TEST(OccupancyFromScan, GivesBackTheCellsWhoseCentresWereScanned) {
  std::vector<SceneBox> boxes = WalkwayTables();
  boxes.push_back(WalkwayRobot(1.4));
  const OccupancyGrid occupancy = Rasterise(boxes, WalkwayGrid(), EpisodeTime(0.7));
  ASSERT_GT(occupancy.CountFilled(), 10000u);
  EXPECT_EQ(ScanRasteriser(WalkwayGrid()).Fill(MakeScan(occupancy, EpisodeTime(0.7))).cells,
            occupancy.cells);
}

TEST(OccupancyFromScan, PlacesPointsByTheSensorsPose) {
  const GridSpec grid{{0, 0, 0}, 0.1, {10, 10, 10}};
  Scan scan;
  scan.X_WC = Pose::FromRollPitchYaw({0, 0, M_PI / 2}, {0.5, 0.2, 0.3});
  scan.p_CP = Eigen::Vector3d(0.2, 0.1, 0.4);  // in W: (0.4, 0.4, 0.7)
  const OccupancyGrid occupancy = ScanRasteriser(grid).Fill(scan);
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
  EXPECT_EQ(ScanRasteriser(grid).Fill(scan).CountFilled(), 0u);
  EXPECT_THROW(ScanRasteriser{GridSpec()}, std::invalid_argument);
}

// Scans of a sensor that is disturbed in every way, one after the other.
std::vector<Scan> DisturbedScans(const GridSpec& grid) {
  RandomStream random(3, "points");
  const double end_m = grid.size[0] * grid.cell_m + 0.2;
  const auto points = [&](int count) -> Eigen::Matrix3Xd {
    return Eigen::Matrix3Xd::NullaryExpr(3, count, [&] { return random.Uniform(-0.2, end_m); });
  };
  const Eigen::Matrix3Xd resting = points(200);
  Eigen::Matrix3Xd with_nan = resting;
  with_nan(1, 7) = std::numeric_limits<double>::quiet_NaN();
  const Pose turned = Pose::FromRollPitchYaw({0.1, 0.2, 0.3}, {0.01, 0, 0});
  std::vector<Scan> scans;
  const auto add = [&](const Pose& X_WC, const Eigen::Matrix3Xd& first, Eigen::Index num_first,
                       const Eigen::Matrix3Xd& then) {
    Scan& scan = scans.emplace_back();
    scan.X_WC = X_WC;
    scan.p_CP.resize(3, num_first + then.cols());
    scan.p_CP << first.leftCols(num_first), then;
  };
  for (int n = 0; n < 4; ++n) add({}, resting, 200, points(20 * n));  // more and more
  add({}, resting, 200, resting.leftCols(50));                        // cells twice
  for (int n = 0; n < 3; ++n) add({}, resting, 150, points(10));      // less rests
  for (int n = 0; n < 3; ++n) add({}, resting, 20, points(100));      // little does
  for (int n = 0; n < 3; ++n) add(turned, resting, 200, points(10));  // from elsewhere
  for (int n = 0; n < 3; ++n) add({}, with_nan, 200, points(10));
  add({}, resting, 0, points(0));
  for (int n = 0; n < 3; ++n) add({}, resting, 0, points(100));
  return scans;
}

TEST(OccupancyFromScan, FillsNothingThatOnlyEarlierScansShowed) {
  const GridSpec grid{{0, 0, 0}, 0.1, {10, 10, 10}};
  ScanRasteriser rasteriser(grid);
  OccupancyGrid before(grid);
  int times_told = 0;
  for (const Scan& scan : DisturbedScans(grid)) {
    SCOPED_TRACE(testing::Message() << scan.p_CP.cols() << " points");
    OccupancyGrid expected(grid);  // point by point
    for (Eigen::Index n = 0; n < scan.p_CP.cols(); ++n) {
      const Eigen::Vector3d p_WP = scan.X_WC * Eigen::Vector3d(scan.p_CP.col(n));
      if (!p_WP.allFinite()) continue;
      const auto [i, j, k] = grid.CellOf(p_WP);
      if (grid.Contains(i, j, k)) expected.cells[grid.Index(i, j, k)] = 1;
    }
    EXPECT_EQ(rasteriser.Fill(scan).cells, expected.cells);
    if (rasteriser.may_differ()) {
      ++times_told;
      for (const std::size_t cell : *rasteriser.may_differ()) {
        before.cells[cell] = expected.cells[cell];
      }
      EXPECT_EQ(before.cells, expected.cells) << "something else has changed, too";
    }
    before = expected;
  }
  EXPECT_GT(times_told, 0);
}

}  // namespace
}  // namespace sidestep::sdf::occupancy_from_scan_test
