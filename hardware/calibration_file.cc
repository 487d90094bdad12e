#include <algorithm>
#include <charconv>
#include <chrono>

#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/yaml_reader.h"
#include "sidestep/hardware/camera_calibration.h"
#include "sidestep/hardware/camera_file.h"

namespace sidestep::hardware {
namespace {

// Days since 1970; nothing for what is no date of the form YYYY-MM-DD.
std::optional<int> DaysOf(const std::string& date) {
  int parts[3] = {};
  const std::size_t begins[] = {0, 5, 8}, lengths[] = {4, 2, 2};
  if (date.size() != 10 || date[4] != '-' || date[7] != '-') return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    const char* const from = date.data() + begins[i];
    const auto read = std::from_chars(from, from + lengths[i], parts[i]);
    if (read.ec != std::errc() || read.ptr != from + lengths[i]) return std::nullopt;
  }
  const std::chrono::year_month_day day{std::chrono::year(parts[0]),
                                        std::chrono::month(static_cast<unsigned>(parts[1])),
                                        std::chrono::day(static_cast<unsigned>(parts[2]))};
  if (!day.ok()) return std::nullopt;
  return std::chrono::sys_days(day).time_since_epoch().count();
}

std::string List(const Eigen::VectorXd& values) {
  return "[" + Joined(values, ", ", &ShortestText) + "]";
}

std::string PoseText(const Pose& X) {
  const Eigen::Quaterniond& R = X.rotation();
  return "{position_m: " + List(X.translation()) +
         ", quaternion_wxyz: " + List(Eigen::Vector4d(R.w(), R.x(), R.y(), R.z())) + "}";
}

Pose ReadPose(const YamlReader& parent, const char* key) {
  const YamlReader map = parent.GetMap(key);
  const Eigen::VectorXd wxyz = map.GetVector("quaternion_wxyz", 4);
  if (std::abs(wxyz.norm() - 1) > 1e-6) map.Fail("quaternion_wxyz", "must have length 1");
  const Pose X(Eigen::Quaterniond(wxyz(0), wxyz(1), wxyz(2), wxyz(3)),
               map.GetVector3("position_m"));
  map.CheckNoUnknownKeys();
  return X;
}

}  // namespace

std::optional<std::string> WhyNotUsable(const CameraCalibration& calibration,
                                        const std::string& serial,
                                        const robot::CameraIntrinsics& camera,
                                        const std::string& today, int most_age_days) {
  if (calibration.serial != serial) {
    return "it is of the camera " + calibration.serial + ", this one is " + serial;
  }
  if (calibration.camera != camera) {
    return "the camera has another lens or picture size than when it was calibrated";
  }
  const std::optional<int> then = DaysOf(calibration.date), now = DaysOf(today);
  if (!then || !now) return "its date '" + calibration.date + "' is none";
  const int age_days = *now - *then;
  if (age_days < 0) return "its date " + calibration.date + " is to come: today is " + today;
  if (age_days > most_age_days) {
    return "it is " + std::to_string(age_days) + " days old, allowed " +
           std::to_string(most_age_days);
  }
  return WhyNotAccepted(calibration);
}

CameraCalibration ReadCalibration(const std::string& path) {
  const YamlReader top = YamlReader::FromFile(path);
  CameraCalibration calibration;
  const NamedCamera camera = ReadCamera(top.GetMap("camera"));
  calibration.serial = camera.serial;
  calibration.camera = camera.intrinsics;
  calibration.robot = top.GetString("robot");
  calibration.date = top.GetString("date");
  if (!DaysOf(calibration.date)) top.Fail("date", "must be YYYY-MM-DD");
  calibration.X_WC = ReadPose(top, "camera_in_world");
  calibration.X_HT = ReadPose(top, "tag_in_hand");
  const YamlReader residuals = top.GetMap("residuals");
  calibration.num_views = residuals.GetInt("views");
  calibration.reprojection_px = residuals.GetNonNegative("reprojection_px");
  calibration.num_held_out = residuals.GetInt("held_out");
  calibration.held_out_rms_m = residuals.GetNonNegative("held_out_rms_m");
  calibration.held_out_max_m = residuals.GetNonNegative("held_out_max_m");
  calibration.held_out_rms_rad = residuals.GetNonNegative("held_out_rms_rad");
  residuals.CheckNoUnknownKeys();
  top.CheckNoUnknownKeys();
  return calibration;
}

std::string ToYaml(const CameraCalibration& calibration) {
  return "# Where a camera stands: sidestep hardware calibrate.\ncamera: " +
         ToYaml(NamedCamera{calibration.serial, calibration.camera}) +
         "\nrobot: " + calibration.robot + "\ndate: " + calibration.date +
         "\ncamera_in_world: " + PoseText(calibration.X_WC) +
         "\ntag_in_hand: " + PoseText(calibration.X_HT) +
         "\nresiduals:\n  views: " + std::to_string(calibration.num_views) +
         "\n  reprojection_px: " + ShortestText(calibration.reprojection_px) +
         "\n  held_out: " + std::to_string(calibration.num_held_out) +
         "\n  held_out_rms_m: " + ShortestText(calibration.held_out_rms_m) +
         "\n  held_out_max_m: " + ShortestText(calibration.held_out_max_m) +
         "\n  held_out_rms_rad: " + ShortestText(calibration.held_out_rms_rad) + "\n";
}

}  // namespace sidestep::hardware
