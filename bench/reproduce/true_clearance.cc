#include "sidestep/bench/reproduce/true_clearance.h"

#include <algorithm>
#include <limits>

#include "sidestep/bench/true_world.h"
#include "sidestep/core/time.h"
#include "sidestep/planner/guarded_spheres.h"
#include "sidestep/sdf/shape_field.h"

namespace sidestep::bench {
namespace {

constexpr int kSamplesAStep = 20;

}  // namespace

TrueClearance MeasureTrueClearance(const OpenLoopExperiment& experiment,
                                   const robot::RobotModel& robot, const Trajectory& trajectory,
                                   double speed_m_s) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  TrueClearance least{kFar, kFar, kFar};
  const std::vector<int> guarded = planner::GuardedSpheres(robot);
  const sdf::ShapeField static_world({StaticShapes(experiment.scene), {}});  // there is no floor
  const sdf::ShapeField moving_world(
      {}, {{experiment.moving_box(), [&](EpisodeTime t) {
              return Pose::Translation(experiment.MovingBoxCenter(speed_m_s, t.seconds()));
            }}});
  const int num_samples = (trajectory.num_states() - 1) * kSamplesAStep + 1;
  for (int i = 0; i < num_samples; ++i) {
    const double t_s = i * experiment.scene.step_s / kSamplesAStep;
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
