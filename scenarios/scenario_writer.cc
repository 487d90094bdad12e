#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/joined.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {
namespace {

Eigen::Vector3d RollPitchYaw(const Pose& pose) {
  const Eigen::Matrix3d R = pose.rotation().toRotationMatrix();
  return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))),
          std::atan2(R(1, 0), R(0, 0))};
}

std::string PoseKeys(const char* position_key, const Pose& pose) {
  std::string text = std::string(position_key) + ": " + List(pose.translation());
  const Eigen::Vector3d rpy = RollPitchYaw(pose);
  if (!rpy.isZero(0)) text += ", rpy_rad: " + List(rpy);
  return text;
}

std::string ShapeText(const Shape& shape) {
  std::string sizes;
  if (const Box* box = std::get_if<Box>(&shape)) sizes = "size_m: " + List(box->size_m);
  if (const Sphere* sphere = std::get_if<Sphere>(&shape)) {
    sizes = "radius_m: " + Number(sphere->radius_m);
  }
  if (const Capsule* capsule = std::get_if<Capsule>(&shape)) {
    sizes = "radius_m: " + Number(capsule->radius_m) + ", length_m: " + Number(capsule->length_m);
  }
  if (const Cylinder* cylinder = std::get_if<Cylinder>(&shape)) {
    sizes = "radius_m: " + Number(cylinder->radius_m) + ", length_m: " + Number(cylinder->length_m);
  }
  if (const Ellipsoid* ellipsoid = std::get_if<Ellipsoid>(&shape)) {
    sizes = "semi_axes_m: " + List(ellipsoid->semi_axes_m);
  }
  if (const ConvexMesh* mesh = std::get_if<ConvexMesh>(&shape)) {
    sizes = "vertices_m: [" + Joined(mesh->hull->vertices(), ", ", &List) + "]";
  }
  return "{" + ShapeName(shape) + ": {" + sizes + "}}";
}

std::string TimesText(double begin_at_s, double stop_at_s) {
  std::string text;
  if (begin_at_s > 0) text += ", begin_at_s: " + Number(begin_at_s);
  if (std::isfinite(stop_at_s)) text += ", stop_at_s: " + Number(stop_at_s);
  return text;
}

std::string KeysOf(const LinearMotion& motion) {
  return "linear: {start_m: " + List(motion.start_m) + ", direction: " + List(motion.direction);
}

std::string KeysOf(const WaypointMotion& motion) {
  const auto position = [](const Eigen::Vector3d& p) { return "{position_m: " + List(p) + "}"; };
  return "waypoints: {points: [" + Joined(motion.points_m, ", ", position) + "]";
}

std::string KeysOf(const AcceleratedMotion& motion) {
  std::string text = "accelerated: {start_m: " + List(motion.start_m) +
                     ", direction: " + List(motion.direction) +
                     ", acceleration_m_s2: " + Number(motion.acceleration_m_s2) +
                     ", change_at_s: " + Number(motion.change_at_s);
  if (std::isfinite(motion.max_speed_m_s)) {
    text += ", max_speed_m_s: " + Number(motion.max_speed_m_s);
  }
  return text;
}

std::string KeysOf(const CircleMotion& motion) {
  return "circle: {center_m: " + List(motion.center_m) + ", radius_m: " + Number(motion.radius_m) +
         ", start_angle_rad: " + Number(motion.start_angle_rad) +
         (motion.clockwise ? ", clockwise: true" : "");
}

std::string KeysOf(const RandomWalkMotion& motion) {
  return "random_walk: {start_m: " + List(motion.start_m) +
         ", heading_rad: " + Number(motion.heading_rad) + ", turn_rad: " + Number(motion.turn_rad) +
         ", turn_every_s: " + Number(motion.turn_every_s);
}

std::string KeysOf(const WalkMotion& motion) {
  const auto range = [](const Range& numbers) {
    return "[" + Number(numbers.least) + ", " + Number(numbers.most) + "]";
  };
  return "walk: {start_m: " + List(motion.start_m) + ", direction: " + List(motion.direction) +
         ", pace_m_s: " + range(motion.pace_m_s) + ", pace_every_s: " + range(motion.pace_every_s) +
         ", pace_factor: " + range(motion.pace_factor) + ", sway_m: " + Number(motion.sway_m) +
         ", sway_rate_hz: " + Number(motion.sway_rate_hz);
}

