#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>

#include "sidestep/core/random.h"
#include "sidestep/robot/sensor.h"

namespace sidestep::bench {

/// What is wrong with the scans of a sensor, whatever it is.
struct SensorFaults {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  double blind_from_s = kNever, blind_for_s = 0;  ///< of capture: no scan comes
  double lost_from_s = kNever;                    ///< no object is in a scan from then on
  double ahead_from_s = kNever, ahead_s = 0;      ///< the time stamps from then on are so late
  double outlier_share = 0;                       ///< of objects, which are anywhere near
  double shift_m = 0, turn_rad = 0;               ///< a calibration that is off by this
};

/// Another sensor, with that.
class FaultySensor final : public robot::Sensor {
 public:
  /// @param sensor must outlive this.
  FaultySensor(robot::Sensor* sensor, const SensorFaults& faults, std::uint64_t seed);

  EpisodeTime NextDue() const override { return sensor_->NextDue(); }
  std::optional<Scan> Read(EpisodeTime now) override;

 private:
  static constexpr double kOutlier_m = 0.5;

  robot::Sensor* sensor_;
  SensorFaults faults_;
  RandomStream random_;
  Pose X_WE_;  // where the world is thought to be, by a wrong calibration
};

}  // namespace sidestep::bench
