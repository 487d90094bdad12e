#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/planner_bench/planner_problems.h"
#include "sidestep/planner/planner.h"

namespace sidestep::bench {

/// How a plan begins.
enum class PlanStart {
  kCold,      ///< from nothing
  kWarm2Cm,   ///< from the plan that runs; the obstacle is 2 cm further along than it thought
  kWarmSame,  ///< from the plan that runs; nothing has changed
};
/// "cold", "warm, 2 cm off", "warm, same".
std::string ToString(PlanStart start);

/// What one planner did with one problem. Quantiles are over its tasks; warm plans are those whose
/// cold plan was free.
struct PlannerBenchRow {
  std::string problem, planner;
  PlanStart start = PlanStart::kCold;
  int num_tasks = 0;
  double cpu_median_ms = 0, cpu_p95_ms = 0;  ///< of this thread, of each task the least of its runs
  double iterations_median = 0, cost_median = 0, clearance_median_m = 0;
  int num_free = 0;           ///< plans that touch nothing truly there, each 5 ms
  int num_within_limits = 0;  ///< free ones within the robot's own limits that the problem asks for
};

struct NamedPlanner {
  std::string name;
  std::function<std::unique_ptr<planner::Planner>(
      const robot::RobotModel&, const planner::PlannerSettings&, const planner::Parameters&)>
      make;
};

/// Runs all planners on each task in turn, and the whole of it `num_runs` times over, so that what
/// disturbs the machine meets all of them alike.
std::vector<PlannerBenchRow> RunPlannerBench(const PlannerProblem& problem,
                                             const std::vector<NamedPlanner>& planners,
                                             int num_runs);

}  // namespace sidestep::bench
