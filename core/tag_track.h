#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "sidestep/core/time.h"

namespace sidestep {

/// What is believed of something's position and velocity at a time, in W.
struct PointEstimate {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< p, then v
};

/// How something was seen to be turned, give or take.
struct SeenTurn {
  Eigen::Quaterniond R_WO = Eigen::Quaterniond::Identity();
  double sigma_rad = 0;
};

struct TagTrackOptions {
  double sigma_a_m_s2 = 1;      ///< acceleration from one sighting to the next, each axis
  double sigma_v_m_s = 1;       ///< velocity of what was seen once
  double most_speed_m_s = 2.5;  ///< from one sighting to the next; faster is a mistake
  /// ... and turned faster than this, the other one of the two poses that explain a tag.
  double most_turn_rad_s = std::numeric_limits<double>::infinity();
  /// Squared Mahalanobis distances: one beyond the gate (99 % of 3 degrees of freedom) is a
  /// mistake; one beyond the expected is believed the less the farther it is, or a mistake at the
  /// edge of the gate would draw the track so far that it took what is right for mistakes.
  double gate = 11.34, expected = 3;
  int most_rejects = 5;         ///< in a row; then the track is lost ...
  bool holds_on = false;        ///< ... but only to one that agrees with itself
  double patience_s = 0.3;      ///< without a sighting; then it is lost
  int least_agreeing = 3;       ///< sightings that make a track
  double agree_within_s = 0.3;  ///< from one of these to the next
};

/// Follows one point from sightings with covariance, at their times of capture: a Kalman filter of
/// constant velocity behind gates. A track begins when so many sightings agree, is lost when too
/// many in a row do not, and begins again. What is asked for later times (the present, when an
/// image arrives 60 ms late) is predicted, with the covariance of that.
class TagTrack {
 public:
  explicit TagTrack(const TagTrackOptions& options = {}) : options_(options) {}

  struct Verdict {
    bool is_taken = false;  ///< by a track that is being followed
    double nis = 0;         ///< squared Mahalanobis distance, of what a track was compared with
    /// The covariance of a sighting that was taken, as far as it was believed.
    Eigen::Matrix3d R_m2 = Eigen::Matrix3d::Zero();
    bool is_too_fast = false;  ///< it is farther from the one before than most_speed_m_s allows
    /// How many of the latest sightings the track has begun with, this one included; 0: it had
    /// begun before, or has not begun.
    int num_begun_with = 0;
  };

  /// Takes in a sighting; times never go back. @param R_m2 its covariance.
  /// @param turn how it was turned; nothing, where that is not to be judged.
  Verdict Update(EpisodeTime t, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& R_m2,
                 const std::optional<SeenTurn>& turn = std::nullopt);

  /// Nothing was seen until `t`.
  void PassTime(EpisodeTime t);

  /// The squared Mahalanobis distance of a sighting from what is expected: by the track or, where
  /// there is none, by what may become it; infinite where nothing is expected.
  double DistanceOf(EpisodeTime t, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& R_m2) const;

  bool is_followed() const { return track_.has_value(); }
  /// How often it was lost after it had been followed.
  int num_losses() const { return num_losses_; }

  /// Nothing while it is not followed. @param t not before the latest sighting that was taken.
  std::optional<PointEstimate> At(EpisodeTime t) const;

 private:
  struct Filter {
    EpisodeTime t;
    PointEstimate estimate;
    std::optional<SeenTurn> turn;  // as seen last
    int num_agreeing = 1;
  };
  struct Seen {
    EpisodeTime t;
    Eigen::Vector3d p_W;
    Eigen::Matrix3d R_m2;
    std::optional<SeenTurn> turn;
  };

  PointEstimate Predict(const Filter& filter, EpisodeTime t) const;
  bool HasTurnedTooFast(const Filter& filter, const Seen& seen) const;
  /// @return whether it agreed; then it is taken in.
  bool Try(Filter* filter, const Seen& seen, Verdict* verdict) const;
  Verdict Challenge(const Seen& seen);
  void Lose();

  TagTrackOptions options_;
  std::optional<Filter> track_, challenger_;
  int num_rejects_ = 0, num_losses_ = 0;
};

}  // namespace sidestep
