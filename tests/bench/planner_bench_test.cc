#include "sidestep/bench/planner_bench/planner_bench.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/bench/planner_bench/planner_problems.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/registry.h"

namespace sidestep::bench {
namespace {

PlannerProblem Problem(const std::string& name, int num_tasks, std::uint64_t seed = 1) {
  return MakePlannerProblem(name, SIDESTEP_SOURCE_DIR "/models", SIDESTEP_SOURCE_DIR "/scenarios",
                            seed, num_tasks);
}

double DirectClearance(const PlannerProblem& problem, const PlannerTask& task) {
  const Trajectory direct = planner::MakeDirectMotion(task.request, planner::Timing::kWholeTime);
  return planner::MeasureClearance(*problem.robot, *task.truth, direct, EpisodeTime(0),
                                   EpisodeTime(0), EpisodeTime(3))
      .least_m;
}

class PairsOf : public ::testing::TestWithParam<std::string> {};

TEST_P(PairsOf, AreTasksWhoseDirectMotionIsHit) {
  const PlannerProblem problem = Problem(GetParam(), 8);
  ASSERT_EQ(problem.tasks.size(), 8u);
  for (const PlannerTask& task : problem.tasks) {
    EXPECT_LE(DirectClearance(problem, task), 0);
    const auto free_at = [&](const Eigen::VectorXd& q, double t_s) {
      const Trajectory rest{Eigen::VectorXd::Zero(1), q, 0 * q};
      return planner::MeasureClearance(*problem.robot, *task.truth, rest, EpisodeTime(0),
                                       EpisodeTime(t_s), EpisodeTime(t_s))
                 .least_m > 0.02;
    };
    EXPECT_TRUE(free_at(task.request.q_start, 0));
    EXPECT_TRUE(free_at(task.request.q_goal, 3));
  }
}

TEST_P(PairsOf, AreDecidedBySeedAndNumber) {
  const PlannerProblem few = Problem(GetParam(), 2), more = Problem(GetParam(), 3),
                       other = Problem(GetParam(), 2, /*seed=*/2);
  for (std::size_t t = 0; t < 2; ++t) {
    EXPECT_EQ(few.tasks[t].request.q_start, more.tasks[t].request.q_start);
    EXPECT_EQ(few.tasks[t].request.q_goal, more.tasks[t].request.q_goal);
    EXPECT_EQ(DirectClearance(few, few.tasks[t]), DirectClearance(more, more.tasks[t]));
    EXPECT_NE(few.tasks[t].request.q_start, other.tasks[t].request.q_start);
  }
}

TEST_P(PairsOf, AreWrittenAsAScenarioWithAChoice) {
  const PlannerProblem problem = Problem(GetParam(), 3);
  const HitPairs pairs = MakeHitPairs(GetParam(), SIDESTEP_SOURCE_DIR "/models",
                                      SIDESTEP_SOURCE_DIR "/scenarios", 1, 3);
  const std::string yaml = ToYaml(pairs.scene, "pair", pairs.tasks);
  for (std::size_t i = 0; i < 3; ++i) {
    const scenarios::Scenario read =
        scenarios::ParseScenario(yaml, "pairs.yaml", {{"pair", std::to_string(i + 1)}});
    EXPECT_EQ(read.q_start, problem.tasks[i].request.q_start);
    EXPECT_EQ(read.q_goal, problem.tasks[i].request.q_goal);
    const double t_s = 1.3;
    EXPECT_EQ(PoseAt(read.moving_obstacles.front(), EpisodeTime(t_s)).translation(),
              PoseAt(pairs.tasks[i].moving_obstacles.front(), EpisodeTime(t_s)).translation());
    EXPECT_EQ(read.moving_obstacles.front().shape.index(),
              pairs.scene.moving_obstacles.front().shape.index());
    EXPECT_EQ(read.planner, pairs.scene.planner);
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, PairsOf, ::testing::Values("hsr", "person_high", "wam"),
                         [](const auto& test) { return test.param; });

TEST(PlannerProblem, HasNoOtherNames) { EXPECT_THROW(Problem("tsr", 1), std::invalid_argument); }

TEST(PlannerBench, HasARowForEachPlannerAndStart) {
  const auto named = [](const std::string& name) {
    return NamedPlanner{name,
                        [name](const auto& robot, const auto& settings, const auto& parameters) {
                          return planner::MakePlannerLeavingOut(name, robot, settings, parameters);
                        }};
  };
  const std::vector<PlannerBenchRow> rows =
      RunPlannerBench(Problem("hsr", 3), {named("straight_line"), named("gpmp_fast")}, 2);
  // Nothing warm is left of a planner that has found nothing free.
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].planner, "straight_line");
  EXPECT_EQ(rows[0].start, PlanStart::kCold);
  EXPECT_EQ(rows[0].num_tasks, 3);
  EXPECT_EQ(rows[0].num_free, 0);
  EXPECT_LT(rows[0].clearance_median_m, 0);
  EXPECT_EQ(rows[1].planner, "gpmp_fast");
  EXPECT_EQ(rows[1].num_free, 3);
  EXPECT_EQ(rows[1].num_within_limits, 3);
  EXPECT_GT(rows[1].iterations_median, 0);
  EXPECT_GT(rows[1].cost_median, 0);
  EXPECT_GT(rows[1].cpu_p95_ms, 0);
  EXPECT_EQ(rows[2].start, PlanStart::kWarm2Cm);
  EXPECT_EQ(rows[3].start, PlanStart::kWarmSame);
  EXPECT_LE(rows[3].iterations_median, rows[2].iterations_median);
}

}  // namespace
}  // namespace sidestep::bench
