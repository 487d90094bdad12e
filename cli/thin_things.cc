#include "sidestep/cli/thin_things.h"

#include <algorithm>
#include <string>
#include <vector>

#include "sidestep/cli/console.h"
#include "sidestep/core/shape.h"

namespace sidestep::cli {

void WarnOfThinThings(const scenarios::Scenario& scenario) {
  // A camera fills the cells that hold a point, whatever the rule is.
  const auto loses = [](const scenarios::SensorSettings& sensor) {
    return sensor.cells == CellRule::kCentre && !sensor.camera;
  };
  const std::vector<scenarios::SensorSettings> sensors = scenarios::SensorsOf(scenario);
  if (!std::all_of(sensors.begin(), sensors.end(), loses)) return;
  const double cell_m = scenario.grid.cell_m;
  const auto check = [&](const std::string& key, const std::string& name, const Shape& shape) {
    const double thickness_m = Thickness(shape);
    if (thickness_m >= cell_m) return;
    PrintErrorText(
        std::string("warning: ") +
        scenarios::WrongValue(
            scenario, key,
            fmt::format("'{}' is {:g} m thin, less than a cell of {:g} m: with sensor.cells centre "
                        "it may fall between the cells, unseen; touched fills all that it reaches",
                        name, thickness_m, cell_m))
            .what() +
        "\n");
  };
  if (scenario.static_world == scenarios::StaticWorld::kOccupancy) {
    for (const scenarios::StaticObstacle& fixed : scenario.static_obstacles) {
      const bool is_of_boxes = fixed.path.starts_with("static_boxes");
      check(fixed.path + (is_of_boxes ? ".size_m" : ".shape"), fixed.name, fixed.shape);
    }
  }
  if (scenario.knowledge == "full_knowledge") return;  // moving things are known by their shapes
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    const scenarios::MovingObstacle& obstacle = scenario.moving_obstacles[i];
    check("moving_obstacles[" + std::to_string(i) + "].shape", obstacle.name, obstacle.shape);
  }
}

}  // namespace sidestep::cli
