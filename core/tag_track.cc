#include "sidestep/core/tag_track.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sidestep {

// Source: Bar-Shalom, Li & Kirubarajan, Estimation with Applications to Tracking and Navigation,
// 2001, section 6.3.2: an acceleration that is constant from one sighting to the next.
PointEstimate TagTrack::Predict(const Filter& filter, EpisodeTime t) const {
  const double dt = (t - filter.t).seconds();
  PointEstimate later = filter.estimate;
  later.p_W += dt * later.v_W;
  Eigen::Matrix<double, 6, 6> F = Eigen::Matrix<double, 6, 6>::Identity();
  F.topRightCorner<3, 3>().diagonal().setConstant(dt);
  Eigen::Matrix<double, 6, 3> G;
  G.topRows<3>() = dt * dt / 2 * Eigen::Matrix3d::Identity();
  G.bottomRows<3>() = dt * Eigen::Matrix3d::Identity();
  const double variance = options_.sigma_a_m_s2 * options_.sigma_a_m_s2;
  later.covariance = F * later.covariance * F.transpose() + variance * G * G.transpose();
  return later;
}

bool TagTrack::HasTurnedTooFast(const Filter& filter, const Seen& seen) const {
  if (!seen.turn || !filter.turn) return false;
  const double most_rad = options_.most_turn_rad_s * (seen.t - filter.t).seconds() +
                          3 * (seen.turn->sigma_rad + filter.turn->sigma_rad);
  return seen.turn->R_WO.angularDistance(filter.turn->R_WO) > most_rad;
}

bool TagTrack::Try(Filter* filter, const Seen& seen, Verdict* verdict) const {
  PointEstimate at = Predict(*filter, seen.t);
  const Eigen::Vector3d off = seen.p_W - at.p_W;
  const Eigen::Matrix3d P = at.covariance.topLeftCorner<3, 3>();
  verdict->nis = off.dot((P + seen.R_m2).ldlt().solve(off));
  const double moved_m = (seen.p_W - filter->estimate.p_W).norm();
  const double most_m =
      options_.most_speed_m_s * (seen.t - filter->t).seconds() +
      3 * std::sqrt(seen.R_m2.trace() + filter->estimate.covariance.topLeftCorner<3, 3>().trace());
  verdict->is_too_fast = moved_m > most_m;
  if (!(verdict->nis <= options_.gate) || verdict->is_too_fast || HasTurnedTooFast(*filter, seen)) {
    return false;
  }
  // What is unlikely is believed less.
  const Eigen::Matrix3d R = std::max(1.0, verdict->nis / options_.expected) * (P + seen.R_m2) - P;
  verdict->R_m2 = R;
  const Eigen::Matrix<double, 6, 3> K =
      (P + R).ldlt().solve(at.covariance.leftCols<3>().transpose()).transpose();
  at.p_W += K.topRows<3>() * off;
  at.v_W += K.bottomRows<3>() * off;
  Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Identity();  // Joseph's form
  J.leftCols<3>() -= K;
  at.covariance = J * at.covariance * J.transpose() + K * R * K.transpose();
  filter->t = seen.t;
  filter->estimate = at;
  filter->turn = seen.turn;
  ++filter->num_agreeing;
  return true;
}

// Sightings that no track takes may agree with one another: then they are the new track.
TagTrack::Verdict TagTrack::Challenge(const Seen& seen) {
  Verdict verdict;
  if (challenger_ && Try(&*challenger_, seen, &verdict)) return verdict;
  challenger_ = Filter();
  Filter& first = *challenger_;
  first.t = seen.t;
  first.turn = seen.turn;
  first.estimate.p_W = seen.p_W;
  first.estimate.covariance.topLeftCorner<3, 3>() = seen.R_m2;
  first.estimate.covariance.bottomRightCorner<3, 3>().diagonal().setConstant(options_.sigma_v_m_s *
                                                                             options_.sigma_v_m_s);
  return verdict;
}

TagTrack::Verdict TagTrack::Update(EpisodeTime t, const Eigen::Vector3d& p_W,
                                   const Eigen::Matrix3d& R_m2,
                                   const std::optional<SeenTurn>& turn) {
  PassTime(t);
  const Seen seen = {t, p_W, R_m2, turn};
  Verdict verdict;
  if (track_) {
    verdict.is_taken = Try(&*track_, seen, &verdict);
    if (verdict.is_taken) {
      num_rejects_ = 0;
      challenger_.reset();
      return verdict;
    }
    if (++num_rejects_ >= options_.most_rejects && !options_.holds_on) Lose();
  }
  const bool is_followed = track_.has_value();
  const Verdict challenge = Challenge(seen);
  if (!is_followed) verdict.is_too_fast = challenge.is_too_fast;
  const bool gives_way = !track_ || num_rejects_ >= options_.most_rejects;
  if (gives_way && challenger_->num_agreeing >= options_.least_agreeing) {
    if (track_) Lose();
    verdict.num_begun_with = challenger_->num_agreeing;
    track_ = challenger_;
    challenger_.reset();
    num_rejects_ = 0;
    verdict.is_taken = true;
  }
  return verdict;
}

void TagTrack::PassTime(EpisodeTime t) {
  const auto is_older = [&](const std::optional<Filter>& filter, double patience_s) {
    return filter && (t - filter->t).seconds() > patience_s;
  };
  if (is_older(challenger_, options_.agree_within_s)) challenger_.reset();
  if (is_older(track_, options_.patience_s)) Lose();
}

void TagTrack::Lose() {
  track_.reset();
  ++num_losses_;
}

double TagTrack::DistanceOf(EpisodeTime t, const Eigen::Vector3d& p_W,
                            const Eigen::Matrix3d& R_m2) const {
  const std::optional<Filter>& filter = track_ ? track_ : challenger_;
  if (!filter) return std::numeric_limits<double>::infinity();
  const PointEstimate at = Predict(*filter, t);
  const Eigen::Vector3d off = p_W - at.p_W;
  const Eigen::Matrix3d S = at.covariance.topLeftCorner<3, 3>() + R_m2;
  return off.dot(S.ldlt().solve(off));
}

std::optional<PointEstimate> TagTrack::At(EpisodeTime t) const {
  if (!track_) return std::nullopt;
  return Predict(*track_, t);
}

}  // namespace sidestep
