#include "sidestep/sdf/tracking/segmentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "sidestep/core/random.h"

namespace sidestep::sdf::segmentation_test {
namespace {

// Brute force: every pair of filled cells that touch gets the same label, until nothing changes.
std::vector<int> LabelByRelaxation(const OccupancyGrid& grid) {
  const auto [nx, ny, nz] = grid.spec.size;
  std::vector<std::array<int, 3>> cells;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        if (grid.At(i, j, k)) cells.push_back({i, j, k});
  std::vector<int> labels(grid.cells.size(), -1);
  for (const auto& [i, j, k] : cells) {
    labels[grid.spec.Index(i, j, k)] = static_cast<int>(grid.spec.Index(i, j, k));
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& a : cells) {
      for (const auto& b : cells) {
        if (std::abs(a[0] - b[0]) > 1 || std::abs(a[1] - b[1]) > 1 || std::abs(a[2] - b[2]) > 1) {
          continue;
        }
        int& label_a = labels[grid.spec.Index(a[0], a[1], a[2])];
        const int label_b = labels[grid.spec.Index(b[0], b[1], b[2])];
        if (label_b < label_a) {
          label_a = label_b;
          changed = true;
        }
      }
    }
  }
  return labels;
}

TEST(Segmentation, EqualsBruteForceOnRandomGrids) {
  RandomStream random(1, "cells");
  const std::array<int, 3> sizes[] = {{9, 8, 7}, {30, 1, 5}, {1, 1, 40}, {6, 6, 6},
                                      {1, 1, 1}, {70, 5, 4}, {3, 2, 200}};
  for (const std::array<int, 3>& size : sizes) {
    for (const double share : {0.0, 0.03, 0.08, 0.3, 1.0}) {
      SCOPED_TRACE(testing::Message()
                   << size[0] << 'x' << size[1] << 'x' << size[2] << ' ' << share);
      OccupancyGrid grid({{0, 0, 0}, 0.1, size});
      for (auto& cell : grid.cells) cell = random.Uniform() < share ? 1 : 0;
      std::vector<int> labels(grid.cells.size(), -1);
      int last_seed = -1;
      for (const Component& component : FindComponents(grid)) {
        const int seed = static_cast<int>(component.cells.front());
        EXPECT_GT(seed, last_seed) << "in the order of their lowest cell";
        last_seed = seed;
        EXPECT_TRUE(std::is_sorted(component.cells.begin(), component.cells.end()));
        for (const std::size_t cell : component.cells) {
          EXPECT_EQ(labels[cell], -1) << "a cell in two components";
          labels[cell] = seed;
        }
      }
      EXPECT_EQ(labels, LabelByRelaxation(grid));
    }
  }
}

TEST(Segmentation, JoinsNothingInAGridOfLonelyCellsAndAllOfACheckerboard) {
  OccupancyGrid lonely({{0, 0, 0}, 1, {40, 20, 20}});
  OccupancyGrid checkerboard = lonely;
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 40; ++i) {
        lonely.cells[lonely.spec.Index(i, j, k)] = i % 2 == 0 && j % 2 == 0 && k % 2 == 0;
        checkerboard.cells[lonely.spec.Index(i, j, k)] = (i + j + k) % 2 == 0;
      }
  EXPECT_EQ(FindComponents(lonely).size(), 20u * 10 * 10);
  const std::vector<Component> components = FindComponents(checkerboard);
  ASSERT_EQ(components.size(), 1u);
  EXPECT_EQ(components[0].cells.size(), 40u * 20 * 20 / 2);
}

TEST(Segmentation, TakesCellsThatAreLeftOutForFree) {
  RandomStream random(2, "cells");
  OccupancyGrid grid({{0, 0, 0}, 0.1, {67, 11, 9}});
  std::vector<std::uint8_t> left_out(grid.cells.size());
  OccupancyGrid rest = grid;
  for (std::size_t n = 0; n < grid.cells.size(); ++n) {
    grid.cells[n] = random.Bits() % 4 == 0;
    left_out[n] = random.Bits() % 2;
    rest.cells[n] = grid.cells[n] != 0 && left_out[n] == 0;
  }
  const std::vector<Component> components = FindComponents(grid, left_out);
  const std::vector<Component> expected = FindComponents(rest);
  ASSERT_EQ(components.size(), expected.size());
  for (std::size_t c = 0; c < expected.size(); ++c) {
    EXPECT_EQ(components[c].cells, expected[c].cells);
  }
  left_out.pop_back();
  EXPECT_THROW(FindComponents(grid, left_out), std::invalid_argument);
}

