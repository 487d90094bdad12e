#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/model_folders.h"
#include "sidestep/core/pose.h"
#include "sidestep/core/shape.h"
#include "sidestep/core/time.h"
#include "sidestep/scenarios/recorded_track.h"
#include "sidestep/scenarios/sensor_settings.h"
#include "sidestep/scenarios/tag.h"

namespace sidestep::scenarios {

/// The planner's margin is at most so many cells of the workspace; it pads objects' fields.
inline constexpr int kMaxMarginCells = 256;

/// A body that never moves.
struct StaticObstacle {
  std::string name;
  Pose X_WO;
  Shape shape;
  std::vector<Tag> tags = {};  ///< printed on it, which is then a box
  /// Its path in the file, `static_boxes[0]` or `static_obstacles[0]`; empty if it is of none.
  std::string path = {};
};

// Every motion has a speed_m_s (>= 0), rests at its start until begin_at_s, and stands still from
// stop_at_s on (infinite: never).

/// Straight on from `start_m`, along a unit vector, at a speed.
struct LinearMotion {
  Eigen::Vector3d start_m;
  Eigen::Vector3d direction;  ///< unit length
  double speed_m_s = 0;
  double stop_at_s = 0;
  double begin_at_s = 0;
};
/// Straight lines from point to point at one speed; rests at the last.
struct WaypointMotion {
  std::vector<Eigen::Vector3d> points_m;  ///< at least 2, no two neighbours equal
  double speed_m_s = 0;
  double stop_at_s = 0;
  double begin_at_s = 0;
};
/// Straight on at a speed that changes at a constant rate from `change_at_s` on, between rest and
/// `max_speed_m_s`: what brakes comes to rest and does not turn back.
struct AcceleratedMotion {
  Eigen::Vector3d start_m;
  Eigen::Vector3d direction;  ///< unit length
  double speed_m_s = 0;       ///< at first
  double acceleration_m_s2 = 0;
  double change_at_s = 0;
  double max_speed_m_s = 0;  ///< may be infinite; not below speed_m_s
  double stop_at_s = 0;
  double begin_at_s = 0;
};
/// Round a horizontal circle at one speed; begins at `start_angle_rad` from the x axis.
struct CircleMotion {
  Eigen::Vector3d center_m;
  double radius_m = 0;  ///< > 0
  double start_angle_rad = 0;
  bool clockwise = false;  ///< as seen from above
  double speed_m_s = 0;
  double stop_at_s = 0;
  double begin_at_s = 0;
};
/// At one speed on the level, along headings that change every `turn_every_s` by a normal deviate
/// of `turn_rad`. A function of the seed: that of the scenario and the obstacle's place in it.
struct RandomWalkMotion {
  Eigen::Vector3d start_m;
  double heading_rad = 0;   ///< at first, from the x axis
  double turn_rad = 0;      ///< standard deviation, >= 0
  double turn_every_s = 0;  ///< > 0
  std::uint64_t seed = 0;
  double speed_m_s = 0;
  double stop_at_s = 0;
  double begin_at_s = 0;
};
/// Between two numbers, least <= most.
struct Range {
  double least = 0, most = 0;
  double middle() const { return (least + most) / 2; }
};
/// As a person walks: along a level line, at a pace that is drawn at first and changed now and then
/// by a random factor within its bounds, swaying from side to side. A function of the seed: that of
/// the scenario and the obstacle's place in it. All draws are even. Its clock runs so fast that the
/// middle of the paces becomes speed_m_s; at 0 it rests at its start.
struct WalkMotion {
  Eigen::Vector3d start_m;
  Eigen::Vector3d direction;  ///< unit length, level
  Range pace_m_s;             ///< > 0
  Range pace_every_s;         ///< > 0, from one change of pace to the next
  Range pace_factor;          ///< > 0
  double sway_m = 0;          ///< to either side of the line
  double sway_rate_hz = 0;
  std::uint64_t seed = 0;
  double speed_m_s = 0;
  double stop_at_s = 0;
  double begin_at_s = 0;
};
/// Along a recorded track, whose times count from `begin_at_s`. Its clock runs so fast that the
/// mean speed while it moves (RecordedTrack::mean_speed_m_s) becomes speed_m_s: as recorded if they
/// are equal, at rest at its start if speed_m_s is 0. A track that stays in one place runs as
/// recorded.
struct RecordedMotion {
  std::shared_ptr<const RecordedTrack> track;  ///< never null
  double speed_m_s = 0;
  double stop_at_s = 0;
  double begin_at_s = 0;
};
using Motion = std::variant<LinearMotion, WaypointMotion, AcceleratedMotion, CircleMotion,
                            RandomWalkMotion, WalkMotion, RecordedMotion>;

struct MovingObstacle {
  std::string name;
  Shape shape;              ///< what contact, clearance and occupancy use
  Eigen::Vector3d rpy_rad;  ///< orientation; relative to that of the motion, if that turns
  Motion motion;
  std::string appearance;  ///< a body of models/ to draw inside the shape; empty: draw the shape
  /// Turned about z so that its x axis (before rpy_rad) points where it goes, see DirectionAt.
  bool faces_path = false;
  std::vector<Tag> tags = {};  ///< printed on it, which is then a box
};

/// What a planning cycle takes of the episode's time.
enum class Latency {
  kCharged,   ///< always the same
  kMeasured,  ///< the CPU time that it needs: no two runs are alike
  kNone       ///< nothing
};
inline constexpr const char* kLatencyWords[] = {"charged", "measured", "none"};  ///< in that order

/// What the safety supervisor of a robot does about what it finds (control/safety.h).
enum class SafetyProfile { kOff, kObserve, kLab };
inline constexpr const char* kSafetyWords[] = {"off", "observe", "lab"};  ///< in that order

struct Safety {
  SafetyProfile profile = SafetyProfile::kOff;
  double obstacle_speed_m_s = 0.5;  ///< what obstacles are declared to do
  double obstacle_acceleration_m_s2 = 2;
  /// What the tool is kept below; infinite: only what the joints' limits leave.
  double tool_speed_m_s = std::numeric_limits<double>::infinity();
};

/// How what moves is followed.
struct Tracking {
  double coast_s = 1;        ///< how long what is not seen goes on as predicted
  double max_speed_m_s = 4;  ///< what is faster, from one scan to the next, is another thing
};

/// How the planner knows what never moves.
enum class StaticWorld {
  kOccupancy,  ///< as the sensor sees it: by cells
  kExact,      ///< static shapes by their shapes, from the beginning; the sensor need not see them
};

struct Scenario {
  std::string name;
  std::string description;
  std::string file;  ///< where it was read

