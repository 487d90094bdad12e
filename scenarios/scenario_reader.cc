#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/model_name.h"
#include "sidestep/core/random.h"
#include "sidestep/core/utf8.h"
#include "sidestep/core/yaml_reader.h"
#include "sidestep/scenarios/bounded_number.h"
#include "sidestep/scenarios/horizon_bounds.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/scenarios/track_file.h"
#include "sidestep/scenarios/variations.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {
namespace {

// A field of 512^3 floats takes 512 MiB; more than that is a slip of the pen, not a workspace.
constexpr int kMaxCellsPerAxis = 512;
constexpr double kMinCell_m = 0.001, kMaxCell_m = 10;
// Bounds against slips such as milliseconds given as seconds; generous for any arm.
constexpr double kMaxCycleRateHz = 1000;
constexpr double kLeastStep_s = 0.001;  // a control tick
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kShortestLeg_s = 0.01;
constexpr double kSwayRate_hz = 1;  // of a person
// Objects' fields are padded for it on all sides.
constexpr double kMaxGrowth_m = 0.5;
// The objective is weighted by the squares of these: beyond such bounds it has no digits left.
constexpr double kLeastScale = 0.001;  // of a limit
constexpr const char* kSharedPlannerKeys[] = {
    "name",           "epsilon_m",       "velocity_scale",  "acceleration_scale", "growth_sigmas",
    "growth_limit_m", "position_limits", "velocity_limits", "acceleration_limits"};
constexpr double kMostSigmas = 100;
constexpr double kThinnestMesh = 1e-4;  // of its size: the simulator has 7 digits for each vertex
constexpr double kFarthest_m = 1e6;     // beyond, positions have no tenth of a micrometre

// A name, or a path to a folder, whose own name is the robot's; and a variant, if there is a colon.
void ReadModel(const YamlReader& map, Scenario& scenario) {
  const std::string name = map.GetString("model"), model = ModelFolder(name);
  scenario.robot_variant = ModelVariant(name);
  if (model.ends_with(":")) map.Fail("model", "must name a variant behind the colon");
  if (model.empty()) map.Fail("model", "must name a robot before the colon");
  if (model.find('/') == std::string::npos) {
    scenario.robot = model;
    return;
  }
  scenario.robot_path = model;
  std::filesystem::path folder = std::filesystem::path(model).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  scenario.robot = folder.filename().string();
  if (scenario.robot.empty() || scenario.robot == "." || scenario.robot == "..") {
    map.Fail("model", "must be a path to a robot's folder and end in its name, is '" + model + "'");
  }
}

void ReadRobot(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("robot");
  ReadModel(map, scenario);
  scenario.X_WB = map.GetPose("base");
  if (scenario.X_WB.translation().cwiseAbs().maxCoeff() > kFarthest_m) {
    throw WrongValue(scenario, "robot.base.position_m", "must be within 1000 km");
  }
  scenario.mount = map.Has("mount") ? map.GetString("mount") : "";
  map.CheckNoUnknownKeys();
}

void ReadConfiguration(const YamlReader& map, const std::string& key, std::string& name,
                       Eigen::VectorXd& q) {
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
  ReadConfiguration(map, "start", scenario.start_name, scenario.q_start);
  ReadConfiguration(map, "goal", scenario.goal_name, scenario.q_goal);
  scenario.dwell_s = map.Has("dwell_s") ? map.GetNonNegative("dwell_s") : 0;
  map.CheckNoUnknownKeys();
}

void ReadHorizon(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("horizon");
  scenario.horizon_s = map.GetPositive("duration_s");
  scenario.step_s = map.GetPositive("step_s");
  if (scenario.horizon_s > kMostHorizon_s) map.Fail("duration_s", "must be at most 60 s");
  const double steps = scenario.horizon_s / scenario.step_s;
  if (std::abs(steps - std::round(steps)) > 1e-6 || std::round(steps) < 4) {
    throw WrongValue(scenario, "horizon.step_s",
                     "must divide duration_s into at least 4 whole steps", {"horizon.duration_s"});
  }
  if (std::round(steps) > kMostHorizonSteps) {
    throw WrongValue(scenario, "horizon.step_s", "makes more than 1000 steps",
                     {"horizon.duration_s"});
  }
  if (scenario.step_s < kLeastStep_s) map.Fail("step_s", "must be at least 0.001 s");
  map.CheckNoUnknownKeys();
  if (scenario.dwell_s > scenario.horizon_s) {
    throw WrongValue(scenario, "task.dwell_s", "must not exceed the horizon",
                     {"horizon.duration_s"});
  }
}

void ReadWorkspace(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("workspace");
  scenario.grid.first_center_m = map.GetVector3("first_center_m");
  scenario.grid.cell_m = map.GetPositive("cell_m");
  if (scenario.grid.cell_m < kMinCell_m || scenario.grid.cell_m > kMaxCell_m) {
    map.Fail("cell_m", "must be from 0.001 to 10 m");
  }
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
  if (!IsPlainName(name)) map.Fail("name", "must be letters, digits, _ and -, is '" + name + "'");
  if (!names.insert(name).second) map.Fail("name", "'" + name + "' is taken");
  return name;
}

// The one key of a map like {box: {...}}.
std::string ReadKind(const YamlReader& map, const std::string& key, const YamlReader& parent,
                     const std::vector<std::string>& kinds) {
  const std::vector<std::string> keys = map.Keys();
  if (keys.size() != 1) parent.Fail(key, "must hold exactly one of " + Joined(kinds));
  if (std::find(kinds.begin(), kinds.end(), keys[0]) == kinds.end()) {
    map.Fail(keys[0], "is not a known kind (known: " + Joined(kinds) + ")");
  }
  return keys[0];
}

ConvexMesh ReadConvexMesh(const YamlReader& body) {
  std::vector<Eigen::Vector3d> vertices;
  for (const std::vector<double>& row : body.GetRows("vertices_m")) {
    if (row.size() != 3) {
      body.Fail("vertices_m[" + std::to_string(vertices.size()) + "]",
                "must have 3 numbers, has " + std::to_string(row.size()));
    }
    vertices.emplace_back(row[0], row[1], row[2]);
  }
  try {
    return MakeConvexMesh(vertices);
  } catch (const std::invalid_argument& fault) {
    body.Fail("vertices_m", fault.what());
  }
}

Shape ReadShape(const YamlReader& parent) {
  const YamlReader map = parent.GetMap("shape");
  const std::string kind = ReadKind(
      map, "shape", parent, {"box", "sphere", "capsule", "cylinder", "ellipsoid", "convex_mesh"});
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
  if (kind == "convex_mesh") shape = ReadConvexMesh(body);
  body.CheckNoUnknownKeys();
  return shape;
}

Eigen::Vector3d ReadTurn(const YamlReader& map) {
  return map.Has("rpy_rad") ? map.GetVector3("rpy_rad") : Eigen::Vector3d(0, 0, 0);
}

// Of what an appearance does not hide.
std::vector<Tag> ReadTagsOf(const Shape& shape, const YamlReader& map) {
  if (!map.Has("tags")) return {};
  const Box* const box = std::get_if<Box>(&shape);
  if (box == nullptr) map.Fail("tags", "are for boxes; this is no box", "shape");
  return ReadTags(map, box->size_m);
}

void ReadStaticBoxes(const YamlReader& top, Scenario& scenario, std::set<std::string>& names) {
  if (!top.Has("static_boxes")) return;
  for (const YamlReader& map : top.GetMaps("static_boxes")) {
    StaticObstacle box;
    box.path = "static_boxes[" + std::to_string(scenario.static_obstacles.size()) + "]";
    box.name = ReadName(map, names);
    const Eigen::Vector3d center = map.GetVector3("center_m");
    box.X_WO = Pose::FromRollPitchYaw(ReadTurn(map), center);
    box.shape = Box{map.GetPositiveVector3("size_m")};
    box.tags = ReadTagsOf(box.shape, map);
    map.CheckNoUnknownKeys();
    scenario.static_obstacles.push_back(std::move(box));
  }
}

void ReadStaticObstacles(const YamlReader& top, Scenario& scenario, std::set<std::string>& names) {
  if (!top.Has("static_obstacles")) return;
  std::size_t number = 0;
  for (const YamlReader& map : top.GetMaps("static_obstacles")) {
    StaticObstacle obstacle;
    obstacle.path = "static_obstacles[" + std::to_string(number++) + "]";
    obstacle.name = ReadName(map, names);
    obstacle.shape = ReadShape(map);
    const Eigen::Vector3d position = map.GetVector3("position_m");
    obstacle.X_WO = Pose::FromRollPitchYaw(ReadTurn(map), position);
    obstacle.tags = ReadTagsOf(obstacle.shape, map);
    map.CheckNoUnknownKeys();
    scenario.static_obstacles.push_back(std::move(obstacle));
  }
}

Eigen::Vector3d ReadDirection(const YamlReader& body) {
  const Eigen::Vector3d direction = body.GetVector3("direction");
  const double length = direction.norm();
  if (!(length > 1e-9)) body.Fail("direction", "must be longer than 1e-9");
  // One that was written as a unit vector is read as the same numbers.
  return std::abs(length - 1) < 1e-12 ? direction : direction / length;
}

double ReadOptional(const YamlReader& map, const char* key, double otherwise) {
  return map.Has(key) ? map.GetNonNegative(key) : otherwise;
}

LinearMotion ReadLinear(const YamlReader& body) {
  LinearMotion motion;
  motion.start_m = body.GetVector3("start_m");
  motion.direction = ReadDirection(body);
  return motion;
}

WaypointMotion ReadWaypoints(const YamlReader& body) {
  WaypointMotion motion;
  for (const YamlReader& point : body.GetMaps("points")) {
    motion.points_m.push_back(point.GetVector3("position_m"));
    point.CheckNoUnknownKeys();
    const std::size_t n = motion.points_m.size();
    if (n > 1 && (motion.points_m[n - 1] - motion.points_m[n - 2]).norm() < 1e-9) {
      point.Fail("position_m", "must differ from the point before it");
    }
  }
  if (motion.points_m.size() < 2) body.Fail("points", "must list at least 2 points");
  return motion;
}

AcceleratedMotion ReadAccelerated(const YamlReader& body) {
  AcceleratedMotion motion;
  motion.start_m = body.GetVector3("start_m");
  motion.direction = ReadDirection(body);
  motion.acceleration_m_s2 = body.GetDouble("acceleration_m_s2");
  motion.change_at_s = ReadOptional(body, "change_at_s", 0);
  motion.max_speed_m_s = ReadOptional(body, "max_speed_m_s", kNever);
  if (motion.max_speed_m_s < body.GetNonNegative("speed_m_s")) {
    body.Fail("max_speed_m_s", "must not be below speed_m_s", "speed_m_s");
  }
  return motion;
}

CircleMotion ReadCircle(const YamlReader& body) {
  CircleMotion motion;
  motion.center_m = body.GetVector3("center_m");
  motion.radius_m = body.GetPositive("radius_m");
  motion.start_angle_rad = body.GetDouble("start_angle_rad");
  motion.clockwise = body.Has("clockwise") && body.GetBool("clockwise");
  return motion;
}

RandomWalkMotion ReadRandomWalk(const YamlReader& body) {
  RandomWalkMotion motion;
  motion.start_m = body.GetVector3("start_m");
  motion.heading_rad = body.GetDouble("heading_rad");
  motion.turn_rad = body.GetNonNegative("turn_rad");
  motion.turn_every_s = body.GetPositive("turn_every_s");
  if (motion.turn_every_s < kShortestLeg_s) body.Fail("turn_every_s", "must be at least 0.01 s");
  return motion;
}

// [LEAST, MOST], both > 0.
Range ReadPositiveRange(const YamlReader& body, const char* key) {
  const Eigen::VectorXd numbers = body.GetVector(key, 2);
  if (!(numbers(0) > 0 && numbers(0) <= numbers(1))) {
    body.Fail(key, "must be [LEAST, MOST] with 0 < LEAST <= MOST, is " + List(numbers));
  }
  return {numbers(0), numbers(1)};
}

WalkMotion ReadWalk(const YamlReader& body) {
  WalkMotion motion;
  motion.start_m = body.GetVector3("start_m");
  motion.direction = ReadDirection(body);
  if (motion.direction.z() != 0) body.Fail("direction", "must be level: z must be 0");
  motion.pace_m_s = ReadPositiveRange(body, "pace_m_s");
  motion.pace_every_s = ReadPositiveRange(body, "pace_every_s");
  if (motion.pace_every_s.least < kShortestLeg_s) {
    body.Fail("pace_every_s", "must be at least 0.01 s");
  }
  motion.pace_factor = ReadPositiveRange(body, "pace_factor");
  motion.sway_m = ReadOptional(body, "sway_m", 0);
  motion.sway_rate_hz = ReadOptional(body, "sway_rate_hz", kSwayRate_hz);
  motion.speed_m_s = motion.pace_m_s.middle();
  return motion;
}

std::vector<TrackSample> ReadSamples(const YamlReader& body) {
  std::vector<TrackSample> samples;
  for (const std::vector<double>& row : body.GetRows("samples")) {
    const std::string key = "samples[" + std::to_string(samples.size()) + "]";
    if (const auto fault = AppendSample(row, &samples)) {
      body.Fail(key, (fault->column.empty() ? "" : fault->column + " ") + fault->why);
    }
  }
  if (samples.size() < 2) body.Fail("samples", "must list at least 2 samples");
  return samples;
}

// The samples of a file that stands beside the scenario or in a folder there, so that the two are
// moved and shared together.
std::vector<TrackSample> ReadSamplesBeside(const std::optional<std::string>& folder,
                                           const YamlReader& body) {
  namespace fs = std::filesystem;
  const fs::path file = body.GetString("file");
  if (!folder) body.Fail("file", "stands beside a scenario file, and this is none: give samples");
  if (file.is_absolute() || std::find(file.begin(), file.end(), "..") != file.end()) {
    body.Fail("file", "must be a path from the scenario's folder that stays in it");
  }
  const fs::path path = fs::path(*folder) / file;
  std::error_code error;
  if (!fs::exists(path, error)) body.Fail("file", "there is no " + path.string());
  return ReadTrackFile(path.string());
}

RecordedMotion ReadRecorded(const std::optional<std::string>& folder, const YamlReader& body) {
  const bool has_file = body.Has("file"), has_samples = body.Has("samples");
  if (has_file && has_samples) body.Fail("file", "must not be given beside samples");
  if (!has_file && !has_samples) body.Fail("samples", "or file must be given");
  RecordedMotion motion;
  motion.track = std::make_shared<const RecordedTrack>(has_file ? ReadSamplesBeside(folder, body)
                                                                : ReadSamples(body));
  motion.speed_m_s = motion.track->mean_speed_m_s();
  return motion;
}

void ReadMotion(const YamlReader& parent, const std::optional<std::string>& folder,
                MovingObstacle& obstacle) {
  const YamlReader map = parent.GetMap("motion");
  const std::string kind =
      ReadKind(map, "motion", parent,
               {"linear", "waypoints", "accelerated", "circle", "random_walk", "walk", "recorded"});
  const YamlReader body = map.GetMap(kind);
  Motion& motion = obstacle.motion;
  if (kind == "linear") motion = ReadLinear(body);
  if (kind == "waypoints") motion = ReadWaypoints(body);
  if (kind == "accelerated") motion = ReadAccelerated(body);
  if (kind == "circle") motion = ReadCircle(body);
  if (kind == "random_walk") motion = ReadRandomWalk(body);
  if (kind == "walk") motion = ReadWalk(body);
  if (kind == "recorded") motion = ReadRecorded(folder, body);
  const bool has_own_speed = (kind == "walk" || kind == "recorded") && !body.Has("speed_m_s");
  std::visit(
      [&](auto& any) {
        if (!has_own_speed) any.speed_m_s = body.GetNonNegative("speed_m_s");
        any.stop_at_s = ReadOptional(body, "stop_at_s", kNever);
        any.begin_at_s = ReadOptional(body, "begin_at_s", 0);
        if (any.stop_at_s < any.begin_at_s) {
          body.Fail("stop_at_s", "must not be before begin_at_s", "begin_at_s");
        }
      },
      motion);
  obstacle.faces_path =
      body.Has("face") && body.GetChoice("face", {"fixed", "along_path"}) == "along_path";
  const auto* const recorded = std::get_if<RecordedMotion>(&motion);
  if (obstacle.faces_path && recorded != nullptr && recorded->track->has_rotations()) {
    body.Fail("face", "cannot be along_path: the samples say how it is turned");
  }
  body.CheckNoUnknownKeys();
}

// Random motions follow from the scenario's seed, each its own way.
void SeedMotions(Scenario& scenario) {
  std::uint64_t place = 0;
  for (MovingObstacle& obstacle : scenario.moving_obstacles) {
    const std::uint64_t seed = 1000 * scenario.seed + place++;
    if (auto* const random_walk = std::get_if<RandomWalkMotion>(&obstacle.motion)) {
      random_walk->seed = seed;
    }
    if (auto* const walk = std::get_if<WalkMotion>(&obstacle.motion)) walk->seed = seed;
  }
}

std::vector<Tag> ReadTagsOfObstacle(const YamlReader& map, const MovingObstacle& obstacle) {
  const bool is_box = std::holds_alternative<Box>(obstacle.shape);
  if (map.Has("tags") && is_box && !obstacle.appearance.empty()) {
    map.Fail("tags", "are printed on a box, and an appearance hides it", "appearance");
  }
  return ReadTagsOf(obstacle.shape, map);
}

// One that is there twice says nothing about where it is.
void CheckTagIds(const Scenario& scenario) {
  std::set<int> ids;
  const auto check = [&](const std::string& path, const std::vector<Tag>& tags) {
    for (std::size_t k = 0; k < tags.size(); ++k) {
      if (ids.insert(tags[k].id).second) continue;
      throw WrongValue(scenario, path + ".tags[" + std::to_string(k) + "].id",
                       std::to_string(tags[k].id) + " is another tag's");
    }
  };
  for (const StaticObstacle& fixed : scenario.static_obstacles) check(fixed.path, fixed.tags);
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    check("moving_obstacles[" + std::to_string(i) + "]", scenario.moving_obstacles[i].tags);
  }
}

