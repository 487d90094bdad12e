#include "sidestep/hardware/camera_calibration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/rotation_vector.h"
#include "sidestep/hardware/body_pose.h"
#include "sidestep/hardware/planar_pose.h"

namespace sidestep::hardware {
namespace {

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

constexpr double kRadPerDegree = std::numbers::pi / 180;

Pose Moved(const Pose& X, const Eigen::Ref<const Eigen::Matrix<double, 6, 1>>& by) {
  return {RotationBy(by.tail<3>()) * X.rotation(), X.translation() + by.head<3>()};
}

Eigen::Matrix<double, 8, 1> PixelsOfTag(const robot::CameraIntrinsics& camera, const Pose& X_CT,
                                        double size_m) {
  const Eigen::Matrix<double, 3, 4> p_TQ = CornersOfTag(size_m);
  Eigen::Matrix<double, 8, 1> pixels;
  for (int k = 0; k < 4; ++k) pixels.segment<2>(2 * k) = Project(camera, X_CT * p_TQ.col(k));
  return pixels;
}

// All corners' errors [px].
Eigen::VectorXd Errors(const robot::CameraIntrinsics& camera, double size_m,
                       const std::vector<HandView>& views, const HandEye& eye) {
  Eigen::VectorXd errors(8 * static_cast<Eigen::Index>(views.size()));
  const Pose X_CW = eye.X_WC.Inverse();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Eigen::Map<const Eigen::Matrix<double, 8, 1>> seen(views[i].tag.corners_px.data());
    errors.segment<8>(8 * static_cast<Eigen::Index>(i)) =
        PixelsOfTag(camera, X_CW * views[i].X_WH * eye.X_HT, size_m) - seen;
  }
  return errors;
}

// Gauss-Newton with damping, its derivatives by central differences.
HandEye Refine(const robot::CameraIntrinsics& camera, double size_m,
               const std::vector<HandView>& views, HandEye eye) {
  const auto moved = [&](const Vector12& by) {
    return HandEye{Moved(eye.X_WC, by.head<6>()), Moved(eye.X_HT, by.tail<6>())};
  };
  Eigen::VectorXd errors = Errors(camera, size_m, views, eye);
  double damping = 1e-6;
  constexpr int kMostSteps = 50;
  constexpr double kStep = 1e-6;
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Matrix<double, Eigen::Dynamic, 12> J(errors.size(), 12);
    for (int i = 0; i < 12; ++i) {
      const Vector12 aside = kStep * Vector12::Unit(i);
      J.col(i) = (Errors(camera, size_m, views, moved(aside)) -
                  Errors(camera, size_m, views, moved(-aside))) /
                 (2 * kStep);
    }
    Matrix12 H = J.transpose() * J;
    H.diagonal() *= 1 + damping;
    const Vector12 delta = -H.ldlt().solve(J.transpose() * errors);
    if (!delta.allFinite()) break;
    const HandEye next = moved(delta);
    const Eigen::VectorXd next_errors = Errors(camera, size_m, views, next);
    if (!(next_errors.squaredNorm() < errors.squaredNorm())) {
      damping *= 10;
      if (damping > 1e6) break;
      continue;
    }
    const bool is_done =
        errors.squaredNorm() - next_errors.squaredNorm() < 1e-12 * errors.squaredNorm();
    eye = next;
    errors = next_errors;
    damping = std::max(1e-12, damping / 10);
    if (is_done) break;
  }
  return eye;
}

TaggedBody TagAlone(int id, double size_m) {
  return {"tag", Box{Eigen::Vector3d::Zero()}, {{id, size_m, Pose()}}};
}

std::optional<Pose> LocateTag(const robot::CameraIntrinsics& camera, double size_m,
                              const TagDetection& tag,
                              const std::optional<RotationPrior>& prior = std::nullopt) {
  const auto pose = LocateBody(camera, TagAlone(tag.id, size_m), {tag}, kEdgeSigma_px, prior);
  if (!pose) return std::nullopt;
  return pose->X_CO;
}

[[noreturn]] void Fail(const std::string& why) { throw InputError("views", why); }

// How far the hand was turned about each of the two axes about which it was turned most.
double SecondTurn(const std::vector<HandView>& views) {
  Eigen::Matrix3Xd turns(3, static_cast<Eigen::Index>(views.size()));
  for (std::size_t i = 0; i < views.size(); ++i) {
    turns.col(static_cast<Eigen::Index>(i)) =
        RotationVector(views[0].X_WH.rotation().conjugate() * views[i].X_WH.rotation());
  }
  const Eigen::Matrix3Xd centred = turns.colwise() - turns.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred * centred.transpose());
  const Eigen::RowVectorXd along = axes.eigenvectors().col(1).transpose() * centred;
  return along.maxCoeff() - along.minCoeff();
}

