#include "sidestep/planner/clearance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sidestep/planner/guarded_spheres.h"
#include "sidestep/planner/self_clearance.h"

namespace sidestep::planner {
namespace {

constexpr double kSameTime_s = 0.02;  // contacts this close are at one time

}  // namespace

bool IsSafer(const Clearance& a, const Clearance& b) {
  if (a.first_contact.has_value() != b.first_contact.has_value()) return !a.first_contact;
  if (a.first_contact) {
    const double later_s = (*a.first_contact - *b.first_contact).seconds();
    if (std::abs(later_s) > kSameTime_s) return later_s > 0;
  }
  return a.least_m > b.least_m;
}

Clearance MeasureClearance(const robot::RobotModel& robot, const sdf::DistanceField& field,
                           const Trajectory& trajectory, EpisodeTime start, EpisodeTime from,
                           EpisodeTime to, double step_s) {
  const std::vector<int> spheres = GuardedSpheres(robot);
  const SelfClearance links(robot);
  const double duration_s = std::max(0.0, (to - from).seconds());
  const int num_steps = static_cast<int>(std::ceil(duration_s / step_s));
  Eigen::Matrix3Xd p_WS(3, spheres.size());
  sdf::DistanceSamples samples;
  Clearance clearance;
  for (int i = 0; i <= num_steps; ++i) {
    const EpisodeTime t = from + HorizonOffset(std::min(duration_s, i * step_s));
    const robot::SphereCenters centers =
        robot.ComputeSphereCenters(Sample(trajectory, t - start).q, /*with_jacobian=*/false);
    for (std::size_t s = 0; s < spheres.size(); ++s) p_WS.col(s) = centers.p_WS.col(spheres[s]);
    clearance.least_m = std::min(clearance.least_m, links.Least(centers.p_WS));
    field.SampleMany(p_WS, t, samples);
    clearance.samples_outside_grid += samples.num_outside;
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      clearance.least_m =
          std::min(clearance.least_m, samples.distance_m(s) - robot.sphere_radii_m()(spheres[s]));
    }
    if (clearance.least_m <= 0 && !clearance.first_contact) clearance.first_contact = t;
  }
  return clearance;
}

}  // namespace sidestep::planner
