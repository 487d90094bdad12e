#include "sidestep/scenarios/recorded_track.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {
namespace {

constexpr double kLongest_s = 86400, kShortestInterval_s = 1e-3;
constexpr double kTimeRounding_s = 1e-9;  // a day in steps of 1 ms is off by less
constexpr double kFarthestSample_m = 1e6, kFastest_m_s = 100;
constexpr double kUnitLength = 1e-3;
// Of the mean speed: below it, a direction is mostly the noise of where it was seen.
constexpr double kSlow = 0.2;

// The mean velocity from sample i to the next.
Eigen::Vector3d Chord(const std::vector<TrackSample>& samples, std::size_t i) {
  return (samples[i + 1].p_WO - samples[i].p_WO) / (samples[i + 1].t_s - samples[i].t_s);
}

// The velocity at a sample between two chords of so many seconds.
Eigen::Vector3d VelocityBetween(const Eigen::Vector3d& chord_before, double before_s,
                                const Eigen::Vector3d& chord_after, double after_s) {
  Eigen::Vector3d v = (after_s * chord_before + before_s * chord_after) / (before_s + after_s);
  for (const Eigen::Vector3d& chord : {chord_before, chord_after}) {
    const double along = v.dot(chord);
    if (along < 0) v -= along / chord.squaredNorm() * chord;
  }
  const double most = 3 * std::min(chord_before.norm(), chord_after.norm());
  const double speed = v.norm();
  return speed > most ? Eigen::Vector3d(most / speed * v) : v;
}

std::vector<Eigen::Vector3d> Velocities(const std::vector<TrackSample>& samples) {
  std::vector<Eigen::Vector3d> velocities(samples.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    velocities[i] = VelocityBetween(Chord(samples, i - 1), samples[i].t_s - samples[i - 1].t_s,
                                    Chord(samples, i), samples[i + 1].t_s - samples[i].t_s);
  }
  return velocities;
}

double MeanSpeed(const std::vector<TrackSample>& samples) {
  double way_m = 0, moving_s = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step_m = (samples[i].p_WO - samples[i - 1].p_WO).norm();
    if (!(step_m > 0)) continue;
    way_m += step_m;
    moving_s += samples[i].t_s - samples[i - 1].t_s;
  }
  return moving_s > 0 ? way_m / moving_s : 0;
}

std::vector<double> Headings(const std::vector<TrackSample>& samples,
                             std::vector<Eigen::Vector3d> velocities, double slow_m_s) {
  // At its ends it rests, but not before it has gone and come.
  velocities.front() = Chord(samples, 0);
  velocities.back() = Chord(samples, samples.size() - 2);
  const auto is_slow = [&](const Eigen::Vector3d& v) { return !(v.head<2>().norm() > slow_m_s); };
  const auto first = std::find_if_not(velocities.begin(), velocities.end(), is_slow);
  double heading = first == velocities.end() ? 0 : std::atan2(first->y(), first->x());
  std::vector<double> headings;
  for (const Eigen::Vector3d& v : velocities) {
    if (!is_slow(v)) {
      heading += std::remainder(std::atan2(v.y(), v.x()) - heading, 2 * std::numbers::pi);
    }
    headings.push_back(heading);
  }
  return headings;
}

}  // namespace

