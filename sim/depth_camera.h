#pragma once

#include <memory>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/robot/sensor.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/capture_clock.h"
#include "sidestep/sim/flying_pixels.h"
#include "sidestep/sim/ray_caster.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// A depth camera that stands still in the world: one ray through the middle of each pixel, met by
/// the true solids. Its frame C is that of computer vision: x to the right of the image, y down,
/// z forward.
///
/// A scan (of ScanKind::kSurface) holds a point for each pixel that sees a thing other than robot
/// and floor, at its depth z with noise of standard deviation noise_per_m z^2, along the pixel's
/// ray. Pixels that see the floor, the robot, or nothing within range_m of depth say that their ray
/// is free so far, as after a filter that knows where the robot is; with sees_robot the robot is
/// measured as all else is. Pixels that drop out say nothing. One whose neighbour to the right or
/// below is at another depth (edge_m) flies with the probability flying_pixels: it measures evenly
/// between the two. Those that are found to fly (sim/flying_pixels.h) say nothing either.
///
/// It may truly stand elsewhere than scans say (misplaced_m).
class DepthCamera final : public robot::Sensor {
 public:
  /// @param world must outlive this.
  DepthCamera(const World& world, const scenarios::CameraSettings& settings, double rate_hz,
              std::uint64_t seed);

  EpisodeTime NextDue() const override { return clock_.Next(); }
  std::optional<Scan> Read(EpisodeTime now) override;

 private:
  // Puts pixels that fly into the image.
  void MakeFly(const std::vector<double>& depths_m, std::vector<bool>& is_measured,
               DepthImage* image);
  bool HasEdge(double a_m, double b_m) const;

  const World& world_;
  scenarios::CameraSettings settings_;
  CaptureClock clock_;
  RayCaster caster_;
  Pose X_WC_;                            ///< as told
  Eigen::Vector3d p_WC_;                 ///< as it is
  std::vector<Eigen::Vector3d> rays_C_;  ///< of each pixel, to depth 1 [m]
  RandomStream depth_, dropout_, flying_;
};

/// As a scenario describes it, which must have settings of a camera.
std::unique_ptr<robot::Sensor> MakeDepthCamera(const scenarios::Scenario& scenario,
                                               const World& world);

}  // namespace sidestep::sim
