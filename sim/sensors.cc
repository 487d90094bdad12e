#include "sidestep/sim/sensors.h"

#include <algorithm>
#include <string_view>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/sim/delayed_sensor.h"

namespace sidestep::sim {

#define SIDESTEP_SENSOR(name, meaning, settings, make, file) \
  std::unique_ptr<robot::Sensor> make(const scenarios::Scenario&, const World&);
#include "sidestep/sim/sensors.def"
#undef SIDESTEP_SENSOR

namespace {

struct Entry {
  std::string_view name;
  const char* meaning;
  std::string_view settings;  // as sensors.def says
  std::unique_ptr<robot::Sensor> (*make)(const scenarios::Scenario&, const World&);
};
constexpr Entry kSensors[] = {
#define SIDESTEP_SENSOR(name, meaning, settings, make, file) {name, meaning, settings, &(make)},
#include "sidestep/sim/sensors.def"
#undef SIDESTEP_SENSOR
};

[[noreturn]] void FailAtKey(const scenarios::Scenario& scenario, const std::string& key,
                            const std::string& why) {
  const std::string& path = scenario.sensor.path;
  throw scenarios::WrongValue(scenario, path + "." + key, why, {path + ".name"});
}

}  // namespace

std::vector<std::string> SensorNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kSensors) names.emplace_back(entry.name);
  std::sort(names.begin(), names.end());
  return names;
}

std::string MeaningOfSensor(const std::string& name) {
  for (const Entry& entry : kSensors) {
    if (name == entry.name) return entry.meaning;
  }
  throw std::invalid_argument("unknown sensor '" + name + "'");
}

void CheckSensorSettings(const scenarios::Scenario& scenario, std::string_view settings) {
  const scenarios::SensorSettings& sensor = scenario.sensor;
  const std::string of = "the sensor '" + sensor.name + "'";
  const struct {
    std::string key;
    bool given;
  } maps[] = {{"noise", sensor.noise.has_value()},
              {"camera", sensor.camera.has_value()},
              {"tags", sensor.tags.has_value()},
              {"tag_images", sensor.tag_images.has_value()}};
  for (const auto& [key, given] : maps) {
    if (given && settings != key && settings != key + "?") {
      FailAtKey(scenario, key, "is not for " + of);
    }
    if (!given && settings == key) FailAtKey(scenario, key, "is missing; " + of + " needs it");
  }
}

std::unique_ptr<robot::Sensor> MakeSensor(const scenarios::Scenario& scenario, const World& world) {
  const scenarios::SensorSettings& settings = scenario.sensor;
  for (const Entry& entry : kSensors) {
    if (settings.name != entry.name) continue;
    CheckSensorSettings(scenario, entry.settings);
    std::unique_ptr<robot::Sensor> sensor = entry.make(scenario, world);
    const bool is_prompt =
        settings.latency_s == 0 && settings.jitter_s == 0 && settings.dropout == 0;
    if (is_prompt) return sensor;
    return std::make_unique<DelayedSensor>(std::move(sensor), settings, world, scenario.seed);
  }
  FailAtKey(
      scenario, "name",
      "is not a known sensor (known: " + Joined(SensorNames()) + "): '" + settings.name + "'");
}

}  // namespace sidestep::sim
