#include "sidestep/hardware/tag_sensor.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "sidestep/core/number_text.h"
#include "sidestep/robot/robot_error.h"

namespace sidestep::hardware {
namespace {

constexpr int kDriftedPictures = 5;  // in a row: somebody may pass before a reference

Eigen::Matrix<double, 6, 6> InWorld(const Eigen::Matrix<double, 6, 6>& covariance_C,
                                    const Pose& X_WC) {
  Eigen::Matrix<double, 6, 6> R = Eigen::Matrix<double, 6, 6>::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = X_WC.rotation().toRotationMatrix();
  return R * covariance_C * R.transpose();
}

double LargestSigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, axes.eigenvalues()(2)));
}

}  // namespace

TagSensor::TagSensor(std::unique_ptr<robot::FrameSource> frames, TagSensorOptions options)
    : frames_(std::move(frames)), options_(std::move(options)), detector_(options_.detector) {
  for (std::size_t i = 0; i < options_.bodies.size(); ++i) {
    followed_.emplace_back().track = TagTrack(options_.track);
  }
}

std::optional<Scan> TagSensor::Read(EpisodeTime now) {
  const std::optional<robot::Frame> frame = frames_->Read(now);
  if (!frame) return std::nullopt;
  const std::vector<TagDetection> tags = detector_.Detect(frame->image);
  CheckReferences(*frame, tags);
  Scan scan;
  scan.t = frame->t;
  scan.p_CP = options_.p_WStatic;
  for (std::size_t i = 0; i < followed_.size(); ++i) {
    if (auto seen = Observe(*frame, tags, options_.bodies[i], &followed_[i])) {
      scan.objects.push_back(std::move(*seen));
    }
  }
  if (options_.on_look) options_.on_look({*frame, tags, scan});
  return scan;
}

std::optional<ObjectObservation> TagSensor::Observe(const robot::Frame& frame,
                                                    const std::vector<TagDetection>& tags,
                                                    const TaggedBody& body,
                                                    Followed* followed) const {
  followed->track.PassTime(frame.t);
  std::optional<RotationPrior> prior;
  if (followed->was_seen && followed->track.is_followed()) {
    const double turned_rad = options_.turn_rate_rad_s * (frame.t - followed->t).seconds();
    prior = {options_.X_WC.rotation().conjugate() * followed->R_WO,
             std::hypot(followed->sigma_rad, turned_rad)};
  }
  const std::optional<BodyPose> pose =
      LocateBody(frame.camera, body, tags, options_.edge_sigma_px, prior);
  if (!pose || pose->reprojection_px > options_.most_reprojection_px) return std::nullopt;
  const double depth_m = pose->X_CO.translation().z();
  if (depth_m < options_.nearest_m || depth_m > options_.farthest_m) return std::nullopt;

  ObjectObservation observation;
  observation.id = body.name;
  observation.t = frame.t;
  observation.X_WO = options_.X_WC * pose->X_CO;
  observation.covariance = InWorld(pose->covariance, options_.X_WC);
  observation.shape = body.shape;
  const TagTrack::Verdict verdict = followed->track.Update(
      frame.t, observation.X_WO.translation(), observation.covariance.topLeftCorner<3, 3>());
  if (!verdict.is_taken) return std::nullopt;
  followed->t = frame.t;
  followed->R_WO = observation.X_WO.rotation();
  followed->sigma_rad = LargestSigma(observation.covariance.bottomRightCorner<3, 3>());
  followed->was_seen = true;
  return observation;
}

void TagSensor::CheckReferences(const robot::Frame& frame, const std::vector<TagDetection>& tags) {
  double farthest_m = 0;
  std::string of;
  for (const ReferenceBody& reference : options_.references) {
    const std::optional<BodyPose> pose =
        LocateBody(frame.camera, reference.body, tags, options_.edge_sigma_px);
    if (!pose || pose->reprojection_px > options_.most_reprojection_px) continue;
    const Eigen::Vector3d drift =
        options_.X_WC * pose->X_CO.translation() - reference.X_WO.translation();
    const double drift_m = drift.norm();
    if (drift_m <= farthest_m) continue;
    // What is seen badly that way proves nothing.
    const Eigen::Matrix3d C_m2 = InWorld(pose->covariance, options_.X_WC).topLeftCorner<3, 3>();
    const double sigma_m = std::sqrt(drift.dot(C_m2 * drift)) / drift_m;
    if (3 * sigma_m > options_.most_drift_m) continue;
    farthest_m = drift_m;
    of = reference.body.name;
  }
  num_drifted_ = farthest_m > options_.most_drift_m ? num_drifted_ + 1 : 0;
  if (num_drifted_ < kDriftedPictures) return;
  throw robot::RobotError("the camera " + frame.serial + " was moved: it sees '" + of + "' " +
                          FiniteText("{:.3f}", farthest_m) + " m from where it stands");
}

}  // namespace sidestep::hardware
