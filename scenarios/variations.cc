#include "sidestep/scenarios/variations.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>
#include <variant>

#include "sidestep/core/input_error.h"
#include "sidestep/core/random.h"
#include "sidestep/core/yaml_reader.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {
namespace {

constexpr const char* kSpeedFactor = "speed_factor";
constexpr const char* kDelay = "delay_s";
constexpr const char* kSideways = "sideways_m";
constexpr const char* kYaw = "yaw_rad";
// Bounds against slips of the pen.
constexpr Range kSpeedFactors{0, 100}, kDelays_s{0, 60}, kSideways_m{-100, 100}, kYaws_rad{-7, 7};
constexpr const char* kAxes[] = {"x_m", "y_m", "z_m"};

void Delay(Motion& motion, double delay_s) {
  std::visit(
      [&](auto& any) {
        any.begin_at_s += delay_s;
        any.stop_at_s += delay_s;
      },
      motion);
}

// What to move so that a motion goes the same way elsewhere.
template <class AnyMotion>
void Shift(AnyMotion& motion, const Eigen::Vector3d& by_m) {
  motion.start_m += by_m;
}
void Shift(CircleMotion& motion, const Eigen::Vector3d& by_m) { motion.center_m += by_m; }
void Shift(WaypointMotion& motion, const Eigen::Vector3d& by_m) {
  for (Eigen::Vector3d& point_m : motion.points_m) point_m += by_m;
}
void Shift(RecordedMotion& motion, const Eigen::Vector3d& by_m) {
  std::vector<TrackSample> samples = motion.track->samples();
  for (TrackSample& sample : samples) sample.p_WO += by_m;
  motion.track = std::make_shared<const RecordedTrack>(std::move(samples));
}

void MoveLeft(Motion& motion, double by_m) {
  const Eigen::Vector3d way = DirectionAt(motion, EpisodeTime(0));
  const Eigen::Vector3d left = LeftOf(way).normalized();  // or zero
  std::visit([&](auto& any) { Shift(any, by_m * left); }, motion);
}

// Draws what `key` says, if it is there, into scenario.drawn.
// @param of whom the draw is, `NAME.`; empty: of all.
void Draw(const YamlReader& map, const char* key, const Range& bounds, Scenario& scenario,
          const std::string& of = "") {
  if (!map.Has(key)) return;
  const Eigen::VectorXd range = map.GetVector(key, 2);
  if (!(range(0) >= bounds.least && range(0) < range(1) && range(1) <= bounds.most)) {
    map.Fail(key, "must be [LEAST, MOST] with " + Number(bounds.least) +
                      " <= LEAST < MOST <= " + Number(bounds.most) + ", is " + List(range));
  }
  if (scenario.moving_obstacles.empty()) return;
  RandomStream random(scenario.seed, "variations." + of + key);
  scenario.drawn[of + key] = random.Uniform(range(0), range(1));
}

// Draws how far an obstacle starts from where the file has it: evenly within `within_m` to either
// side, or by a normal deviate of `deviation_m`, along each axis.
void DrawOffset(const YamlReader& map, Scenario& scenario, const std::string& of) {
  if (map.Has("within_m") && map.Has("deviation_m")) {
    map.Fail("deviation_m", "must not be given beside within_m");
  }
  for (const char* const key : {"within_m", "deviation_m"}) {
    if (!map.Has(key)) continue;
    const Eigen::Vector3d size_m = map.GetVector3(key);
    if (!(size_m.minCoeff() >= 0 && size_m.maxCoeff() <= kSideways_m.most)) {
      map.Fail(key, "must be three lengths from 0 to 100, is " + List(size_m));
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (size_m(axis) == 0) continue;
      RandomStream random(scenario.seed, "variations." + of + kAxes[axis]);
      const bool is_even = key == std::string("within_m");
      scenario.drawn[of + kAxes[axis]] =
          size_m(axis) * (is_even ? random.Uniform(-1, 1) : random.Normal());
    }
  }
}

double DrawnOr(const Scenario& scenario, const std::string& key, double otherwise) {
  const auto drawn = scenario.drawn.find(key);
  return drawn == scenario.drawn.end() ? otherwise : drawn->second;
}

// Whether another seed would let it go another way.
template <class AnyMotion>
bool IsRandom(const AnyMotion&) {
  return false;
}
bool IsRandom(const RandomWalkMotion& motion) {
  return motion.turn_rad > 0 && motion.speed_m_s > 0;
}
bool IsRandom(const WalkMotion& motion) {
  return motion.pace_m_s.least < motion.pace_m_s.most && motion.speed_m_s > 0;
}

void AddChangedNoise(const SensorSettings& sensor, std::vector<std::string>& changed) {
  const auto add = [&](const char* key, bool is_random) {
    if (is_random) changed.push_back(sensor.path + "." + key);
  };
  add("jitter_s", sensor.jitter_s > 0);
  add("dropout", sensor.dropout > 0 && sensor.dropout < 1);
  if (sensor.noise) {
    add("noise", sensor.noise->false_filled > 0 || sensor.noise->false_free > 0 ||
                     sensor.noise->position_noise_m > 0);
  }
  if (sensor.camera) {
    add("camera", sensor.camera->noise_per_m > 0 || sensor.camera->pixel_dropout > 0 ||
                      sensor.camera->flying_pixels > 0);
  }
  if (sensor.tags) {
    const TagSettings& tags = *sensor.tags;
    const double chances[] = {tags.across_noise,
                              tags.along_noise_per_m,
                              tags.rotation_noise_rad,
                              tags.partly_hidden,
                              tags.flips,
                              tags.outliers,
                              tags.swaps,
                              tags.phantoms};
    add("tags", *std::max_element(std::begin(chances), std::end(chances)) > 0);
  }
  if (sensor.tag_images) add("tag_images", sensor.tag_images->grey_noise > 0);
}

// What is drawn for one obstacle alone.
void DrawObject(const YamlReader& map, Scenario& scenario) {
  const std::string name = map.GetString("name");
  const auto obstacle =
      std::find_if(scenario.moving_obstacles.begin(), scenario.moving_obstacles.end(),
                   [&](const MovingObstacle& one) { return one.name == name; });
  if (obstacle == scenario.moving_obstacles.end()) {
    map.Fail("name", "'" + name + "' is no moving obstacle");
  }
  const std::string of = name + ".";
  Draw(map, kSpeedFactor, kSpeedFactors, scenario, of);
  Draw(map, kDelay, kDelays_s, scenario, of);
  Draw(map, kYaw, kYaws_rad, scenario, of);
  DrawOffset(map, scenario, of);
  map.CheckNoUnknownKeys();
  Scenario alone = scenario;
  alone.moving_obstacles = {*obstacle};
  ScaleSpeeds(alone, DrawnOr(scenario, of + kSpeedFactor, 1));
  obstacle->motion = alone.moving_obstacles.front().motion;
  Delay(obstacle->motion, DrawnOr(scenario, of + kDelay, 0));
  obstacle->rpy_rad.z() += DrawnOr(scenario, of + kYaw, 0);
  Eigen::Vector3d by_m;
  for (int axis = 0; axis < 3; ++axis) by_m(axis) = DrawnOr(scenario, of + kAxes[axis], 0);
  if (!by_m.isZero(0)) std::visit([&](auto& any) { Shift(any, by_m); }, obstacle->motion);
}

}  // namespace

