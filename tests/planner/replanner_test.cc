#include "sidestep/planner/replanner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/goal.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/registry.h"
#include "tests/support/moving_ball_world.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::replanner_test {
namespace {

const Eigen::Vector2d kStart(-1.1, 0.3), kGoal(1.2, -0.2);

CycleResult RunAndAccept(Replanner& replanner, MovingBallWorld& world, const JointState& state,
                         double latency_s, const GoalWatch& goal = GoalWatch(kGoal, 0)) {
  CycleResult cycle = replanner.Work(
      replanner.Prepare(state.t, state, HorizonOffset(latency_s), goal, world.MakeField()));
  replanner.Accept(cycle);
  return cycle;
}

// A robot that does exactly what it was told, and the loop around a replanner.
class Loop {
 public:
  explicit Loop(MovingBallWorld& world, const std::string& planner = "gpmp", double dwell_s = 0)
      : Loop(world, MakePlanner(planner, MakePlanarArm(), Settings()), dwell_s) {}
  Loop(MovingBallWorld& world, std::unique_ptr<Planner> planner, double dwell_s = 0)
      : world_(world),
        planner_(std::move(planner)),
        replanner_(*planner_, {.horizon_s = 3, .step_s = 0.1, .q_goal = kGoal}),
        goal_(kGoal, dwell_s) {}

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
  CycleResult Cycle(double now_s, double latency_s) {
    const EpisodeTime now(now_s);
    for (; ticks_ < std::lround(1000 * now_s); ++ticks_) {
      const JointState state = StateAt(EpisodeTime(0.001 * static_cast<double>(ticks_)));
      goal_.Observe(state.t, state.q, state.v);
    }
    CycleResult cycle = RunAndAccept(replanner_, world_, StateAt(now), latency_s, goal_);
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
  const GoalWatch& goal() const { return goal_; }
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
  GoalWatch goal_;
  long ticks_ = 0;  // shown to it
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
  const CycleResult cycle = loop.Cycle(0, 0.1);
  EXPECT_EQ(cycle.record.status, "in_collision");
}

// Plans as gpmp does, until it is spoilt.
class PlannerThatMayFail final : public Planner {
 public:
  PlannerThatMayFail() : Planner(MakePlanarArm(), Loop::Settings()) {}
  bool fails = false;

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge&) const override {
    if (fails) return {.why_none = "has no idea"};
    return {.trajectory = MakePlanner("gpmp", robot(), settings())->Plan(request).trajectory,
            .converged = true};
  }
};

TEST(Replanner, GoesOnWithThePlanThatRunsIfThePlannerFindsNone) {
  MovingBallWorld world = NothingThere();
  auto mine = std::make_unique<PlannerThatMayFail>();
  PlannerThatMayFail& planner = *mine;
  Loop loop(world, std::move(mine));
  ASSERT_TRUE(loop.Cycle(0, 0.1).plan);
  planner.fails = true;
  for (int i = 1; i < 10; ++i) {
    const CycleResult cycle = loop.Cycle(0.1 * i, 0.1);
    EXPECT_FALSE(cycle.plan);
    EXPECT_EQ(cycle.record.status, "failed");
    EXPECT_EQ(cycle.record.reason, "has no idea");
    EXPECT_EQ(cycle.record.plan.q, loop.plan()->trajectory.q);
  }
  planner.fails = false;
  EXPECT_EQ(loop.Cycle(1, 0.1).record.status, "solved");
  EXPECT_EQ(loop.Cycle(1.1, 0.1).record.reason, "");
}

// Says how many iterations it may do, and does them.
class SpendingPlanner final : public Planner {
 public:
  SpendingPlanner() : Planner(MakePlanarArm(), Loop::Settings()) {}
  mutable std::vector<PlanBudget> budgets;

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge&) const override {
    budgets.push_back(request.budget);
    return {.trajectory = MakeDirectMotion(request, sidestep::planner::Timing::kWholeTime),
            .iterations = std::min(30, request.budget.iterations)};
  }
};

