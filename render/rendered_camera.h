#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sidestep/core/random.h"
#include "sidestep/robot/frame_source.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/capture_clock.h"
#include "sidestep/sim/delay_line.h"
#include "sidestep/sim/world.h"

namespace sidestep::render {

/// The serial number of every rendered camera.
inline constexpr const char* kRenderedSerial = "rendered";

/// The lens of the camera of a scenario, whose sensor must have settings of tag_images.
robot::CameraIntrinsics IntrinsicsOf(const scenarios::Scenario& scenario);

/// A grey camera that stands still in a simulated world: MuJoCo's picture of it through a lens
/// (render/lens.h), taken at a fixed rate. The exposure is centred on the time of capture, and what
/// moves is smeared over it; each pixel has noise; frames arrive late, or never, as the settings of
/// the sensor say (sim/delay_line.h). Shadows are not drawn.
class RenderedCamera final : public robot::FrameSource {
 public:
  /// @param scenario its sensor must have settings of tag_images.
  /// @param world must outlive this.
  /// @throws InputError if nothing can be drawn here, or the distortion has no end.
  RenderedCamera(const scenarios::Scenario& scenario, const sim::World& world);
  ~RenderedCamera() override;

  EpisodeTime NextDue() const override;
  std::optional<robot::Frame> Read(EpisodeTime now) override;

  /// The pose of the camera, as the scenario has it.
  const Pose& X_WC() const;

 private:
  class Studio;

  robot::Frame Capture();

  const sim::World& world_;
  sim::CaptureClock clock_;
  sim::DelayLine<robot::Frame> line_;
  double grey_noise_;
  RandomStream noise_;
  std::int64_t number_ = 0;
  std::unique_ptr<Studio> studio_;
};

}  // namespace sidestep::render