void DrawVariations(const YamlReader& top, Scenario& scenario) {
  if (!top.Has("variations")) return;
  const YamlReader map = top.GetMap("variations");
  Draw(map, kSpeedFactor, kSpeedFactors, scenario);
  Draw(map, kDelay, kDelays_s, scenario);
  Draw(map, kSideways, kSideways_m, scenario);
  const std::vector<YamlReader> objects =
      map.Has("objects") ? map.GetMaps("objects") : std::vector<YamlReader>();
  map.CheckNoUnknownKeys();
  ScaleSpeeds(scenario, DrawnOr(scenario, kSpeedFactor, 1));
  for (MovingObstacle& obstacle : scenario.moving_obstacles) {
    Delay(obstacle.motion, DrawnOr(scenario, kDelay, 0));
    if (scenario.drawn.count(kSideways) != 0) {
      MoveLeft(obstacle.motion, scenario.drawn.at(kSideways));
    }
  }
  for (const YamlReader& object : objects) DrawObject(object, scenario);
}

void SetSpeed(Scenario& scenario, double speed_m_s) {
  if (scenario.moving_obstacles.empty()) {
    throw InputError("--speed", "this scenario has no moving obstacle");
  }
  if (speed_m_s > YamlReader::kLargestNumber) throw InputError("--speed", "must be at most 1e12");
  const double of_all_m_s = speed_m_s * DrawnOr(scenario, kSpeedFactor, 1);
  for (MovingObstacle& obstacle : scenario.moving_obstacles) {
    const double drawn_m_s = of_all_m_s * DrawnOr(scenario, obstacle.name + "." + kSpeedFactor, 1);
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
    const Motion& motion = scenario.moving_obstacles[i].motion;
    if (std::visit([](const auto& any) { return IsRandom(any); }, motion)) {
      const char* const kind = std::holds_alternative<WalkMotion>(motion) ? "walk" : "random_walk";
      changed.push_back("moving_obstacles[" + std::to_string(i) + "].motion." + kind);
    }
  }
  for (const SensorSettings& sensor : SensorsOf(scenario)) AddChangedNoise(sensor, changed);
  return changed;
}

}  // namespace sidestep::scenarios
