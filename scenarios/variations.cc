#include "sidestep/scenarios/variations.h"

#include <variant>

#include "sidestep/core/input_error.h"
#include "sidestep/core/random.h"
#include "sidestep/core/yaml_reader.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {
namespace {

constexpr const char* kSpeedFactor = "speed_factor";
constexpr const char* kDelay = "delay_s";
// Bounds against slips of the pen.
constexpr double kMaxSpeedFactor = 100, kMaxDelay_s = 60;

void Delay(Motion& motion, double delay_s) {
  std::visit(
      [&](auto& any) {
        any.begin_at_s += delay_s;
        any.stop_at_s += delay_s;
      },
      motion);
}

// Draws what `key` says, if it is there, into scenario.drawn.
void Draw(const YamlReader& map, const char* key, double most, Scenario& scenario) {
  if (!map.Has(key)) return;
  const Eigen::VectorXd range = map.GetVector(key, 2);
  if (!(range(0) >= 0 && range(0) < range(1) && range(1) <= most)) {
    map.Fail(key, "must be [LEAST, MOST] with 0 <= LEAST < MOST <= " + Number(most) + ", is " +
                      List(range));
  }
  if (scenario.moving_obstacles.empty()) return;
  RandomStream random(scenario.seed, std::string("variations.") + key);
  scenario.drawn[key] = random.Uniform(range(0), range(1));
}

double SpeedFactor(const Scenario& scenario) {
  const auto drawn = scenario.drawn.find(kSpeedFactor);
  return drawn == scenario.drawn.end() ? 1 : drawn->second;
}

void AddChangedNoise(const SensorSettings& sensor, std::vector<std::string>& changed) {
  const auto add = [&](const char* key, bool is_random) {
    if (is_random) changed.push_back(std::string("sensor.") + key);
  };
  add("jitter_s", sensor.jitter_s > 0);
  add("dropout", sensor.dropout > 0 && sensor.dropout < 1);
  if (sensor.noise) {
    add("noise", sensor.noise->false_filled > 0 || sensor.noise->false_free > 0 ||
                     sensor.noise->position_noise_m > 0);
  }
  if (sensor.camera) {
    add("camera", sensor.camera->noise_per_m > 0 || sensor.camera->pixel_dropout > 0);
  }
  if (sensor.tags) {
    add("tags", sensor.tags->across_noise > 0 || sensor.tags->along_noise_per_m > 0 ||
                    sensor.tags->rotation_noise_rad > 0);
  }
  if (sensor.tag_images) add("tag_images", sensor.tag_images->grey_noise > 0);
}

}  // namespace

void DrawVariations(const YamlReader& top, Scenario& scenario) {
  if (!top.Has("variations")) return;
  const YamlReader map = top.GetMap("variations");
  Draw(map, kSpeedFactor, kMaxSpeedFactor, scenario);
  Draw(map, kDelay, kMaxDelay_s, scenario);
  map.CheckNoUnknownKeys();
  ScaleSpeeds(scenario, SpeedFactor(scenario));
  const auto delay = scenario.drawn.find(kDelay);
  if (delay == scenario.drawn.end()) return;
  for (MovingObstacle& obstacle : scenario.moving_obstacles) Delay(obstacle.motion, delay->second);
}

void SetSpeed(Scenario& scenario, double speed_m_s) {
  if (scenario.moving_obstacles.empty()) {
    throw InputError("--speed", "this scenario has no moving obstacle");
  }
  if (speed_m_s > YamlReader::kLargestNumber) throw InputError("--speed", "must be at most 1e12");
  const double drawn_m_s = speed_m_s * SpeedFactor(scenario);
  for (MovingObstacle& obstacle : scenario.moving_obstacles) {
    // Its greatest speed has the factor already.
    const auto* const accelerated = std::get_if<AcceleratedMotion>(&obstacle.motion);
    if (accelerated && accelerated->max_speed_m_s < drawn_m_s) {
      throw InputError("--speed", "is above the max_speed_m_s of '" + obstacle.name + "'");
    }
    std::visit([&](auto& any) { any.speed_m_s = drawn_m_s; }, obstacle.motion);
  }
}

std::vector<std::string> WhatTheSeedChanges(const Scenario& scenario) {
  std::vector<std::string> changed;
  for (const auto& [key, value] : scenario.drawn) changed.push_back("variations." + key);
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    const auto* const walk = std::get_if<RandomWalkMotion>(&scenario.moving_obstacles[i].motion);
    if (walk && walk->turn_rad > 0 && walk->speed_m_s > 0) {
      changed.push_back("moving_obstacles[" + std::to_string(i) + "].motion.random_walk");
    }
  }
  AddChangedNoise(scenario.sensor, changed);
  return changed;
}

}  // namespace sidestep::scenarios