  std::string robot;  ///< its name; empty: a world without one, and without task, planner, ...
  /// The robot's folder as the file says it, from its own folder on; empty: that of its name, where
  /// robots are looked for.
  std::string robot_path;
  std::string robot_variant;  ///< of its description, as `covered` of `panda:covered`; may be empty
  Pose X_WB;                  ///< of the robot's base
  std::string mount;  ///< what the robot stands on: its mount links may touch it; empty: the floor
  std::string start_name, goal_name;  ///< empty when given as joints
  Eigen::VectorXd q_start, q_goal;    ///< filled when given as joints; else looked up by the name
  double dwell_s = 0;  ///< how long to stay at the goal for it to be reached; at most the horizon

  double horizon_s = 0;
  double step_s = 0;
  GridSpec grid;
  /// Height of the floor: solid, drawn, known exactly under every knowledge, never part of the
  /// occupancy. Without a mount the robot stands on it.
  double floor_m = 0;

  StaticWorld static_world = StaticWorld::kOccupancy;
  std::vector<StaticObstacle> static_obstacles;  ///< those of static_boxes first
  std::vector<MovingObstacle> moving_obstacles;

  std::string planner;
  /// What the file sets of this planner, which declares what can be set and judges the texts.
  std::map<std::string, std::string> planner_parameters;
  double epsilon_m = 0;
  double velocity_scale = 1, acceleration_scale = 1;
  /// Without velocity limits the simulated arm is not held to them either; how far a motion exceeds
  /// them is recorded.
  bool velocity_limits = true, acceleration_limits = true, position_limits = true;

  std::string knowledge;  ///< a word of sdf/world_model.h
  std::string predictor;
  /// Under prediction, moving things are taken to be thicker by so many standard deviations of
  /// where they are predicted to be, but by no more than the limit.
  double growth_sigmas = 0, growth_limit_m = 0;
  double replan_rate_hz = 0;
  Latency latency = Latency::kCharged;
  double latency_s = 0;  ///< charged to each planning cycle; measured: the most it may take
  /// In each cycle, counted as Planner::BudgetOf has it; 0: no end.
  int most_iterations = 0;
  double longest_latency_s() const { return latency == Latency::kNone ? 0 : latency_s; }

  Safety safety;
  Tracking tracking;
  SensorSettings sensor;
  std::vector<SensorSettings> more_sensors;  ///< beside it
  EvidenceSettings evidence;                 ///< of what depth cameras see
  std::uint64_t seed = 1;

