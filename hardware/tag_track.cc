#include "sidestep/hardware/tag_track.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sidestep::hardware {

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

bool TagTrack::Try(Filter* filter, EpisodeTime t, const Eigen::Vector3d& p_W,
                   const Eigen::Matrix3d& R_m2, double* nis) const {
  PointEstimate at = Predict(*filter, t);
  const Eigen::Vector3d off = p_W - at.p_W;
  const Eigen::Matrix3d P = at.covariance.topLeftCorner<3, 3>();
  *nis = off.dot((P + R_m2).ldlt().solve(off));
  const double moved_m = (p_W - filter->estimate.p_W).norm();
  const double most_m =
      options_.most_speed_m_s * (t - filter->t).seconds() +
      3 * std::sqrt(R_m2.trace() + filter->estimate.covariance.topLeftCorner<3, 3>().trace());
  if (!(*nis <= options_.gate) || moved_m > most_m) return false;
  // What is unlikely is believed less.
  const Eigen::Matrix3d R = std::max(1.0, *nis / options_.expected) * R_m2;
  const Eigen::Matrix<double, 6, 3> K =
      (P + R).ldlt().solve(at.covariance.leftCols<3>().transpose()).transpose();
  at.p_W += K.topRows<3>() * off;
  at.v_W += K.bottomRows<3>() * off;
  Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Identity();  // Joseph's form
  J.leftCols<3>() -= K;
  at.covariance = J * at.covariance * J.transpose() + K * R * K.transpose();
  filter->t = t;
  filter->estimate = at;
  ++filter->num_agreeing;
  return true;
}

// Sightings that no track takes may agree with one another: then they are the new track.
void TagTrack::Challenge(EpisodeTime t, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& R_m2) {
  double nis = 0;
  if (challenger_ && Try(&*challenger_, t, p_W, R_m2, &nis)) return;
  Filter& first = challenger_.emplace();
  first.t = t;
  first.estimate.p_W = p_W;
  first.estimate.covariance.topLeftCorner<3, 3>() = R_m2;
  first.estimate.covariance.bottomRightCorner<3, 3>().diagonal().setConstant(options_.sigma_v_m_s *
                                                                             options_.sigma_v_m_s);
}

TagTrack::Verdict TagTrack::Update(EpisodeTime t, const Eigen::Vector3d& p_W,
                                   const Eigen::Matrix3d& R_m2) {
  PassTime(t);
  Verdict verdict;
  if (track_) {
    verdict.is_taken = Try(&*track_, t, p_W, R_m2, &verdict.nis);
    if (verdict.is_taken) {
      num_rejects_ = 0;
      challenger_.reset();
      return verdict;
    }
    if (++num_rejects_ >= options_.most_rejects) {
      track_.reset();
      ++num_losses_;
    }
  }
  Challenge(t, p_W, R_m2);
  if (!track_ && challenger_->num_agreeing >= options_.least_agreeing) {
    track_ = challenger_;
    challenger_.reset();
    num_rejects_ = 0;
    verdict.is_taken = true;
  }
  return verdict;
}

void TagTrack::PassTime(EpisodeTime t) {
  const auto is_old = [&](const std::optional<Filter>& filter) {
    return filter && (t - filter->t).seconds() > options_.patience_s;
  };
  if (is_old(challenger_)) challenger_.reset();
  if (is_old(track_)) {
    track_.reset();
    ++num_losses_;
  }
}

std::optional<PointEstimate> TagTrack::At(EpisodeTime t) const {
  if (!track_) return std::nullopt;
  return Predict(*track_, t);
}

}  // namespace sidestep::hardware
