#include "sidestep/sdf/map/distance_transform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>
#include <string>
#include <tuple>

#include "sidestep/core/random.h"

namespace sidestep::sdf::distance_transform_test {
namespace {

using ::testing::Each;

OccupancyGrid MakeGrid(int nx, int ny, int nz, double cell_m = 0.04) {
  return OccupancyGrid({{-1, 0.5, 2}, cell_m, {nx, ny, nz}});
}

// Squared distance along one axis, in half cells, between cells that are `offset` apart.
int AxisSquare(int offset, DistanceConvention convention) {
  if (offset == 0) return 0;
  const int half_cells =
      convention == DistanceConvention::kBwdist ? 2 * std::abs(offset) : 2 * std::abs(offset) - 1;
  return half_cells * half_cells;
}

// By definition: every cell against every other one.
std::vector<std::int32_t> BruteForce(const OccupancyGrid& grid, DistanceConvention convention) {
  const auto [nx, ny, nz] = grid.spec.size;
  std::vector<std::int32_t> squares(grid.cells.size(), kNoOtherCell);
  const auto for_each = [&](const auto& visit) {
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) visit(i, j, k);
  };
  for_each([&](int i, int j, int k) {
    std::int32_t& nearest = squares[grid.spec.Index(i, j, k)];
    for_each([&](int a, int b, int c) {
      if (grid.At(a, b, c) == grid.At(i, j, k)) return;
      nearest = std::min(nearest, AxisSquare(a - i, convention) + AxisSquare(b - j, convention) +
                                      AxisSquare(c - k, convention));
    });
  });
  return squares;
}

struct Case {
  std::string name;
  OccupancyGrid grid;
};
void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }

OccupancyGrid Random(int nx, int ny, int nz, double share) {
  OccupancyGrid grid = MakeGrid(nx, ny, nz);
  RandomStream random(static_cast<std::uint64_t>(nx + 100 * ny + 10000 * nz), "cells");
  for (auto& cell : grid.cells) cell = random.Uniform() < share ? 1 : 0;
  return grid;
}

OccupancyGrid Filled(int nx, int ny, int nz) { return Random(nx, ny, nz, 2.0); }

OccupancyGrid OneCell(int nx, int ny, int nz, int i, int j, int k) {
  OccupancyGrid grid = MakeGrid(nx, ny, nz);
  grid.cells[grid.spec.Index(i, j, k)] = 1;
  return grid;
}

OccupancyGrid Checkerboard(int nx, int ny, int nz) {
  OccupancyGrid grid = MakeGrid(nx, ny, nz);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) grid.cells[grid.spec.Index(i, j, k)] = (i + j + k) % 2;
  return grid;
}

std::vector<Case> Cases() {
  std::vector<Case> cases = {
      {"Empty", MakeGrid(5, 4, 3)},
      {"Full", Filled(5, 4, 3)},
      {"EmptySingleCell", MakeGrid(1, 1, 1)},
      {"FullSingleCell", Filled(1, 1, 1)},
      {"OneCellInTheCorner", OneCell(19, 7, 11, 0, 0, 0)},
      {"OneCellInTheFarCorner", OneCell(19, 7, 11, 18, 6, 10)},
      {"OneCellWithin", OneCell(19, 17, 18, 9, 3, 14)},
      {"Checkerboard", Checkerboard(9, 8, 7)},
  };
  const std::array<int, 3> sizes[] = {{17, 16, 15}, {33, 2, 9},  {40, 1, 1},  {1, 40, 1},
                                      {1, 1, 40},   {1, 23, 19}, {23, 1, 19}, {23, 19, 1}};
  for (const auto& [nx, ny, nz] : sizes) {
    for (const double percent : {0.5, 5.0, 50.0, 97.0}) {
      cases.push_back({"Random" + std::to_string(nx) + "x" + std::to_string(ny) + "x" +
                           std::to_string(nz) + "At" + std::to_string(int(10 * percent)) +
                           "Permille",
                       Random(nx, ny, nz, percent / 100)});
    }
  }
  return cases;
}

