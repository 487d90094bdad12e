#include "sidestep/bench/reproduce/true_clearance.h"

#include <algorithm>
#include <limits>

#include "sidestep/core/shape.h"
#include "sidestep/core/time.h"
#include "sidestep/planner/guarded_spheres.h"

namespace sidestep::bench {
namespace {

constexpr int kSamplesAStep = 20;

double DistanceTo(const PublishedBox& box, const Eigen::Vector3d& p_WS) {
  return SignedDistance(Box{box.size_m}, p_WS - box.center_m);
}

}  // namespace

TrueClearance MeasureTrueClearance(const OpenLoopExperiment& experiment,
                                   const robot::RobotModel& robot, const Trajectory& trajectory,
                                   double speed_m_s) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  TrueClearance least{kFar, kFar, kFar};
  const std::vector<int> guarded = planner::GuardedSpheres(robot);
  const int num_samples = (trajectory.num_states() - 1) * kSamplesAStep + 1;
  for (int i = 0; i < num_samples; ++i) {
    const double t_s = i * experiment.step_s / kSamplesAStep;
    const robot::SphereCenters centers =
        robot.ComputeSphereCenters(Sample(trajectory, HorizonOffset(t_s)).q, false);
    const PublishedBox moving = experiment.MovingBoxAtTime(speed_m_s, t_s);
    for (const int s : guarded) {
      const Eigen::Vector3d p_WS = centers.p_WS.col(s);
      const double radius_m = robot.sphere_radii_m()(s);
      const double moving_m = DistanceTo(moving, p_WS) - radius_m;
      double static_m = kFar;
      for (const PublishedBox& box : experiment.static_boxes) {
        static_m = std::min(static_m, DistanceTo(box, p_WS) - radius_m);
      }
      least.moving_m = std::min(least.moving_m, moving_m);
      least.static_m = std::min(least.static_m, static_m);
      if (i % kSamplesAStep == 0) least.states_m = std::min({least.states_m, moving_m, static_m});
    }
  }
  return least;
}

}  // namespace sidestep::bench
