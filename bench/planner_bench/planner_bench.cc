#include "sidestep/bench/planner_bench/planner_bench.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "sidestep/bench/statistics.h"
#include "sidestep/core/cpu_time.h"
#include "sidestep/planner/clearance.h"

namespace sidestep::bench {
namespace {

constexpr double kJudgeStep_s = 0.005;
constexpr int kNumFixedWarm = 3;  // states, as after a latency of 0.2 s
constexpr PlanStart kStarts[] = {PlanStart::kCold, PlanStart::kWarm2Cm, PlanStart::kWarmSame};

struct Measured {
  double cpu_s = std::numeric_limits<double>::infinity();
  planner::PlanResult plan;
  bool has_run = false, is_free = false;
};

class TaskBench {
 public:
  TaskBench(const PlannerTask& task, const planner::Planner& planner)
      : task_(task), planner_(planner) {}

  // One run of each start; all but the time is the same each time.
  void Run() {
    planner::PlanRequest request = task_.request;
    Time(request, cold);
    if (!cold.plan.trajectory || cold.plan.clearance.first_contact) return;
    request.num_fixed = kNumFixedWarm;
    request.initial = cold.plan.trajectory;
    Measured settled;
    Time(request, settled);
    if (!settled.plan.trajectory) return;
    request.initial = settled.plan.trajectory;
    Time(request, warm_same);
    if (!task_.moved_field) return;
    request.field = task_.moved_field.get();
    Time(request, warm_2_cm);
  }

  const Measured& Of(PlanStart start) const {
    return start == PlanStart::kCold ? cold : start == PlanStart::kWarm2Cm ? warm_2_cm : warm_same;
  }

 private:
  void Time(const planner::PlanRequest& request, Measured& measured) const {
    const double begin_s = ThreadCpuSeconds();
    planner::PlanResult plan = planner_.Plan(request);
    measured.cpu_s = std::min(measured.cpu_s, ThreadCpuSeconds() - begin_s);
    measured.plan = std::move(plan);
    measured.has_run = true;
    const bool reaches = measured.plan.status != planner::PlanStatus::kShortOfGoal;
    if (!measured.plan.trajectory || !reaches) return;
    const EpisodeTime end =
        request.start + HorizonOffset((request.num_states - 1) * request.step_s);
    const sdf::DistanceField& truth = task_.truth ? *task_.truth : *request.field;
    measured.is_free = planner::MeasureClearance(planner_.robot(), truth, *measured.plan.trajectory,
                                                 request.start, request.start, end, kJudgeStep_s)
                           .least_m > 0;
  }

  const PlannerTask& task_;
  const planner::Planner& planner_;
  Measured cold, warm_2_cm, warm_same;
};

}  // namespace

std::string ToString(PlanStart start) {
  switch (start) {
    case PlanStart::kCold:
      return "cold";
    case PlanStart::kWarm2Cm:
      return "warm, 2 cm off";
    case PlanStart::kWarmSame:
      return "warm, same";
  }
  throw std::invalid_argument("unknown PlanStart");
}

std::vector<PlannerBenchRow> RunPlannerBench(const PlannerProblem& problem,
                                             const std::vector<NamedPlanner>& planners,
                                             int num_runs) {
  std::vector<std::unique_ptr<planner::Planner>> made;
  std::vector<std::vector<TaskBench>> benches;  // of each planner, each task
  for (const NamedPlanner& named : planners) {
    made.push_back(named.make(*problem.robot, problem.settings, problem.parameters));
    std::vector<TaskBench>& of_planner = benches.emplace_back();
    for (const PlannerTask& task : problem.tasks) of_planner.emplace_back(task, *made.back());
  }
  for (int run = 0; run < num_runs; ++run) {
    for (std::size_t t = 0; t < problem.tasks.size(); ++t) {
      for (std::vector<TaskBench>& of_planner : benches) of_planner[t].Run();
    }
  }

  std::vector<PlannerBenchRow> rows;
  for (const PlanStart start : kStarts) {
    for (std::size_t p = 0; p < planners.size(); ++p) {
      PlannerBenchRow row{problem.name, planners[p].name, start};
      std::vector<double> cpu_ms, iterations, cost, clearance_m;
      for (const TaskBench& bench : benches[p]) {
        const Measured& one = bench.Of(start);
        if (!one.has_run) continue;
        ++row.num_tasks;
        cpu_ms.push_back(1e3 * one.cpu_s);
        iterations.push_back(one.plan.iterations);
        cost.push_back(one.plan.cost.total());
        clearance_m.push_back(one.plan.clearance.least_m);
        row.num_free += one.is_free;
        row.num_within_limits +=
            one.is_free && planner::KeepsWholeLimits(one.plan.limit_use, problem.settings);
      }
      if (row.num_tasks == 0) continue;
      row.cpu_median_ms = Quantile(cpu_ms, 0.5);
      row.cpu_p95_ms = Quantile(cpu_ms, 0.95);
      row.iterations_median = Quantile(iterations, 0.5);
      row.cost_median = Quantile(cost, 0.5);
      row.clearance_median_m = Quantile(clearance_m, 0.5);
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace sidestep::bench
