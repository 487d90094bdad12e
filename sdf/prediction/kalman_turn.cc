#include "sidestep/sdf/prediction/kalman_turn.h"

#include <cmath>

namespace sidestep::sdf {
namespace {

constexpr double kSpeedNoise = 0.1;  // m^2/s^3, of each axis of the velocity
constexpr double kTurnNoise = 0.3;   // rad^2/s^3, of the rate of turn
constexpr double kSmallAngle = 1e-4;

MotionVector MoveTurning(const MotionVector& x, double dt_s, MotionMatrix* F) {
  const double w = x(kTurn), angle = w * dt_s;
  const double sine = std::sin(angle), cosine = std::cos(angle);
  const bool small = std::abs(angle) < kSmallAngle;
  // sin(w dt) / w and (1 - cos(w dt)) / w, and their derivatives by w.
  const double along = small ? dt_s : sine / w;
  const double across = small ? dt_s * angle / 2 : (1 - cosine) / w;
  const double vx = x(kV), vy = x(kV + 1);

  MotionVector moved = MotionVector::Zero();
  moved(kP) = x(kP) + along * vx - across * vy;
  moved(kP + 1) = x(kP + 1) + across * vx + along * vy;
  moved(kP + 2) = x(kP + 2) + dt_s * x(kV + 2);
  moved(kV) = cosine * vx - sine * vy;
  moved(kV + 1) = sine * vx + cosine * vy;
  moved(kV + 2) = x(kV + 2);
  moved(kTurn) = w;
  if (F != nullptr) {
    const double dalong = small ? -dt_s * dt_s * angle / 3 : (dt_s * cosine - along) / w;
    const double dacross = small ? dt_s * dt_s / 2 : (dt_s * sine - across) / w;
    F->setZero();
    F->block<3, 3>(kP, kP).setIdentity();
    F->block<2, 2>(kP, kV) << along, -across, across, along;
    (*F)(kP + 2, kV + 2) = dt_s;
    F->block<2, 2>(kV, kV) << cosine, -sine, sine, cosine;
    (*F)(kV + 2, kV + 2) = 1;
    (*F)(kP, kTurn) = dalong * vx - dacross * vy;
    (*F)(kP + 1, kTurn) = dacross * vx + dalong * vy;
    (*F)(kV, kTurn) = dt_s * (-sine * vx - cosine * vy);
    (*F)(kV + 1, kTurn) = dt_s * (cosine * vx - sine * vy);
    (*F)(kTurn, kTurn) = 1;
  }
  return moved;
}

MotionMatrix TurningNoise(double dt_s) {
  MotionMatrix Q = MotionMatrix::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const int p = kP + axis, v = kV + axis;
    Q(p, p) = kSpeedNoise * dt_s * dt_s * dt_s / 3;
    Q(p, v) = Q(v, p) = kSpeedNoise * dt_s * dt_s / 2;
    Q(v, v) = kSpeedNoise * dt_s;
  }
  AddPriorNoise(kA, Q);
  Q(kTurn, kTurn) = kTurnNoise * dt_s;
  return Q;
}

}  // namespace

const MotionModel kCoordinatedTurn = {&MoveTurning, &TurningNoise};

std::unique_ptr<ObstaclePredictor> MakeKalmanTurnPredictor() {
  return MakeFilterPredictor(kCoordinatedTurn);
}

}  // namespace sidestep::sdf
