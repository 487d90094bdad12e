#include "sidestep/sdf/map/fast_distance_transform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/sdf/map/fast_distance_transform_envelope.h"
#include "tests/sdf/only_target.h"
#include "tests/support/allocations.h"

namespace sidestep::sdf {
namespace {

using ::testing::Each;

constexpr double kCell_m = 0.04;
constexpr DistanceConvention kConventions[] = {DistanceConvention::kSurface,
                                               DistanceConvention::kBwdist};
constexpr int kLaneBits[] = {8, 16, 32};

// --- Grids ---------------------------------------------------------------------------------------

using Size = std::array<int, 3>;

template <class IsFilled>
OccupancyGrid MakeGrid(const Size& size, const IsFilled& is_filled) {
  OccupancyGrid grid(GridSpec{{-1, 0.5, 2}, kCell_m, size});
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) grid.cells[grid.spec.Index(i, j, k)] = is_filled(i, j, k);
    }
  }
  return grid;
}

OccupancyGrid Random(const Size& size, double share) {
  const int seed = size[0] + 100 * size[1] + 10000 * size[2];
  RandomStream random(static_cast<std::uint64_t>(seed), "cells");
  return MakeGrid(size, [&](int, int, int) { return random.Uniform() < share; });
}

OccupancyGrid Inverted(OccupancyGrid grid) {
  for (std::uint8_t& cell : grid.cells) cell = cell == 0;
  return grid;
}

struct Case {
  std::string name;
  OccupancyGrid grid;
};

std::vector<Case> Cases() {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const OccupancyGrid& grid) {
    const auto [nx, ny, nz] = grid.spec.size;
    const std::string size =
        std::to_string(nx) + "x" + std::to_string(ny) + "x" + std::to_string(nz);
    cases.push_back({name + "_" + size, grid});
    cases.push_back({"inverted_" + name + "_" + size, Inverted(grid)});
  };
  for (const Size& size : {Size{1, 1, 1}, Size{5, 3, 2}, Size{70, 2, 3}}) {
    add("empty", MakeGrid(size, [](int, int, int) { return false; }));
  }
  // Thin, odd, and around the numbers of lanes of columns and words of bits.
  for (const Size& size :
       {Size{2, 1, 1}, Size{1, 9, 1}, Size{1, 1, 33}, Size{40, 1, 7}, Size{3, 40, 1},
        Size{1, 19, 23}, Size{7, 5, 11}, Size{15, 16, 17}, Size{31, 6, 9}, Size{32, 9, 6},
        Size{33, 7, 8}, Size{63, 5, 4}, Size{64, 4, 5}, Size{65, 5, 6}, Size{129, 3, 4}}) {
    for (const double share : {0.0005, 0.02, 0.5, 0.9}) add("random", Random(size, share));
    const auto [nx, ny, nz] = size;
    add("corner", MakeGrid(size, [](int i, int j, int k) { return i + j + k == 0; }));
    add("centre", MakeGrid(size, [nx = nx, ny = ny, nz = nz](int i, int j, int k) {
          return i == nx / 2 && j == ny / 2 && k == nz / 2;
        }));
    add("checkerboard", MakeGrid(size, [](int i, int j, int k) { return (i + j + k) % 2 == 0; }));
  }
  const Size cube = {34, 33, 35};
  for (const double share : {0.0001, 0.001, 0.02, 0.5}) add("random", Random(cube, share));
  const auto squared = [](int i, int j, int k) {
    return (i - 17) * (i - 17) + (j - 16) * (j - 16) + (k - 18) * (k - 18);
  };
  add("ball", MakeGrid(cube, [&](int i, int j, int k) { return squared(i, j, k) < 150; }));
  add("shell", MakeGrid(cube, [&](int i, int j, int k) {
        return squared(i, j, k) < 200 && squared(i, j, k) > 170;
      }));
  add("diagonal_plane", MakeGrid(cube, [](int i, int j, int k) { return i + j + k == 50; }));
  add("steep_plane", MakeGrid(cube, [](int i, int j, int k) { return i == 3 * j - 2 * k; }));
  add("edges", MakeGrid(cube, [](int i, int j, int k) { return i * j == 0 || k * i == 0; }));
  add("boxes", MakeGrid(cube, [](int i, int j, int k) {
        return (i > 3 && i < 9 && j > 20 && k < 30) || (i > 12 && j < 14 && j > 9 && k > 31);
      }));
  return cases;
}

