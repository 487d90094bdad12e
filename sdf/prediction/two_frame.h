#pragma once

#include <memory>

#include "sidestep/sdf/prediction/predictor.h"

namespace sidestep::sdf {

/// Constant velocity, from two sightings:  p(t) = p_n + (p_n - p_m) / (t_n - t_m) (t - t_n),
/// n the latest, m the one whose age is nearest to kVelocityBaseline (tracked_object.h says why not
/// simply the one before). No filter. Its covariance is that of the two sightings, as if the object
/// never changed its velocity: (1 + s)^2 R_n + s^2 R_m with s = (t - t_n) / (t_n - t_m). What was
/// seen once stays there, as sure as a speed of kPriorSpeed lets it be.
/// Source: the tracker of Finean, Merkt & Havoutis (ICAPS 2021), which was fed once a re-plan.
std::unique_ptr<ObstaclePredictor> MakeTwoFramePredictor();

}  // namespace sidestep::sdf