TEST(Replanner, SharesItsBudgetAmongThePlansOfACycle) {
  MovingBallWorld world = CrossingBall();
  const SpendingPlanner planner;
  Replanner replanner(planner, {.horizon_s = 3, .step_s = 0.1, .q_goal = kGoal});
  const auto cycle = [&](double now_s) {
    CycleTask task =
        replanner.Prepare(EpisodeTime(now_s), {EpisodeTime(now_s), kStart, Eigen::Vector2d::Zero()},
                          HorizonOffset(0.1), GoalWatch(kGoal, 0), world.MakeField());
    task.budget.iterations = 40;
    task.budget.deadline = std::chrono::steady_clock::now() + std::chrono::hours(1);
    return std::pair(replanner.Work(task), task);
  };
  CycleResult first = cycle(0).first;
  ASSERT_EQ(planner.budgets.size(), 1u);
  first.plan = TimedPlan{first.record.plan, first.record.plan_start};
  replanner.Accept(first);
  // It runs into the ball, and so does what is tried first: another horizon is tried as well.
  const auto [second, task] = cycle(0.1);
  ASSERT_EQ(planner.budgets.size(), 3u);
  EXPECT_EQ(planner.budgets[1].iterations, 40);
  EXPECT_EQ(planner.budgets[2].iterations, 10);
  EXPECT_EQ(planner.budgets[2].deadline, task.budget.deadline);
  EXPECT_EQ(second.record.iterations, 40);
}

// Spends all it may and says that it had more to try.
class InsatiablePlanner final : public Planner {
 public:
  InsatiablePlanner() : Planner(MakePlanarArm(), Loop::Settings()) {}
  struct Asked {
    int iterations;
    bool is_warm;
    int next_seed;
  };
  mutable std::vector<Asked> asked;

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge&) const override {
    asked.push_back(
        {request.budget.iterations, request.initial.has_value(), request.progress.next_seed});
    PlanAnswer answer;
    answer.trajectory = MakeDirectMotion(request, sidestep::planner::Timing::kWholeTime);
    answer.iterations = request.budget.iterations;
    answer.progress = {request.initial.has_value(), static_cast<int>(asked.size()), std::nullopt};
    return answer;
  }
};

TEST(Replanner, KeepsHalfOfTheNextBudgetForANewHorizonThatItCameTooLateFor) {
  MovingBallWorld world = NothingThere();
  const InsatiablePlanner planner;
  Replanner replanner(planner, {.horizon_s = 3, .step_s = 0.1, .q_goal = kGoal});
  const auto cycle = [&](double now_s) {
    CycleTask task =
        replanner.Prepare(EpisodeTime(now_s), {EpisodeTime(now_s), kStart, Eigen::Vector2d::Zero()},
                          HorizonOffset(0.1), GoalWatch(kGoal, 0), world.MakeField());
    task.budget.iterations = 41;
    CycleResult result = replanner.Work(task);
    if (now_s > 0) result.plan.reset();  // so that the next cycle is like this one
    replanner.Accept(result);
    return result.record;
  };
  cycle(0);
  world.Replace({0.95, 0, 0}, {0, 0, 0}, 0.1);  // in the middle of its way
  ASSERT_EQ(planner.asked.size(), 1u);
  EXPECT_TRUE(cycle(0.1).cut_short);
  ASSERT_EQ(planner.asked.size(), 2u);  // all was spent on going on
  EXPECT_EQ(planner.asked[1].iterations, 41);
  EXPECT_TRUE(planner.asked[1].is_warm);
  EXPECT_TRUE(cycle(0.1).cut_short);
  ASSERT_EQ(planner.asked.size(), 4u);
  EXPECT_EQ(planner.asked[2].iterations, 21);
  EXPECT_EQ(planner.asked[2].next_seed, 2);  // goes on where it stopped
  EXPECT_FALSE(planner.asked[3].is_warm);
  EXPECT_EQ(planner.asked[3].iterations, 20);
  EXPECT_EQ(planner.asked[3].next_seed, 0);  // nothing had been tried
}

// In a hurry from the plan that runs, at leisure with a new horizon.
class HastyPlanner final : public Planner {
 public:
  explicit HastyPlanner(bool always = false) : Planner(MakePlanarArm(), Slow()), always_(always) {}
  static PlannerSettings Slow() {
    PlannerSettings settings = Loop::Settings();
    settings.velocity_scale = 0.65;  // the arm can do 2 rad/s, and has 2.3 rad to go in 3 s
    return settings;
  }

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge&) const override {
    const bool is_hasty = request.initial || (always_ && request.start.seconds() > 0);
    return {
        .trajectory = MakeDirectMotion(request, is_hasty ? sidestep::planner::Timing::kArriveEarly
                                                         : sidestep::planner::Timing::kWholeTime),
        .converged = true};
  }
  bool always_;
};