// --- Truth ---------------------------------------------------------------------------------------

std::vector<float> Clamped(std::vector<float> distance_m, double max_distance_m) {
  const float limit = static_cast<float>(max_distance_m);
  for (float& distance : distance_m) distance = std::clamp(distance, -limit, limit);
  return distance_m;
}

// By definition: every cell against every other one.
std::vector<float> BruteForce(const OccupancyGrid& grid, DistanceConvention convention) {
  const auto axis_square = [&](int offset) {
    const int faces = convention == DistanceConvention::kSurface && offset != 0 ? 1 : 0;
    return (2 * std::abs(offset) - faces) * (2 * std::abs(offset) - faces);
  };
  const auto [nx, ny, nz] = grid.spec.size;
  std::vector<float> distance_m(grid.cells.size());
  MakeGrid(grid.spec.size, [&, nx = nx, ny = ny, nz = nz](int i, int j, int k) {
    const bool filled = grid.At(i, j, k);
    int nearest = std::numeric_limits<int>::max();
    for (int c = 0; c < nz; ++c) {
      for (int b = 0; b < ny; ++b) {
        for (int a = 0; a < nx; ++a) {
          if (grid.At(a, b, c) == filled) continue;
          nearest = std::min(nearest, axis_square(a - i) + axis_square(b - j) + axis_square(c - k));
        }
      }
    }
    const float distance =
        nearest == std::numeric_limits<int>::max()
            ? kNoSurfaceDistance_m
            : static_cast<float>(kCell_m / 2 * std::sqrt(static_cast<float>(nearest)));
    distance_m[grid.spec.Index(i, j, k)] = filled ? -distance : distance;
    return false;
  });
  return distance_m;
}

// Brute force takes the square of the number of cells; beyond a few thousand, the simple transform
// stands in for it (distance_transform_test.cc).
std::vector<float> Truth(const OccupancyGrid& grid, DistanceConvention convention) {
  if (grid.cells.size() <= 2500) return BruteForce(grid, convention);
  const SdfGrid field = ComputeSignedDistance(grid, convention);
  return {field.distance_m().begin(), field.distance_m().end()};
}

std::vector<float> Compute(FastDistanceTransform& transform, const OccupancyGrid& grid,
                           const DistanceTransformOptions& options) {
  // NaN, so that a cell that is left out shows.
  std::vector<float> distance_m(grid.cells.size(), std::nanf(""));
  transform.Compute(grid, options, distance_m);
  return distance_m;
}

// Where the first difference is; both may be long.
::testing::AssertionResult IsSame(std::span<const float> actual, std::span<const float> expected) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!(actual[i] == expected[i])) {
      return ::testing::AssertionFailure()
             << "cell " << i << " is " << actual[i] << ", should be " << expected[i];
    }
  }
  return ::testing::AssertionSuccess();
}

// --- Every instruction set -----------------------------------------------------------------------

class FastDistanceTransformOn : public ::testing::TestWithParam<std::int64_t> {
 private:
  const OnlyTarget target_{GetParam()};
};

