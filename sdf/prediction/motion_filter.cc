#include "sidestep/sdf/prediction/motion_filter.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace sidestep::sdf {
namespace {

// Over longer ones, what chance does to the rate of turn would not reach the position.
constexpr double kLongestStep_s = 0.1;

class FilterPredictor final : public ObstaclePredictor {
 public:
  explicit FilterPredictor(const MotionModel& model) : model_(model) {}

  PredictedMotion Predict(const TrackedObject& object) const override {
    MotionFilter filter(model_, object.history.front());
    for (std::size_t n = 1; n < object.history.size(); ++n) filter.Update(object.history[n]);
    const EpisodeTime seen = filter.t();
    const MotionEstimate estimate =
        object.is_filtered ? filter.estimate() : filter.AnchoredEstimate();
    return {[model = model_, estimate, seen](EpisodeTime t) {
              const MotionVector x = model.move(estimate.x, (t - seen).seconds(), nullptr);
              return Pose::Translation(x.segment<3>(kP));
            },
            [model = model_, estimate, seen](EpisodeTime t) -> Eigen::Matrix3d {
              return Propagate(model, estimate, (t - seen).seconds()).P.block<3, 3>(kP, kP);
            }};
  }

 private:
  MotionModel model_;
};

}  // namespace

void AddPriorNoise(int part, MotionMatrix& Q) {
  if (part == kA) Q.block<3, 3>(kA, kA) += Isotropic(kPriorAcceleration);
  if (part == kTurn) Q(kTurn, kTurn) += kPriorTurn * kPriorTurn;
}

MotionEstimate Propagate(const MotionModel& model, const MotionEstimate& estimate, double dt_s) {
  const int num_steps = std::max(1, static_cast<int>(std::ceil(std::abs(dt_s) / kLongestStep_s)));
  const double step_s = dt_s / num_steps;
  MotionMatrix F;
  MotionEstimate moved = estimate;
  for (int n = 0; n < num_steps; ++n) {
    moved.x = model.move(moved.x, step_s, &F);
    moved.P = F * moved.P * F.transpose() + model.noise(std::abs(step_s));
  }
  return moved;
}

MotionFilter::MotionFilter(const MotionModel& model, const Sighting& first)
    : model_(model), t_(first.t), seen_(first.p_WO), R_m2_(first.covariance_m2) {
  estimate_.x.segment<3>(kP) = first.p_WO;
  estimate_.P.block<3, 3>(kP, kP) = first.covariance_m2;
  estimate_.P.block<3, 3>(kV, kV) = Isotropic(kPriorSpeed);
  AddPriorNoise(kA, estimate_.P);
  AddPriorNoise(kTurn, estimate_.P);
  gain_.setZero();
}

Innovation MotionFilter::Update(const Sighting& sighting) {
  const MotionEstimate expected = Propagate(model_, estimate_, (sighting.t - t_).seconds());
  const Eigen::Matrix3d& R = sighting.covariance_m2;
  Innovation innovation;
  innovation.residual_m = sighting.p_WO - expected.x.segment<3>(kP);
  innovation.S_m2 = expected.P.block<3, 3>(kP, kP) + R;
  gain_ = expected.P.leftCols<3>() * innovation.S_m2.inverse();
  MotionMatrix I_KH = MotionMatrix::Identity();
  I_KH.leftCols<3>() -= gain_;
  estimate_.x = expected.x + gain_ * innovation.residual_m;
  estimate_.P = I_KH * expected.P * I_KH.transpose() + gain_ * R * gain_.transpose();
  t_ = sighting.t;
  seen_ = sighting.p_WO;
  R_m2_ = sighting.covariance_m2;
  return innovation;
}

MotionEstimate MotionFilter::AnchoredEstimate() const {
  MotionEstimate anchored = estimate_;
  anchored.x.segment<3>(kP) = seen_;
  const Eigen::Matrix<double, kMotionDims, 3> KR = gain_ * R_m2_;
  anchored.P.leftCols<3>() = KR;
  anchored.P.topRows<3>() = KR.transpose();
  anchored.P.block<3, 3>(kP, kP) = R_m2_;
  return anchored;
}

std::unique_ptr<ObstaclePredictor> MakeFilterPredictor(const MotionModel& model) {
  return std::make_unique<FilterPredictor>(model);
}

}  // namespace sidestep::sdf
