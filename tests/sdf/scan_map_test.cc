#include "sidestep/sdf/map/scan_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sidestep/sdf/map/cells_on_line.h"
#include "tests/support/random_points.h"

namespace sidestep::sdf::scan_map_test {
namespace {

const GridSpec kGrid = {{-0.95, -0.95, -0.95}, 0.1, {20, 20, 20}};

std::size_t CellAt(const Eigen::Vector3d& p_W) {
  const auto [i, j, k] = kGrid.CellOf(p_W);
  return kGrid.Index(i, j, k);
}

// A camera at the origin of W that looks along x.
Scan Surface(const std::vector<Eigen::Vector3d>& hits,
             const std::vector<Eigen::Vector3d>& free_ends, double t_s = 0) {
  Scan scan;
  scan.t = EpisodeTime(t_s);
  scan.kind = ScanKind::kSurface;
  scan.p_CP.resize(3, static_cast<Eigen::Index>(hits.size()));
  for (std::size_t n = 0; n < hits.size(); ++n) {
    scan.p_CP.col(static_cast<Eigen::Index>(n)) = hits[n];
  }
  scan.p_CFree.resize(3, static_cast<Eigen::Index>(free_ends.size()));
  for (std::size_t n = 0; n < free_ends.size(); ++n) {
    scan.p_CFree.col(static_cast<Eigen::Index>(n)) = free_ends[n];
  }
  return scan;
}

// The cells on a line, the one that holds its end left out.
std::vector<std::size_t> CellsOnTheWay(const Eigen::Vector3d& start, const Eigen::Vector3d& end) {
  std::vector<std::size_t> cells;
  double left = 0;
  VisitCellsOnLine(kGrid, start, end, [&](std::size_t cell, double enter, double leave) {
    if (cell == CellAt(end)) return false;
    EXPECT_TRUE(cells.empty() || enter == left) << "a gap";
    EXPECT_LE(enter, leave);
    left = leave;
    cells.push_back(cell);
    return true;
  });
  return cells;
}

// A map that takes each scan at its word.
ScanMap MapOf(UnseenSpace unseen) { return ScanMap(kGrid, {}, {{"", {unseen, 0}}}); }

bool Filled(const OccupancyGrid& grid, const Eigen::Vector3d& p_W) {
  return grid.cells[CellAt(p_W)] != 0;
}

TEST(CellsOnTheWay, AreThoseThatManySamplesOfTheLineFallInto) {
  RandomStream random(1, "lines");
  for (int run = 0; run < 500; ++run) {
    const Eigen::Vector3d start = UniformPoint(random, 1.5);
    const Eigen::Vector3d end = UniformPoint(random, 1.5);
    const std::vector<std::size_t> cells = CellsOnTheWay(start, end);
    std::vector<std::size_t> sampled;
    constexpr int kSamples = 3000;
    for (int n = 0; n <= kSamples; ++n) {
      const Eigen::Vector3d p = start + (end - start) * n / kSamples;
      const auto cell = kGrid.CellOf(p);
      if (!kGrid.Contains(cell[0], cell[1], cell[2]) || cell == kGrid.CellOf(end)) continue;
      const std::size_t index = kGrid.Index(cell[0], cell[1], cell[2]);
      if (sampled.empty() || sampled.back() != index) sampled.push_back(index);
    }
    // Sampling may step over a corner that the line just cuts, never the other way round.
    std::size_t at = 0;
    for (const std::size_t cell : sampled) {
      while (at < cells.size() && cells[at] != cell) ++at;
      ASSERT_LT(at, cells.size()) << "run " << run;
    }
    EXPECT_LE(cells.size(), sampled.size() + 8) << "run " << run;
    std::vector<std::size_t> sorted = cells;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end()) << "visited twice";
  }
}

TEST(CellsOnTheWay, OfALineAlongAnAxisAreARow) {
  const std::vector<std::size_t> cells = CellsOnTheWay({0.05, 0.05, 0.05}, {0.55, 0.05, 0.05});
  ASSERT_EQ(cells.size(), 5u);
  for (std::size_t n = 0; n < 5; ++n) {
    EXPECT_EQ(cells[n], CellAt({0.05 + 0.1 * static_cast<double>(n), 0.05, 0.05}));
  }
}

TEST(CellsOnTheWay, AreNoneForALineBesideTheGrid) {
  EXPECT_TRUE(CellsOnTheWay({-2, 3, 0}, {2, 3, 0}).empty());
  EXPECT_TRUE(CellsOnTheWay({0.3, 0.3, 0.3}, {0.3, 0.3, 0.3}).empty());
}

const Eigen::Vector3d kHit(0.55, 0.05, 0.05), kBefore(0.35, 0.03, 0.03), kBehind(0.85, 0.05, 0.05);

TEST(ScanMap, FillsTheSurfaceAndTreatsWhatIsBehindAsConfigured) {
  const struct {
    UnseenSpace unseen;
    bool behind;
  } cases[] = {
      {UnseenSpace::kFree, false}, {UnseenSpace::kFilled, true}, {UnseenSpace::kRemembered, false}};
  for (const auto& [unseen, behind] : cases) {
    ScanMap map = MapOf(unseen);
    const OccupancyGrid grid = map.Update(Surface({kHit}, {}));
    EXPECT_TRUE(Filled(grid, kHit)) << ToString(unseen);
    EXPECT_FALSE(Filled(grid, kBefore)) << ToString(unseen);
    EXPECT_EQ(Filled(grid, kBehind), behind) << ToString(unseen);
  }
}

TEST(ScanMap, SeesThatASpaceIsFreeWhereARayMeetsNothing) {
  ScanMap map = MapOf(UnseenSpace::kFilled);
  const OccupancyGrid grid = map.Update(Surface({}, {{3, 0.17, 0.17}}));
  EXPECT_FALSE(Filled(grid, {0.85, 0.05, 0.05}));
  EXPECT_TRUE(Filled(grid, {0.85, 0.45, 0.05}));
}

TEST(ScanMap, RemembersWhatItDoesNotSeeUntilItLooksAgain) {
  ScanMap remembering = MapOf(UnseenSpace::kRemembered), forgetting = MapOf(UnseenSpace::kFree);
  for (ScanMap* const map : {&remembering, &forgetting}) {
    map->Update(Surface({kHit}, {}, 0));
    const OccupancyGrid elsewhere = map->Update(Surface({{-0.55, 0.05, 0.05}}, {}, 1));
    EXPECT_EQ(Filled(elsewhere, kHit), map == &remembering);
    const OccupancyGrid gone = map->Update(Surface({}, {kBehind}, 2));
    EXPECT_FALSE(Filled(gone, kHit));
  }
}

TEST(ScanMap, KeepsASurfaceThatAnotherRayOfTheSameScanPasses) {
  ScanMap map = MapOf(UnseenSpace::kFree);
  const OccupancyGrid grid = map.Update(Surface({kHit}, {kBehind}));
  EXPECT_TRUE(Filled(grid, kHit));
}

TEST(ScanMap, TakesAScanOfSolidsForTheWholeTruth) {
  ScanMap map = MapOf(UnseenSpace::kFilled);
  Scan scan = Surface({kHit}, {});
  scan.kind = ScanKind::kSolid;
  EXPECT_EQ(map.Update(scan).CountFilled(), 1u);
}

TEST(ScanMap, LeavesOutRaysThatAreNotFinite) {
  ScanMap map = MapOf(UnseenSpace::kFilled);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const OccupancyGrid grid = map.Update(Surface({{nan, 0, 1}}, {{0, nan, 1}}));
  EXPECT_EQ(grid.CountFilled(), kGrid.num_cells());
}

// Named, and from where its camera stands.
Scan From(const std::string& sensor, const Eigen::Vector3d& p_WC,
          const std::vector<Eigen::Vector3d>& hits_W, const std::vector<Eigen::Vector3d>& ends_W,
          double t_s) {
  Scan scan = Surface(hits_W, ends_W, t_s);
  scan.sensor = sensor;
  scan.X_WC = Pose::Translation(p_WC);
  scan.p_CP.colwise() -= p_WC;
  scan.p_CFree.colwise() -= p_WC;
  return scan;
}

TEST(ScanMap, KeepsWhatOneSensorSeesAndAnotherDoesNot) {
  for (const UnseenSpace unseen : {UnseenSpace::kFree, UnseenSpace::kRemembered}) {
    ScanMap map(kGrid, {}, {{"left", {unseen, 0}}, {"right", {unseen, 0}}});
    const Eigen::Vector3d right(0.05, -0.9, 0.05);
    map.Update(From("left", {0, 0, 0}, {kHit}, {}, 0));
    // The other one looks elsewhere, then past it, then the first one sees that it is gone.
    EXPECT_TRUE(Filled(map.Update(From("right", right, {}, {{-0.8, -0.8, 0.05}}, 0)), kHit));
    EXPECT_TRUE(Filled(map.Update(From("right", right, {}, {{1.05, 0.95, 0.05}}, 0.03)), kHit));
    EXPECT_FALSE(Filled(map.Update(From("left", {0, 0, 0}, {}, {kBehind}, 0.03)), kHit));
  }
}

TEST(ScanMap, LetsASensorFreeWhatAnotherSawThereBefore) {
  ScanMap map(kGrid, {}, {});
  map.Update(From("left", {0, 0, 0}, {kHit}, {}, 0));
  map.Update(From("left", {0, 0, 0}, {{-0.55, 0.05, 0.05}}, {}, 0.1));  // it is hidden now
  const Eigen::Vector3d right(0.55, -0.9, 0.05);
  EXPECT_FALSE(Filled(map.Update(From("right", right, {}, {{0.55, 0.9, 0.05}}, 0.1)), kHit));
}

TEST(ScanMap, AddsWhatSensorsOfSolidsTellToWhatCamerasSee) {
  ScanMap map(kGrid, {}, {});
  Scan solid = Surface({kBehind}, {});
  solid.kind = ScanKind::kSolid;
  solid.sensor = "tags";
  map.Update(solid);
  const OccupancyGrid both = map.Update(From("camera", {0, 0, 0}, {kHit}, {}, 0));
  EXPECT_TRUE(Filled(both, kHit));
  EXPECT_TRUE(Filled(both, kBehind));
  EXPECT_EQ(both.CountFilled(), 2u);
  solid.p_CP.resize(3, 0);
  EXPECT_EQ(map.Update(solid).CountFilled(), 1u) << "what it told before is gone";
}

TEST(UnseenSpace, HasAWordForEachKind) {
  for (const char* const word : {"free", "filled", "remembered"}) {
    EXPECT_EQ(ToString(UnseenSpaceFromString(word)), word);
  }
  EXPECT_THROW(UnseenSpaceFromString("fog"), std::invalid_argument);
}

TEST(FillObjects, FillsTheCellsOfATurnedShapeByTheRule) {
  ObjectObservation object;
  object.shape = Box{{0.6, 0.3, 0.4}};
  object.X_WO = Pose::FromRollPitchYaw({0.3, 0.2, 0.9}, {0.11, -0.52, 0.7});
  OccupancyGrid centres(kGrid), touched(kGrid);
  FillObjects({object}, CellRule::kCentre, &centres);
  FillObjects({object}, CellRule::kTouched, &touched);
  const CubeTouch touches(object.shape, object.X_WO.rotation().toRotationMatrix(),
                          object.X_WO.translation(), kGrid.cell_m);
  for (std::size_t cell = 0; cell < centres.cells.size(); ++cell) {
    const Eigen::Vector3d p_WCell = kGrid.CenterOf(cell);
    EXPECT_EQ(centres.cells[cell] != 0,
              SignedDistance(object.shape, object.X_WO.Inverse() * p_WCell) < 0);
    EXPECT_EQ(touched.cells[cell] != 0, touches(p_WCell));
  }
  EXPECT_GT(centres.CountFilled(), 40u);
  EXPECT_GT(touched.CountFilled(), centres.CountFilled());
}

}  // namespace
}  // namespace sidestep::sdf::scan_map_test
