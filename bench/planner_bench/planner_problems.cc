#include "sidestep/bench/planner_bench/planner_problems.h"

#include <stdexcept>
#include <variant>

#include "sidestep/bench/planner_bench/gpmp2_reference.h"
#include "sidestep/bench/planner_bench/hit_pairs.h"
#include "sidestep/bench/scenario_planner.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/object_field.h"

namespace sidestep::bench {
namespace {

constexpr double kMoved_m = 0.02;

struct PairProblem {
  const char* name;
  const char* scenario;
  HitPairOptions options;
  Shape obstacle;   ///< in the place of the scenario's
  double height_m;  ///< of its middle
};

std::vector<PairProblem> PairProblems() {
  const std::vector<std::string> starts = {"right_ready", "pickup_right"},
                                 goals = {"table_forward", "table_left"};
  return {
      {"hsr", "hsr_walkway", {starts, goals, 0.2, 1, 2}, Box{{0.48, 0.55, 1.0}}, 0.5},
      {"person_high", "hsr_walkway", {starts, goals, 0.2, 0.5, 2}, Capsule{0.22, 1.26}, 0.85},
      {"wam",
       "wam_single_pillar",
       {{"pose1", "pose2"}, {"pose3", "pose4", "pose5"}, 0.1, 0.3, 0.9},
       Box{{0.15, 0.15, 1.9}},
       -0.05},
  };
}

// The cells whose centres lie in what stands still.
sdf::SdfGrid StaticGrid(const scenarios::Scenario& scenario) {
  OccupancyGrid cells(scenario.grid);
  const std::vector<PlacedShape> shapes = StaticShapes(scenario);
  for (int k = 0; k < cells.spec.size[2]; ++k) {
    for (int j = 0; j < cells.spec.size[1]; ++j) {
      for (int i = 0; i < cells.spec.size[0]; ++i) {
        const Eigen::Vector3d center = cells.spec.Center(i, j, k);
        for (const PlacedShape& placed : shapes) {
          if (SignedDistance(placed.shape, placed.X_WO.Inverse() * center) < 0) {
            cells.cells[cells.spec.Index(i, j, k)] = 1;
          }
        }
      }
    }
  }
  return sdf::ComputeSignedDistance(cells);
}

scenarios::Scenario SceneOf(const PairProblem& pairs, const std::string& scenarios_dir) {
  scenarios::Scenario scenario =
      scenarios::LoadScenario(scenarios_dir + "/" + pairs.scenario + ".yaml");
  scenarios::MovingObstacle& obstacle = scenario.moving_obstacles.front();
  obstacle.shape = pairs.obstacle;
  obstacle.appearance.clear();  // it belongs to another shape
  std::get<scenarios::LinearMotion>(obstacle.motion).start_m.z() = pairs.height_m;
  return scenario;
}

PlannerProblem MakePairs(const PairProblem& pairs, const std::string& models_dir,
                         const std::string& scenarios_dir, std::uint64_t seed, int num_tasks) {
  const scenarios::Scenario scenario = SceneOf(pairs, scenarios_dir);
  PlannerProblem problem;
  problem.name = pairs.name;
  problem.robot = std::make_shared<robot::RobotModel>(
      robot::RobotModel::Load(models_dir, scenario.robot, scenario.X_WB));
  problem.settings = SettingsOf(scenario);
  problem.parameters = ParametersOf(scenario);
  const double clamp_m = scenario.epsilon_m + problem.robot->largest_sphere_radius_m();
  const auto static_W = std::make_shared<const sdf::SdfGrid>(StaticGrid(scenario));
  const auto shape_O = std::make_shared<const sdf::SdfGrid>(
      sdf::MakeShapeField(pairs.obstacle, scenario.grid.cell_m, clamp_m));

  for (int number = 0; number < num_tasks; ++number) {
    const scenarios::Scenario task =
        MakeHitPair(scenario, *problem.robot, pairs.options, seed, number);
    const auto field_of = [&](const scenarios::MovingObstacle& obstacle) {
      return std::make_shared<const sdf::CompositeField>(
          static_W,
          std::vector<sdf::MovingField>{
              {shape_O, [obstacle](EpisodeTime t) { return PoseAt(obstacle, t); }}},
          clamp_m, StaticSolids{{}, {FloorOf(task)}});
    };
    scenarios::MovingObstacle moved = task.moving_obstacles.front();
    auto& motion = std::get<scenarios::LinearMotion>(moved.motion);
    motion.start_m += kMoved_m * motion.direction;
    PlannerTask& one = problem.tasks.emplace_back();
    one.request = RequestOf(task, task.horizon_s);
    one.field = field_of(task.moving_obstacles.front());
    one.moved_field = field_of(moved);
    one.truth = std::make_shared<const sdf::ShapeField>(TrueWorld(task, clamp_m));
    one.request.field = one.field.get();
  }
  return problem;
}

PlannerProblem MakeReference(const std::string& name, const std::string& models_dir,
                             bool is_dense) {
  PlannerProblem problem;
  problem.name = name;
  problem.robot =
      std::make_shared<robot::RobotModel>(robot::RobotModel::Load(models_dir, "wam", Pose()));
  problem.settings.epsilon_m = is_dense ? 0.2 : 0.3;
  problem.parameters["sigma_obs"] = is_dense ? 0.2 : 0.05;
  problem.parameters["n_int"] = is_dense ? 19 : 1;
  problem.settings.position_limits = problem.settings.velocity_limits =
      problem.settings.acceleration_limits = false;
  PlannerTask& task = problem.tasks.emplace_back();
  task.field = std::make_shared<gpmp2_reference::SteppedField>();
  task.request.field = task.field.get();
  task.request.step_s = gpmp2_reference::kStep_s;
  task.request.num_states = gpmp2_reference::kNumStates;
  task.request.q_start = problem.robot->configurations().at("pose1");
  task.request.v_start = Eigen::VectorXd::Zero(7);
  task.request.q_goal = problem.robot->configurations().at("pose3");
  return problem;
}

}  // namespace

std::vector<std::string> PlannerProblemNames() {
  std::vector<std::string> names = HitPairNames();
  names.insert(names.begin(), {"gpmp2_reference_n1", "gpmp2_reference_n19"});
  return names;
}

std::vector<std::string> HitPairNames() {
  std::vector<std::string> names;
  for (const PairProblem& pairs : PairProblems()) names.emplace_back(pairs.name);
  return names;
}

HitPairs MakeHitPairs(const std::string& name, const std::string& models_dir,
                      const std::string& scenarios_dir, std::uint64_t seed, int num_tasks) {
  for (const PairProblem& pairs : PairProblems()) {
    if (name != pairs.name) continue;
    HitPairs made{SceneOf(pairs, scenarios_dir), {}};
    const robot::RobotModel robot =
        robot::RobotModel::Load(models_dir, made.scene.robot, made.scene.X_WB);
    for (int number = 0; number < num_tasks; ++number) {
      made.tasks.push_back(MakeHitPair(made.scene, robot, pairs.options, seed, number));
    }
    return made;
  }
  throw std::invalid_argument("no pairs are called '" + name + "'");
}

PlannerProblem MakePlannerProblem(const std::string& name, const std::string& models_dir,
                                  const std::string& scenarios_dir, std::uint64_t seed,
                                  int num_tasks) {
  if (name == "gpmp2_reference_n1") return MakeReference(name, models_dir, false);
  if (name == "gpmp2_reference_n19") return MakeReference(name, models_dir, true);
  for (const PairProblem& pairs : PairProblems()) {
    if (name == pairs.name) return MakePairs(pairs, models_dir, scenarios_dir, seed, num_tasks);
  }
  throw std::invalid_argument("unknown planner problem '" + name + "'");
}

}  // namespace sidestep::bench
