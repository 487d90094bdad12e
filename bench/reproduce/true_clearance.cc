#include "sidestep/bench/reproduce/true_clearance.h"

#include <algorithm>
#include <limits>

#include "sidestep/core/solid.h"
#include "sidestep/core/time.h"
#include "sidestep/planner/guarded_spheres.h"
#include "sidestep/sdf/shape_field.h"

namespace sidestep::bench {
namespace {

constexpr int kSamplesAStep = 20;

PlacedShape Placed(const PublishedBox& box) {
  return {Box{box.size_m}, Pose::Translation(box.center_m)};
}

}  // namespace

TrueClearance MeasureTrueClearance(const OpenLoopExperiment& experiment,
                                   const robot::RobotModel& robot, const Trajectory& trajectory,
                                   double speed_m_s) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  TrueClearance least{kFar, kFar, kFar};
  const std::vector<int> guarded = planner::GuardedSpheres(robot);
  StaticSolids still;  // there is no floor
  for (const PublishedBox& box : experiment.static_boxes) still.shapes.push_back(Placed(box));
  const sdf::ShapeField static_world(still);
  const sdf::ShapeField moving_world(
      {}, {{Box{experiment.moving_box.size_m}, [&](EpisodeTime t) {
              return Placed(experiment.MovingBoxAtTime(speed_m_s, t.seconds())).X_WO;
            }}});
  const int num_samples = (trajectory.num_states() - 1) * kSamplesAStep + 1;
  for (int i = 0; i < num_samples; ++i) {
    const double t_s = i * experiment.step_s / kSamplesAStep;
    const robot::SphereCenters centers =
        robot.ComputeSphereCenters(Sample(trajectory, HorizonOffset(t_s)).q, false);
    for (const int s : guarded) {
      const Eigen::Vector3d p_WS = centers.p_WS.col(s);
      const double radius_m = robot.sphere_radii_m()(s);
      const double moving_m = moving_world.Distance(p_WS, EpisodeTime(t_s)) - radius_m;
      const double static_m = static_world.Distance(p_WS, EpisodeTime(t_s)) - radius_m;
      least.moving_m = std::min(least.moving_m, moving_m);
      least.static_m = std::min(least.static_m, static_m);
      if (i % kSamplesAStep == 0) least.states_m = std::min({least.states_m, moving_m, static_m});
    }
  }
  return least;
}

}  // namespace sidestep::bench
