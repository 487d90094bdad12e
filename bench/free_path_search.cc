#include "sidestep/bench/free_path_search.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "sidestep/bench/scenario_planner.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/core/random.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/tool_speed.h"
#include "sidestep/robot/tolerance_scale.h"

namespace sidestep::bench {
namespace {

constexpr double kFreePathStep_s = 0.005, kAfterGoal_s = 0.5;

bool IsToolHeldBack(const scenarios::Scenario& scenario) {
  return std::isfinite(scenario.safety.tool_speed_m_s);
}

// Planners do not know how fast the tool may be: with more time they find slower motions.
std::vector<double> HorizonsToTry(const scenarios::Scenario& scenario,
                                  const robot::RobotModel& robot) {
  constexpr double kMore = 1.5;
  const double horizon_s = HorizonOf(scenario, robot);
  if (!IsToolHeldBack(scenario)) return {horizon_s};
  return {horizon_s, kMore * horizon_s};
}

// @param first_free the first state of the motion that is not given.
FreePath Search(const PathStart& start, int first_free, const sdf::DistanceField& field,
                const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                int max_guesses, std::uint64_t seed) {
  const auto planner = MakePlanner(scenario, robot);
  std::vector<planner::PlanRequest> requests;
  for (const double horizon_s : HorizonsToTry(scenario, robot)) {
    requests.push_back(RequestOf(scenario, horizon_s));
    planner::PlanRequest& request = requests.back();
    request.field = &field;
    request.start = start.t;
    request.q_start = start.q;
    request.v_start = start.v;
    request.num_fixed = first_free;
  }

  const Eigen::VectorXd scale = robot::ToleranceScale(robot);
  RandomStream random(seed, "free path search");
  FreePath best;
  best.clearance_m = -std::numeric_limits<double>::infinity();
  while (best.guesses < max_guesses && !best.found) {
    const auto guess = static_cast<std::size_t>(best.guesses);
    planner::PlanRequest& request = requests[guess % requests.size()];
    if (guess >= requests.size()) {
      request.initial.reset();
      request.initial = planner::MakeDetour(request, scale, random);
    }
    ++best.guesses;
    const planner::PlanResult result = planner->Plan(request);
    const std::optional<Trajectory>& motion = result.trajectory;
    if (!motion || result.status == planner::PlanStatus::kShortOfGoal) continue;
    if (IsToolHeldBack(scenario) &&
        planner::GreatestToolSpeed_m_s(robot, *motion, 0) > scenario.safety.tool_speed_m_s) {
      continue;
    }
    const EpisodeTime end =
        start.t + HorizonOffset(motion->t_s(request.num_states - 1) + kAfterGoal_s);
    const double clearance_m =
        planner::MeasureClearance(robot, field, *motion, start.t, start.t, end, kFreePathStep_s)
            .least_m;
    if (clearance_m <= best.clearance_m) continue;
    best.clearance_m = clearance_m;
    best.trajectory = *motion;
    best.found = clearance_m > 0;
  }
  return best;
}

}  // namespace

FreePath SearchFreePath(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                        int max_guesses, std::uint64_t seed) {
  const sdf::ShapeField field =
      TrueWorld(scenario, scenario.epsilon_m + robot.largest_sphere_radius_m());
  const int resting =
      static_cast<int>(std::ceil(scenario.longest_latency_s() / scenario.step_s - 1e-9));
  const PathStart start = {EpisodeTime(0), scenario.q_start,
                           Eigen::VectorXd::Zero(scenario.q_start.size())};
  return Search(start, 1 + resting, field, scenario, robot, max_guesses, seed);
}

FreePath SearchFreePathFrom(const PathStart& start, const sdf::DistanceField& field,
                            const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                            int max_guesses, std::uint64_t seed) {
  const Eigen::Index n = robot.num_joints();
  if (start.q.size() != n || start.v.size() != n || !start.q.allFinite() || !start.v.allFinite()) {
    throw std::invalid_argument(
        "SearchFreePathFrom: the start must hold finite q and v of shape n");
  }
  return Search(start, 1, field, scenario, robot, max_guesses, seed);
}

}  // namespace sidestep::bench
