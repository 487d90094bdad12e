#include "sidestep/hardware/planar_pose.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace sidestep::hardware {
namespace {

Pose PoseOf(const cv::Mat& R, const cv::Mat& t) {
  Eigen::Matrix3d rotation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation(row, column) = R.at<double>(row, column);
  }
  return {Eigen::Quaterniond(rotation), {t.at<double>(0), t.at<double>(1), t.at<double>(2)}};
}

void Append(const Pose& X, std::vector<cv::Mat>* rotations, std::vector<cv::Mat>* translations) {
  const Eigen::Matrix3d R = X.rotation().toRotationMatrix();
  const Eigen::Vector3d& p = X.translation();
  cv::Mat rotation(3, 3, CV_64F);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation.at<double>(row, column) = R(row, column);
  }
  rotations->push_back(rotation);
  translations->push_back((cv::Mat_<double>(3, 1) << p.x(), p.y(), p.z()));
}

}  // namespace

std::array<Pose, 2> PosesOfSquare(const Eigen::Matrix<double, 2, 4>& corners, double size_m) {
  const double h = size_m / 2;
  // OpenCV's square has y up and z out of the print, and begins at the upper left.
  const std::vector<cv::Point3d> square = {{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
  std::vector<cv::Point2d> seen;
  for (const int k : {3, 2, 1, 0}) seen.emplace_back(corners(0, k), corners(1, k));
  std::vector<cv::Mat> rotations, translations;
  cv::solvePnPGeneric(square, seen, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations,
                      translations, false, cv::SOLVEPNP_IPPE_SQUARE);
  if (rotations.empty()) throw std::runtime_error("no pose explains the corners of a tag");
  const Pose X_SquareT(Eigen::Quaterniond(0, 1, 0, 0), Eigen::Vector3d::Zero());
  std::array<Pose, 2> poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t from = std::min(i, rotations.size() - 1);
    cv::Mat R;
    cv::Rodrigues(rotations[from], R);
    poses[i] = PoseOf(R, translations[from]) * X_SquareT;
  }
  return poses;
}

HandEye EstimateHandEye(const std::vector<Pose>& X_WH, const std::vector<Pose>& X_CT) {
  if (X_WH.size() != X_CT.size() || X_WH.size() < 3) {
    throw std::invalid_argument("EstimateHandEye: needs 3 poses of hand and tag");
  }
  // OpenCV solves A X = Z B with its "world to camera" A and "base to gripper" B. Here the tag is
  // its camera's world: X_TC X_CW = X_TH X_HW.
  std::vector<cv::Mat> R_world2cam, t_world2cam, R_base2gripper, t_base2gripper;
  for (std::size_t i = 0; i < X_WH.size(); ++i) {
    Append(X_CT[i].Inverse(), &R_world2cam, &t_world2cam);
    Append(X_WH[i].Inverse(), &R_base2gripper, &t_base2gripper);
  }
  cv::Mat R_CW, t_CW, R_TH, t_TH;
  cv::calibrateRobotWorldHandEye(R_world2cam, t_world2cam, R_base2gripper, t_base2gripper, R_CW,
                                 t_CW, R_TH, t_TH, cv::CALIB_ROBOT_WORLD_HAND_EYE_SHAH);
  return {PoseOf(R_CW, t_CW).Inverse(), PoseOf(R_TH, t_TH).Inverse()};
}

}  // namespace sidestep::hardware