TEST(Segmentation, FindsTheSameWhereItNeedNotSearchWhatIsKnownToHoldNothing) {
  RandomStream random(3, "cells");
  OccupancyGrid grid({{0, 0, 0}, 0.1, {67, 11, 9}});
  std::vector<std::uint8_t> left_out(grid.cells.size(), 0);
  SearchBlocks blocks(grid.cells.size());
  std::size_t num_unsearched = 0;
  for (int n = 0; n < 300; ++n) {
    for (int k = 0; k < 5; ++k) {
      const std::size_t cell = random.Bits() % grid.cells.size();
      grid.cells[cell] = random.Bits() % 3 == 0;
      left_out[random.Bits() % left_out.size()] = 1;  // that needs no mark: there is less
      blocks.Mark(cell);
    }
    const std::vector<Component> components = FindComponents(grid, left_out, &blocks);
    const std::vector<Component> expected = FindComponents(grid, left_out);
    ASSERT_EQ(components.size(), expected.size());
    for (std::size_t c = 0; c < expected.size(); ++c) {
      EXPECT_EQ(components[c].cells, expected[c].cells);
    }
    for (std::size_t b = 0; b < blocks.num_blocks(); ++b) num_unsearched += !blocks.may_hold(b);
  }
  EXPECT_GT(num_unsearched, 0u);
  SearchBlocks others(grid.cells.size() + SearchBlocks::kCells);
  EXPECT_THROW(FindComponents(grid, left_out, &others), std::invalid_argument);
}

TEST(Segmentation, DescribesABoxByItsCornersAndItsCentre) {
  OccupancyGrid grid({{-1, 0, 2}, 0.5, {10, 10, 10}});
  for (int k = 1; k <= 2; ++k)
    for (int j = 3; j <= 3; ++j)
      for (int i = 4; i <= 9; ++i) grid.cells[grid.spec.Index(i, j, k)] = 1;
  const std::vector<Component> components = FindComponents(grid);
  ASSERT_EQ(components.size(), 1u);
  EXPECT_EQ(components[0].first, (std::array<int, 3>{4, 3, 1}));
  EXPECT_EQ(components[0].last, (std::array<int, 3>{9, 3, 2}));
  EXPECT_LT((components[0].centroid_m - Eigen::Vector3d(2.25, 1.5, 2.75)).norm(), 1e-12);
}

TEST(Segmentation, JoinsCellsThatShareOnlyACornerAndPartsThoseWithAFreeCellBetween) {
  OccupancyGrid grid({{0, 0, 0}, 1, {6, 3, 3}});
  grid.cells[grid.spec.Index(0, 0, 0)] = 1;
  grid.cells[grid.spec.Index(1, 1, 1)] = 1;
  grid.cells[grid.spec.Index(3, 1, 1)] = 1;
  const std::vector<Component> components = FindComponents(grid);
  ASSERT_EQ(components.size(), 2u);
  EXPECT_EQ(components[0].cells.size(), 2u);
  EXPECT_EQ(components[1].cells.size(), 1u);
}

TEST(Segmentation, CutsOutAComponentWhereItStandsAndWithoutItsNeighbours) {
  OccupancyGrid grid({{-1, 0, 2}, 0.5, {8, 8, 8}});
  const std::array<int, 3> ring[] = {{2, 3, 4}, {3, 3, 4}, {4, 4, 4}, {4, 5, 5}};
  for (const auto& [i, j, k] : ring) grid.cells[grid.spec.Index(i, j, k)] = 1;
  grid.cells[grid.spec.Index(2, 5, 5)] = 1;  // within the box of the others
  const std::vector<Component> components = FindComponents(grid);
  ASSERT_EQ(components.size(), 2u);
  const OccupancyGrid shape = CutOut(components[0], grid.spec);
  EXPECT_EQ(shape.spec.size, (std::array<int, 3>{3, 3, 2}));
  EXPECT_EQ(shape.spec.first_center_m, grid.spec.Center(2, 3, 4));
  EXPECT_EQ(shape.CountFilled(), 4u);
  for (const auto& [i, j, k] : ring) EXPECT_TRUE(shape.At(i - 2, j - 3, k - 4));
}

}  // namespace
}  // namespace sidestep::sdf::segmentation_test