std::string KeysOf(const RecordedMotion& motion) {
  std::string rows;
  for (const TrackSample& sample : motion.track->samples()) {
    Eigen::VectorXd row(sample.R_WO ? 8 : 4);
    row.head<4>() << sample.t_s, sample.p_WO;
    if (sample.R_WO) {
      row.tail<4>() << sample.R_WO->w(), sample.R_WO->x(), sample.R_WO->y(), sample.R_WO->z();
    }
    rows += (rows.empty() ? "" : ", ") + List(row);
  }
  return "recorded: {samples: [" + rows + "]";
}

std::string MotionText(const MovingObstacle& obstacle) {
  return std::visit(
      [&](const auto& any) {
        return "{" + KeysOf(any) + ", speed_m_s: " + Number(any.speed_m_s) +
               TimesText(any.begin_at_s, any.stop_at_s) +
               (obstacle.faces_path ? ", face: along_path" : "") + "}}";
      },
      obstacle.motion);
}

bool IsOfStaticBoxes(const StaticObstacle& obstacle) {
  return obstacle.path.starts_with("static_boxes");
}

std::string StaticText(const Scenario& scenario) {
  std::string boxes, others;
  for (const StaticObstacle& one : scenario.static_obstacles) {
    const std::string tags = one.tags.empty() ? "" : ", tags: " + ToYaml(one.tags);
    const std::string name = "  - {name: " + Quoted(one.name) + ", ";
    if (IsOfStaticBoxes(one)) {
      boxes += name + PoseKeys("center_m", one.X_WO) +
               ", size_m: " + List(std::get<Box>(one.shape).size_m) + tags + "}\n";
    } else {
      others += name + "shape: " + ShapeText(one.shape) + ", " + PoseKeys("position_m", one.X_WO) +
                tags + "}\n";
    }
  }
  return (boxes.empty() ? "" : "static_boxes:\n" + boxes) +
         (others.empty() ? "" : "static_obstacles:\n" + others);
}

// The keys of an obstacle, in order, each with its value.
std::vector<std::pair<std::string, std::string>> ObstacleKeys(const MovingObstacle& obstacle) {
  std::vector<std::pair<std::string, std::string>> keys = {{"name", Quoted(obstacle.name)},
                                                           {"shape", ShapeText(obstacle.shape)}};
  if (!obstacle.rpy_rad.isZero(0)) keys.emplace_back("rpy_rad", List(obstacle.rpy_rad));
  if (!obstacle.appearance.empty()) keys.emplace_back("appearance", Quoted(obstacle.appearance));
  if (!obstacle.tags.empty()) keys.emplace_back("tags", ToYaml(obstacle.tags));
  keys.emplace_back("motion", MotionText(obstacle));
  return keys;
}

const char* Word(bool value) { return value ? "true" : "false"; }

std::string ConfigurationText(const std::string& name, const Eigen::VectorXd& q) {
  return name.empty() ? List(q) : Quoted(name);
}

std::string RobotText(const Scenario& scenario) {
  const std::string model = (scenario.robot_path.empty() ? scenario.robot : scenario.robot_path) +
                            (scenario.robot_variant.empty() ? "" : ":" + scenario.robot_variant);
  return "robot:\n  model: " + Quoted(model) + "\n  base: {" +
         PoseKeys("position_m", scenario.X_WB) + "}\n" +
         (scenario.mount.empty() ? "" : "  mount: " + Quoted(scenario.mount) + "\n") +
         "task:\n  start: " + ConfigurationText(scenario.start_name, scenario.q_start) +
         "\n  goal: " + ConfigurationText(scenario.goal_name, scenario.q_goal) +
         "\n  dwell_s: " + Number(scenario.dwell_s) +
         "\nhorizon: {duration_s: " + Number(scenario.horizon_s) +
         ", step_s: " + Number(scenario.step_s) + "}\n";
}

// What YAML does not take for a text.
bool IsNumberOrSwitch(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  return text == "true" || text == "false" || (parsed.ec == std::errc() && parsed.ptr == end);
}

std::string PlannerText(const Scenario& scenario) {
  std::string text = "planner:\n";
  const auto line = [&](const char* key, const std::string& value) {
    text += std::string("  ") + key + ": " + value + "\n";
  };
  line("name", Quoted(scenario.planner));
  line("epsilon_m", Number(scenario.epsilon_m));
  line("velocity_scale", Number(scenario.velocity_scale));
  line("acceleration_scale", Number(scenario.acceleration_scale));
  line("growth_sigmas", Number(scenario.growth_sigmas));
  line("growth_limit_m", Number(scenario.growth_limit_m));
  line("position_limits", Word(scenario.position_limits));
  line("velocity_limits", Word(scenario.velocity_limits));
  line("acceleration_limits", Word(scenario.acceleration_limits));
  for (const auto& [key, value] : scenario.planner_parameters) {
    line(key.c_str(), IsNumberOrSwitch(value) ? value : Quoted(value));
  }
  return text + "replanning: {rate_hz: " + Number(scenario.replan_rate_hz) +
         ", latency: " + ToString(scenario.latency) + ", latency_s: " + Number(scenario.latency_s) +
         ", iterations: " + std::to_string(scenario.most_iterations) +
         "}\nsafety: {profile: " + ToString(scenario.safety.profile) +
         ", obstacle_speed_m_s: " + Number(scenario.safety.obstacle_speed_m_s) +
         ", obstacle_acceleration_m_s2: " + Number(scenario.safety.obstacle_acceleration_m_s2) +
         (std::isfinite(scenario.safety.tool_speed_m_s)
              ? ", tool_speed_m_s: " + Number(scenario.safety.tool_speed_m_s)
              : "") +
         "}\n";
}

}  // namespace

