#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/time.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// The covariance of an error of this standard deviation [m] along each axis.
inline Eigen::Matrix3d Isotropic(double sigma_m) {
  return sigma_m * sigma_m * Eigen::Matrix3d::Identity();
}

/// Where an object was seen.
struct Sighting {
  EpisodeTime t;
  Eigen::Vector3d p_WO;
  Eigen::Matrix3d covariance_m2 = Isotropic(0.01);  ///< of p_WO's error, positive definite
};

/// What is known of a thing that moves, as it was at the latest scan: a snapshot, so that a
/// prediction depends on nothing else. Its frame O stands in the centroid of its shape and keeps
/// the axes of W: occupancy does not tell how a thing is turned.
struct TrackedObject {
  int id = 0;  ///< unique within an episode, kept for as long as the object is tracked
  EpisodeTime first_seen;
  /// Oldest first, never empty, over the last seconds only. All are of the same point of the
  /// object, also where more or less of its shape came into view in between.
  std::vector<Sighting> history;

  /// The box around its shape, in O [m].
  Eigen::Vector3d box_center_O = Eigen::Vector3d::Zero();
  Eigen::Vector3d box_half_extents_m = Eigen::Vector3d::Zero();
  /// Its sightings may be wrong, and its shape is known, not seen: it is where a filter says rather
  /// than where it was seen last.
  bool is_filtered = false;

  /// Of its shape, padded for the field's clamp; shared by all snapshots until the shape changes.
  std::shared_ptr<const SdfGrid> field_O;

  const Sighting& latest() const { return history.back(); }
  Pose X_WO() const { return Pose::Translation(history.back().p_WO); }
};

/// The sighting whose age is nearest to `baseline`; the latest itself only if it is the only one.
const Sighting& SightingBefore(const std::vector<Sighting>& history, HorizonOffset baseline);

/// Mean velocity [m/s] between the latest sighting and SightingBefore; zero if there is only one.
Eigen::Vector3d MeanVelocity(const std::vector<Sighting>& history, HorizonOffset baseline);

/// How far apart two sightings should be for a velocity. The centroid of a thing made of cells is
/// off by up to half a cell, so a difference of two is off by up to a whole one: at 4 cm and 30 Hz
/// that makes 1.2 m/s between neighbouring frames, and 0.4 m/s over this baseline. It is also how
/// often the authors' tracker was fed, once for each re-plan.
inline constexpr HorizonOffset kVelocityBaseline{0.1};

}  // namespace sidestep::sdf