TEST_P(FastDistanceTransformOn, IsExactForAllGridsConventionsLanesAndLimits) {
  FastDistanceTransform transform;  // One for all: its memory is reused between shapes.
  for (const Case& c : Cases()) {
    for (const DistanceConvention convention : kConventions) {
      const std::vector<float> truth = Truth(c.grid, convention);
      for (const int bits : kLaneBits) {
        for (const double max_distance_m :
             {std::numeric_limits<double>::infinity(), 10 * kCell_m, 2.5 * kCell_m}) {
          const DistanceTransformOptions options{convention, max_distance_m, 1, bits};
          ASSERT_TRUE(IsSame(Compute(transform, c.grid, options), Clamped(truth, max_distance_m)))
              << c.name << ", convention " << static_cast<int>(convention) << ", " << bits
              << " bits, up to " << max_distance_m << " m";
        }
      }
    }
  }
}

TEST_P(FastDistanceTransformOn, WidensItsLanesWhereSquaresOverflow) {
  // 16 bits reach 209 cells from a surface and 255 from a centre.
  for (const int length : {208, 209, 210, 211, 254, 255, 256, 257, 300}) {
    for (const Size& size : {Size{length, 2, 3}, Size{2, length, 3}, Size{2, 3, length}}) {
      const OccupancyGrid grid = MakeGrid(size, [](int i, int j, int k) { return i + j + k == 0; });
      for (const DistanceConvention convention : kConventions) {
        FastDistanceTransform transform;
        EXPECT_TRUE(IsSame(Compute(transform, grid, {.convention = convention}),
                           ComputeSignedDistance(grid, convention).distance_m()))
            << ::testing::PrintToString(size);
      }
    }
  }
}

TEST_P(FastDistanceTransformOn, WritesGridsPastTheCachesToTheirLastCell) {
  // Over 16 MB, rows not a multiple of a cache line, and an output that is not aligned to one.
  const OccupancyGrid grid = Random({163, 162, 165}, 0.001);
  const AlignedVector<float> truth =
      ComputeSignedDistance(grid, DistanceConvention::kSurface).distance_m();
  FastDistanceTransform transform;
  for (const std::size_t offset : {0, 1, 13}) {
    std::vector<float> memory(grid.cells.size() + 14, -7);
    transform.Compute(grid, {}, std::span(memory).subspan(offset, grid.cells.size()));
    EXPECT_THAT(std::vector<float>(memory.begin(), memory.begin() + static_cast<int>(offset)),
                Each(-7));
    EXPECT_EQ(memory[offset + grid.cells.size()], -7);
    memory.erase(memory.begin(), memory.begin() + static_cast<int>(offset));
    EXPECT_TRUE(IsSame(memory, truth)) << offset;
  }
}

std::string TargetName(const ::testing::TestParamInfo<std::int64_t>& test) {
  return hwy::TargetName(test.param);
}
INSTANTIATE_TEST_SUITE_P(Target, FastDistanceTransformOn,
                         ::testing::ValuesIn(hwy::SupportedAndGeneratedTargets()), TargetName);

// --- The rest ------------------------------------------------------------------------------------

TEST(FastDistanceTransform, IsTheSameOnAnyNumberOfThreads) {
  const OccupancyGrid grid = Random({70, 45, 50}, 0.003);
  const AlignedVector<float> truth =
      ComputeSignedDistance(grid, DistanceConvention::kSurface).distance_m();
  FastDistanceTransform transform;
  for (const int threads : {2, 1, 3}) {
    EXPECT_TRUE(IsSame(Compute(transform, grid, {.num_threads = threads}), truth)) << threads;
  }
  // More threads than slices, and lanes that turn out too narrow on several threads at once.
  const OccupancyGrid line = MakeGrid({300, 2, 2}, [](int i, int, int) { return i == 0; });
  EXPECT_TRUE(IsSame(Compute(transform, line, {.num_threads = 5}),
                     ComputeSignedDistance(line, DistanceConvention::kSurface).distance_m()));
}

TEST(FastDistanceTransform, GoesOverToLowerEnvelopesInLargeVoids) {
  // A cell far from a diagonal improves on its neighbours' way to it hundreds of times.
  const OccupancyGrid grid = MakeGrid({2200, 2200, 1}, [](int i, int j, int) { return i == j; });
  FastDistanceTransform transform;
  for (const DistanceConvention convention : kConventions) {
    EXPECT_TRUE(IsSame(Compute(transform, grid, {.convention = convention}),
                       ComputeSignedDistance(grid, convention).distance_m()));
  }
}

