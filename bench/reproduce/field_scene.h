#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/reproduce/published_rasteriser.h"
#include "sidestep/core/grid.h"
#include "sidestep/core/time.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// Reads a scenario for the published rasteriser, which knows boxes along the axes of W alone, and
/// no floor.
/// @throws InputError as LoadScenario, and if something else stands or moves in it.
scenarios::Scenario LoadBoxScene(const std::string& path, const scenarios::Settings& settings = {});

/// "field_one_box", "field_two_boxes", "field_one_pillar", "field_two_pillars",
/// "field_large_block": the scenarios, without a robot, of table 1 of Finean, Merkt & Havoutis
/// (ICAPS 2021), with the figures of their public code. The one small box is in the paper and not
/// in the code; here it is the first of the two.
std::vector<std::string> FieldSceneNames();

/// The cube of cells that the published timings use: from (-1, -1, -1), with an edge of
/// ceil(300 / N) cm.
/// @throws std::invalid_argument unless voxels_per_side >= 2.
GridSpec PublishedTimingGrid(int voxels_per_side);

/// What stands, and what moves alone, by the published rasteriser.
OccupancyGrid StaticOccupancy(const scenarios::Scenario& scene, const GridSpec& grid,
                              BoxAlignment alignment = BoxAlignment::kIntended);
OccupancyGrid MovingOccupancy(const scenarios::Scenario& scene, const GridSpec& grid,
                              EpisodeTime t);

}  // namespace sidestep::bench
