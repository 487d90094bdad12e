#include "sidestep/planner/replanner.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/planner/clearance.h"
#include "sidestep/planner/registry.h"
#include "tests/support/moving_ball_world.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner {
namespace {

const Eigen::Vector2d kStart(-1.1, 0.3), kGoal(1.2, -0.2);

// A robot that does exactly what it was told, and the loop around a replanner.
class Loop {
 public:
  explicit Loop(MovingBallWorld& world, const std::string& planner = "gpmp")
      : world_(world),
        planner_(MakePlanner(planner, arm_, Settings())),
        replanner_(*planner_, world, {.horizon_s = 3, .step_s = 0.1, .q_goal = kGoal}) {}

  static PlannerSettings Settings() {
    PlannerSettings settings;
    settings.epsilon_m = 0.1;
    return settings;
  }

  JointState StateAt(EpisodeTime t) const {
    if (!plan_) return {t, rest_q_, Eigen::Vector2d::Zero()};
    const TrajectoryPoint point = Sample(plan_->trajectory, t - plan_->start);
    return {t, point.q, point.v};
  }

  // One cycle at `now`; its plan takes effect at once it may. Checks the splice.
  Replanner::Cycle Cycle(double now_s, double latency_s) {
    const EpisodeTime now(now_s);
    Replanner::Cycle cycle = replanner_.Run(now, StateAt(now), HorizonOffset(latency_s));
    EXPECT_EQ(cycle.plan.has_value(), cycle.record.accepted);
    if (cycle.plan) {
      ExpectContinuousSplice(*cycle.plan, cycle.record.t_effect);
      KeepClearance(cycle.record.t_effect);
      plan_ = cycle.plan;
      plan_from_ = cycle.record.t_effect;
    }
    return cycle;
  }

  // Cycles of a period that take their latency, until `end_s`.
  void RunUntil(double end_s, double period_s, double latency_s) {
    for (int i = 0; i * period_s < end_s; ++i) Cycle(i * period_s, latency_s);
    KeepClearance(EpisodeTime(end_s));
  }

  double min_clearance_m() const { return min_clearance_m_; }
  const std::optional<TimedPlan>& plan() const { return plan_; }
  void Push(const Eigen::Vector2d& q) {
    plan_.reset();
    rest_q_ = q;
  }

 private:
  void ExpectContinuousSplice(const TimedPlan& next, EpisodeTime t_effect) const {
    const JointState before = StateAt(t_effect);
    const TrajectoryPoint after = Sample(next.trajectory, t_effect - next.start);
    EXPECT_LT((after.q - before.q).cwiseAbs().maxCoeff(), 1e-9) << t_effect.seconds();
    EXPECT_LT((after.v - before.v).cwiseAbs().maxCoeff(), 1e-9) << t_effect.seconds();
  }

  // Of what has been executed since the last splice.
  void KeepClearance(EpisodeTime to) {
    const TimedPlan executed =
        plan_ ? *plan_
              : TimedPlan{{Eigen::VectorXd::Zero(1), rest_q_, Eigen::VectorXd::Zero(2)},
                          EpisodeTime(0)};
    min_clearance_m_ = std::min(
        min_clearance_m_,
        MeasureClearance(arm_, world_.field(), executed.trajectory, executed.start, plan_from_, to)
            .least_m);
  }

