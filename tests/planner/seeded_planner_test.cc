// The policy that all optimising planners share, with an optimiser that does nothing but tell what
// it was asked.

#include "sidestep/planner/seeded_planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <vector>

#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/registry.h"
#include "sidestep/planner/seeds.h"
#include "tests/support/ball_field.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::seeded_planner_test {
namespace {

constexpr int kIterations = 3;  // of each solve

struct Log {
  std::vector<Trajectory> guesses;
  int num_solves = 0;
};

// Leaves every guess as it is.
class IdleOptimizer final : public TrajectoryOptimizer {
 public:
  explicit IdleOptimizer(Log& log) : log_(log) {}
  void Restart(const Trajectory& guess) override {
    log_.guesses.push_back(guess);
    guess_ = guess;
  }
  void AddLimits(double) override {}
  SolveOutcome Solve(int max_iterations, double) override {
    ++log_.num_solves;
    return {std::min(max_iterations, kIterations), max_iterations >= kIterations};
  }
  Trajectory GetTrajectory() const override { return guess_; }
  PlanCost ComputeCost() override { return {}; }

 private:
  Log& log_;
  Trajectory guess_;
};

class IdlePlanner final : public SeededPlanner {
 public:
  IdlePlanner() : SeededPlanner(MakePlanarArm(), {}, {.num_detours = 3}) {}
  mutable Log log;

 private:
  std::unique_ptr<TrajectoryOptimizer> MakeOptimizer(const PlanRequest&) const override {
    return std::make_unique<IdleOptimizer>(log);
  }
};

// Too fast for the robot at the first guess; elsewhere too fast for what is asked for, until it has
// had more iterations than a trial gets. The motion is the guess but for one velocity.
class PatientOptimizer final : public TrajectoryOptimizer {
 public:
  void Restart(const Trajectory& guess) override {
    guess_ = guess;
    is_first_ = num_guesses_++ == 0;
  }
  void AddLimits(double) override {}
  SolveOutcome Solve(int max_iterations, double) override {
    is_finished_ = max_iterations >= kPatience;
    return {std::min(max_iterations, kPatience), is_finished_};
  }
  Trajectory GetTrajectory() const override {
    Trajectory motion = guess_;
    motion.v(0, 10) = is_first_ ? kTooFast_rad_s : is_finished_ ? kSlow_rad_s : kFast_rad_s;
    return motion;
  }
  PlanCost ComputeCost() override { return {}; }

 private:
  static constexpr int kPatience = 20;
  static constexpr double kSlow_rad_s = 1, kFast_rad_s = 1.8, kTooFast_rad_s = 9;  // of 2, or 1.6

  Trajectory guess_;
  int num_guesses_ = 0;
  bool is_first_ = true, is_finished_ = false;
};

class PatientPlanner final : public SeededPlanner {
 public:
  PatientPlanner()
      : SeededPlanner(MakePlanarArm(), {.acceleration_limits = false, .velocity_scale = 0.8},
                      {.num_detours = 0}) {}

