#include "sidestep/cli/sensors.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "sidestep/core/input_error.h"
#include "sidestep/render/rendered_camera.h"
#include "sidestep/sim/static_cells.h"

namespace sidestep::cli {
namespace {

constexpr const char* kTagImages = "tag_images";

hardware::TaggedBody BodyOf(const std::string& name, const Eigen::Vector3d& size_m,
                            const std::vector<scenarios::Tag>& tags) {
  hardware::TaggedBody body{name, Box{size_m}, {}};
  for (const scenarios::Tag& tag : tags) {
    body.tags.push_back({tag.id, tag.size_m, scenarios::TagPose(size_m, tag.face)});
  }
  return body;
}

std::unique_ptr<robot::Sensor> MakeTagImages(const scenarios::Scenario& scenario,
                                             const sim::World& world,
                                             const std::optional<Pose>& X_WC = std::nullopt) {
  sim::CheckSensorSettings(scenario, kTagImages);
  auto frames = std::make_unique<render::RenderedCamera>(scenario, world);
  hardware::TagSensorOptions options = TagSensorOptionsOf(scenario);
  if (X_WC) options.X_WC = *X_WC;
  options.p_WStatic = sim::StaticCells(world, scenario.grid, scenario.sensor.cells);
  return std::make_unique<hardware::TagSensor>(std::move(frames), std::move(options));
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

sim::SensorMaker CalibratedCamera(const scenarios::Scenario& scenario,
                                  const hardware::CameraCalibration& calibration,
                                  const std::string& today) {
  if (scenario.sensor.name != kTagImages) {
    throw InputError("--calibration", "is of a camera: the sensor is '" + scenario.sensor.name +
                                          "', not tag_images");
  }
  sim::CheckSensorSettings(scenario, kTagImages);
  const auto why_not = hardware::WhyNotUsable(calibration, render::kRenderedSerial,
                                              render::IntrinsicsOf(scenario), today);
  if (why_not) throw InputError("--calibration", *why_not);
  return [X_WC = calibration.X_WC](const scenarios::Scenario& of, const sim::World& world) {
    return MakeTagImages(of, world, X_WC);
  };
}

std::unique_ptr<robot::Sensor> MakeSensor(const scenarios::Scenario& scenario,
                                          const sim::World& world) {
  if (scenario.sensor.name == kTagImages) return MakeTagImages(scenario, world);
  return sim::MakeSensor(scenario, world);
}

}  // namespace sidestep::cli