TEST(Replanner, TakesANewHorizonWhereThePlanExceedsALimitAndThatOneDoesNot) {
  for (const bool always : {false, true}) {
    MovingBallWorld world = NothingThere();
    Loop loop(world, std::make_unique<HastyPlanner>(always));
    EXPECT_EQ(loop.Cycle(0, 0.1).record.status, "solved");
    const CycleResult next = loop.Cycle(0.3, 0.1);
    EXPECT_EQ(next.record.status, always ? "over_limits" : "solved");
    EXPECT_EQ(next.record.plan_start, EpisodeTime(always ? 0 : 0.4));
    EXPECT_TRUE(next.record.accepted);
  }
}

TEST(Replanner, SlowsDownByAboutAsMuchAsALimitAsksFor) {
  for (const double late_s : {2.0, 2.2, 2.4}) {
    MovingBallWorld world = NothingThere();
    Loop loop(world, std::make_unique<HastyPlanner>());
    const Trajectory first = loop.Cycle(0, 0.1).record.plan;
    const CycleResult next = loop.Cycle(late_s, 0.1);
    EXPECT_EQ(next.record.status, "solved");
    ASSERT_EQ(next.record.plan_start, EpisodeTime(late_s + 0.1));

    const TrajectoryPoint from = Sample(first, HorizonOffset(late_s + 0.1));
    const auto field = world.MakeField();
    const auto keeps_limits = [&](int num_states) {
      PlanRequest request;
      request.field = field.get();
      request.start = next.record.plan_start;
      request.step_s = 0.1;
      request.num_states = num_states;
      request.q_start = from.q;
      request.v_start = from.v;
      request.q_goal = kGoal;
      return HastyPlanner().Plan(request).status == PlanStatus::kSolved;
    };
    int least = 4;
    while (!keeps_limits(least)) ++least;
    EXPECT_GE(next.record.plan.num_states(), least);
    EXPECT_LE(next.record.plan.num_states(), 2 * least);

    // It ends there.
    const double end_s = late_s + 0.1 + 0.1 * (next.record.plan.num_states() - 1);
    EXPECT_EQ(loop.Cycle(end_s, 0.1).record.status, "kept");
    EXPECT_TRUE(Sample(loop.plan()->trajectory, HorizonOffset(3)).q.isApprox(kGoal));
  }
}

// The second cycle of a robot that rests at `q` when the first one begins.
CycleResult SecondCycle(Replanner& replanner, MovingBallWorld& world, const Eigen::Vector2d& q) {
  const CycleResult first =
      RunAndAccept(replanner, world, {EpisodeTime(0), q, Eigen::Vector2d::Zero()}, 0.1);
  EXPECT_EQ(first.record.plan.num_states(), 31);
  if (!first.plan) {
    ADD_FAILURE() << first.record.status;
    return first;
  }
  const TrajectoryPoint there = Sample(first.plan->trajectory, HorizonOffset(0.1));
  return RunAndAccept(replanner, world, {EpisodeTime(0.1), there.q, there.v}, 0.1);
}

TEST(Replanner, CatchesUpAsFarAsWhatIsLeftOfTheWayAsksForLessTime) {
  const auto planner = MakePlanner("gpmp", MakePlanarArm(), Loop::Settings());
  const Eigen::Vector2d q = kGoal - 0.2 * (kGoal - kStart);
  const double left_s = 3 * planner->DirectTime_s(q, kGoal) / planner->DirectTime_s(kStart, kGoal);
  ASSERT_LT(left_s, 2);
  for (const bool knows_way : {false, true}) {
    MovingBallWorld world = NothingThere();
    ReplannerOptions options = {.horizon_s = 3, .step_s = 0.1, .q_goal = kGoal};
    if (knows_way) options.direct_s = planner->DirectTime_s(kStart, kGoal);
    Replanner replanner(*planner, options);
    const CycleRecord record = SecondCycle(replanner, world, q).record;
    EXPECT_EQ(record.status, "solved");
    EXPECT_EQ(record.plan_start, EpisodeTime(knows_way ? 0.2 : 0));
    const double took_s = record.plan.t_s(record.plan.num_states() - 1);
    EXPECT_NEAR(took_s, knows_way ? left_s : 3, 0.2);
    EXPECT_TRUE(record.plan.q.rightCols(1).isApprox(kGoal, 1e-3));
  }
}

