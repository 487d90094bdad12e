#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/hardware/body_pose.h"
#include "sidestep/render/rendered_camera.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/world.h"

namespace sidestep {

/// A box with tags before a rendered camera, at one pose after the other.
class PosedTags {
 public:
  /// @param X_CO of the box in the camera, of each frame.
  /// @param tags of the box, as a scenario has them.
  /// @param settings further settings of the camera, as a scenario has them.
  PosedTags(const std::vector<Pose>& X_CO, const Eigen::Vector3d& size_m, const std::string& tags,
            const std::string& settings = "");

  const hardware::TaggedBody& body() const { return body_; }
  const Pose& X_WC() const { return camera_->X_WC(); }
  /// The next frame, and where the box truly is in it.
  robot::Frame Take();
  Pose X_CO() const;

 private:
  scenarios::Scenario scenario_;
  hardware::TaggedBody body_;
  std::optional<sim::World> world_;
  std::optional<render::RenderedCamera> camera_;
};

}  // namespace sidestep