void ReadMovingObstacles(const YamlReader& top, const std::optional<std::string>& folder,
                         Scenario& scenario, std::set<std::string>& names) {
  if (!top.Has("moving_obstacles")) return;
  for (const YamlReader& map : top.GetMaps("moving_obstacles")) {
    MovingObstacle obstacle;
    obstacle.name = ReadName(map, names);
    obstacle.shape = ReadShape(map);
    obstacle.rpy_rad = ReadTurn(map);
    ReadMotion(map, folder, obstacle);
    obstacle.appearance = map.Has("appearance") ? map.GetString("appearance") : "";
    obstacle.tags = ReadTagsOfObstacle(map, obstacle);
    map.CheckNoUnknownKeys();
    scenario.moving_obstacles.push_back(obstacle);
  }
}

void ReadPlanner(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("planner");
  scenario.planner = map.GetString("name");
  scenario.epsilon_m = map.GetNonNegative("epsilon_m");
  if (scenario.epsilon_m > kMaxMarginCells * scenario.grid.cell_m) {
    throw WrongValue(
        scenario, "planner.epsilon_m",
        "must be at most " + std::to_string(kMaxMarginCells) + " cells of the workspace",
        {"workspace.cell_m"});
  }
  const auto within = [&](const char* key, double value, double least, double most) {
    if (value < least || value > most) {
      map.Fail(key,
               "must be from " + Number(least) + " to " + Number(most) + ", is " + Number(value));
    }
    return value;
  };
  const auto number = [&](const char* key, double otherwise) {
    return map.Has(key) ? map.GetPositive(key) : otherwise;
  };
  const auto flag = [&](const char* key) { return map.Has(key) ? map.GetBool(key) : true; };
  const auto fraction = [&](const char* key, double otherwise) {
    const double value = number(key, otherwise);
    if (value > 1) map.Fail(key, "must be at most 1");
    return within(key, value, kLeastScale, 1);
  };
  scenario.velocity_scale = fraction("velocity_scale", 0.95);
  scenario.acceleration_scale = fraction("acceleration_scale", 0.5);
  const auto size = [&](const char* key, double otherwise) {
    return map.Has(key) ? map.GetNonNegative(key) : otherwise;
  };
  scenario.growth_sigmas = within("growth_sigmas", size("growth_sigmas", 0), 0, kMostSigmas);
  scenario.growth_limit_m = size("growth_limit_m", 0.1);
  if (scenario.growth_limit_m > kMaxGrowth_m) map.Fail("growth_limit_m", "must be at most 0.5 m");
  scenario.position_limits = flag("position_limits");
  scenario.velocity_limits = flag("velocity_limits");
  scenario.acceleration_limits = flag("acceleration_limits");
  for (const std::string& key : map.Keys()) {
    if (std::count(std::begin(kSharedPlannerKeys), std::end(kSharedPlannerKeys), key) != 0)
      continue;
    if (!map.IsScalar(key)) map.Fail(key, "must be a number, true or false, or a word");
    scenario.planner_parameters[key] = map.GetString(key);
  }
  map.CheckNoUnknownKeys();
}

