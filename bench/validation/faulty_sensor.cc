#include "sidestep/bench/validation/faulty_sensor.h"

namespace sidestep::bench {
namespace {

using Eigen::Vector3d;

Vector3d AnyDirection(RandomStream& random) {
  Vector3d v;
  do {
    v = Vector3d(random.Normal(), random.Normal(), random.Normal());
  } while (v.norm() < 1e-3);
  return v.normalized();
}

}  // namespace

FaultySensor::FaultySensor(robot::Sensor* sensor, const SensorFaults& faults, std::uint64_t seed)
    : sensor_(sensor), faults_(faults), random_(seed, "faulty sensor") {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(faults.turn_rad, AnyDirection(random_)));
  X_WE_ = Pose(turn, faults.shift_m * AnyDirection(random_));
}

std::optional<Scan> FaultySensor::Read(EpisodeTime now) {
  std::optional<Scan> scan = sensor_->Read(now);
  if (!scan) return scan;
  const double t_s = scan->t.seconds();
  if (t_s >= faults_.blind_from_s && t_s < faults_.blind_from_s + faults_.blind_for_s) return {};
  if (t_s >= faults_.lost_from_s) scan->objects.clear();
  for (ObjectObservation& object : scan->objects) {
    if (faults_.shift_m != 0 || faults_.turn_rad != 0) {
      // About the camera, whose place is what a calibration gets wrong.
      const Pose X_WC = scan->X_WC;
      object.X_WO = X_WC * X_WE_ * X_WC.Inverse() * object.X_WO;
    }
    if (faults_.outlier_share > 0 && random_.Uniform() < faults_.outlier_share) {
      const Vector3d p_W = object.X_WO.translation() + kOutlier_m * AnyDirection(random_);
      object.X_WO = Pose(object.X_WO.rotation(), p_W);
    }
  }
  if (t_s >= faults_.ahead_from_s) {
    scan->t = scan->t + HorizonOffset(faults_.ahead_s);
    for (ObjectObservation& object : scan->objects) object.t = scan->t;
  }
  return scan;
}

}  // namespace sidestep::bench
