// How long does one plan of each planner take in the walkway scene: from nothing, and from the plan
// that runs?

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>
#include <variant>

#include "sidestep/core/shape.h"
#include "sidestep/planner/registry.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/object_field.h"

namespace sidestep::bench {
namespace {

// The scene with its obstacle at `speed_m_s`, `ahead_m` further along than the scenario says. The
// field knows its motion.
struct Scene {
  explicit Scene(double speed_m_s, double ahead_m = 0)
      : scenario(scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml")),
        robot(
            robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", scenario.robot, scenario.X_WB)) {
    scenarios::MovingObstacle& obstacle = scenario.moving_obstacles.front();
    auto& motion = std::get<scenarios::LinearMotion>(obstacle.motion);
    motion.speed_m_s = speed_m_s;
    motion.start_m += ahead_m * motion.direction;
    OccupancyGrid boxes(scenario.grid);
    for (int k = 0; k < boxes.spec.size[2]; ++k) {
      for (int j = 0; j < boxes.spec.size[1]; ++j) {
        for (int i = 0; i < boxes.spec.size[0]; ++i) {
          for (const scenarios::StaticObstacle& box : scenario.static_obstacles) {
            const Eigen::Vector3d p_OQ = box.X_WO.Inverse() * boxes.spec.Center(i, j, k);
            if (SignedDistance(box.shape, p_OQ) < 0) {
              boxes.cells[boxes.spec.Index(i, j, k)] = 1;
            }
          }
        }
      }
    }
    const double clamp_m = scenario.epsilon_m + robot.largest_sphere_radius_m();
    const auto shape_field = std::make_shared<sdf::SdfGrid>(
        sdf::MakeShapeField(obstacle.shape, scenario.grid.cell_m, clamp_m));
    field = std::make_unique<sdf::CompositeField>(
        std::make_shared<sdf::SdfGrid>(sdf::ComputeSignedDistance(boxes)),
        std::vector<sdf::MovingField>{
            {shape_field, [obstacle](EpisodeTime t) { return PoseAt(obstacle, t); }}},
        clamp_m);
  }

  planner::PlanRequest Request() const {
    planner::PlanRequest request;
    request.field = field.get();
    request.step_s = scenario.step_s;
    request.num_states = static_cast<int>(std::lround(scenario.horizon_s / scenario.step_s)) + 1;
    request.q_start = robot.configurations().at(scenario.start_name);
    request.v_start = Eigen::VectorXd::Zero(robot.num_joints());
    request.q_goal = robot.configurations().at(scenario.goal_name);
    return request;
  }

  scenarios::Scenario scenario;
  robot::RobotModel robot;
  std::unique_ptr<const sdf::CompositeField> field;
};

void PlanAgain(const planner::Planner& planner, const planner::PlanRequest& request,
               benchmark::State& state) {
  int iterations = 0;
  for (auto _ : state) {
    const planner::PlanResult result = planner.Plan(request);
    iterations = result.iterations;
    benchmark::DoNotOptimize(result.clearance.least_m);
  }
  state.counters["iterations"] = iterations;
}

void BM_ColdPlan(benchmark::State& state, const std::string& name) {
  const Scene scene(0.1 * static_cast<double>(state.range(0)));
  const auto planner = planner::MakePlanner(name, scene.robot, {});
  PlanAgain(*planner, scene.Request(), state);
}

// The obstacle turns out to be `error_cm` further along than the running plan thought.
void BM_WarmPlan(benchmark::State& state, const std::string& name) {
  const Scene scene(1.4);
  const auto planner = planner::MakePlanner(name, scene.robot, {});
  planner::PlanRequest request = scene.Request();
  request.initial = planner->Plan(request).trajectory;
  request.num_fixed = 3;
  const Scene moved(1.4, 0.01 * static_cast<double>(state.range(0)));
  request.field = moved.field.get();
  PlanAgain(*planner, request, state);
}

// Of every planner there is; that of straight_line is what checking and judging cost.
const bool kAreRegistered = [] {
  for (const std::string& name : planner::PlannerNames()) {
    benchmark::RegisterBenchmark(("BM_ColdPlan/" + name).c_str(), BM_ColdPlan, name)
        ->ArgName("speed_dm_s")
        ->Arg(10)
        ->Arg(14)
        ->Arg(20)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("BM_WarmPlan/" + name).c_str(), BM_WarmPlan, name)
        ->ArgName("error_cm")
        ->Arg(0)
        ->Arg(2)
        ->Arg(10)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace sidestep::bench