double ReadRate(const YamlReader& map, const char* key) {
  const double rate = map.GetPositive(key);
  if (rate > kMaxCycleRateHz) map.Fail(key, "must be at most 1000");
  return rate;
}

void ReadReplanning(const YamlReader& top, Scenario& scenario) {
  const YamlReader map = top.GetMap("replanning");
  scenario.replan_rate_hz = ReadRate(map, "rate_hz");
  scenario.latency_s = map.GetNonNegative("latency_s");
  if (scenario.latency_s > scenario.horizon_s) {
    throw WrongValue(scenario, "replanning.latency_s", "must not exceed the horizon",
                     {"horizon.duration_s"});
  }
  if (map.Has("latency")) {
    const std::vector<std::string> words(std::begin(kLatencyWords), std::end(kLatencyWords));
    scenario.latency = LatencyFromString(map.GetChoice("latency", words));
  }
  if (map.Has("iterations")) {
    scenario.most_iterations = map.GetInt("iterations");
    if (scenario.most_iterations < 0) {
      map.Fail("iterations", "must be >= 0, is " + std::to_string(scenario.most_iterations));
    }
  }
  map.CheckNoUnknownKeys();
}

void ReadSafety(const YamlReader& top, Scenario& scenario) {
  if (!top.Has("safety")) return;
  const YamlReader map = top.GetMap("safety");
  Safety& safety = scenario.safety;
  const std::vector<std::string> words(std::begin(kSafetyWords), std::end(kSafetyWords));
  safety.profile = SafetyFromString(map.GetChoice("profile", words));
  const auto bounded = [&](const char* key, double& value, double most) {
    if (!map.Has(key)) return;
    value = map.GetPositive(key);
    if (value > most) map.Fail(key, "must be at most " + ShortestText(most));
  };
  bounded("obstacle_speed_m_s", safety.obstacle_speed_m_s, 100);
  bounded("obstacle_acceleration_m_s2", safety.obstacle_acceleration_m_s2, 1000);
  bounded("tool_speed_m_s", safety.tool_speed_m_s, 100);
  map.CheckNoUnknownKeys();
}

