#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/core/grid.h"
#include "sidestep/core/time.h"

namespace sidestep::bench {

/// A world without a robot, to time and compare distance fields in: boxes that stand and boxes that
/// move.
struct FieldScene {
  struct MovingBox {
    PublishedBox at_start;
    Eigen::Vector3d velocity_m_s;
    double stop_s = 0;  ///< infinite: never
  };

  std::string name;
  std::vector<PublishedBox> static_boxes;
  std::vector<MovingBox> moving_boxes;
};

/// "field_one_box", "field_two_boxes", "field_one_pillar", "field_two_pillars",
/// "field_large_block".
std::vector<std::string> FieldSceneNames();

/// The scenes of table 1 of Finean, Merkt & Havoutis (ICAPS 2021), with the figures of their public
/// code. The one small box is in the paper and not in the code; here it is the first of the two.
/// @throws std::invalid_argument for another name.
FieldScene MakeFieldScene(const std::string& name);

/// The cube of cells that the published timings use: from (-1, -1, -1), with an edge of
/// ceil(300 / N) cm.
/// @throws std::invalid_argument unless voxels_per_side >= 2.
GridSpec PublishedTimingGrid(int voxels_per_side);

/// What stands, and what moves alone, by the published rasteriser, both aligned as intended.
OccupancyGrid StaticOccupancy(const FieldScene& scene, const GridSpec& grid);
OccupancyGrid MovingOccupancy(const FieldScene& scene, const GridSpec& grid, EpisodeTime t);

}  // namespace sidestep::bench
