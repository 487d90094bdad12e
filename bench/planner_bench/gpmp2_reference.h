#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/sdf_grid.h"
#include "sidestep/sdf/placed_composite.h"

namespace sidestep::bench::gpmp2_reference {

// A planning problem that GPMP2 itself (github.com/borglab/gpmp2, tag gtsam4.2, on GTSAM 4.2.0)
// solved and evaluated: a WAM reaches over a desk into a cabinet while a pillar moves by, one cell
// a step. All figures are its output.

inline constexpr int kNumStates = 31;
inline constexpr double kStep_s = 0.1;

struct CellBox {
  int x[2], y[2], z[2];  ///< first and last cell, both included
};

/// Desk and cabinet of GPMP2's WAMDeskDataset, in cells of 4 cm.
inline constexpr CellBox kFurniture[] = {
    {{36, 70}, {58, 72}, {43, 43}}, {{36, 37}, {58, 60}, {23, 42}}, {{68, 70}, {58, 60}, {23, 42}},
    {{36, 37}, {71, 72}, {23, 42}}, {{68, 70}, {71, 72}, {23, 42}}, {{66, 80}, {58, 58}, {23, 70}},
    {{66, 80}, {33, 33}, {23, 70}}, {{56, 65}, {58, 58}, {23, 70}}, {{66, 80}, {33, 57}, {70, 70}},
    {{66, 80}, {33, 57}, {58, 58}}, {{66, 80}, {33, 57}, {45, 45}}, {{66, 80}, {33, 57}, {33, 33}}};

inline void Fill(const CellBox& box, OccupancyGrid& grid) {
  for (int k = box.z[0]; k <= box.z[1]; ++k) {
    for (int j = box.y[0]; j <= box.y[1]; ++j) {
      for (int i = box.x[0]; i <= box.x[1]; ++i) grid.cells[grid.spec.Index(i, j, k)] = 1;
    }
  }
}

/// The world at a support state: furniture, and the pillar at 0.4 m/s along y.
inline OccupancyGrid WorldAtStep(int step) {
  OccupancyGrid grid({Eigen::Vector3d::Constant(-1.92), 0.04, {96, 96, 96}});
  for (const CellBox& box : kFurniture) Fill(box, grid);
  Fill({{57, 61}, {27 + step, 31 + step}, {0, 64}}, grid);
  return grid;
}

/// One exact field a step, distances between cell centres. What lies between support states k - 1
/// and k sees the field of k, as in the reference.
class SteppedField final : public sdf::DistanceField {
 public:
  SteppedField() {
    for (int step = 0; step < kNumStates; ++step) {
      grids_.push_back(
          sdf::ComputeSignedDistance(WorldAtStep(step), sdf::DistanceConvention::kBwdist));
    }
  }

  sdf::DistanceSample Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const override {
    const sdf::GridSample sample = GridAt(t).Sample(p_WQ);
    if (!sample.in_grid) return {max_distance_m(), Eigen::Vector3d::Zero(), false};
    return {sample.distance_m, sample.gradient, true};
  }

  std::unique_ptr<const sdf::FieldSlice> At(EpisodeTime t) const override {
    return std::make_unique<sdf::PlacedComposite>(GridAt(t), std::vector<sdf::PlacedObject>{},
                                                  max_distance_m());
  }

  double max_distance_m() const override { return 10; }  // more than any reach: no clamp

 private:
  const sdf::SdfGrid& GridAt(EpisodeTime t) const {
    // Support times are sums of steps: rounded, they may stand a little after the step they mean.
    const double step = std::ceil(t.seconds() / kStep_s - 1e-6);
    return grids_[static_cast<std::size_t>(std::clamp(step, 0.0, kNumStates - 1.0))];
  }

  std::vector<sdf::SdfGrid> grids_;
};

}  // namespace sidestep::bench::gpmp2_reference
