#pragma once

#include <map>
#include <memory>
#include <vector>

#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/bench/reproduce/published_rasteriser.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/map/distance_transform.h"

namespace sidestep::bench {

/// How the authors measure distances.
inline constexpr sdf::DistanceConvention kPublishedConvention = sdf::DistanceConvention::kBwdist;

/// The worlds of an experiment, frozen at each of its steps: occupancy by the published rasteriser
/// and its distance field. Steps and speeds that fill the same cells share one field. Immutable;
/// safe from many threads.
class PublishedMaps {
 public:
  /// Makes all the fields that `experiment` needs at its speeds, `num_jobs` at a time.
  /// @param static_boxes how the static boxes are aligned; the moving box is as intended.
  PublishedMaps(const OpenLoopExperiment& experiment, BoxAlignment static_boxes,
                sdf::DistanceConvention convention, int num_jobs);

  const OccupancyGrid& static_occupancy() const { return static_occupancy_; }
  /// The world at `step`. Any speed.
  OccupancyGrid OccupancyAt(double speed_m_s, int step) const;

  /// The fields of steps 0, 1, ... at one of the experiment's speeds. They live as long as this.
  std::vector<const sdf::DistanceField*> FieldsAt(double speed_m_s) const;

 private:
  CellRange MovingCells(double speed_m_s, int step) const;

  OpenLoopExperiment experiment_;
  OccupancyGrid static_occupancy_;
  std::map<CellRange, std::unique_ptr<const sdf::DistanceField>>
      fields_;  // by the moving box's cells
};

}  // namespace sidestep::bench
