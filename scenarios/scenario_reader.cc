#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "core/input_error.h"
#include "core/yaml_reader.h"
#include "scenarios/scenario.h"

namespace sidestep {
namespace {

// A field of 512^3 floats takes 512 MiB; more than that is a slip of the pen, not a workspace.
constexpr int kMaxCellsPerAxis = 512;
// Bounds against slips such as milliseconds given as seconds; generous for any arm.
constexpr double kMaxHorizon = 60, kMaxRateHz = 1000;
constexpr int kMaxStates = 1001;

void ReadRobot(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("robot");
  scenario.robot = map.GetString("model");
  scenario.X_WB = map.GetPose("base");
  scenario.mount = map.Has("mount") ? map.GetString("mount") : "";
  scenario.lines["robot.model"] = map.Line("model");
  scenario.lines["robot.mount"] = map.Line("mount");
  map.CheckNoUnknownKeys();
}

void ReadConfiguration(const YamlReader& map, const std::string& key, std::string& name,
                       Eigen::VectorXd& q, Scenario& scenario) {
  scenario.lines["task." + key] = map.Line(key);
  if (map.IsScalar(key)) {
    name = map.GetString(key);
    return;
  }
  const std::vector<double> joints = map.GetDoubles(key);
  if (joints.empty()) map.Fail(key, "must name a configuration or list joint positions, is empty");
  q = Eigen::Map<const Eigen::VectorXd>(joints.data(), static_cast<Eigen::Index>(joints.size()));
}

void ReadTask(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("task");
  ReadConfiguration(map, "start", scenario.start_name, scenario.q_start, scenario);
  ReadConfiguration(map, "goal", scenario.goal_name, scenario.q_goal, scenario);
  map.CheckNoUnknownKeys();
}

void ReadHorizon(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("horizon");
  scenario.horizon_s = map.GetPositive("duration_s");
  scenario.step_s = map.GetPositive("step_s");
  if (scenario.horizon_s > kMaxHorizon) map.Fail("duration_s", "must be at most 60 s");
  const double steps = scenario.horizon_s / scenario.step_s;
  if (std::abs(steps - std::round(steps)) > 1e-6 || std::round(steps) < 4) {
    map.Fail("step_s", "must divide duration_s into at least 4 whole steps");
  }
  if (std::round(steps) >= kMaxStates) map.Fail("step_s", "makes more than 1000 steps");
  map.CheckNoUnknownKeys();
}

void ReadWorkspace(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("workspace");
  scenario.grid.first_center_m = map.GetVector3("first_center_m");
  scenario.grid.cell_m = map.GetPositive("cell_m");
  const Eigen::Vector3d cells = map.GetPositiveVector3("cells");
  for (int axis = 0; axis < 3; ++axis) {
    const double n = cells(axis);
    if (n != std::floor(n) || n < 2 || n > kMaxCellsPerAxis) {
      map.Fail("cells", "must be whole numbers from 2 to " + std::to_string(kMaxCellsPerAxis));
    }
    scenario.grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(n);
  }
  map.CheckNoUnknownKeys();
}

std::string ReadName(const YamlReader& map, std::set<std::string>& names) {
  const std::string name = map.GetString("name");
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  if (!plain) map.Fail("name", "must be letters, digits, _ and -, is '" + name + "'");
  if (!names.insert(name).second) map.Fail("name", "'" + name + "' is taken");
  return name;
}

void ReadStaticBoxes(const YamlReader& top, Scenario& scenario, std::set<std::string>& names) {
  if (!top.Has("static_boxes")) return;
  for (const YamlReader& map : top.GetMaps("static_boxes")) {
    StaticBox box;
    box.name = ReadName(map, names);
    const Eigen::Vector3d center = map.GetVector3("center_m");
    const Eigen::Vector3d rpy =
        map.Has("rpy_rad") ? map.GetVector3("rpy_rad") : Eigen::Vector3d(0, 0, 0);
    box.X_WO = Pose::FromRollPitchYaw(rpy, center);
    box.size_m = map.GetPositiveVector3("size_m");
    map.CheckNoUnknownKeys();
    scenario.static_boxes.push_back(box);
  }
}

// The one key of a map like {box: {...}}.
std::string ReadKind(const YamlReader& map, const std::string& key, const YamlReader& parent,
                     const std::vector<std::string>& kinds) {
  const std::vector<std::string> keys = map.Keys();
  std::string list;
  for (const std::string& kind : kinds) list += (list.empty() ? "" : ", ") + kind;
  if (keys.size() != 1) parent.Fail(key, "must hold exactly one of " + list);
  if (std::find(kinds.begin(), kinds.end(), keys[0]) == kinds.end()) {
    map.Fail(keys[0], "is not a known kind (known: " + list + ")");
  }
  return keys[0];
}

Shape ReadShape(const YamlReader& parent) {
  const YamlReader map = parent.GetMap("shape");
  const std::string kind =
      ReadKind(map, "shape", parent, {"box", "sphere", "capsule", "cylinder", "ellipsoid"});
  const YamlReader body = map.GetMap(kind);
  Shape shape;
  if (kind == "box") shape = Box{body.GetPositiveVector3("size_m")};
  if (kind == "sphere") shape = Sphere{body.GetPositive("radius_m")};
  if (kind == "capsule")
    shape = Capsule{body.GetPositive("radius_m"), body.GetPositive("length_m")};
  if (kind == "cylinder") {
    shape = Cylinder{body.GetPositive("radius_m"), body.GetPositive("length_m")};
  }
  if (kind == "ellipsoid") shape = Ellipsoid{body.GetPositiveVector3("semi_axes_m")};
  body.CheckNoUnknownKeys();
  return shape;
}

double ReadStop(const YamlReader& map) {
  return map.Has("stop_at_s") ? map.GetNonNegative("stop_at_s")
                              : std::numeric_limits<double>::infinity();
}

Motion ReadMotion(const YamlReader& parent) {
  const YamlReader map = parent.GetMap("motion");
  const std::string kind = ReadKind(map, "motion", parent, {"linear", "waypoints"});
  const YamlReader body = map.GetMap(kind);
  Motion motion;
  if (kind == "linear") {
    LinearMotion linear;
    linear.start_m = body.GetVector3("start_m");
    const Eigen::Vector3d direction = body.GetVector3("direction");
    if (!(direction.norm() > 1e-9)) body.Fail("direction", "must not be zero");
    linear.direction = direction.normalized();
    linear.speed_m_s = body.GetNonNegative("speed_m_s");
    linear.stop_at_s = ReadStop(body);
    motion = linear;
  } else {
    WaypointMotion waypoints;
    for (const YamlReader& point : body.GetMaps("points")) {
      waypoints.points_m.push_back(point.GetVector3("position_m"));
      point.CheckNoUnknownKeys();
      const std::size_t n = waypoints.points_m.size();
      if (n > 1 && (waypoints.points_m[n - 1] - waypoints.points_m[n - 2]).norm() < 1e-9) {
        point.Fail("position_m", "must differ from the point before it");
      }
    }
    if (waypoints.points_m.size() < 2) body.Fail("points", "must list at least 2 points");
    waypoints.speed_m_s = body.GetNonNegative("speed_m_s");
    waypoints.stop_at_s = ReadStop(body);
    motion = waypoints;
  }
  body.CheckNoUnknownKeys();
  return motion;
}

void ReadMovingObstacles(const YamlReader& top, Scenario& scenario, std::set<std::string>& names) {
  if (!top.Has("moving_obstacles")) return;
  for (const YamlReader& map : top.GetMaps("moving_obstacles")) {
    MovingObstacle obstacle;
    const std::string index = std::to_string(scenario.moving_obstacles.size());
    obstacle.name = ReadName(map, names);
    obstacle.shape = ReadShape(map);
    obstacle.rpy_rad = map.Has("rpy_rad") ? map.GetVector3("rpy_rad") : Eigen::Vector3d(0, 0, 0);
    obstacle.motion = ReadMotion(map);
    obstacle.appearance = map.Has("appearance") ? map.GetString("appearance") : "";
    scenario.lines["moving_obstacles[" + index + "].appearance"] = map.Line("appearance");
    map.CheckNoUnknownKeys();
    scenario.moving_obstacles.push_back(obstacle);
  }
}

void ReadPlanner(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("planner");
  scenario.planner = map.GetString("name");
  scenario.lines["planner.name"] = map.Line("name");
  scenario.epsilon_m = map.GetNonNegative("epsilon_m");
  scenario.sigma_obs = map.GetPositive("sigma_obs");
  scenario.num_interpolated = map.GetInt("n_int");
  if (scenario.num_interpolated < 0 || scenario.num_interpolated > 100) {
    map.Fail("n_int", "must be from 0 to 100, is " + std::to_string(scenario.num_interpolated));
  }
  const auto number = [&](const char* key, double otherwise) {
    return map.Has(key) ? map.GetPositive(key) : otherwise;
  };
  const auto flag = [&](const char* key) { return map.Has(key) ? map.GetBool(key) : true; };
  scenario.qc = number("qc", 1.0);
  const auto fraction = [&](const char* key, double otherwise) {
    const double value = number(key, otherwise);
    if (value > 1) map.Fail(key, "must be at most 1");
    return value;
  };
  scenario.velocity_scale = fraction("velocity_scale", 0.95);
  scenario.acceleration_scale = fraction("acceleration_scale", 0.5);
  scenario.max_iterations = map.Has("max_iterations") ? map.GetInt("max_iterations") : 50;
  if (scenario.max_iterations < 1 || scenario.max_iterations > 100000) {
    map.Fail("max_iterations", "must be from 1 to 100000");
  }
  scenario.position_limits = flag("position_limits");
  scenario.velocity_limits = flag("velocity_limits");
  scenario.acceleration_limits = flag("acceleration_limits");
  map.CheckNoUnknownKeys();
}

double ReadRate(const YamlReader& map, const char* key) {
  const double rate = map.GetPositive(key);
  if (rate > kMaxRateHz) map.Fail(key, "must be at most 1000");
  return rate;
}

void ReadLoop(const YamlReader& top, Scenario& scenario) {
  scenario.knowledge = top.GetString("knowledge");
  scenario.predictor = top.GetString("predictor");
  scenario.lines["knowledge"] = top.Line("knowledge");
  scenario.lines["predictor"] = top.Line("predictor");
  const YamlReader replanning = top.GetMap("replanning");
  scenario.replan_rate_hz = ReadRate(replanning, "rate_hz");
  scenario.latency_s = replanning.GetNonNegative("latency_s");
  if (scenario.latency_s > scenario.horizon_s) {
    replanning.Fail("latency_s", "must not exceed the horizon");
  }
  replanning.CheckNoUnknownKeys();
  const YamlReader sensor = top.GetMap("sensor");
  scenario.sensor = sensor.GetString("name");
  scenario.lines["sensor.name"] = sensor.Line("name");
  scenario.sensor_rate_hz = ReadRate(sensor, "rate_hz");
  sensor.CheckNoUnknownKeys();
  const int seed = top.GetInt("seed");
  if (seed < 0) top.Fail("seed", "must be >= 0, is " + std::to_string(seed));
  scenario.seed = static_cast<std::uint64_t>(seed);
}

Scenario Read(const YamlReader& top, const std::string& file) {
  Scenario scenario;
  scenario.file = file;
  scenario.name =
      top.Has("name") ? top.GetString("name") : std::filesystem::path(file).stem().string();
  scenario.description = top.GetString("description");
  std::set<std::string> names = {"floor", "self"};  // words of verdicts
  ReadRobot(top, scenario);
  ReadTask(top, scenario);
  ReadHorizon(top, scenario);
  ReadWorkspace(top, scenario);
  scenario.floor_m = top.Has("floor_m") ? top.GetDouble("floor_m") : 0;
  ReadStaticBoxes(top, scenario, names);
  ReadMovingObstacles(top, scenario, names);
  ReadPlanner(top, scenario);
  ReadLoop(top, scenario);
  top.CheckNoUnknownKeys();

  const bool known = std::any_of(scenario.static_boxes.begin(), scenario.static_boxes.end(),
                                 [&](const StaticBox& box) { return box.name == scenario.mount; });
  if (!scenario.mount.empty() && !known) {
    throw InputError(file, scenario.lines["robot.mount"], "robot.mount",
                     "'" + scenario.mount + "' is no static box of this scenario");
  }
  return scenario;
}

}  // namespace

std::vector<std::string> ScenarioNames(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Scenario LoadScenario(const std::string& path) { return Read(YamlReader::FromFile(path), path); }

Scenario ParseScenario(const std::string& text, const std::string& name) {
  return Read(YamlReader::FromText(text, name), name);
}

}  // namespace sidestep
