// The distance field of a published planning problem, computed by GPMP2 (tag gtsam4.2): a WAM's
// desk and cabinet with a pillar that moves one cell a step, centre-to-centre convention, 96^3.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "sidestep/sdf/grid_field.h"
#include "sidestep/sdf/map/distance_transform.h"

namespace sidestep::sdf::gpmp2_reference_field_test {
namespace {

struct CellBox {
  int x[2], y[2], z[2];  // first and last cell, both included
};

constexpr CellBox kFurniture[] = {
    {{36, 70}, {58, 72}, {43, 43}}, {{36, 37}, {58, 60}, {23, 42}}, {{68, 70}, {58, 60}, {23, 42}},
    {{36, 37}, {71, 72}, {23, 42}}, {{68, 70}, {71, 72}, {23, 42}}, {{66, 80}, {58, 58}, {23, 70}},
    {{66, 80}, {33, 33}, {23, 70}}, {{56, 65}, {58, 58}, {23, 70}}, {{66, 80}, {33, 57}, {70, 70}},
    {{66, 80}, {33, 57}, {58, 58}}, {{66, 80}, {33, 57}, {45, 45}}, {{66, 80}, {33, 57}, {33, 33}}};

void Fill(const CellBox& box, OccupancyGrid& grid) {
  for (int k = box.z[0]; k <= box.z[1]; ++k)
    for (int j = box.y[0]; j <= box.y[1]; ++j)
      for (int i = box.x[0]; i <= box.x[1]; ++i) grid.cells[grid.spec.Index(i, j, k)] = 1;
}

OccupancyGrid Furniture() {
  OccupancyGrid grid({Eigen::Vector3d::Constant(-1.92), 0.04, {96, 96, 96}});
  for (const CellBox& box : kFurniture) Fill(box, grid);
  return grid;
}

OccupancyGrid WorldAtStep(int step) {
  OccupancyGrid grid = Furniture();
  Fill({{57, 61}, {27 + step, 31 + step}, {0, 64}}, grid);
  return grid;
}

TEST(Gpmp2ReferenceField, HasThePublishedNumberOfFilledCells) {
  EXPECT_EQ(Furniture().CountFilled(), 4310u);
  EXPECT_EQ(WorldAtStep(0).CountFilled(), 5935u);
  EXPECT_EQ(WorldAtStep(30).CountFilled(), 5710u);
}

TEST(Gpmp2ReferenceField, HasThePublishedSumAndRange) {
  const struct {
    int step;
    double sum_m, min_m, max_m;
  } kPublished[] = {{0, 833983.682378314, -0.12, 2.811120773},
                    {15, 882924.085564966, -0.12, 3.091666217},
                    {30, 896881.530012308, -0.12, 3.116408189}};
  for (const auto& published : kPublished) {
    SCOPED_TRACE(published.step);
    const OccupancyGrid grid = WorldAtStep(published.step);
    const auto squares = ComputeSquaredDistance(grid, DistanceConvention::kBwdist);
    double sum = 0, min = std::numeric_limits<double>::infinity(), max = -min;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const double distance_m = (grid.cells[i] ? -0.02 : 0.02) * std::sqrt(squares[i]);
      sum += distance_m;
      min = std::min(min, distance_m);
      max = std::max(max, distance_m);
    }
    EXPECT_NEAR(sum, published.sum_m, 1e-12 * published.sum_m);
    EXPECT_NEAR(min, published.min_m, 1e-12);
    EXPECT_NEAR(max, published.max_m, 1e-9);  // as many digits as are published
  }
}

TEST(Gpmp2ReferenceField, AnswersThePublishedQueries) {
  const struct {
    Eigen::Vector3d p;
    double distance_m;
    Eigen::Vector3d gradient;
  } kPublished[] = {
      {{0.43, 0.05, 0.31}, 0.130000000000, {0, 1, 0}},
      {{0.30, 0.02, 0.31}, 0.118323240379, {-0.517816381271, 0.851666916693, 0}},
      {{0.617, -0.333, 0.771}, 0.149867019727, {-0.617101494175, -0.049831178763, -0.650209630012}},
      {{0.905, 0.151, 0.047}, 0.167, {0, 0, 1}},
      {{-0.283, 0.941, -0.103}, 0.097, {0, 0, 1}},
  };
  const GridField field(std::make_shared<SdfGrid>(
                            ComputeSignedDistance(WorldAtStep(15), DistanceConvention::kBwdist)),
                        /*max_distance_m=*/10);
  for (const auto& published : kPublished) {
    const DistanceSample sample = field.Sample(published.p, EpisodeTime(0));
    // Published for fields of doubles; ours are floats: half an ulp at 0.25 m is 1.5e-8 m, and the
    // gradient divides the difference of two by the cell.
    EXPECT_NEAR(sample.distance_m, published.distance_m, 2e-8);
    EXPECT_LT((sample.gradient_W - published.gradient).cwiseAbs().maxCoeff(), 1e-6);
  }
}

}  // namespace
}  // namespace sidestep::sdf::gpmp2_reference_field_test
