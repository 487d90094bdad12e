#include "sidestep/sdf/map/grid_changes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/sdf/map/static_map.h"

namespace sidestep::sdf::grid_changes_test {
namespace {

// Turns cells of a few places over, or none.
void Disturb(RandomStream& random, OccupancyGrid* grid) {
  const int times = static_cast<int>(random.Uniform(0, 4));
  for (int n = 0; n < times; ++n) {
    const std::size_t size = grid->cells.size();
    const auto begin = static_cast<std::size_t>(random.Uniform(0, 1) * static_cast<double>(size));
    const std::size_t end = std::min(size, begin + static_cast<std::size_t>(random.Uniform(1, 40)));
    for (std::size_t cell = begin; cell < end; ++cell) grid->cells[cell] ^= 1;
  }
}

TEST(GridChanges, AreTheCellsThatAreNotAsTheyWere) {
  RandomStream random(1, "grids");
  OccupancyGrid grid(GridSpec{{0, 0, 0}, 0.04, {21, 33, 17}});
  GridChanges changes, of_told;
  std::vector<std::uint8_t> last(grid.cells.size(), 0);
  for (int n = 0; n < 200; ++n) {
    Disturb(random, &grid);
    std::vector<std::size_t> expected;
    for (std::size_t cell = 0; cell < last.size(); ++cell) {
      if (grid.cells[cell] != last[cell]) expected.push_back(cell);
    }
    const auto found = changes.Update(grid);
    ASSERT_EQ(std::vector<std::size_t>(found.begin(), found.end()), expected);
    // Told some that have not, twice, and backwards, it comes to the same.
    std::vector<std::size_t> told = expected;
    for (int k = 0; k < 10; ++k) told.push_back(static_cast<std::size_t>(random.Uniform(0, 5000)));
    told.insert(told.end(), expected.rbegin(), expected.rend());
    const auto again = of_told.Update(grid, told);
    ASSERT_EQ(std::vector<std::size_t>(again.begin(), again.end()), expected);
    last = grid.cells;
  }
}

TEST(StaticMap, HasTheFieldOfAllWhenItIsToldWhatHasChanged) {
  RandomStream random(2, "grids");
  OccupancyGrid grid(GridSpec{{0, 0, 0}, 0.04, {12, 10, 11}});
  grid.cells[5] = 1;
  GridChanges changes;
  StaticMap told, all;
  for (int n = 0; n < 50; ++n) {
    told.Set(grid, changes.Update(grid));
    all.Set(grid);
    ASSERT_EQ(told.Field()->distance_m(), all.Field()->distance_m());
    Disturb(random, &grid);
  }
}

}  // namespace
}  // namespace sidestep::sdf::grid_changes_test
