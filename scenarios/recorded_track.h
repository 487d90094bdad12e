#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace sidestep::scenarios {

/// Where a thing was at a time and, if the record says so, how it was turned.
struct TrackSample {
  double t_s = 0;
  Eigen::Vector3d p_WO = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> R_WO;  ///< unit length
};

/// What is wrong with a sample: in its column t, x, ..., q or, if empty, with the row as a whole.
struct TrackFault {
  std::string column, why;
};

/// Appends the sample that a row t, x, y, z or t, x, y, z, qw, qx, qy, qz says, unless it is wrong
/// by itself or after those before it: all rows have the same columns, times are from 0 to a day
/// and at least 1 ms apart, positions within 1000 km, speeds at most 100 m/s (more is a slip of the
/// pen, such as millimetres), quaternions of unit length to 0.001.
std::optional<TrackFault> AppendSample(const std::vector<double>& row,
                                       std::vector<TrackSample>* samples);

/// At most so many samples: 5 minutes at 30 Hz.
inline constexpr std::size_t kMaxTrackSamples = 10000;

/// A way through space and time that passes exactly through time-stamped poses and rests before the
/// first and after the last.
///
/// Between samples the position is a cubic Hermite curve: position and velocity are continuous. The
/// velocity at a sample is that of the parabola through it and its neighbours (Bessel's rule: C. de
/// Boor, A Practical Guide to Splines, 1978, chapter IV), without what points back along either of
/// the two chords, and at most 3 times the slower chord's speed (F. N. Fritsch, R. E. Carlson,
/// "Monotone Piecewise Cubic Interpolation", SIAM J. Numer. Anal. 17, 1980). So along each chord
/// the curve goes from one sample to the next without turning back or overshooting, equal
/// neighbours are a pause of exact rest, and the curve does not depend on the axes of W. At the
/// first and last sample the velocity is zero.
///
/// Immutable.
class RecordedTrack {
 public:
  /// @param samples made by AppendSample. @throws std::invalid_argument for fewer than 2.
  explicit RecordedTrack(std::vector<TrackSample> samples);

  const std::vector<TrackSample>& samples() const { return samples_; }
  bool has_rotations() const { return samples_.front().R_WO.has_value(); }
  /// Its length from sample to sample over the time between those that differ [m/s]; 0 if it stays
  /// in one place.
  double mean_speed_m_s() const { return mean_speed_m_s_; }

  Eigen::Vector3d Position(double t_s) const;  ///< p_WO [m]
  Eigen::Vector3d Velocity(double t_s) const;  ///< v_WO [m/s], the derivative of Position
  /// R_WO: the samples' own, by the shorter turn at one rate in between. Needs has_rotations().
  Eigen::Quaterniond Rotation(double t_s) const;
  /// Where it is headed: the angle of the velocity's level part from the x axis [rad]. At samples
  /// slower than a fifth of the mean speed, where a direction is noise, it keeps the last heading;
  /// before the first faster one it has that one's. Linear in time between samples by the shorter
  /// turn, so that it is continuous and a reversal is a turn from one sample to the next. 0 if it
  /// never moves on the level.
  double Heading(double t_s) const;

 private:
  // Where t falls: after sample `before`, by `share` of the interval; after the last, share 0.
  struct Place {
    std::size_t before;
    double share;
  };
  Place Locate(double t_s) const;

  std::vector<TrackSample> samples_;
  std::vector<Eigen::Vector3d> v_WO_;  ///< at each sample
  std::vector<double> heading_rad_;    ///< at each sample, without jumps of a whole turn
  double mean_speed_m_s_ = 0;
};

}  // namespace sidestep::scenarios
