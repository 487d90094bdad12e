#include "sidestep/planner/costs/obstacle_hinge.h"

#include <algorithm>

#include "sidestep/planner/costs/condense_rows.h"
#include "sidestep/planner/guarded_spheres.h"

namespace sidestep::planner {

ObstacleHinge::ObstacleHinge(const robot::RobotModel& robot, const sdf::DistanceField& field,
                             double epsilon_m, double sigma, std::optional<double> self_epsilon_m,
                             bool condensed)
    : robot_(robot),
      field_(field),
      sigma_(sigma),
      spheres_(GuardedSpheres(robot)),
      links_(robot),
      self_epsilon_m_(self_epsilon_m),
      condensed_(condensed) {
  const auto S = static_cast<Eigen::Index>(spheres_.size());
  reach_m_.resize(S);
  for (Eigen::Index s = 0; s < S; ++s) {
    reach_m_(s) = epsilon_m + robot.sphere_radii_m()(spheres_[s]);
  }
  p_WS_.resize(3, S);
  hinges_.resize(S + (self_epsilon_m ? links_.num_pairs() : 0));
  jacobian_.resize(hinges_.size(), num_joints());
  if (!condensed_) return;
  condensed_r_.resize(num_residuals());
  condensed_J_.resize(num_residuals(), num_joints());
  active_.resize(hinges_.size(), num_joints() + 1);
}

void ObstacleHinge::Evaluate(const Eigen::VectorXd& q, EpisodeTime t, bool with_jacobian) {
  const Eigen::Index S = p_WS_.cols();
  const robot::SphereCenters centers = robot_.ComputeSphereCenters(q, with_jacobian);
  for (Eigen::Index s = 0; s < S; ++s) p_WS_.col(s) = centers.p_WS.col(spheres_[s]);
  field_.SampleMany(p_WS_, t, samples_);
  hinges_.head(S) = (reach_m_ - samples_.distance_m).cwiseMax(0) / sigma_;
  if (self_epsilon_m_) EvaluateLinks(centers, with_jacobian);
  for (Eigen::Index s = 0; with_jacobian && s < S; ++s) {
    if (hinges_(s) > 0) {
      jacobian_.row(s).noalias() = (samples_.gradient_W.col(s).transpose() / -sigma_) *
                                   centers.Jq.middleRows<3>(3 * spheres_[s]);
    } else {
      jacobian_.row(s).setZero();
    }
  }
  if (condensed_) Condense(with_jacobian);
}

void ObstacleHinge::Condense(bool with_jacobian) {
  const Eigen::Index n = num_joints();
  condensed_r_.setZero();
  if (!with_jacobian) {
    condensed_r_(n) = hinges_.norm();
    return;
  }
  Eigen::Index num_active = 0;
  for (Eigen::Index h = 0; h < hinges_.size(); ++h) {
    if (hinges_(h) <= 0) continue;
    active_.row(num_active++) << jacobian_.row(h), hinges_(h);
  }
  const Eigen::Index num_rows = CondenseRows(active_, num_active);
  condensed_J_.topRows(num_rows) = active_.topLeftCorner(num_rows, n);
  condensed_J_.bottomRows(n + 1 - num_rows).setZero();
  condensed_r_.head(num_rows) = active_.col(n).head(num_rows);
}

void ObstacleHinge::EvaluateLinks(const robot::SphereCenters& centers, bool with_jacobian) {
  for (int pair = 0; pair < links_.num_pairs(); ++pair) {
    const Eigen::Index h = p_WS_.cols() + pair;
    const LinkGap gap = links_.Find(pair, centers.p_WS);
    hinges_(h) = std::max(0.0, *self_epsilon_m_ - gap.gap_m) / sigma_;
    if (!with_jacobian) continue;
    const Eigen::Vector3d apart_W = centers.p_WS.col(gap.second) - centers.p_WS.col(gap.first);
    if (hinges_(h) > 0 && apart_W.norm() > 0) {
      jacobian_.row(h).noalias() =
          (apart_W.normalized().transpose() / -sigma_) *
          (centers.Jq.middleRows<3>(3 * gap.second) - centers.Jq.middleRows<3>(3 * gap.first));
    } else {
      jacobian_.row(h).setZero();
    }
  }
}

}  // namespace sidestep::planner