void ReadTracking(const YamlReader& top, Tracking& tracking) {
  if (!top.Has("tracking")) return;
  const YamlReader map = top.GetMap("tracking");
  tracking.coast_s = AtMost(map, "coast_s", tracking.coast_s, 10);
  tracking.max_speed_m_s = PositiveAtMost(map, "max_speed_m_s", tracking.max_speed_m_s, 100);
  map.CheckNoUnknownKeys();
}

void ReadPerception(const YamlReader& top, Scenario& scenario) {
  scenario.knowledge = top.GetString("knowledge");
  scenario.predictor = top.Has("predictor") ? top.GetString("predictor") : "kalman_cv";
  ReadTracking(top, scenario.tracking);
  scenario.more_sensors = ReadSensors(top);
  scenario.evidence = ReadEvidence(top, scenario.more_sensors);
  scenario.sensor = std::move(scenario.more_sensors.front());
  scenario.more_sensors.erase(scenario.more_sensors.begin());
  const int seed = top.GetInt("seed");
  if (seed < 0) top.Fail("seed", "must be >= 0, is " + std::to_string(seed));
  scenario.seed = static_cast<std::uint64_t>(seed);
}

struct Choice {
  std::string default_option;
  std::vector<std::string> options;
  YamlReader parts;  // what each option puts into place
};
using Choices = std::map<std::string, Choice>;

