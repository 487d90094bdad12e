#pragma once

#include <Eigen/Core>
#include <memory>

#include "sidestep/core/time.h"
#include "sidestep/sdf/prediction/predictor.h"

namespace sidestep::sdf {

/// The state that all motion models share, so that their estimates can be mixed: position,
/// velocity, acceleration (x, y, z in W) and the rate of turn about z.
inline constexpr int kMotionDims = 10;
inline constexpr int kP = 0, kV = 3, kA = 6, kTurn = 9;  ///< where each part begins
using MotionVector = Eigen::Matrix<double, kMotionDims, 1>;
using MotionMatrix = Eigen::Matrix<double, kMotionDims, kMotionDims>;

/// How a state goes on. A model that does not use a part of the state forgets it: its rows of the
/// Jacobian are zero and its noise is the prior of that part.
struct MotionModel {
  /// The state after dt seconds (negative: before) and, unless null, its Jacobian.
  MotionVector (*move)(const MotionVector& x, double dt_s, MotionMatrix* F);
  /// Covariance of what the model leaves to chance over |dt| seconds.
  MotionMatrix (*noise)(double dt_s);
};

/// What is believed of an object before it has moved: at rest, give or take these [m/s, m/s^2,
/// rad/s]. Obstacles of this size rarely exceed twice as much.
inline constexpr double kPriorSpeed = 2, kPriorAcceleration = 2, kPriorTurn = 1;

/// The prior noise of the acceleration and the rate of turn, in their places of a matrix: for
/// models that forget them.
void AddPriorNoise(int part, MotionMatrix& Q);

/// A state and the covariance of its error.
struct MotionEstimate {
  MotionVector x = MotionVector::Zero();
  MotionMatrix P = MotionMatrix::Zero();
};

/// The estimate after dt seconds by `model`; before, if negative.
MotionEstimate Propagate(const MotionModel& model, const MotionEstimate& estimate, double dt_s);

/// What a sighting said that the filter had not expected, and the covariance of that.
struct Innovation {
  Eigen::Vector3d residual_m;
  Eigen::Matrix3d S_m2;
};

/// An extended Kalman filter over sightings (Bar-Shalom, Li & Kirubarajan, Estimation with
/// Applications to Tracking and Navigation, 2001, sections 5.2 and 10.3), update in Joseph's form.
class MotionFilter {
 public:
  /// Begins at the first sighting, at rest give or take the priors. `model` is copied.
  MotionFilter(const MotionModel& model, const Sighting& first);

  /// Takes in a later sighting.
  Innovation Update(const Sighting& sighting);

  const MotionModel& model() const { return model_; }
  EpisodeTime t() const { return t_; }  ///< of the latest sighting
  const MotionEstimate& estimate() const { return estimate_; }
  /// For mixing between updates; keeps the time.
  void set_estimate(const MotionEstimate& estimate) { estimate_ = estimate; }

  /// The estimate with the position replaced by the one just seen: its error is then that of the
  /// sighting, which the velocity's is correlated with by the latest gain. With w the sighting's
  /// noise, J the identity without its position block, and K the gain: e' = J e + H^T w,
  ///   P' = J P J + J K R H + (J K R H)^T + H^T R H.
  MotionEstimate AnchoredEstimate() const;

 private:
  MotionModel model_;
  EpisodeTime t_;
  MotionEstimate estimate_;
  Eigen::Matrix<double, kMotionDims, 3> gain_;
  Eigen::Vector3d seen_;
  Eigen::Matrix3d R_m2_;
};

/// Runs a filter of one model over an object's history and goes on with it. `model` is copied.
std::unique_ptr<ObstaclePredictor> MakeFilterPredictor(const MotionModel& model);

}  // namespace sidestep::sdf
