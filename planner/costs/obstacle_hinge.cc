#include "planner/costs/obstacle_hinge.h"

#include "planner/guarded_spheres.h"

namespace sidestep {

ObstacleHinge::ObstacleHinge(const RobotModel& robot, const DistanceField& field, double epsilon_m,
                             double sigma)
    : robot_(robot), field_(field), sigma_(sigma), spheres_(GuardedSpheres(robot)) {
  reach_m_.resize(num_spheres());
  for (int s = 0; s < num_spheres(); ++s) {
    reach_m_(s) = epsilon_m + robot.sphere_radii_m()(spheres_[s]);
  }
  p_WS_.resize(3, num_spheres());
  hinges_.resize(num_spheres());
  jacobian_.resize(num_spheres(), num_joints());
}

void ObstacleHinge::Evaluate(const Eigen::VectorXd& q, EpisodeTime t, bool with_jacobian) {
  const SphereCenters centers = robot_.ComputeSphereCenters(q, with_jacobian);
  for (int s = 0; s < num_spheres(); ++s) p_WS_.col(s) = centers.p_WS.col(spheres_[s]);
  field_.SampleMany(p_WS_, t, samples_);
  hinges_ = (reach_m_ - samples_.distance_m).cwiseMax(0) / sigma_;
  if (!with_jacobian) return;
  for (int s = 0; s < num_spheres(); ++s) {
    if (hinges_(s) > 0) {
      jacobian_.row(s).noalias() = (samples_.gradient_W.col(s).transpose() / -sigma_) *
                                   centers.Jq.middleRows<3>(3 * spheres_[s]);
    } else {
      jacobian_.row(s).setZero();
    }
  }
}

}  // namespace sidestep
