#include "sidestep/sdf/prediction/kalman_ca.h"

namespace sidestep::sdf {
namespace {

constexpr double kCaNoise = 4;  // m^2/s^5

MotionVector MoveAccelerating(const MotionVector& x, double dt_s, MotionMatrix* F) {
  MotionVector moved = x;
  moved.segment<3>(kP) += dt_s * x.segment<3>(kV) + dt_s * dt_s / 2 * x.segment<3>(kA);
  moved.segment<3>(kV) += dt_s * x.segment<3>(kA);
  moved(kTurn) = 0;
  if (F != nullptr) {
    F->setIdentity();
    (*F)(kTurn, kTurn) = 0;
    F->block<3, 3>(kP, kV).diagonal().setConstant(dt_s);
    F->block<3, 3>(kP, kA).diagonal().setConstant(dt_s * dt_s / 2);
    F->block<3, 3>(kV, kA).diagonal().setConstant(dt_s);
  }
  return moved;
}

MotionMatrix AcceleratingNoise(double dt_s) {
  const double dt2 = dt_s * dt_s;
  MotionMatrix Q = MotionMatrix::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const int p = kP + axis, v = kV + axis, a = kA + axis;
    Q(p, p) = kCaNoise * dt2 * dt2 * dt_s / 20;
    Q(p, v) = Q(v, p) = kCaNoise * dt2 * dt2 / 8;
    Q(p, a) = Q(a, p) = kCaNoise * dt2 * dt_s / 6;
    Q(v, v) = kCaNoise * dt2 * dt_s / 3;
    Q(v, a) = Q(a, v) = kCaNoise * dt2 / 2;
    Q(a, a) = kCaNoise * dt_s;
  }
  AddPriorNoise(kTurn, Q);
  return Q;
}

}  // namespace

const MotionModel kConstantAcceleration = {&MoveAccelerating, &AcceleratingNoise};

std::unique_ptr<ObstaclePredictor> MakeKalmanCaPredictor() {
  return MakeFilterPredictor(kConstantAcceleration);
}

}  // namespace sidestep::sdf
