#pragma once

#include "sidestep/planner/gp_settings.h"
#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_kind.h"
#include "sidestep/planner/planner_settings.h"

namespace sidestep::planner {

/// `gpmp`: trajectory optimisation after GPMP2, by Levenberg-Marquardt in one thread, with caps on
/// iterations and never on time.
///
/// A cold start is solved in two stages, first without joint limits and then with them from there:
/// stiff limits from the beginning keep the solver on the wrong side of obstacles. A warm start is
/// solved with limits at once. A plan is judged by its clearance, not by its cost. If a cold one is
/// not free within the limits, or a warm one not free, direct motions with other timings are tried
/// as seeds until one is, and the best counts. Where all of them touch something, a cold start is
/// followed by detours over random configurations, other ones for another time. Such seeds get few
/// iterations, and no second stage if the first leaves them less safe than the best so far. Links
/// that the robot's self_collision() names are kept 0.05 m apart.
///
/// Source: Mukadam et al., "Continuous-time Gaussian process motion planning via probabilistic
/// inference", IJRR 37(11):1319-1340, 2018.
class GpPlanner final : public Planner {
 public:
  /// @throws std::invalid_argument for settings out of range.
  GpPlanner(const robot::RobotModel& robot, const PlannerSettings& settings,
            const GpSettings& gp = {});

  PlannerCapabilities capabilities() const override {
    return {.reaches_goal = true, .avoids_obstacles = true};
  }

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge& judge) const override;
  enum class Stages {
    kWithLimits,  ///< for a warm start
    kBoth         ///< for a cold one
  };
  struct Candidate {
    PlanAnswer answer;
    Verdict verdict;
  };
  /// At most the budget's iterations less `iterations_done`. With `to_beat` it is a trial, for one
  /// of many seeds: few iterations, and it gives up after the first stage if that touches something
  /// and is not safer.
  Candidate Solve(const PlanRequest& request, PlanJudge& judge, const Trajectory& guess,
                  Stages stages, int iterations_done, const Clearance* to_beat = nullptr) const;
  bool IsWithinLimits(const Verdict& verdict) const;  // the robot's own, unscaled
  /// Free within limits comes before free, free before not free; then what is safer.
  bool IsBetter(const Verdict& a, const Verdict& b) const;
  GpSettings gp_;
};

PlannerKind GpmpKind();

}  // namespace sidestep::planner
