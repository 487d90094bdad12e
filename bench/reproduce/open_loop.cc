#include "sidestep/bench/reproduce/open_loop.h"

#include "sidestep/planner/gauss_newton.h"
#include "sidestep/planner/gp_trajectory.h"
#include "sidestep/planner/guarded_spheres.h"

namespace sidestep::bench {
namespace {

Trajectory StraightLine(const OpenLoopExperiment& experiment, const OpenLoopTask& task) {
  const int K = experiment.num_states(), n = static_cast<int>(task.q_start.size());
  const Eigen::VectorXd displacement = task.q_goal - task.q_start;
  Trajectory line{Eigen::VectorXd(K), Eigen::MatrixXd(n, K), Eigen::MatrixXd(n, K)};
  for (int k = 0; k < K; ++k) {
    line.t_s(k) = k * experiment.scene.step_s;
    line.q.col(k) = task.q_start + k / (K - 1.0) * displacement;
    line.v.col(k) = displacement / (K - 1);
  }
  line.q.col(K - 1) = task.q_goal;
  return line;
}

planner::GaussNewtonOptions Options(const OpenLoopExperiment& experiment) {
  planner::GaussNewtonOptions options;
  options.epsilon_m = experiment.epsilon_m;
  options.sigma_obs = experiment.sigma_obs;
  options.num_interpolated = experiment.num_interpolated;
  options.qc = experiment.qc;
  return options;
}

void AddEndPriors(planner::GaussNewton& problem, const OpenLoopExperiment& experiment,
                  const OpenLoopTask& task) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(task.q_start.size());
  problem.AddPrior(0, task.q_start, rest, experiment.sigma_prior);
  problem.AddPrior(experiment.num_states() - 1, task.q_goal, rest, experiment.sigma_prior);
}

}  // namespace

int CountCollidingStates(const robot::RobotModel& robot, const Trajectory& trajectory,
                         const std::vector<const sdf::DistanceField*>& truth) {
  const std::vector<int> guarded = planner::GuardedSpheres(robot);
  int colliding = 0;
  for (int k = 0; k < trajectory.num_states(); ++k) {
    const robot::SphereCenters centers = robot.ComputeSphereCenters(trajectory.q.col(k), false);
    const sdf::DistanceField& map = *truth[static_cast<std::size_t>(k)];
    bool touches = false;
    for (const int s : guarded) {
      const double distance_m = map.Sample(centers.p_WS.col(s), EpisodeTime()).distance_m;
      touches = touches || distance_m < robot.sphere_radii_m()(s);
    }
    colliding += touches ? 1 : 0;
  }
  return colliding;
}

OpenLoopResult RunOpenLoop(const OpenLoopExperiment& experiment, const robot::RobotModel& robot,
                           const OpenLoopTask& task, const BelievedField& believed,
                           const std::vector<const sdf::DistanceField*>& truth, bool once) {
  const int K = experiment.num_states();
  planner::GaussNewton problem(robot, StraightLine(experiment, task), Options(experiment));
  AddEndPriors(problem, experiment, task);
  OpenLoopResult result;
  std::vector<const sdf::DistanceField*> fields(static_cast<std::size_t>(K), nullptr);
  const int num_solves = once ? 1 : K;
  for (int now = 0; now < num_solves; ++now) {
    if (now > 0) {
      const Trajectory present = problem.GetTrajectory();
      problem.AddPrior(now, present.q.col(now), present.v.col(now), experiment.sigma_prior);
    }
    for (int k = now; k < K; ++k) {
      const sdf::DistanceField* const field = &believed(now, k);
      const sdf::DistanceField*& previous = fields[static_cast<std::size_t>(k)];
      if (field == previous) continue;
      problem.SetField(k, *field, EpisodeTime());
      previous = field;
    }
    result.iterations += problem.Solve().iterations();
  }
  result.trajectory = problem.GetTrajectory();

  planner::GaussNewton judge(robot, result.trajectory, Options(experiment));
  AddEndPriors(judge, experiment, task);
  for (int k = 0; k < K; ++k) {
    judge.SetField(k, *truth[static_cast<std::size_t>(k)], EpisodeTime());
  }
  const planner::PlanCost cost = judge.ComputeCost();
  result.gp_cost = cost.gp + cost.goal;
  result.obstacle_cost = cost.obstacle;
  result.colliding_states = CountCollidingStates(robot, result.trajectory, truth);
  return result;
}

}  // namespace sidestep::bench