// Who set a key would otherwise depend on the order of the choices.
void CheckKeysOfOptions(const std::string& name, const YamlReader& part,
                        std::map<std::string, std::string>& choice_of_key) {
  for (const std::string& key : part.Keys()) {
    if (key == "choices") part.Fail(key, "cannot be chosen");
    const std::string& other = choice_of_key.emplace(key, name).first->second;
    if (other != name) part.Fail(key, "is set by the choice '" + other + "' as well");
  }
}

Choices ReadChoices(const YamlReader& file) {
  Choices choices;
  if (!file.Has("choices")) return choices;
  const YamlReader map = file.GetMap("choices");
  std::map<std::string, std::string> choice_of_key;
  for (const std::string& name : map.Keys()) {
    if (!IsPlainName(name)) map.Fail(name, "must be letters, digits, _ and -");
    // A study has factors of these names, and a setting of one would be taken for the other.
    for (const char* const taken : {"seed", "speed_m_s", "knowledge", "predictor"}) {
      if (name == taken)
        map.Fail(name, "is the name of something else that varies; choose another");
    }
    const YamlReader choice = map.GetMap(name);
    YamlReader parts = choice.GetMap("options");
    const std::vector<std::string> options = parts.Keys();
    const std::string default_option = choice.GetChoice("default", options);
    choice.CheckNoUnknownKeys();
    for (const std::string& option : options) {
      CheckKeysOfOptions(name, parts.GetMap(option), choice_of_key);
    }
    choices.emplace(name, Choice{default_option, options, std::move(parts)});
  }
  map.CheckNoUnknownKeys();
  return choices;
}

