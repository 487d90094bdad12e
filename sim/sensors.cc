#include "sim/sensors.h"

#include <array>

#include "core/input_error.h"
#include "sim/occupancy_sensor.h"

namespace sidestep {
namespace {

std::unique_ptr<Sensor> MakeOccupancySensor(const Scenario& scenario, const World& world) {
  return std::make_unique<OccupancySensor>(world, scenario.grid, scenario.sensor_rate_hz);
}

struct Entry {
  const char* name;
  std::unique_ptr<Sensor> (*make)(const Scenario&, const World&);
};
constexpr std::array kSensors = {Entry{"occupancy", &MakeOccupancySensor}};

}  // namespace

std::vector<std::string> SensorNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kSensors) names.emplace_back(entry.name);
  return names;
}

std::unique_ptr<Sensor> MakeSensor(const Scenario& scenario, const World& world) {
  std::string known;
  for (const Entry& entry : kSensors) {
    if (scenario.sensor == entry.name) return entry.make(scenario, world);
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  const auto line = scenario.lines.find("sensor.name");
  throw InputError(scenario.file, line == scenario.lines.end() ? 0 : line->second, "sensor.name",
                   "is not a known sensor (known: " + known + "): '" + scenario.sensor + "'");
}

}  // namespace sidestep
