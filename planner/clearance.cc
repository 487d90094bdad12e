#include "planner/clearance.h"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kSampleStep_s = 0.02;

}  // namespace

std::vector<int> GuardedSpheres(const RobotModel& robot) {
  const std::vector<int>& mount = robot.mount_spheres();
  std::vector<int> guarded;
  for (int s = 0; s < robot.num_spheres(); ++s) {
    if (!std::binary_search(mount.begin(), mount.end(), s)) guarded.push_back(s);
  }
  return guarded;
}

Clearance MeasureClearance(const RobotModel& robot, const DistanceField& field,
                           const Trajectory& trajectory, EpisodeTime start, EpisodeTime from) {
  const std::vector<int> spheres = GuardedSpheres(robot);
  const EpisodeTime end = start + HorizonOffset(trajectory.t_s(trajectory.num_states() - 1));
  const double duration_s = std::max(0.0, (end - from).seconds());
  const int num_steps = static_cast<int>(std::ceil(duration_s / kSampleStep_s));
  Eigen::Matrix3Xd p_WS(3, spheres.size());
  DistanceSamples samples;
  Clearance clearance;
  for (int i = 0; i <= num_steps; ++i) {
    const EpisodeTime t = from + HorizonOffset(std::min(duration_s, i * kSampleStep_s));
    const SphereCenters centers =
        robot.ComputeSphereCenters(Sample(trajectory, t - start).q, /*with_jacobian=*/false);
    for (std::size_t s = 0; s < spheres.size(); ++s) p_WS.col(s) = centers.p_WS.col(spheres[s]);
    field.SampleMany(p_WS, t, samples);
    clearance.samples_outside_grid += samples.num_outside;
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      const double distance_m = samples.distance_m(s) - robot.sphere_radii_m()(spheres[s]);
      if (distance_m < clearance.least_m) {
        clearance.least_m = distance_m;
        clearance.t = t;
      }
    }
  }
  return clearance;
}

}  // namespace sidestep
