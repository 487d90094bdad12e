#include "sidestep/bench/true_world.h"

#include <memory>

namespace sidestep::bench {

std::vector<PlacedShape> StaticShapes(const scenarios::Scenario& scenario) {
  std::vector<PlacedShape> shapes;
  for (const scenarios::StaticObstacle& fixed : scenario.static_obstacles) {
    shapes.push_back({fixed.shape, fixed.X_WO});
  }
  return shapes;
}

HalfSpace FloorOf(const scenarios::Scenario& scenario) {
  return {Eigen::Vector3d::UnitZ(), scenario.floor_m};
}

StaticSolids StaticSolidsOf(const scenarios::Scenario& scenario) {
  return {StaticShapes(scenario), {FloorOf(scenario)}};
}

std::vector<sdf::MovingShape> TrueMotions(const scenarios::Scenario& scenario) {
  std::vector<sdf::MovingShape> motions;
  for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
    motions.push_back(
        {obstacle.shape, [moving = std::make_shared<const scenarios::MovingObstacle>(obstacle)](
                             EpisodeTime t) { return PoseAt(*moving, t); }});
  }
  return motions;
}

sdf::ShapeField TrueWorld(const scenarios::Scenario& scenario, double max_distance_m) {
  return sdf::ShapeField(StaticSolidsOf(scenario), TrueMotions(scenario), max_distance_m);
}

sdf::ShapeField TrueWorldAt(const scenarios::Scenario& scenario,
                            const std::vector<ObjectObservation>& moving) {
  StaticSolids solids = StaticSolidsOf(scenario);
  for (const ObjectObservation& seen : moving) solids.shapes.push_back({seen.shape, seen.X_WO});
  return sdf::ShapeField(solids);
}

}  // namespace sidestep::bench
