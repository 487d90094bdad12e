#include "sidestep/bench/free_path_search.h"

#include <cmath>
#include <limits>
#include <vector>

#include "sidestep/bench/planner_settings.h"
#include "sidestep/core/random.h"
#include "sidestep/core/shape.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/registry.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::bench {
namespace {

constexpr double kJudgeStep_s = 0.005, kAfterGoal_s = 0.5;
constexpr double kGradientStep_m = 1e-4;

// The distance to the true shapes, where they truly will be.
class TrueField final : public sdf::DistanceField {
 public:
  TrueField(const scenarios::Scenario& scenario, double max_distance_m)
      : scenario_(scenario), max_distance_m_(max_distance_m) {
    for (const scenarios::StaticBox& box : scenario.static_boxes) {
      still_.push_back({box.X_WO.Inverse(), Box{box.size_m}});
    }
  }

  sdf::DistanceSample Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const override {
    return SampleAmong(p_WQ, MovingAt(t));
  }
  void SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                  sdf::DistanceSamples& samples) const override {
    const std::vector<Placed> moving = MovingAt(t);
    samples.distance_m.resize(p_WQ.cols());
    samples.gradient_W.resize(3, p_WQ.cols());
    samples.num_outside = 0;
    for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
      const sdf::DistanceSample sample = SampleAmong(p_WQ.col(s), moving);
      samples.distance_m(s) = sample.distance_m;
      samples.gradient_W.col(s) = sample.gradient_W;
    }
  }
  double max_distance_m() const override { return max_distance_m_; }

 private:
  struct Placed {
    Pose X_OW;
    Shape shape;
    double Distance(const Eigen::Vector3d& p_WQ) const {
      return SignedDistance(shape, X_OW * p_WQ);
    }
  };

  std::vector<Placed> MovingAt(EpisodeTime t) const {
    std::vector<Placed> moving;
    for (const scenarios::MovingObstacle& obstacle : scenario_.moving_obstacles) {
      moving.push_back({PoseAt(obstacle, t).Inverse(), obstacle.shape});
    }
    return moving;
  }

  sdf::DistanceSample SampleAmong(const Eigen::Vector3d& p_WQ,
                                  const std::vector<Placed>& moving) const {
    sdf::DistanceSample sample{max_distance_m_, Eigen::Vector3d::Zero(), true};
    const Placed* nearest = nullptr;
    for (const std::vector<Placed>* group : {&still_, &moving}) {
      for (const Placed& placed : *group) {
        const double distance_m = placed.Distance(p_WQ);
        if (distance_m < sample.distance_m) {
          sample.distance_m = distance_m;
          nearest = &placed;
        }
      }
    }
    if (nearest == nullptr) return sample;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kGradientStep_m * Eigen::Vector3d::Unit(axis);
      sample.gradient_W(axis) =
          (nearest->Distance(p_WQ + step) - nearest->Distance(p_WQ - step)) / (2 * kGradientStep_m);
    }
    return sample;
  }

  const scenarios::Scenario& scenario_;
  double max_distance_m_;
  std::vector<Placed> still_;
};

}  // namespace

FreePath SearchFreePath(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                        int max_guesses, std::uint64_t seed) {
  const TrueField field(scenario, scenario.epsilon_m + robot.largest_sphere_radius_m());
  const auto planner = planner::MakePlanner(scenario.planner, robot, MakePlannerSettings(scenario));
  planner::PlanRequest request;
  request.field = &field;
  request.step_s = scenario.step_s;
  request.num_states = static_cast<int>(std::lround(scenario.horizon_s / scenario.step_s)) + 1;
  request.q_start = scenario.q_start;
  request.v_start = Eigen::VectorXd::Zero(robot.num_joints());
  request.q_goal = scenario.q_goal;
  request.num_fixed = 1 + static_cast<int>(std::ceil(scenario.latency_s / scenario.step_s - 1e-9));

  RandomStream random(seed, "free path search");
  FreePath best;
  best.clearance_m = -std::numeric_limits<double>::infinity();
  while (best.guesses < max_guesses && !best.found) {
    if (best.guesses > 0) {
      request.initial.reset();
      request.initial = planner::MakeDetour(request, random);
    }
    ++best.guesses;
    const planner::PlanResult plan = planner->Plan(request);
    const EpisodeTime begin(0), end(plan.trajectory.t_s(request.num_states - 1) + kAfterGoal_s);
    const double clearance_m =
        planner::MeasureClearance(robot, field, plan.trajectory, begin, begin, end, kJudgeStep_s)
            .least_m;
    if (clearance_m <= best.clearance_m) continue;
    best.clearance_m = clearance_m;
    best.trajectory = plan.trajectory;
    best.found = clearance_m > 0;
  }
  return best;
}

}  // namespace sidestep::bench