// The file without its choices, one option of each in place: those that the settings name, else the
// default.
YamlReader Choose(const YamlReader& file, const Choices& choices, const Settings& settings,
                  std::map<std::string, std::string>& chosen) {
  YamlReader top = file.Without("choices");
  for (const auto& [name, choice] : choices) {
    const auto setting = settings.find(name);
    const std::string& option = setting == settings.end() ? choice.default_option : setting->second;
    if (std::find(choice.options.begin(), choice.options.end(), option) == choice.options.end()) {
      throw InputError("--set " + name,
                       "must be one of " + Joined(choice.options) + ", is '" + option + "'");
    }
    top = top.With(choice.parts.GetMap(option));
    chosen[name] = option;
  }
  return top;
}

// Puts the settings that are no choices into place.
YamlReader Set(YamlReader top, const Choices& choices, const Settings& settings) {
  for (const auto& [path, value] : settings) {
    if (choices.count(path) != 0) continue;
    if (path == "choices" || path.starts_with("choices.")) {
      throw InputError("--set " + path, "is chosen by --set NAME=OPTION");
    }
    top = top.With(path, value, "--set");
  }
  return top;
}

// A world to look at needs no robot; what a robot needs asks for one.
bool HasRobot(const YamlReader& top) {
  const auto keys = {"robot", "task", "horizon", "planner", "replanning"};
  return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return top.Has(key); });
}