// Goes on as it does, and straight to the goal in the whole time of a new horizon.
class UnhurriedPlanner final : public Planner {
 public:
  UnhurriedPlanner() : Planner(MakePlanarArm(), Loop::Settings()) {}

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge&) const override {
    return {.trajectory = request.initial
                              ? *request.initial
                              : MakeDirectMotion(request, sidestep::planner::Timing::kWholeTime),
            .converged = true};
  }
};

TEST(Replanner, IsNotInAHurryWhereSomethingPasses) {
  const UnhurriedPlanner planner;
  Trajectory sooner;
  for (const bool passes : {false, true}) {
    // From above through the arm's plane, where the arm would be in a hurry.
    MovingBallWorld world = {{0.9, 0, passes ? 4.0 : 40.0}, {0, 0, -4}, 0.1};
    ReplannerOptions options = {.horizon_s = 3, .step_s = 0.1, .q_goal = kGoal};
    options.direct_s = 1.7 * planner.DirectTime_s(kStart, kGoal);  // so there is much time
    Replanner replanner(planner, options);
    const CycleRecord record = SecondCycle(replanner, world, kStart).record;
    EXPECT_EQ(record.status, "solved");
    EXPECT_EQ(record.plan_start, EpisodeTime(passes ? 0 : 0.2));
    if (!passes) sooner = record.plan;
    const auto field = world.MakeField();
    const auto would_touch = MeasureClearance(planner.robot(), *field, sooner, EpisodeTime(0.2),
                                              EpisodeTime(0.2), EpisodeTime(3))
                                 .first_contact;
    EXPECT_EQ(would_touch.has_value(), passes);
  }
}

TEST(Replanner, BrakesBeforeWhatComesIfThePlannerFindsNone) {
  MovingBallWorld world = NothingThere();
  auto mine = std::make_unique<PlannerThatMayFail>();
  PlannerThatMayFail& planner = *mine;
  Loop loop(world, std::move(mine));
  loop.Cycle(0, 0.1);
  planner.fails = true;
  world.Replace({0.95, 0, 0}, {0, 0, 0}, 0.1);  // in the middle of its way
  EXPECT_EQ(loop.Cycle(0.3, 0.1).record.status, "braked");
  for (int i = 4; i < 30; ++i) loop.Cycle(0.1 * i, 0.1);
  EXPECT_GT(loop.min_clearance_m(), 0);
}

// Where somebody else stops the robot in time, a contact that is far ahead is none yet.
TEST(Replanner, GoesOnTowardsWhatIsFarAheadIfItNeedNotFlee) {
  for (const double flees_within_s : {0.4, 3.0}) {
    MovingBallWorld world = NothingThere();
    PlannerThatMayFail planner;
    Replanner replanner(planner, {3, 0.1, kGoal, flees_within_s});
    const JointState start{EpisodeTime(0), kStart, Eigen::Vector2d::Zero()};
    RunAndAccept(replanner, world, start, 0.1);
    planner.fails = true;
    world.Replace({0.95, 0, 0}, {0, 0, 0}, 0.1);  // it comes there after more than 0.5 s
    const JointState later{EpisodeTime(0.1), kStart, Eigen::Vector2d::Zero()};
    const CycleResult cycle = RunAndAccept(replanner, world, later, 0.1);
    EXPECT_EQ(cycle.record.accepted, flees_within_s > 1);
    EXPECT_EQ(cycle.record.status == "braked", flees_within_s > 1);
  }
}

