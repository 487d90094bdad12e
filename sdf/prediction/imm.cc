#include "sidestep/sdf/prediction/imm.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

#include "sidestep/sdf/prediction/kalman_ca.h"
#include "sidestep/sdf/prediction/kalman_cv.h"
#include "sidestep/sdf/prediction/kalman_turn.h"

namespace sidestep::sdf {
namespace {

constexpr int kNumModels = 3;
using Weights = Eigen::Matrix<double, kNumModels, 1>;
constexpr double kSojourn_s = 1;  // mean time before an object begins to move otherwise
// A model that has become impossible could never come back.
constexpr double kLeastWeight = 1e-6;

// How likely each model follows each, over dt: row i from, column j to.
Eigen::Matrix<double, kNumModels, kNumModels> Switching(double dt_s) {
  const double leaves = 1 - std::exp(-dt_s / kSojourn_s);
  Eigen::Matrix<double, kNumModels, kNumModels> Pi;
  Pi.setConstant(leaves / (kNumModels - 1));
  Pi.diagonal().setConstant(1 - leaves);
  return Pi;
}

// The mean and covariance of a mixture.
MotionEstimate Mix(const std::array<MotionEstimate, kNumModels>& estimates,
                   const Weights& weights) {
  MotionEstimate mixed;
  for (int i = 0; i < kNumModels; ++i) mixed.x += weights(i) * estimates[i].x;
  for (int i = 0; i < kNumModels; ++i) {
    const MotionVector off = estimates[i].x - mixed.x;
    mixed.P += weights(i) * (estimates[i].P + off * off.transpose());
  }
  return mixed;
}

// log N(residual; 0, S), but for a constant.
double LogLikelihood(const Innovation& innovation) {
  const Eigen::Vector3d& r = innovation.residual_m;
  return -0.5 * (r.dot(innovation.S_m2.inverse() * r) + std::log(innovation.S_m2.determinant()));
}

struct Imm {
  std::array<MotionModel, kNumModels> models;
  std::array<MotionEstimate, kNumModels> now;
  Weights weights;
  EpisodeTime seen;
};

Imm Filter(const TrackedObject& object) {
  Imm imm;
  imm.models = {kConstantVelocity, kConstantAcceleration, kCoordinatedTurn};
  imm.weights.setConstant(1.0 / kNumModels);
  std::vector<MotionFilter> filters;
  for (const MotionModel& model : imm.models) filters.emplace_back(model, object.history.front());

  for (std::size_t n = 1; n < object.history.size(); ++n) {
    const Sighting& sighting = object.history[n];
    const auto Pi = Switching((sighting.t - filters.front().t()).seconds());
    const Weights expected = Pi.transpose() * imm.weights;
    std::array<MotionEstimate, kNumModels> before;
    for (int i = 0; i < kNumModels; ++i) before[i] = filters[i].estimate();
    Weights log_weights;
    for (int j = 0; j < kNumModels; ++j) {
      filters[j].set_estimate(Mix(before, Pi.col(j).cwiseProduct(imm.weights) / expected(j)));
      log_weights(j) = std::log(expected(j)) + LogLikelihood(filters[j].Update(sighting));
    }
    imm.weights = (log_weights.array() - log_weights.maxCoeff()).exp().max(kLeastWeight);
    imm.weights /= imm.weights.sum();
  }
  for (int i = 0; i < kNumModels; ++i) {
    imm.now[i] = object.is_filtered ? filters[i].estimate() : filters[i].AnchoredEstimate();
  }
  imm.seen = filters.front().t();
  return imm;
}

class ImmPredictor final : public ObstaclePredictor {
 public:
  PredictedMotion Predict(const TrackedObject& object) const override {
    const Imm imm = Filter(object);
    return {[imm](EpisodeTime t) {
              const double dt_s = (t - imm.seen).seconds();
              Eigen::Vector3d p_WO = Eigen::Vector3d::Zero();
              for (int i = 0; i < kNumModels; ++i) {
                const MotionVector x = imm.models[i].move(imm.now[i].x, dt_s, nullptr);
                p_WO += imm.weights(i) * x.segment<3>(kP);
              }
              return Pose::Translation(p_WO);
            },
            [imm](EpisodeTime t) -> Eigen::Matrix3d {
              std::array<MotionEstimate, kNumModels> moved;
              for (int i = 0; i < kNumModels; ++i) {
                moved[i] = Propagate(imm.models[i], imm.now[i], (t - imm.seen).seconds());
              }
              return Mix(moved, imm.weights).P.topLeftCorner<3, 3>();
            }};
  }
};

}  // namespace

std::unique_ptr<ObstaclePredictor> MakeImmPredictor() { return std::make_unique<ImmPredictor>(); }

}  // namespace sidestep::sdf
