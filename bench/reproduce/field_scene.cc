#include "sidestep/bench/reproduce/field_scene.h"

#include <stdexcept>

#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

bool IsAlongTheAxes(const Pose& pose) { return pose.rotation().vec().isZero(0); }

}  // namespace

scenarios::Scenario LoadBoxScene(const std::string& path, const scenarios::Settings& settings) {
  scenarios::Scenario scene = scenarios::LoadScenario(path, settings);
  const auto fail = [&](const std::string& name) {
    throw InputError(path, "'" + name + "' is not a box along the axes, as published ones are");
  };
  for (const scenarios::StaticObstacle& fixed : scene.static_obstacles) {
    const bool is_box = std::holds_alternative<Box>(fixed.shape);
    if (!is_box || !IsAlongTheAxes(fixed.X_WO)) fail(fixed.name);
  }
  for (const scenarios::MovingObstacle& obstacle : scene.moving_obstacles) {
    const bool turns = obstacle.faces_path || !obstacle.rpy_rad.isZero(0) ||
                       std::holds_alternative<scenarios::RecordedMotion>(obstacle.motion);
    if (turns || !std::holds_alternative<Box>(obstacle.shape)) fail(obstacle.name);
  }
  return scene;
}

std::vector<std::string> FieldSceneNames() {
  return {"field_one_box", "field_two_boxes", "field_one_pillar", "field_two_pillars",
          "field_large_block"};
}

GridSpec PublishedTimingGrid(int voxels_per_side) {
  if (voxels_per_side < 2) throw std::invalid_argument("PublishedTimingGrid: needs >= 2 voxels");
  const int cell_cm = (300 + voxels_per_side - 1) / voxels_per_side;
  return {Eigen::Vector3d(-1, -1, -1),
          cell_cm / 100.0,
          {voxels_per_side, voxels_per_side, voxels_per_side}};
}

OccupancyGrid StaticOccupancy(const scenarios::Scenario& scene, const GridSpec& grid,
                              BoxAlignment alignment) {
  OccupancyGrid occupancy(grid);
  for (const scenarios::StaticObstacle& fixed : scene.static_obstacles) {
    Fill(occupancy, PublishedBoxCells(grid, fixed.X_WO.translation(),
                                      std::get<Box>(fixed.shape).size_m, alignment));
  }
  return occupancy;
}

OccupancyGrid MovingOccupancy(const scenarios::Scenario& scene, const GridSpec& grid,
                              EpisodeTime t) {
  OccupancyGrid occupancy(grid);
  for (const scenarios::MovingObstacle& obstacle : scene.moving_obstacles) {
    Fill(occupancy,
         PublishedBoxCells(grid, PoseAt(obstacle, t).translation(),
                           std::get<Box>(obstacle.shape).size_m, BoxAlignment::kIntended));
  }
  return occupancy;
}

}  // namespace sidestep::bench
