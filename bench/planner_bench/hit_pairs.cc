#include "sidestep/bench/planner_bench/hit_pairs.h"

#include <limits>
#include <stdexcept>
#include <variant>

#include "sidestep/bench/scenario_planner.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/core/random.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/first_guess.h"

namespace sidestep::bench {
namespace {

constexpr int kMaxDraws = 10000;
constexpr double kClearMargin_m = 0.02;

class Draw {
 public:
  Draw(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
       const HitPairOptions& options, std::uint64_t seed, int number)
      : robot_(robot),
        options_(options),
        random_(seed, "hit pair " + std::to_string(number)),
        task_(scenario) {
    if (task_.moving_obstacles.size() != 1 ||
        !std::holds_alternative<scenarios::LinearMotion>(task_.moving_obstacles.front().motion)) {
      throw std::invalid_argument("hit pairs need a scenario with one obstacle on a straight line");
    }
    line_ = std::get<scenarios::LinearMotion>(task_.moving_obstacles.front().motion);
    task_.start_name.clear();
    task_.goal_name.clear();
  }

  bool IsHit() {
    task_.q_start = Around(options_.starts);
    task_.q_goal = Around(options_.goals);
    task_.moving_obstacles.front().motion = Passing();
    if (!IsWithinLimits(task_.q_start) || !IsWithinLimits(task_.q_goal)) return false;
    const double latency_s = task_.longest_latency_s();
    const auto world = TrueWorld(task_, /*max_distance_m=*/1);
    scenarios::Scenario still = task_;
    still.moving_obstacles.clear();
    const auto still_world = TrueWorld(still, 1);

    const Trajectory direct =
        planner::MakeDirectMotion(RequestOf(task_, task_.horizon_s), planner::Timing::kWholeTime);
    const auto clearance_m = [&](const sdf::ShapeField& field, double from_s, double to_s) {
      return planner::MeasureClearance(robot_, field, direct, EpisodeTime(0), EpisodeTime(from_s),
                                       EpisodeTime(to_s))
          .least_m;
    };
    return clearance_m(still_world, 0, task_.horizon_s) > kClearMargin_m &&
           clearance_m(world, 0, latency_s) > kClearMargin_m &&
           clearance_m(world, task_.horizon_s, task_.horizon_s) > kClearMargin_m &&
           clearance_m(world, 0, task_.horizon_s) <= 0;
  }

  const scenarios::Scenario& task() const { return task_; }

 private:
  Eigen::VectorXd Around(const std::vector<std::string>& names) {
    const std::string& name = names.at(random_.Bits() % names.size());
    const auto found = robot_.configurations().find(name);
    if (found == robot_.configurations().end()) {
      throw std::invalid_argument("hit pairs: the robot has no configuration '" + name + "'");
    }
    Eigen::VectorXd q = found->second;
    for (double& position : q) position += options_.spread_rad * random_.Normal();
    return q;
  }

  scenarios::LinearMotion Passing() {
    scenarios::LinearMotion motion = line_;
    const Eigen::Vector3d p_WB = task_.X_WB.translation();
    const Eigen::Vector3d nearest =
        line_.start_m + (p_WB - line_.start_m).dot(line_.direction) * line_.direction;
    motion.speed_m_s = random_.Uniform(options_.least_speed_m_s, options_.most_speed_m_s);
    if (random_.Uniform() < 0.5) motion.direction = -motion.direction;
    const double passes_s = random_.Uniform(0.25, 0.75) * task_.horizon_s;
    motion.start_m = nearest - passes_s * motion.speed_m_s * motion.direction;
    motion.begin_at_s = 0;
    motion.stop_at_s = std::numeric_limits<double>::infinity();
    return motion;
  }

  bool IsWithinLimits(const Eigen::VectorXd& q) const {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const robot::JointLimits& limits = robot_.limits()[static_cast<std::size_t>(i)];
      if (q(i) < limits.q_min + 0.05 || q(i) > limits.q_max - 0.05) return false;
    }
    return true;
  }

  const robot::RobotModel& robot_;
  const HitPairOptions& options_;
  RandomStream random_;
  scenarios::Scenario task_;
  scenarios::LinearMotion line_;
};

}  // namespace

scenarios::Scenario MakeHitPair(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                                const HitPairOptions& options, std::uint64_t seed, int number) {
  Draw draw(scenario, robot, options, seed, number);
  for (int i = 0; i < kMaxDraws; ++i) {
    if (draw.IsHit()) return draw.task();
  }
  throw std::invalid_argument("hit pairs: 10000 draws gave no task");
}

}  // namespace sidestep::bench