// Results go into a folder of the scenario's name.
std::string ReadFolderName(const YamlReader& top) {
  const std::string name = top.GetString("name");
  if (name == "." || name == ".." || name.find('/') != std::string::npos) {
    top.Fail("name", "must be fit for a folder's name, without /, is '" + name + "'");
  }
  return name;
}

// Where a scenario was written.
struct Origin {
  std::string file;
  std::optional<std::string> folder;  // what the file's own references begin at; a text has none
};

// What was chosen and set is in place.
Scenario ReadSettled(const YamlReader& top, const Origin& origin) {
  const auto& [file, folder] = origin;
  Scenario scenario;
  scenario.lines = top.Lines();
  scenario.file = file;
  // A file's name may hold any bytes; that of a scenario is told in every kind of result.
  scenario.name = top.Has("name") ? ReadFolderName(top)
                                  : EscapeInvalidUtf8(std::filesystem::path(file).stem().string());
  scenario.description = top.GetString("description");
  std::set<std::string> names = {"floor", "self", "world"};  // words of verdicts and of MJCF
  const bool has_robot = HasRobot(top);
  if (has_robot) {
    ReadRobot(top, scenario);
    ReadTask(top, scenario);
    ReadHorizon(top, scenario);
  }
  ReadWorkspace(top, scenario);
  scenario.floor_m = top.Has("floor_m") ? top.GetDouble("floor_m") : 0;
  const bool exact =
      top.Has("static_world") && top.GetChoice("static_world", {"occupancy", "exact"}) == "exact";
  scenario.static_world = exact ? StaticWorld::kExact : StaticWorld::kOccupancy;
  ReadStaticBoxes(top, scenario, names);
  ReadStaticObstacles(top, scenario, names);
  ReadMovingObstacles(top, folder, scenario, names);
  CheckTagIds(scenario);
  if (has_robot) {
    ReadPlanner(top, scenario);
    ReadReplanning(top, scenario);
    ReadSafety(top, scenario);
  }
  ReadPerception(top, scenario);
  SeedMotions(scenario);
  DrawVariations(top, scenario);
  top.Has("choices");  // known, though they have been taken out
  top.CheckNoUnknownKeys();

  const auto is_mount = [&](const StaticObstacle& one) { return one.name == scenario.mount; };
  const auto& fixed = scenario.static_obstacles;
  if (!scenario.mount.empty() && std::none_of(fixed.begin(), fixed.end(), is_mount)) {
    throw WrongValue(scenario, "robot.mount",
                     "'" + scenario.mount + "' is no static box or obstacle of this scenario");
  }
  return scenario;
}

// A fault in an option that nobody has chosen is told too: each is read as if it alone were chosen.
void CheckOptions(const YamlReader& file, const Choices& choices, const Origin& origin) {
  for (const auto& [name, choice] : choices) {
    for (const std::string& option : choice.options) {
      std::map<std::string, std::string> chosen;
      ReadSettled(Choose(file, choices, {{name, option}}, chosen), origin);
    }
  }
}