std::string ToString(Latency latency) { return kLatencyWords[static_cast<int>(latency)]; }

Latency LatencyFromString(const std::string& word) {
  for (const Latency latency : {Latency::kCharged, Latency::kMeasured, Latency::kNone}) {
    if (ToString(latency) == word) return latency;
  }
  throw std::invalid_argument("no latency is '" + word + "'");
}

std::string ToString(SafetyProfile profile) { return kSafetyWords[static_cast<int>(profile)]; }

SafetyProfile SafetyFromString(const std::string& word) {
  for (const SafetyProfile profile :
       {SafetyProfile::kOff, SafetyProfile::kObserve, SafetyProfile::kLab}) {
    if (ToString(profile) == word) return profile;
  }
  throw std::invalid_argument("no safety profile is '" + word + "'");
}

std::string ToYaml(const Scenario& scenario) {
  const GridSpec& grid = scenario.grid;
  std::string text;
  const auto line = [&](const std::string& row) { text += row + "\n"; };
  line("name: " + Quoted(scenario.name));
  line("description: " + Quoted(scenario.description));
  const bool has_robot = !scenario.robot.empty();
  if (has_robot) text += RobotText(scenario);
  line("workspace: {first_center_m: " + List(grid.first_center_m) +
       ", cell_m: " + Number(grid.cell_m) + ", cells: [" + std::to_string(grid.size[0]) + ", " +
       std::to_string(grid.size[1]) + ", " + std::to_string(grid.size[2]) + "]}");
  line("floor_m: " + Number(scenario.floor_m));
  line(std::string("static_world: ") +
       (scenario.static_world == StaticWorld::kExact ? "exact" : "occupancy"));
  text += StaticText(scenario);
  if (!scenario.moving_obstacles.empty()) line("moving_obstacles:");
  for (const MovingObstacle& obstacle : scenario.moving_obstacles) {
    const char* dash = "- ";
    for (const auto& [key, value] : ObstacleKeys(obstacle)) {
      line("  " + std::string(std::exchange(dash, "  ")) + key + ": " + value);
    }
  }
  if (has_robot) text += PlannerText(scenario);
  line("knowledge: " + Quoted(scenario.knowledge));
  line("predictor: " + Quoted(scenario.predictor));
  line("tracking: {coast_s: " + Number(scenario.tracking.coast_s) +
       ", max_speed_m_s: " + Number(scenario.tracking.max_speed_m_s) + "}");
  const std::vector<SensorSettings> sensors = SensorsOf(scenario);
  text += ToYaml(sensors);
  const auto has_camera = [](const SensorSettings& sensor) { return sensor.camera.has_value(); };
  if (std::any_of(sensors.begin(), sensors.end(), has_camera)) text += ToYaml(scenario.evidence);
  line("seed: " + std::to_string(scenario.seed));
  return text;
}

std::string ToYaml(const Scenario& scenario, const std::string& choice,
                   const std::vector<Scenario>& options) {
  std::string text =
      ToYaml(scenario) + "choices:\n  " + choice + ":\n    default: \"1\"\n" + "    options:\n";
  int number = 0;
  for (const Scenario& option : options) {
    text += "      \"" + std::to_string(++number) +
            "\":\n        task: {start: " + ConfigurationText(option.start_name, option.q_start) +
            ", goal: " + ConfigurationText(option.goal_name, option.q_goal) +
            ", dwell_s: " + Number(option.dwell_s) + "}\n        moving_obstacles:\n";
    for (const MovingObstacle& obstacle : option.moving_obstacles) {
      const auto entry = [](const auto& key) { return key.first + ": " + key.second; };
      text += "          - {" + Joined(ObstacleKeys(obstacle), ", ", entry) + "}\n";
    }
  }
  return text;
}

}  // namespace sidestep::scenarios