class SquaredDistance : public ::testing::TestWithParam<std::tuple<Case, DistanceConvention>> {};

TEST_P(SquaredDistance, EqualsBruteForce) {
  const auto& [test_case, convention] = GetParam();
  EXPECT_EQ(ComputeSquaredDistance(test_case.grid, convention),
            BruteForce(test_case.grid, convention));
}

std::string ConventionName(DistanceConvention convention) {
  return convention == DistanceConvention::kSurface ? "Surface" : "Bwdist";
}

INSTANTIATE_TEST_SUITE_P(Grids, SquaredDistance,
                         ::testing::Combine(::testing::ValuesIn(Cases()),
                                            ::testing::Values(DistanceConvention::kSurface,
                                                              DistanceConvention::kBwdist)),
                         [](const auto& test) {
                           return std::get<0>(test.param).name +
                                  ConventionName(std::get<1>(test.param));
                         });

TEST(SignedDistance, IsTheDistanceToTheCubesInTheSurfaceConvention) {
  const OccupancyGrid grid = OneCell(9, 9, 9, 4, 4, 4);
  const SdfGrid field = ComputeSignedDistance(grid, DistanceConvention::kSurface);
  EXPECT_FLOAT_EQ(field.At(4, 4, 4), -0.02F);  // its own half cell
  EXPECT_FLOAT_EQ(field.At(5, 4, 4), 0.02F);
  EXPECT_FLOAT_EQ(field.At(8, 4, 4), 0.14F);
  EXPECT_FLOAT_EQ(field.At(6, 6, 4), static_cast<float>(std::hypot(0.06, 0.06)));
  // The surface itself, halfway between the two centres.
  EXPECT_NEAR(field.Sample(grid.spec.Center(4, 4, 4) + Eigen::Vector3d(0.02, 0, 0)).distance_m, 0,
              1e-9);
}

TEST(SignedDistance, IsFromCentreToCentreInTheBwdistConvention) {
  const SdfGrid field =
      ComputeSignedDistance(OneCell(9, 9, 9, 4, 4, 4), DistanceConvention::kBwdist);
  EXPECT_FLOAT_EQ(field.At(4, 4, 4), -0.04F);
  EXPECT_FLOAT_EQ(field.At(5, 4, 4), 0.04F);
  EXPECT_FLOAT_EQ(field.At(8, 4, 4), 0.16F);
  EXPECT_FLOAT_EQ(field.At(6, 6, 4), static_cast<float>(std::hypot(0.08, 0.08)));
}

TEST(SignedDistance, IsFiniteAndFarWhereThereIsNoSurface) {
  EXPECT_THAT(ComputeSignedDistance(MakeGrid(3, 4, 5)).distance_m(), Each(kNoSurfaceDistance_m));
  EXPECT_THAT(ComputeSignedDistance(Filled(3, 4, 5)).distance_m(), Each(-kNoSurfaceDistance_m));
}

TEST(SignedDistance, RefusesGridsThatMakeNoSense) {
  OccupancyGrid too_few = MakeGrid(3, 3, 3);
  too_few.cells.pop_back();
  EXPECT_THROW(ComputeSignedDistance(too_few), std::invalid_argument);
  EXPECT_THROW(ComputeSignedDistance(OccupancyGrid()), std::invalid_argument);
  EXPECT_THROW(ComputeSignedDistance(MakeGrid(17000, 1, 1)), std::invalid_argument);
}

TEST(SignedDistance, DoesNotOverflowInTheLargestGridItAccepts) {
  const OccupancyGrid grid = OneCell(16380, 1, 2, 0, 0, 0);
  const SdfGrid field = ComputeSignedDistance(grid, DistanceConvention::kBwdist);
  EXPECT_FLOAT_EQ(field.At(16379, 0, 0), 16379 * 0.04F);
}

}  // namespace
}  // namespace sidestep::sdf::distance_transform_test