 private:
  std::unique_ptr<TrajectoryOptimizer> MakeOptimizer(const PlanRequest&) const override {
    return std::make_unique<PatientOptimizer>();
  }
};

PlanRequest Request(const sdf::DistanceField& field) {
  PlanRequest request;
  request.field = &field;
  request.step_s = 0.1;
  request.num_states = 21;
  request.q_start = Eigen::Vector2d(-1.1, 0.3);
  request.v_start = Eigen::Vector2d::Zero();
  request.q_goal = Eigen::Vector2d(1.2, -0.2);
  return request;
}

// The arm lies in it from beginning to end.
const BallField& Everywhere() {
  static const BallField field({0, 0, 0}, {0, 0, 0}, 3);
  return field;
}

bool AreAlike(const Trajectory& a, const Trajectory& b) {
  return (a.q - b.q).cwiseAbs().maxCoeff() < 1e-9 && (a.v - b.v).cwiseAbs().maxCoeff() < 1e-9;
}

// Of the request's seeds the one that `guess` is.
int WhichSeed(const PlanRequest& request, const Trajectory& guess) {
  Seeds seeds(request, 3, Eigen::Vector2d::Ones());
  for (int seed = 0; seed < seeds.count(); ++seed) {
    if (!seeds.IsDetour(seed) && AreAlike(seeds.Make(seed), guess)) return seed;
  }
  return seeds.count();  // a detour
}

TEST(SeededPlanner, TriesEachGuessOnceInOrderWhereNothingIsFree) {
  const IdlePlanner planner;
  const PlanRequest request = Request(Everywhere());
  const PlanResult result = planner.Plan(request);
  ASSERT_EQ(planner.log.guesses.size(), 6u);
  Seeds seeds(request, 3, Eigen::Vector2d::Ones());
  for (int seed = 0; seed < 6; ++seed) {
    EXPECT_TRUE(AreAlike(planner.log.guesses[static_cast<std::size_t>(seed)], seeds.Make(seed)))
        << seed;
  }
  EXPECT_FALSE(result.progress.cut_short);
  EXPECT_EQ(result.iterations, kIterations * planner.log.num_solves);
  EXPECT_EQ(result.spent, (kIterations + 1) * planner.log.num_solves);
}

TEST(SeededPlanner, ChangesNothingForABudgetThatIsNotSpent) {
  const IdlePlanner planner;
  PlanRequest request = Request(Everywhere());
  const PlanResult without = planner.Plan(request);
  const Log log = planner.log;
  planner.log = {};
  request.budget.iterations = without.spent;
  const PlanResult with = planner.Plan(request);
  EXPECT_FALSE(with.progress.cut_short);
  EXPECT_EQ(with.spent, without.spent);
  EXPECT_EQ(with.trajectory->q, without.trajectory->q);
  ASSERT_EQ(planner.log.guesses.size(), log.guesses.size());
}

TEST(SeededPlanner, BringsAGuessThatIsFreeToItsEndBeforeItIsOverTheLimits) {
  const PatientPlanner planner;
  const BallField far_away({9, 9, 9}, {0, 0, 0}, 0.1);
  PlanRequest request = Request(far_away);
  request.num_states = 41;
  const PlanResult result = planner.Plan(request);
  EXPECT_EQ(result.status, PlanStatus::kSolved) << ToString(result.status);
  EXPECT_LE(result.limit_use.velocity, 0.8);
  // With an iteration less than that takes (the solve itself counts as one):
  request.budget.iterations = result.spent - 2;
  EXPECT_EQ(planner.Plan(request).status, PlanStatus::kOverLimits);
}

class ASearchCutShort : public ::testing::TestWithParam<int> {};

TEST_P(ASearchCutShort, GoesOnWhereItStoppedUntilAllHasBeenTried) {
  for (const bool is_warm : {false, true}) {
    SCOPED_TRACE(is_warm ? "warm" : "cold");
    const IdlePlanner planner;
    PlanRequest request = Request(Everywhere());
    if (is_warm) {
      request.initial = MakeDirectMotion(request, Timing::kWholeTime);
      request.initial->q.middleCols(1, 19).array() += 0.05;  // none of the direct ones
    }
    request.budget.iterations = GetParam();
    const int num_seeds = Seeds(request, 3, Eigen::Vector2d::Ones()).count();
    std::set<int> tried;
    int num_detours = 0, num_requests = 0;
    do {
      planner.log = {};
      const PlanResult result = planner.Plan(request);
      ASSERT_LT(++num_requests, 30);
      // A solve that has begun is looked at: one more.
      EXPECT_LE(result.spent, request.budget.iterations + 2);
      ASSERT_FALSE(planner.log.guesses.empty());
      const bool is_taken_up = request.progress.cut_short && request.progress.next_seed > 0;
      if (is_taken_up) {
        EXPECT_TRUE(AreAlike(planner.log.guesses.front(), request.progress.best->trajectory));
      }
      const std::size_t first = is_taken_up ? 1 : 0;
      for (std::size_t i = first; i < planner.log.guesses.size(); ++i) {
        const int seed = WhichSeed(request, planner.log.guesses[i]);
        const bool is_detour = seed == num_seeds;
        if (is_detour) {
          ++num_detours;
        } else {
          if (i == first) {
            EXPECT_EQ(seed, is_taken_up ? request.progress.next_seed : 0);
          }
          tried.insert(seed);
        }
      }
      request.progress = result.progress;
    } while (request.progress.next_seed != 0 && num_requests < 12);
    EXPECT_EQ(tried.size(), is_warm ? 4u : 3u);
    EXPECT_GE(num_detours, is_warm ? 0 : 3);
    EXPECT_GT(num_requests, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(OfBudgets, ASearchCutShort, ::testing::Values(5, 9, 12));

TEST(ASearchThatWasCutShort, IsForgottenOnceThePlanThatRunsIsFree) {
  const IdlePlanner planner;
  const BallField nothing({100, 0, 0}, {0, 0, 0}, 0.1);
  PlanRequest request = Request(nothing);
  request.num_states = 41;  // time enough to keep the limits
  request.initial = MakeDirectMotion(request, Timing::kLeaveLate);
  request.progress = {true, 2, TimedPlan{MakeDirectMotion(request, Timing::kArriveEarly), {}}};
  const PlanResult result = planner.Plan(request);
  ASSERT_EQ(planner.log.guesses.size(), 1u);
  EXPECT_TRUE(AreAlike(planner.log.guesses.front(), *request.initial));
  EXPECT_FALSE(result.progress.cut_short);
}

TEST(MakeContinuation, DoesWhatThePlanDoesAtTheSameTimes) {
  PlanRequest request = Request(Everywhere());
  const Trajectory plan = MakeDirectMotion(request, Timing::kWholeTime);
  request.start = EpisodeTime(0.5);
  request.num_fixed = 2;
  const Trajectory motion = MakeContinuation(request, {plan, EpisodeTime(0)});
  for (int k = 0; k < 2; ++k) EXPECT_EQ(motion.q.col(k), request.q_start);
  for (int k = 2; k < 21; ++k) {
    const int then = std::min(k + 5, 20);  // rests at its end
    EXPECT_LT((motion.q.col(k) - plan.q.col(then)).norm(), 1e-9) << k;
  }
}

// The same of all planners that search: what they find does not depend on a budget that they do not
// need.
TEST(SeededPlanners, FindTheSameWithABudgetThatIsNotSpent) {
  const BallField field({0.9, 0.4, 0}, {0, -0.3, 0}, 0.15);
  for (const char* const name : {"gpmp", "gpmp_ceres", "gpmp_fast"}) {
    SCOPED_TRACE(name);
    const auto planner = MakePlanner(name, MakePlanarArm(), {});
    PlanRequest request = Request(field);
    const PlanResult without = planner->Plan(request);
    request.budget.iterations = without.spent;
    const PlanResult with = planner->Plan(request);
    EXPECT_EQ(with.trajectory->q, without.trajectory->q);
    EXPECT_EQ(with.status, without.status);
    EXPECT_FALSE(with.progress.cut_short);
    request.budget.iterations = without.iterations / 2;
    EXPECT_TRUE(planner->Plan(request).progress.cut_short);
  }
}

}  // namespace
}  // namespace sidestep::planner::seeded_planner_test