  std::map<std::string, std::string> choices;  ///< what was chosen, by the choice's name
  /// What the seed decided of the file's `variations`, by its key. The motions above have it
  /// already.
  std::map<std::string, double> drawn;

  /// Lines of the file by path (YamlReader::Lines), so that others can complain of what only they
  /// can judge (names of robots, configurations, ...) as the reader does; 0 of what a setting gave.
  std::map<std::string, int> lines;
};

/// @throws std::invalid_argument for another word than those of kLatencyWords.
Latency LatencyFromString(const std::string& word);
std::string ToString(Latency latency);
/// The same for those of kSafetyWords.
SafetyProfile SafetyFromString(const std::string& word);
std::string ToString(SafetyProfile profile);

/// The keys of `planner` that are asked of every planner; any other one is the planner's own.
std::vector<std::string> SharedPlannerKeys();

/// What to throw where the value of `key` (a path in the file) is wrong: `FILE:LINE: KEY: WHY`, or
/// `--set KEY: WHY` where a person set it, or a part of it.
/// @param against the paths of what it does not agree with: where only one of them was set, that is
///   blamed, `--set AGAINST: KEY: WHY`.
InputError WrongValue(const Scenario& scenario, const std::string& key, const std::string& why,
                      const std::vector<std::string>& against = {});

/// Makes every moving obstacle `factor` times as fast, at each moment of its motion: speeds, their
/// limits and accelerations alike, so that what was a scenario stays one.
/// @throws InputError, as the reader would, if a number would be more than a scenario file may say;
///   std::invalid_argument for a factor that is negative or not finite.
void ScaleSpeeds(Scenario& scenario, double factor);

/// The hull of points, as a scenario may hold it: no thinner than 1/10000 of its largest
/// coordinate.
/// @throws std::invalid_argument with what is wrong, as of ConvexPolytope.
ConvexMesh MakeConvexMesh(const std::vector<Eigen::Vector3d>& vertices_m);

/// All sensors of a scenario, in the file's order.
std::vector<SensorSettings> SensorsOf(const Scenario& scenario);
/// The scenario with this sensor and no other. One that has a name of its own has a seed of its
/// own: two cameras do not err alike.
Scenario WithSensor(Scenario scenario, const SensorSettings& sensor);

/// The folder of the scenario's robot. @throws InputError at `robot.model` if there is none.
std::string RobotFolder(const Scenario& scenario, const ModelFolders& models);
/// Its MJCF, in there.
std::string RobotMjcf(const Scenario& scenario, const ModelFolders& models);

/// Where an obstacle is at `t`. Before 0 it rests at its start.
Pose PoseAt(const MovingObstacle& obstacle, EpisodeTime t);

/// Along which way a motion goes at `t`: a vector in W of any length whose level part is not zero,
/// or zero if it never goes on the level. At rest it is the way it went last or, before it has
/// moved, will go first; so it is on a vertical leg of waypoints. As continuous as the motion's
/// direction: it jumps where waypoints have a corner and a random walk turns; of a recorded track
/// it is RecordedTrack::Heading.
Eigen::Vector3d DirectionAt(const Motion& motion, EpisodeTime t);

/// The level direction to the left of a direction, as long as its level part.
Eigen::Vector3d LeftOf(const Eigen::Vector3d& direction);

/// The names of all scenarios in a folder, sorted.
std::vector<std::string> ScenarioNames(const std::string& directory);

/// What a person sets apart from the file, by name: one of the file's choices to choose from, or a
/// value to put in the place of a key, by its path (core/yaml_tree.h).
using Settings = std::map<std::string, std::string>;

/// Reads a scenario file, with the chosen parts and the settings in place. Options that are not
/// chosen are checked too, each as if it alone were chosen.
/// @throws InputError FILE:LINE: KEY: WHY, or `--set KEY: WHY` for what is wrong with a setting.
Scenario LoadScenario(const std::string& path, const Settings& settings = {});
/// The same from text; `name` stands for the file in messages.
Scenario ParseScenario(const std::string& text, const std::string& name,
                       const Settings& settings = {});

/// What a scenario file lets one choose: the options of each choice, in the file's order.
/// @throws InputError.
std::map<std::string, std::vector<std::string>> ScenarioChoices(const std::string& path);

/// The scenario as YAML that ParseScenario reads back to an equal value.
std::string ToYaml(const Scenario& scenario);

/// The same with a choice whose options, "1", "2", ..., have each the task and the moving obstacles
/// of one of `options`; "1" is the default.
/// @param options one or more, that differ from the scenario in nothing else.
std::string ToYaml(const Scenario& scenario, const std::string& choice,
                   const std::vector<Scenario>& options);

}  // namespace sidestep::scenarios
