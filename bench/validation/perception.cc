#include "sidestep/bench/validation/perception.h"

#include <numbers>

#include "sidestep/bench/validation/named_row.h"

namespace sidestep::bench {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kBegins_s = 2;  // what fails for a while does so in the middle of the motion

const Perception kPerceptions[] = {
    {.name = "nominal"},
    {.name = "ideal", .noise = 0, .latency_s = 0},
    {.name = "noise_x3", .noise = 3},
    {.name = "noise_x10", .noise = 10},
    {.name = "latency_40ms", .latency_s = 0.04},
    {.name = "latency_100ms", .latency_s = 0.1},
    {.name = "dropout_5", .dropout = 0.05},
    {.name = "dropout_20", .dropout = 0.2},
    {.name = "blackout", .faults = {.blind_from_s = kBegins_s, .blind_for_s = 0.5}},
    {.name = "outliers_5", .faults = {.outlier_share = 0.05}},
    {.name = "miscalibrated", .faults = {.shift_m = 0.01, .turn_rad = kDegree}},
};

// Beside the table, 1.5 to 2 m from where the arm works.
const Eigen::Vector3d kCamera_B(1.6, 0, 1.4);

}  // namespace

std::span<const Perception> Perceptions() { return kPerceptions; }

const Perception& PerceptionOf(const std::string& name) {
  return RowNamed(Perceptions(), "perception", name);
}

bool HasNoiseModel(const scenarios::Scenario& scenario) {
  return scenario.sensor.name == "tags" || scenario.sensor.name == "depth_camera";
}

void SetLikelySensor(scenarios::Scenario& scenario) {
  scenarios::SensorSettings& sensor = scenario.sensor;
  if (sensor.name != "occupancy") return;
  sensor.name = "tags";
  sensor.noise.reset();
  if (!sensor.tags) {
    scenarios::TagSettings tags;
    tags.position_m = scenario.X_WB * kCamera_B;
    sensor.tags = tags;
  }
}

void SetPerception(const Perception& perception, scenarios::Scenario& scenario) {
  scenarios::SensorSettings& sensor = scenario.sensor;
  sensor.latency_s = perception.latency_s;
  sensor.dropout = perception.dropout;
  if (sensor.tags) {
    sensor.tags->across_noise *= perception.noise;
    sensor.tags->along_noise_per_m *= perception.noise;
    sensor.tags->rotation_noise_rad *= perception.noise;
  }
  if (sensor.camera) sensor.camera->noise_per_m *= perception.noise;
}

}  // namespace sidestep::bench