  MovingBallWorld& world_;
  const robot::RobotModel arm_ = MakePlanarArm();
  std::unique_ptr<Planner> planner_;
  Replanner replanner_;
  std::optional<TimedPlan> plan_;
  EpisodeTime plan_from_;
  Eigen::VectorXd rest_q_ = kStart;
  double min_clearance_m_ = 1e9;
};

// Comes along the walkway and crosses the arm's way in the middle of its motion.
MovingBallWorld CrossingBall() { return {{0.95, 1.5, 0}, {0, -1, 0}, 0.1}; }
MovingBallWorld NothingThere() { return {{100, 0, 0}, {0, 0, 0}, 0.1}; }

struct Timing {
  double period_s, latency_s;
};
std::ostream& operator<<(std::ostream& stream, const Timing& timing) {
  return stream << timing.period_s << " s, " << timing.latency_s << " s";
}

class ReplannerAtAnyLatency : public ::testing::TestWithParam<Timing> {};

TEST_P(ReplannerAtAnyLatency, ReachesTheGoalInTimePastTheBallWithoutAJump) {
  MovingBallWorld world = CrossingBall();
  Loop loop(world);
  loop.RunUntil(3.2, GetParam().period_s, GetParam().latency_s);
  const JointState end = loop.StateAt(EpisodeTime(3.0));
  EXPECT_LT((end.q - kGoal).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(end.v.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_GT(loop.min_clearance_m(), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Latencies, ReplannerAtAnyLatency,
                         ::testing::Values(Timing{0.1, 0}, Timing{0.1, 0.1}, Timing{0.1, 0.03},
                                           Timing{0.17, 0.13}, Timing{0.3, 0.25}, Timing{0.1, 0.25},
                                           Timing{0.5, 0.5}));

TEST(Replanner, TheDirectMotionWouldHitTheBall) {  // or the tests above show nothing
  MovingBallWorld world = CrossingBall();
  Loop loop(world, "straight_line");
  const Replanner::Cycle cycle = loop.Cycle(0, 0.1);
  EXPECT_EQ(cycle.record.status, "in_collision");
}

TEST(Replanner, RestsUntilTheFirstPlanTakesEffect) {
  MovingBallWorld world = NothingThere();
  Loop loop(world);
  const Replanner::Cycle cycle = loop.Cycle(0, 0.25);
  ASSERT_TRUE(cycle.plan);
  EXPECT_EQ(cycle.plan->start, EpisodeTime(0));
  for (int k = 0; k <= 3; ++k) EXPECT_EQ(cycle.plan->trajectory.q.col(k), kStart);
  EXPECT_NE(cycle.plan->trajectory.q.col(4), kStart);
}

TEST(Replanner, RepeatsItselfBitForBit) {
  std::vector<Trajectory> plans[2];
  for (auto& run : plans) {
    MovingBallWorld world = CrossingBall();
    Loop loop(world);
    for (int i = 0; i < 12; ++i) run.push_back(loop.Cycle(0.1 * i, 0.1).record.plan);
  }
  for (std::size_t i = 0; i < plans[0].size(); ++i) {
    EXPECT_EQ(plans[0][i].q, plans[1][i].q) << "cycle " << i;
    EXPECT_EQ(plans[0][i].v, plans[1][i].v) << "cycle " << i;
  }
}

TEST(Replanner, DoesNothingMoreAtTheGoal) {
  MovingBallWorld world = NothingThere();
  Loop loop(world);
  loop.RunUntil(3.0, 0.1, 0.1);
  for (const double now_s : {3.0, 3.1, 5.0}) {
    const Replanner::Cycle cycle = loop.Cycle(now_s, 0.1);
    EXPECT_FALSE(cycle.plan);
    EXPECT_EQ(cycle.record.status, "kept");
  }
}

TEST(Replanner, StepsAsideFromTheGoalWhenSomethingComes) {
  MovingBallWorld world = NothingThere();
  Loop loop(world);
  loop.RunUntil(3.5, 0.1, 0.1);
  // Passes through the tip at the goal at t = 5.5.
  const Eigen::Vector3d p_WTip = MakePlanarArm().ComputeSphereCenters(kGoal, false).p_WS.col(5);
  world.Replace(p_WTip + Eigen::Vector3d(0, 5.5, 0), {0, -1, 0}, 0.1);
  double clearance_m = 1e9;
  for (int i = 35; i < 80; ++i) {
    clearance_m = std::min(clearance_m, loop.Cycle(0.1 * i, 0.1).record.predicted_clearance_m);
  }
  EXPECT_GT(loop.min_clearance_m(), 0.01);
  EXPECT_GT(clearance_m, 0.01);
  EXPECT_LT((loop.StateAt(EpisodeTime(9)).q - kGoal).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Replanner, WaitsWhileTheGoalIsTakenAndGoesWhenItIsFree) {
  const Eigen::Vector3d p_WTip = MakePlanarArm().ComputeSphereCenters(kGoal, false).p_WS.col(5);
  MovingBallWorld world(p_WTip, {0, 0, 0}, 0.1);
  Loop loop(world);
  for (const double now_s : {0.0, 0.1, 0.2}) {
    const Replanner::Cycle cycle = loop.Cycle(now_s, 0.1);
    EXPECT_FALSE(cycle.plan);
    EXPECT_EQ(cycle.record.status, "in_collision");
  }
  world.Replace({100, 0, 0}, {0, 0, 0}, 0.1);
  ASSERT_TRUE(loop.Cycle(0.3, 0.1).plan);
  EXPECT_LT((loop.StateAt(EpisodeTime(3.3)).q - kGoal).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Replanner, BrakesAndWaitsWhenTheGoalIsTakenOnItsWay) {
  MovingBallWorld world = NothingThere();
  Loop loop(world);
  loop.RunUntil(1.5, 0.1, 0.1);
  const Eigen::Vector3d p_WTip = MakePlanarArm().ComputeSphereCenters(kGoal, false).p_WS.col(5);
  world.Replace(p_WTip, {0, 0, 0}, 0.1);
  for (int i = 15; i < 40; ++i) {
    EXPECT_EQ(loop.Cycle(0.1 * i, 0.1).record.status, i == 15 ? "braked" : "in_collision") << i;
  }
  EXPECT_EQ(loop.StateAt(EpisodeTime(4)).v, Eigen::Vector2d(0, 0));
  EXPECT_GT(loop.min_clearance_m(), 0.01);
  world.Replace({100, 0, 0}, {0, 0, 0}, 0.1);
  for (int i = 40; i < 80; ++i) loop.Cycle(0.1 * i, 0.1);
  EXPECT_LT((loop.StateAt(EpisodeTime(8)).q - kGoal).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Replanner, BeginsANewHorizonWhenThePlanIsSpoiltTooLate) {
  MovingBallWorld world = NothingThere();
  Loop loop(world);
  loop.RunUntil(2.75, 0.1, 0.1);
  const Eigen::Vector3d p_WTip = MakePlanarArm().ComputeSphereCenters(kGoal, false).p_WS.col(5);
  // Reaches the goal together with the arm, and leaves again.
  world.Replace(p_WTip + Eigen::Vector3d(0, 2.97, 0) * 0.6, {0, -0.6, 0}, 0.05);
  const Replanner::Cycle cycle = loop.Cycle(2.75, 0.1);
  ASSERT_TRUE(cycle.plan);
  EXPECT_EQ(cycle.plan->start, EpisodeTime(2.75) + HorizonOffset(0.1));
  EXPECT_EQ(cycle.plan->trajectory.num_states(), 31);
}

TEST(Replanner, BeginsANewHorizonWhereTheRobotIsWhenItIsFarFromItsPlan) {
  MovingBallWorld world = NothingThere();
  Loop loop(world);
  loop.RunUntil(1.0, 0.1, 0.1);
  const Eigen::Vector2d elsewhere(-0.9, 0.9);
  loop.Push(elsewhere);
  const Replanner::Cycle cycle = loop.Cycle(1.0, 0.1);
  ASSERT_TRUE(cycle.plan);
  EXPECT_EQ(cycle.plan->start, EpisodeTime(1.0) + HorizonOffset(0.1));
  EXPECT_EQ(cycle.plan->trajectory.q.col(0), elsewhere);
}

TEST(Replanner, RecordsWhatItSawAndFound) {
  MovingBallWorld world = CrossingBall();
  Loop loop(world);
  const Replanner::Cycle cycle = loop.Cycle(0, 0.1);
  const CycleRecord& record = cycle.record;
  EXPECT_EQ(record.t, EpisodeTime(0));
  EXPECT_EQ(record.t_effect, EpisodeTime(0.1));
  EXPECT_EQ(record.status, "solved");
  EXPECT_GT(record.iterations, 0);
  EXPECT_GT(record.cost, 0);
  EXPECT_GT(record.predicted_clearance_m, 0);
  EXPECT_EQ(record.plan.q, cycle.plan->trajectory.q);
  ASSERT_EQ(record.objects.size(), 1u);
  ASSERT_EQ(record.objects[0].t.size(), 31u);
  EXPECT_EQ(record.objects[0].t.front(), EpisodeTime(0));
  EXPECT_NEAR(record.objects[0].t.back().seconds(), 3, 1e-9);
}

TEST(Replanner, RefusesOptionsOutOfRange) {
  MovingBallWorld world = NothingThere();
  const auto planner = MakePlanner("gpmp", MakePlanarArm(), {});
  const ReplannerOptions kBad[] = {{3, 0, kGoal},
                                   {3, 0.13, kGoal},
                                   {0.2, 0.1, kGoal},
                                   {-3, 0.1, kGoal},
                                   {3, 0.1, Eigen::VectorXd::Zero(3)}};
  for (const ReplannerOptions& options : kBad) {
    EXPECT_THROW(Replanner(*planner, world, options), std::invalid_argument);
  }
}

}  // namespace
}  // namespace sidestep::planner