void JudgeByHeldOut(const robot::CameraIntrinsics& camera, double size_m,
                    const std::vector<HandView>& held_out, CameraCalibration* calibration) {
  double squares_m2 = 0, squares_rad2 = 0;
  for (const HandView& view : held_out) {
    const Pose X_WT = view.X_WH * calibration->X_HT;
    const Pose X_CT = calibration->X_WC.Inverse() * X_WT;
    // Which of the two poses of a square is meant is no question here.
    const RotationPrior near{X_CT.rotation(), 10 * kRadPerDegree};
    const std::optional<Pose> seen = LocateTag(camera, size_m, view.tag, near);
    if (!seen) Fail("one of the tag cannot be explained by any pose");
    const double off_m = (seen->translation() - X_CT.translation()).norm();
    const double off_rad = seen->rotation().angularDistance(X_CT.rotation());
    squares_m2 += off_m * off_m;
    squares_rad2 += off_rad * off_rad;
    calibration->held_out_max_m = std::max(calibration->held_out_max_m, off_m);
  }
  const auto count = static_cast<double>(held_out.size());
  calibration->num_held_out = static_cast<int>(held_out.size());
  calibration->held_out_rms_m = std::sqrt(squares_m2 / count);
  calibration->held_out_rms_rad = std::sqrt(squares_rad2 / count);
}

}  // namespace

CameraCalibration CalibrateCamera(const robot::CameraIntrinsics& camera, double tag_size_m,
                                  const std::vector<HandView>& views) {
  const int count = static_cast<int>(views.size());
  if (count < kLeastViews + kHeldOut) {
    Fail("show the tag " + std::to_string(count) + " times, needed are " +
         std::to_string(kLeastViews + kHeldOut));
  }
  const double turn_rad = SecondTurn(views);
  if (turn_rad < kLeastTurn_rad) {
    Fail("turn the hand by " + FiniteText("{:.0f}", turn_rad / kRadPerDegree) +
         " degrees about the second axis, needed are 30 about two");
  }
  std::vector<HandView> fitted, held_out;
  for (int i = 0, next = 0; i < count; ++i) {
    const bool is_held_out = next < kHeldOut && i == (2 * next + 1) * count / (2 * kHeldOut);
    next += is_held_out ? 1 : 0;
    (is_held_out ? held_out : fitted).push_back(views[static_cast<std::size_t>(i)]);
  }
  std::vector<Pose> X_WH, X_CT;
  for (const HandView& view : fitted) {
    const std::optional<Pose> seen = LocateTag(camera, tag_size_m, view.tag);
    if (!seen) Fail("one of the tag cannot be explained by any pose");
    X_WH.push_back(view.X_WH);
    X_CT.push_back(*seen);
  }
  const HandEye eye = Refine(camera, tag_size_m, fitted, EstimateHandEye(X_WH, X_CT));
  const Eigen::VectorXd errors_px = Errors(camera, tag_size_m, fitted, eye);
  CameraCalibration calibration;
  calibration.camera = camera;
  calibration.X_WC = eye.X_WC;
  calibration.X_HT = eye.X_HT;
  calibration.num_views = static_cast<int>(fitted.size());
  calibration.reprojection_px =
      std::sqrt(errors_px.squaredNorm() / static_cast<double>(errors_px.size()));
  JudgeByHeldOut(camera, tag_size_m, held_out, &calibration);
  return calibration;
}

std::optional<std::string> WhyNotAccepted(const CameraCalibration& calibration) {
  if (calibration.num_views < kLeastViews || calibration.num_held_out < kHeldOut) {
    return "it was fitted to " + std::to_string(calibration.num_views) + " views and judged by " +
           std::to_string(calibration.num_held_out) + ", needed are 15 and 5";
  }
  const struct {
    const char* what;
    double value, most, unit;
    const char* format;
  } bounds[] = {
      {"root mean square of position", calibration.held_out_rms_m, kMostHeldOutRms_m, 1e-3,
       "{:.1f} mm"},
      {"largest error of position", calibration.held_out_max_m, kMostHeldOut_m, 1e-3, "{:.1f} mm"},
      {"root mean square of rotation", calibration.held_out_rms_rad, kMostHeldOutRms_rad,
       kRadPerDegree, "{:.2f} degrees"}};
  for (const auto& bound : bounds) {
    if (bound.value <= bound.most) continue;
    return "the " + std::string(bound.what) + " in views that it was not fitted to is " +
           FiniteText(bound.format, bound.value / bound.unit) + ", allowed " +
           FiniteText(bound.format, bound.most / bound.unit);
  }
  return std::nullopt;
}

}  // namespace sidestep::hardware
