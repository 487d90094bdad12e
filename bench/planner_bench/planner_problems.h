#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/planner/parameters.h"
#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::bench {

/// A planning task and who may judge it.
struct PlannerTask {
  planner::PlanRequest request;  ///< its field is `field`
  std::shared_ptr<const sdf::DistanceField> field;
  /// The same with the obstacle 2 cm further along; none where there is no such thing.
  std::shared_ptr<const sdf::DistanceField> moved_field;
  /// The exact distance to what is truly there; none where `field` is all there is.
  std::shared_ptr<const sdf::DistanceField> truth;
};

/// A set of tasks for one robot and one way to plan.
struct PlannerProblem {
  std::string name;
  std::shared_ptr<const robot::RobotModel> robot;
  planner::PlannerSettings settings;
  planner::Parameters parameters;  ///< as gpmp takes them
  std::vector<PlannerTask> tasks;
};

/// "gpmp2_reference_n1", "gpmp2_reference_n19" (planner_bench/gpmp2_reference.h, one task each,
/// without limits), and pairs of start and goal whose direct motion is hit (hit_pairs.h): "hsr" (a
/// mobile robot 1.0 m high through hsr_walkway at 1 to 2 m/s), "person_high" (a capsule 1.7 m high
/// at 0.5 to 2 m/s) and "wam" (the pillar of wam_single_pillar at 0.3 to 0.9 m/s).
std::vector<std::string> PlannerProblemNames();
/// Those of pairs alone.
std::vector<std::string> HitPairNames();

/// The pairs of a problem as scenarios, for episodes: of the scene they were drawn in, each has a
/// task and an obstacle of its own.
struct HitPairs {
  scenarios::Scenario scene;
  std::vector<scenarios::Scenario> tasks;
};
/// @throws as MakePlannerProblem, which makes the same.
HitPairs MakeHitPairs(const std::string& name, const std::string& models_dir,
                      const std::string& scenarios_dir, std::uint64_t seed, int num_tasks);

/// @param num_tasks of a problem that has many.
/// @throws std::invalid_argument for another name; InputError for what is wrong with the files.
PlannerProblem MakePlannerProblem(const std::string& name, const std::string& models_dir,
                                  const std::string& scenarios_dir, std::uint64_t seed,
                                  int num_tasks);

}  // namespace sidestep::bench
