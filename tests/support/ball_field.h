#pragma once

#include <algorithm>

#include "sidestep/sdf/distance_field.h"

namespace sidestep {

/// The field of one ball that moves at a constant velocity, in closed form and without bounds.
class BallField final : public sdf::DistanceField {
 public:
  /// @param p_WO_start where its centre is at time 0 [m]; @param v_WO its velocity [m/s].
  BallField(const Eigen::Vector3d& p_WO_start, const Eigen::Vector3d& v_WO, double radius_m,
            double max_distance_m = 100)
      : p_WO_start_(p_WO_start), v_WO_(v_WO), radius_m_(radius_m), max_m_(max_distance_m) {}

  Eigen::Vector3d CenterAt(EpisodeTime t) const { return p_WO_start_ + t.seconds() * v_WO_; }

  sdf::DistanceSample Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const override {
    const Eigen::Vector3d p_OQ_W = p_WQ - CenterAt(t);
    const double norm = p_OQ_W.norm();
    if (norm - radius_m_ >= max_m_) return {max_m_, Eigen::Vector3d::Zero(), true};
    if (norm == 0) return {-radius_m_, Eigen::Vector3d::UnitX(), true};
    return {norm - radius_m_, p_OQ_W / norm, true};
  }

  double max_distance_m() const override { return max_m_; }

 private:
  Eigen::Vector3d p_WO_start_, v_WO_;
  double radius_m_, max_m_;
};

}  // namespace sidestep
