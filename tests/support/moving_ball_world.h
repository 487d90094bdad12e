#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sidestep/sdf/world_model.h"
#include "tests/support/ball_field.h"

namespace sidestep {

/// A world model that knows one moving ball exactly and needs no scans.
class MovingBallWorld final : public sdf::WorldModel {
 public:
  MovingBallWorld(const Eigen::Vector3d& p_WO_start, const Eigen::Vector3d& v_WO, double radius_m)
      : field_(std::make_shared<BallField>(p_WO_start, v_WO, radius_m)), radius_m_(radius_m) {}

  const BallField& field() const { return *field_; }
  /// From now on another ball, as if the first had been mistaken.
  void Replace(const Eigen::Vector3d& p_WO_start, const Eigen::Vector3d& v_WO, double radius_m) {
    field_ = std::make_shared<BallField>(p_WO_start, v_WO, radius_m);
    radius_m_ = radius_m;
  }

  void Observe(std::span<const Scan>) override {}
  const OccupancyGrid& Occupancy() const override { return nothing_; }
  std::span<const std::size_t> ChangedCells() const override { return {}; }
  std::shared_ptr<const sdf::DistanceField> MakeField() override { return field_; }
  std::vector<PredictedObject> DescribeObjects(
      const std::vector<EpisodeTime>& times) const override {
    PredictedObject ball;
    ball.half_extents_m.setConstant(radius_m_);
    ball.t = times;
    for (const EpisodeTime t : times) ball.X_WO.push_back(Pose::Translation(field_->CenterAt(t)));
    return {ball};
  }
  sdf::WorldModelTimes TakeTimes() override { return {}; }

 private:
  std::shared_ptr<const BallField> field_;
  double radius_m_;
  OccupancyGrid nothing_;
};

}  // namespace sidestep
