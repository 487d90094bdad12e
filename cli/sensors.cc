#include "sidestep/cli/sensors.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "sidestep/render/rendered_camera.h"
#include "sidestep/sim/static_cells.h"

namespace sidestep::cli {
namespace {

hardware::TaggedBody BodyOf(const std::string& name, const Eigen::Vector3d& size_m,
                            const std::vector<scenarios::Tag>& tags) {
  hardware::TaggedBody body{name, Box{size_m}, {}};
  for (const scenarios::Tag& tag : tags) {
    body.tags.push_back({tag.id, tag.size_m, scenarios::TagPose(size_m, tag.face)});
  }
  return body;
}

}  // namespace

std::vector<std::string> SensorNames() {
  std::vector<std::string> names = sim::SensorNames();
  names.emplace_back(kTagImages);
  std::sort(names.begin(), names.end());
  return names;
}

std::string MeaningOfSensor(const std::string& name) {
  if (name != kTagImages) return sim::MeaningOfSensor(name);
  return "poses of boxes by their AprilTags, found in pictures of a camera";
}

hardware::TagSensorOptions TagSensorOptionsOf(const scenarios::Scenario& scenario) {
  hardware::TagSensorOptions options;
  const scenarios::TagImageSettings& settings = scenario.sensor.tag_images.value();
  options.X_WC = scenarios::PoseOfCamera(settings.position_m, settings.look_at_m);
  for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
    if (obstacle.tags.empty()) continue;
    const Eigen::Vector3d size_m = std::get<Box>(obstacle.shape).size_m;
    options.bodies.push_back(BodyOf(obstacle.name, size_m, obstacle.tags));
  }
  for (const scenarios::StaticObstacle& fixed : scenario.static_obstacles) {
    if (fixed.tags.empty()) continue;
    const Eigen::Vector3d size_m = std::get<Box>(fixed.shape).size_m;
    options.references.push_back({BodyOf(fixed.name, size_m, fixed.tags), fixed.X_WO});
  }
  return options;
}

std::unique_ptr<robot::Sensor> MakeTagSensor(std::unique_ptr<robot::FrameSource> frames,
                                             hardware::TagSensorOptions options,
                                             const scenarios::Scenario& scenario,
                                             const sim::World& world) {
  options.p_WStatic = sim::StaticCells(world, scenario.grid, scenario.sensor.cells);
  return std::make_unique<hardware::TagSensor>(std::move(frames), std::move(options));
}

std::unique_ptr<robot::Sensor> MakeSensor(const scenarios::Scenario& scenario,
                                          const sim::World& world) {
  if (scenario.sensor.name == kTagImages) {
    sim::CheckSensorSettings(scenario, kTagImages);
    return MakeTagSensor(std::make_unique<render::RenderedCamera>(scenario, world),
                         TagSensorOptionsOf(scenario), scenario, world);
  }
  return sim::MakeSensor(scenario, world);
}

}  // namespace sidestep::cli