std::optional<TrackFault> AppendSample(const std::vector<double>& row,
                                       std::vector<TrackSample>* samples) {
  if (row.size() != 4 && row.size() != 8) {
    return TrackFault{"", "must be t, x, y, z or t, x, y, z, qw, qx, qy, qz, has " +
                              std::to_string(row.size()) + " numbers"};
  }
  TrackSample sample{row[0], {row[1], row[2], row[3]}, std::nullopt};
  if (!(sample.t_s >= 0 && sample.t_s <= kLongest_s)) {
    return TrackFault{"t", "must be from 0 to 86400 s, is " + Number(sample.t_s)};
  }
  for (const int axis : {0, 1, 2}) {
    if (!(std::abs(sample.p_WO(axis)) <= kFarthestSample_m)) {
      return TrackFault{std::string(1, "xyz"[axis]),
                        "must be within 1e6 m, is " + Number(sample.p_WO(axis))};
    }
  }
  if (row.size() == 8) {
    Eigen::Quaterniond R_WO(row[4], row[5], row[6], row[7]);
    const double length = R_WO.norm();
    if (!(std::abs(length - 1) <= kUnitLength)) {
      return TrackFault{"q",
                        "must be a quaternion (w, x, y, z) of length 1, is of " + Number(length)};
    }
    // As in Pose: what is normalised keeps its bits, so that it survives being written and read.
    constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
    if (std::abs(length - 1) > kRounding) R_WO.coeffs() /= length;
    sample.R_WO = R_WO;
  }
  if (!samples->empty()) {
    const TrackSample& before = samples->back();
    if (before.R_WO.has_value() != sample.R_WO.has_value()) {
      return TrackFault{"", "must have as many numbers as the samples before it"};
    }
    const double interval_s = sample.t_s - before.t_s;
    if (!(interval_s >= kShortestInterval_s - kTimeRounding_s)) {
      return TrackFault{"t", "must be at least 0.001 s after the sample before it, at " +
                                 Number(before.t_s) + ", is " + Number(sample.t_s)};
    }
    const double speed_m_s = (sample.p_WO - before.p_WO).norm() / interval_s;
    if (!(speed_m_s <= kFastest_m_s)) {
      return TrackFault{"", "is reached at " + Number(std::round(speed_m_s)) +
                                " m/s from the sample before it, must be at most 100 m/s"};
    }
  }
  if (samples->size() == kMaxTrackSamples) {
    return TrackFault{"", "is one too many: there may be 10000 samples"};
  }
  samples->push_back(sample);
  return std::nullopt;
}

RecordedTrack::RecordedTrack(std::vector<TrackSample> samples) : samples_(std::move(samples)) {
  if (samples_.size() < 2) throw std::invalid_argument("RecordedTrack: needs 2 samples");
  v_WO_ = Velocities(samples_);
  mean_speed_m_s_ = MeanSpeed(samples_);
  heading_rad_ = Headings(samples_, v_WO_, kSlow * mean_speed_m_s_);
}

RecordedTrack::Place RecordedTrack::Locate(double t_s) const {
  if (!(t_s > samples_.front().t_s)) return {0, 0};
  const auto after =
      std::upper_bound(samples_.begin(), samples_.end(), t_s,
                       [](double t, const TrackSample& sample) { return t < sample.t_s; });
  if (after == samples_.end()) return {samples_.size() - 1, 0};
  const auto before = std::prev(after);
  return {static_cast<std::size_t>(before - samples_.begin()),
          (t_s - before->t_s) / (after->t_s - before->t_s)};
}

Eigen::Vector3d RecordedTrack::Position(double t_s) const {
  const auto [i, s] = Locate(t_s);
  const TrackSample& a = samples_[i];
  if (s == 0) return a.p_WO;
  const TrackSample& b = samples_[i + 1];
  const double r = 1 - s;
  return a.p_WO + s * s * (3 - 2 * s) * (b.p_WO - a.p_WO) +
         (b.t_s - a.t_s) * s * r * (r * v_WO_[i] - s * v_WO_[i + 1]);
}

Eigen::Vector3d RecordedTrack::Velocity(double t_s) const {
  const auto [i, s] = Locate(t_s);
  if (s == 0) return v_WO_[i];
  const double r = 1 - s;
  return 6 * s * r * Chord(samples_, i) + r * (1 - 3 * s) * v_WO_[i] -
         s * (2 - 3 * s) * v_WO_[i + 1];
}

Eigen::Quaterniond RecordedTrack::Rotation(double t_s) const {
  const auto [i, s] = Locate(t_s);
  const Eigen::Quaterniond& R = samples_[i].R_WO.value();
  return s == 0 ? R : R.slerp(s, samples_[i + 1].R_WO.value());
}

double RecordedTrack::Heading(double t_s) const {
  const auto [i, s] = Locate(t_s);
  if (s == 0) return heading_rad_[i];
  return heading_rad_[i] + s * (heading_rad_[i + 1] - heading_rad_[i]);
}

}  // namespace sidestep::scenarios
