#include "sidestep/core/grid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sidestep::grid_test {
namespace {

// Cells whose faces, at multiples of 1/4, have no rounding.
GridSpec QuarterMetreGrid() {
  return {.first_center_m = {0.125, -0.875, 0.125}, .cell_m = 0.25, .size = {4, 3, 5}};
}

TEST(GridSpec, CountsCellsWithXFastest) {
  const GridSpec spec = QuarterMetreGrid();
  EXPECT_EQ(spec.num_cells(), 60u);
  std::size_t expected = 0;
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 4; ++i) EXPECT_EQ(spec.Index(i, j, k), expected++);
    }
  }
}

TEST(GridSpec, CountsMoreCellsThanAnIntHolds) {
  const GridSpec spec = {.first_center_m = {0, 0, 0}, .cell_m = 1, .size = {2000, 2000, 2000}};
  EXPECT_EQ(spec.num_cells(), 8'000'000'000u);
  EXPECT_EQ(spec.Index(1999, 1999, 1999), 7'999'999'999u);
}

TEST(GridSpec, ContainsItsCellsAndNoNeighbour) {
  const GridSpec spec = QuarterMetreGrid();
  EXPECT_TRUE(spec.Contains(0, 0, 0));
  EXPECT_TRUE(spec.Contains(3, 2, 4));
  for (const std::array<int, 3>& c :
       {std::array{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {4, 0, 0}, {0, 3, 0}, {0, 0, 5}}) {
    EXPECT_FALSE(spec.Contains(c[0], c[1], c[2])) << c[0] << ' ' << c[1] << ' ' << c[2];
  }
}

TEST(GridSpec, FindsTheCellOfEveryCentreAgain) {
  const GridSpec spec = {.first_center_m = {-1.7, 0.3, 11.1}, .cell_m = 0.031, .size = {9, 8, 7}};
  for (int k = 0; k < 7; ++k) {
    for (int j = 0; j < 8; ++j) {
      for (int i = 0; i < 9; ++i) {
        EXPECT_EQ(spec.CellOf(spec.Center(i, j, k)), (std::array{i, j, k}));
      }
    }
  }
}

TEST(GridSpec, GivesAPointOnAFaceToTheUpperCell) {
  const GridSpec spec = QuarterMetreGrid();
  const double below = std::nextafter(0.25, 0.0);
  EXPECT_EQ(spec.CellOf({0.25, -0.9, 0.1}), (std::array{1, 0, 0}));
  EXPECT_EQ(spec.CellOf({below, -0.9, 0.1}), (std::array{0, 0, 0}));
  EXPECT_EQ(spec.CellOf({0, -1, 0}), (std::array{0, 0, 0}));        // the lowest corner is inside,
  EXPECT_EQ(spec.CellOf({1, -0.25, 1.25}), (std::array{4, 3, 5}));  // the highest is outside
}

TEST(GridSpec, AnswersForPointsFarOutside) {
  const GridSpec spec = QuarterMetreGrid();
  EXPECT_EQ(spec.CellOf({-0.01, -1.01, -0.01}), (std::array{-1, -1, -1}));
  const std::array<int, 3> far = spec.CellOf({1e300, -1e300, 0.1});
  EXPECT_FALSE(spec.Contains(far[0], far[1], far[2]));
  EXPECT_GT(far[0], 3);
  EXPECT_LT(far[1], 0);
}

TEST(GridSpec, IsCheckedForSizesAndNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(CheckGridSpec(QuarterMetreGrid()));
  for (const double cell_m : {0.0, -0.1, nan, inf}) {
    GridSpec spec = QuarterMetreGrid();
    spec.cell_m = cell_m;
    EXPECT_THROW(CheckGridSpec(spec), std::invalid_argument) << cell_m;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    GridSpec spec = QuarterMetreGrid();
    spec.size[axis] = 0;
    EXPECT_THROW(CheckGridSpec(spec), std::invalid_argument) << axis;
    spec = QuarterMetreGrid();
    spec.first_center_m(static_cast<int>(axis)) = nan;
    EXPECT_THROW(CheckGridSpec(spec), std::invalid_argument) << axis;
  }
}

TEST(OccupancyGrid, IsFreeUntilCellsAreFilled) {
  OccupancyGrid grid(QuarterMetreGrid());
  EXPECT_EQ(grid.cells.size(), 60u);
  EXPECT_EQ(grid.CountFilled(), 0u);
  grid.cells[grid.spec.Index(3, 0, 2)] = 1;
  grid.cells[grid.spec.Index(0, 2, 4)] = 1;
  EXPECT_EQ(grid.CountFilled(), 2u);
  EXPECT_TRUE(grid.At(3, 0, 2));
  EXPECT_TRUE(grid.At(0, 2, 4));
  EXPECT_FALSE(grid.At(2, 0, 2));
}

}  // namespace
}  // namespace sidestep::grid_test