Scenario Read(const YamlReader& file, const Origin& origin, const Settings& settings) {
  const Choices choices = ReadChoices(file);
  std::map<std::string, std::string> chosen;
  YamlReader top = Choose(file, choices, settings, chosen);
  Scenario scenario = ReadSettled(Set(std::move(top), choices, settings), origin);
  scenario.choices = chosen;
  CheckOptions(file, choices, origin);
  return scenario;
}

// The path of what holds this one; empty at the top.
std::string ParentOf(const std::string& path) {
  const std::size_t end = path.find_last_of(".[");
  return end == std::string::npos ? "" : path.substr(0, end);
}

// The line of `path`, or of the nearest that holds it.
int LineOf(const Scenario& scenario, const std::string& path) {
  for (std::string at = path; !at.empty(); at = ParentOf(at)) {
    const auto found = scenario.lines.find(at);
    if (found != scenario.lines.end()) return found->second;
  }
  return 1;
}

// What a person set of `path`: all of it, or the first part of it that was set.
std::optional<std::string> SetPath(const Scenario& scenario, const std::string& path) {
  if (LineOf(scenario, path) == 0) return path;
  for (const auto& [part, line] : scenario.lines) {
    const bool is_inside = part.starts_with(path + ".") || part.starts_with(path + "[");
    if (is_inside && line == 0) return part;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> SharedPlannerKeys() {
  return {std::begin(kSharedPlannerKeys), std::end(kSharedPlannerKeys)};
}

InputError WrongValue(const Scenario& scenario, const std::string& key, const std::string& why,
                      const std::vector<std::string>& against) {
  if (const auto set = SetPath(scenario, key)) return InputError("--set " + *set, why);
  for (const std::string& path : against) {
    if (const auto set = SetPath(scenario, path)) {
      return InputError("--set " + *set, key + ": " + why);
    }
  }
  return InputError(scenario.file, LineOf(scenario, key), key, why);
}

ConvexMesh MakeConvexMesh(const std::vector<Eigen::Vector3d>& vertices_m) {
  const auto hull = std::make_shared<const ConvexPolytope>(vertices_m);
  if (hull->thickness_m() < kThinnestMesh * hull->half_extents_m().maxCoeff()) {
    throw std::invalid_argument("are a solid that is too thin for its size");
  }
  return {hull};
}

std::vector<SensorSettings> SensorsOf(const Scenario& scenario) {
  std::vector<SensorSettings> sensors = {scenario.sensor};
  sensors.insert(sensors.end(), scenario.more_sensors.begin(), scenario.more_sensors.end());
  return sensors;
}

Scenario WithSensor(Scenario scenario, const SensorSettings& sensor) {
  scenario.sensor = sensor;
  scenario.more_sensors.clear();
  const std::string name = NameOf(sensor);
  if (name != sensor.name) scenario.seed = RandomStream(scenario.seed, "sensor " + name).Bits();
  return scenario;
}

std::string RobotFolder(const Scenario& scenario, const ModelFolders& models) {
  if (!scenario.robot_path.empty()) {
    const auto folder = std::filesystem::path(scenario.file).parent_path() / scenario.robot_path;
    const std::string normal = folder.lexically_normal().string();
    return normal.ends_with("/") ? normal.substr(0, normal.size() - 1) : normal;
  }
  const auto folder = models.Find(scenario.robot);
  if (folder) return *folder;
  throw WrongValue(scenario, "robot.model",
                   "there is no '" + scenario.robot + "' in " + Joined(models.folders()));
}

std::string RobotMjcf(const Scenario& scenario, const ModelFolders& models) {
  return RobotFolder(scenario, models) + "/" + scenario.robot + ".xml";
}

std::vector<std::string> ScenarioNames(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Scenario LoadScenario(const std::string& path, const Settings& settings) {
  return Read(YamlReader::FromFile(path),
              {path, std::filesystem::path(path).parent_path().string()}, settings);
}

Scenario ParseScenario(const std::string& text, const std::string& name, const Settings& settings) {
  return Read(YamlReader::FromText(text, name), {name, std::nullopt}, settings);
}

std::map<std::string, std::vector<std::string>> ScenarioChoices(const std::string& path) {
  std::map<std::string, std::vector<std::string>> options;
  for (const auto& [name, choice] : ReadChoices(YamlReader::FromFile(path))) {
    options[name] = choice.options;
  }
  return options;
}

}  // namespace sidestep::scenarios