TEST(Replanner, RestsUntilTheFirstPlanTakesEffect) {
  MovingBallWorld world = NothingThere();
  Loop loop(world);
  const CycleResult cycle = loop.Cycle(0, 0.25);
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
    const CycleResult cycle = loop.Cycle(now_s, 0.1);
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

TEST(Replanner, GoesNearAGoalThatIsTakenAndThereWhenItIsFree) {
  const Eigen::Vector3d p_WTip = MakePlanarArm().ComputeSphereCenters(kGoal, false).p_WS.col(5);
  MovingBallWorld world(p_WTip, {0, 0, 0}, 0.1);
  Loop loop(world);
  for (const double now_s : {0.0, 0.1, 0.2}) {
    const CycleResult cycle = loop.Cycle(now_s, 0.1);
    EXPECT_EQ(cycle.record.status, "short_of_goal");
    EXPECT_GT(cycle.record.predicted_clearance_m, 0);
    EXPECT_EQ(cycle.record.reason, "the goal is blocked when the horizon ends");
  }
  world.Replace({100, 0, 0}, {0, 0, 0}, 0.1);
  ASSERT_TRUE(loop.Cycle(0.3, 0.1).plan);
  EXPECT_LT((loop.StateAt(EpisodeTime(3.3)).q - kGoal).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Replanner, WaitsNearbyWhenTheGoalIsTakenOnItsWay) {
  MovingBallWorld world = NothingThere();
  Loop loop(world);
  loop.RunUntil(1.5, 0.1, 0.1);
  const Eigen::Vector3d p_WTip = MakePlanarArm().ComputeSphereCenters(kGoal, false).p_WS.col(5);
  world.Replace(p_WTip, {0, 0, 0}, 0.1);
  for (int i = 15; i < 40; ++i) {
    const CycleRecord record = loop.Cycle(0.1 * i, 0.1).record;
    EXPECT_EQ(record.status, i < 27 ? "short_of_goal" : "kept") << i;
    EXPECT_GT(record.predicted_clearance_m, 0) << i;
  }
  EXPECT_GT((loop.StateAt(EpisodeTime(4)).q - kGoal).cwiseAbs().maxCoeff(), kGoalTolerance_rad);
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
  const CycleResult cycle = loop.Cycle(2.75, 0.1);
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
  const CycleResult cycle = loop.Cycle(1.0, 0.1);
  ASSERT_TRUE(cycle.plan);
  EXPECT_EQ(cycle.plan->start, EpisodeTime(1.0) + HorizonOffset(0.1));
  EXPECT_EQ(cycle.plan->trajectory.q.col(0), elsewhere);
}

// What a robot is found doing, and how it will be 0.1 s later. The arm: 2.5 rad, 2 rad/s,
// 10 rad/s^2.
struct Found {
  const char* name;
  Eigen::Vector2d q, v, q_later, v_later;
};
std::ostream& operator<<(std::ostream& stream, const Found& found) { return stream << found.name; }
std::string NameOf(const ::testing::TestParamInfo<Found>& test) { return test.param.name; }

class ReplannerOffPlan : public ::testing::TestWithParam<Found> {};

TEST_P(ReplannerOffPlan, BeginsWhereTheRobotWillBeWhenTheNewPlanTakesEffect) {
  const Found& found = GetParam();
  MovingBallWorld world = NothingThere();
  const auto planner = MakePlanner("straight_line", MakePlanarArm(), {});
  Replanner replanner(*planner, {.horizon_s = 3, .step_s = 0.1, .q_goal = kGoal});
  RunAndAccept(replanner, world, {EpisodeTime(0), kStart, Eigen::Vector2d::Zero()}, 0.1);
  const EpisodeTime now(1), effect = now + HorizonOffset(0.1);
  const CycleResult cycle = RunAndAccept(replanner, world, {now, found.q, found.v}, 0.1);
  ASSERT_TRUE(cycle.plan);
  EXPECT_EQ(cycle.plan->start, effect);
  EXPECT_LT((cycle.plan->trajectory.q.col(0) - found.q_later).norm(), 1e-12);
  EXPECT_LT((cycle.plan->trajectory.v.col(0) - found.v_later).norm(), 1e-12);
  // A robot that did just that follows the new plan, and needs no other one.
  const CycleResult next =
      RunAndAccept(replanner, world, {effect, found.q_later, found.v_later}, 0.1);
  EXPECT_EQ(next.record.plan_start, effect);
}

INSTANTIATE_TEST_SUITE_P(
    Found, ReplannerOffPlan,
    ::testing::Values(Found{"AtRest", {0.5, 0.9}, {0, 0}, {0.5, 0.9}, {0, 0}},
                      Found{"Moving", {0.5, 0.9}, {1.5, -1}, {0.65, 0.8}, {1.5, -1}},
                      Found{"UpToALimit", {2.45, 0.9}, {1.5, -1}, {2.5, 0.8}, {0, -1}},
                      Found{"DownToALimit", {0.5, -2.45}, {1.5, -1}, {0.65, -2.5}, {1.5, 0}},
                      Found{"BeyondALimit", {2.6, 0.9}, {1.5, -1}, {2.6, 0.8}, {0, -1}},
                      Found{
                          "BackFromBeyondALimit", {2.6, 0.9}, {-1.5, -1}, {2.45, 0.8}, {-1.5, -1}},
                      Found{"FasterThanItMay", {0.5, 0.9}, {3, -1}, {0.7, 0.8}, {2, -1}}),
    NameOf);

class ReplannerWithoutAPlan : public ::testing::TestWithParam<Found> {};

TEST_P(ReplannerWithoutAPlan, BeginsWhereTheRobotStopsMeanwhile) {
  const Found& found = GetParam();
  MovingBallWorld world = NothingThere();
  const auto planner = MakePlanner("straight_line", MakePlanarArm(), {});
  Replanner replanner(*planner, {.horizon_s = 3, .step_s = 0.1, .q_goal = kGoal});
  const EpisodeTime now(0);
  const CycleResult cycle = RunAndAccept(replanner, world, {now, found.q, found.v}, 0.1);
  ASSERT_TRUE(cycle.plan);
  const TrajectoryPoint there =
      Sample(cycle.plan->trajectory, EpisodeTime(0.1) - cycle.plan->start);
  EXPECT_LT((there.q - found.q_later).norm(), 1e-12);
  EXPECT_LT((there.v - found.v_later).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    Found, ReplannerWithoutAPlan,
    ::testing::Values(Found{"AtRest", {0.5, 0.9}, {0, 0}, {0.5, 0.9}, {0, 0}},
                      Found{"AtRestButForNoise", {0.5, 0.9}, {0.002, -0.001}, {0.5, 0.9}, {0, 0}},
                      // 1.5 rad/s less 10 rad/s^2 leave 0.5; 0.6 rad/s are gone after 0.06 s.
                      Found{"Moving", {0.5, 0.9}, {1.5, -0.6}, {0.6, 0.882}, {0.5, 0}}),
    NameOf);

// The arm arrives and something comes: at the tip at `passes_s`, touching it first 0.14 s earlier.
struct Passing {
  const char* name;
  double dwell_s, passes_s;
  bool stays;  ///< for dwell_s after its arrival
};
std::ostream& operator<<(std::ostream& stream, const Passing& p) { return stream << p.name; }

class ReplannerAtItsGoal : public ::testing::TestWithParam<Passing> {};

TEST_P(ReplannerAtItsGoal, StaysAsLongAsAskedAndSafe) {
  MovingBallWorld world = NothingThere();
  Loop loop(world, "gpmp", GetParam().dwell_s);
  const Eigen::Vector3d p_WTip = MakePlanarArm().ComputeSphereCenters(kGoal, false).p_WS.col(5);
  const auto see = [&] {
    world.Replace(p_WTip + Eigen::Vector3d(0, GetParam().passes_s, 0), {0, -1, 0}, 0.1);
  };
  double left_s = 0;  // when it was first away from where it had arrived
  for (int i = 0; i < 90; ++i) {
    if (i == 31) see();
    loop.Cycle(0.1 * i, 0.1);
    const JointState state = loop.StateAt(EpisodeTime(0.1 * i));
    if (i > 31 && left_s == 0 && !IsAtGoal(state.q, state.v, kGoal)) left_s = 0.1 * i;
  }
  ASSERT_TRUE(loop.goal().dwelt());
  EXPECT_GT(loop.min_clearance_m(), 0.01);
  EXPECT_GT(left_s, 3.1) << "it does step aside";
  EXPECT_EQ(loop.goal().arrived()->seconds() < 3.1, GetParam().stays) << left_s;
}

INSTANTIATE_TEST_SUITE_P(Comes, ReplannerAtItsGoal,
                         ::testing::Values(Passing{"LongAfterTheDwell", 1.0, 5.5, true},
                                           Passing{"AfterTheDwell", 1.0, 5.0, true},
                                           Passing{"WithinTheDwell", 2.0, 4.6, false},
                                           // It would have to be gone 0.1 s after the dwell's end.
                                           Passing{"TooSoonAfterTheDwell", 1.5, 4.7, false}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Replanner, DoesNotStayForADwellThatNobodyAsksFor) {
  MovingBallWorld world = NothingThere();
  Loop loop(world);
  for (int i = 0; i <= 31; ++i) loop.Cycle(0.1 * i, 0.1);
  const Eigen::Vector3d p_WTip = MakePlanarArm().ComputeSphereCenters(kGoal, false).p_WS.col(5);
  world.Replace(p_WTip + Eigen::Vector3d(0, 5.5, 0), {0, -1, 0}, 0.1);
  EXPECT_TRUE(loop.Cycle(3.2, 0.1).plan);
}

TEST(Replanner, RecordsWhatItSawAndFound) {
  MovingBallWorld world = CrossingBall();
  Loop loop(world);
  const CycleResult cycle = loop.Cycle(0, 0.1);
  const CycleRecord& record = cycle.record;
  EXPECT_EQ(record.t, EpisodeTime(0));
  EXPECT_EQ(record.t_effect, EpisodeTime(0.1));
  EXPECT_EQ(record.status, "solved");
  EXPECT_GT(record.iterations, 0);
  EXPECT_GT(record.cost, 0);
  EXPECT_GT(record.predicted_clearance_m, 0);
  EXPECT_EQ(record.plan.q, cycle.plan->trajectory.q);
  const std::vector<EpisodeTime> times = TimesToDescribe(record);
  ASSERT_EQ(times.size(), 31u);
  EXPECT_EQ(times.front(), EpisodeTime(0));
  EXPECT_NEAR(times.back().seconds(), 3, 1e-9);
}

// A plan that came too late is not given to the robot: the replanner goes on from what runs.
TEST(Replanner, GoesOnFromWhatRunsWhenAResultIsNotAccepted) {
  MovingBallWorld world = CrossingBall();
  const auto planner = MakePlanner("gpmp", MakePlanarArm(), Loop::Settings());
  const ReplannerOptions options = {.horizon_s = 3, .step_s = 0.1, .q_goal = kGoal};
  Replanner never_late(*planner, options), late_once(*planner, options);
  const JointState start = {EpisodeTime(0), kStart, Eigen::Vector2d::Zero()};
  const TimedPlan first = *RunAndAccept(never_late, world, start, 0.1).plan;
  RunAndAccept(late_once, world, start, 0.1);
  const auto state_at = [&](double t_s) {
    const TrajectoryPoint point = Sample(first.trajectory, EpisodeTime(t_s) - first.start);
    return JointState{EpisodeTime(t_s), point.q, point.v};
  };
  const GoalWatch goal(kGoal, 0);
  const CycleTask lost = late_once.Prepare(EpisodeTime(0.5), state_at(0.5), HorizonOffset(0.1),
                                           goal, world.MakeField());
  ASSERT_TRUE(late_once.Work(lost).plan);
  const CycleTask a = never_late.Prepare(EpisodeTime(0.8), state_at(0.8), HorizonOffset(0.1), goal,
                                         world.MakeField());
  const CycleTask b = late_once.Prepare(EpisodeTime(0.8), state_at(0.8), HorizonOffset(0.1), goal,
                                        world.MakeField());
  EXPECT_EQ(never_late.Work(a).plan->trajectory.q, late_once.Work(b).plan->trajectory.q);
}

TEST(Replanner, RefusesOptionsOutOfRange) {
  MovingBallWorld world = NothingThere();
  const auto planner = MakePlanner("gpmp", MakePlanarArm(), {});
  const ReplannerOptions kBad[] = {{3, 0, kGoal},
                                   {3, 0.13, kGoal},
                                   {0.2, 0.1, kGoal},
                                   {-3, 0.1, kGoal},
                                   {3, 0.1, Eigen::VectorXd::Zero(3)},
                                   {3e-200, 1e-200, kGoal},
                                   {3, 0.1, kGoal, 0},
                                   {3, 0.1, kGoal, 1, -1},
                                   {3, 0.1, kGoal, 1, std::nan("")}};
  for (const ReplannerOptions& options : kBad) {
    EXPECT_THROW(Replanner(*planner, options), std::invalid_argument);
  }
}

}  // namespace
}  // namespace sidestep::planner::replanner_test
