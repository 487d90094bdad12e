#include "sidestep/sdf/prediction/kalman_cv.h"

namespace sidestep::sdf {
namespace {

constexpr double kCvNoise = 0.1;  // m^2/s^3

MotionVector MoveSteadily(const MotionVector& x, double dt_s, MotionMatrix* F) {
  MotionVector moved = MotionVector::Zero();
  moved.segment<3>(kP) = x.segment<3>(kP) + dt_s * x.segment<3>(kV);
  moved.segment<3>(kV) = x.segment<3>(kV);
  if (F != nullptr) {
    F->setZero();
    F->topLeftCorner<6, 6>().setIdentity();
    F->block<3, 3>(kP, kV).diagonal().setConstant(dt_s);
  }
  return moved;
}

MotionMatrix SteadyNoise(double dt_s) {
  MotionMatrix Q = MotionMatrix::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const int p = kP + axis, v = kV + axis;
    Q(p, p) = kCvNoise * dt_s * dt_s * dt_s / 3;
    Q(p, v) = Q(v, p) = kCvNoise * dt_s * dt_s / 2;
    Q(v, v) = kCvNoise * dt_s;
  }
  AddPriorNoise(kA, Q);
  AddPriorNoise(kTurn, Q);
  return Q;
}

}  // namespace

const MotionModel kConstantVelocity = {&MoveSteadily, &SteadyNoise};

std::unique_ptr<ObstaclePredictor> MakeKalmanCvPredictor() {
  return MakeFilterPredictor(kConstantVelocity);
}

}  // namespace sidestep::sdf