TEST(FastDistanceTransform, AllocatesNothingForAGridNoLargerThanTheLast) {
  const OccupancyGrid large = Random({70, 40, 50}, 0.01);
  const OccupancyGrid small = Random({50, 40, 30}, 0.9);
  std::vector<float> distance_m(large.cells.size());
  FastDistanceTransform transform;
  transform.Compute(large, {}, distance_m);
  const int before = CountAllocations().count;
  EXPECT_GT(before, 0);
  transform.Compute(large, {}, distance_m);
  transform.Compute(small, {}, std::span(distance_m).first(small.cells.size()));
  EXPECT_EQ(CountAllocations().count, before);
}

TEST(FastDistanceTransform, AnswersWithTheLimitWhereThereIsNoSurface) {
  const OccupancyGrid empty = MakeGrid({3, 4, 5}, [](int, int, int) { return false; });
  FastDistanceTransform transform;
  EXPECT_THAT(transform.Compute(empty).distance_m(), Each(kNoSurfaceDistance_m));
  EXPECT_THAT(transform.Compute(Inverted(empty)).distance_m(), Each(-kNoSurfaceDistance_m));
  EXPECT_THAT(transform.Compute(empty, {.max_distance_m = 0.4}).distance_m(), Each(0.4F));
}

TEST(FastDistanceTransform, RefusesWhatMeansNothing) {
  const OccupancyGrid grid = MakeGrid({3, 4, 5}, [](int, int, int) { return false; });
  FastDistanceTransform transform;
  for (const DistanceTransformOptions& options : {DistanceTransformOptions{.max_distance_m = 0},
                                                  {.max_distance_m = -1},
                                                  {.max_distance_m = std::nan("")},
                                                  {.num_threads = 0},
                                                  {.min_lane_bits = 12}}) {
    EXPECT_THROW(transform.Compute(grid, options), std::invalid_argument);
  }
  OccupancyGrid too_few = grid;
  too_few.cells.pop_back();
  EXPECT_THROW(transform.Compute(too_few), std::invalid_argument);
  std::vector<float> too_small(grid.cells.size() - 1);
  EXPECT_THROW(transform.Compute(grid, {}, too_small), std::invalid_argument);
}

TEST(TransformLineByEnvelope, IsTheMinimumOverAllSources) {
  constexpr std::uint32_t kFar = 5000;
  const auto squares = [](std::uint32_t k) { return k * k; };
  const auto flat_then_steep = [](std::uint32_t k) { return k < 4 ? 0 : 9 * (k - 4); };
  RandomStream random(5, "values");
  const auto check = [&](const auto& cost) {
    for (std::size_t n = 1; n < 60; ++n) {
      std::vector<std::uint32_t> values(n);
      for (std::uint32_t& value : values) {
        const bool is_far = random.Bits() % 3 == 0;
        value = is_far ? kFar : static_cast<std::uint32_t>(random.Bits() % 900);
      }
      std::vector<std::uint32_t> expected(n, kFar);
      for (std::size_t t = 0; t < n; ++t) {
        for (std::size_t s = 0; s < n; ++s) {
          if (values[s] == kFar) continue;
          const std::size_t k = std::max(s, t) - std::min(s, t);
          expected[t] = std::min(expected[t], values[s] + cost(static_cast<std::uint32_t>(k)));
        }
      }
      std::vector<fast_transform::EnvelopePiece> pieces(n);
      fast_transform::TransformLineByEnvelope(values.data(), n, kFar, cost, pieces.data());
      EXPECT_EQ(values, expected);
    }
  };
  check(squares);
  check(flat_then_steep);
}

}  // namespace
}  // namespace sidestep::sdf
